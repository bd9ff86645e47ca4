//! The family `flow`: jumps, joins and counted loops.
//!
//! A jump lands on its join in the same step, and what the join saves then says that it was reached
//! by the jump. Going back over a join asks it where control came from; the jump that it names is
//! then undone in the same step. That is why most jumps have nothing to do in reverse.

use crate::class::{AfterForward, Always, Failure};
use crate::stop::TrapKind;
use crate::values::{CounterSlots, Variables};
use obverse_isa::{CounterId, Label, LocalId, op};
use obverse_tape::record::{Bit, Counter};

/// Where control goes from an instruction, or where it came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// The instruction beside it.
    Beside,
    /// The one that it names.
    Named(Label),
}

/// What a flow opcode sees: variables, and the way it decides.
pub(crate) struct Course<'c, 'v, 'a> {
    pub(crate) variables: &'c mut Variables<'v, 'a>,
    pub(crate) way: Way,
}

impl Course<'_, '_, '_> {
    #[inline(always)]
    fn top(&self) -> i64 {
        self.variables.top().cast_signed()
    }

    #[inline(always)]
    fn below(&self) -> i64 {
        self.variables.below().cast_signed()
    }

    #[inline(always)]
    fn local(&self, local: LocalId) -> i64 {
        self.variables.values().local(local).cast_signed()
    }

    #[inline(always)]
    fn go_unless(&mut self, condition: bool, target: Label) {
        if !condition {
            self.way = Way::Named(target);
        }
    }
}

/// Jumps: whether to stay, by the operands, and where to go otherwise. Nothing is lost by one.
macro_rules! jumps {
    ($($op:ident($this:ident, $course:ident) unless $stay:expr;)*) => {$(
        impl Always<Course<'_, '_, '_>> for op::$op {
            #[inline(always)]
            fn forward(self, $course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
                let $this = self;
                $course.go_unless($stay, self.target);
                Ok(())
            }

            #[inline(always)]
            fn reverse(self, _: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
                Ok(())
            }
        }
    )*};
}

jumps! {
    Jump(_op, course) unless false;
    JumpIf(_op, course) unless course.variables.top() == 0;
    JumpUnless(_op, course) unless course.variables.top() != 0;
    JumpUnlessLt(_op, course) unless course.below() < course.top();
    JumpUnlessLe(_op, course) unless course.below() <= course.top();
    JumpUnlessEq(_op, course) unless course.below() == course.top();
    JumpUnlessNe(_op, course) unless course.below() != course.top();
    JumpUnlessEqImmediate(op, course) unless course.top() == i64::from(op.value);
    JumpUnlessLocalLtImmediate(op, course) unless course.local(op.local) < i64::from(op.value);
    JumpUnlessLocalLtLocal(op, course) unless course.local(op.left) < course.local(op.right);
}

impl Always<Course<'_, '_, '_>> for op::Land {
    #[inline(always)]
    fn forward(self, _: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        course.way = Way::Named(self.from);
        Ok(())
    }
}

impl AfterForward<Course<'_, '_, '_>> for op::Join {
    type Saved = Bit;

    #[inline(always)]
    fn save(&self, _: &Course<'_, '_, '_>) -> Bit {
        // Reached from above; the jump that lands here saves the other value.
        Bit(false)
    }

    #[inline(always)]
    fn forward(self, _: &mut Course<'_, '_, '_>, _: &Bit) -> Result<(), Failure> {
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>, saved: &Bit) -> Result<(), Failure> {
        if saved.0 {
            course.way = Way::Named(self.from);
        }
        Ok(())
    }
}

impl Always<Course<'_, '_, '_>> for op::JoinAssert {
    #[inline(always)]
    fn forward(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        if course.variables.top() != 0 {
            return Err(TrapKind::Assertion { by_jump: false }.into());
        }
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        if course.variables.top() != 0 {
            course.way = Way::Named(self.from);
        }
        Ok(())
    }
}

/// The three words of a loop counter.
struct Count<'c, 'v, 'a> {
    variables: &'c mut Variables<'v, 'a>,
    slots: CounterSlots,
}

impl<'c, 'v, 'a> Count<'c, 'v, 'a> {
    #[inline(always)]
    fn of(course: &'c mut Course<'_, 'v, 'a>, counter: CounterId) -> Self {
        Self { variables: course.variables, slots: CounterSlots::of(counter) }
    }

    #[inline(always)]
    fn first(&mut self) -> i64 {
        self.variables.slot(self.slots.first).cast_signed()
    }

    #[inline(always)]
    fn last(&mut self) -> i64 {
        self.variables.slot(self.slots.last).cast_signed()
    }

    #[inline(always)]
    fn present(&mut self) -> &mut u64 {
        self.variables.slot(self.slots.present)
    }

    #[inline(always)]
    fn set(&mut self, [first, last, present]: [u64; 3]) {
        *self.variables.slot(self.slots.first) = first;
        *self.variables.slot(self.slots.last) = last;
        *self.variables.slot(self.slots.present) = present;
    }
}

impl AfterForward<Course<'_, '_, '_>> for op::ForEnter {
    type Saved = Counter;

    #[inline(always)]
    fn save(&self, course: &Course<'_, '_, '_>) -> Counter {
        let slots = CounterSlots::of(self.counter);
        let words = &course.variables.values().words;
        Counter([slots.first, slots.last, slots.present].map(|slot| words.slot(slot)))
    }

    #[inline(always)]
    fn forward(self, course: &mut Course<'_, '_, '_>, _: &Counter) -> Result<(), Failure> {
        let (first, last) = (course.variables.below(), course.variables.top());
        Count::of(course, self.counter).set([first, last, first]);
        course.go_unless(first.cast_signed() <= last.cast_signed(), self.exit);
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>, saved: &Counter) -> Result<(), Failure> {
        Count::of(course, self.counter).set(saved.0);
        Ok(())
    }
}

impl Always<Course<'_, '_, '_>> for op::ForTop {
    #[inline(always)]
    fn forward(self, _: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        let mut count = Count::of(course, self.counter);
        if count.present().cast_signed() != count.first() {
            course.way = Way::Named(self.from);
        }
        Ok(())
    }
}

impl Always<Course<'_, '_, '_>> for op::ForNext {
    #[inline(always)]
    fn forward(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        let mut count = Count::of(course, self.counter);
        // Asked before counting, so that a loop up to the largest integer ends.
        let is_last = count.present().cast_signed() == count.last();
        let present = count.present();
        *present = present.wrapping_add(1);
        course.go_unless(is_last, self.target);
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        let mut count = Count::of(course, self.counter);
        let present = count.present();
        *present = present.wrapping_sub(1);
        Ok(())
    }
}

impl Always<Course<'_, '_, '_>> for op::ForExit {
    #[inline(always)]
    fn forward(self, _: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        Ok(())
    }

    #[inline(always)]
    fn reverse(self, course: &mut Course<'_, '_, '_>) -> Result<(), Failure> {
        let mut count = Count::of(course, self.counter);
        if count.first() > count.last() {
            course.way = Way::Named(self.from);
        }
        Ok(())
    }
}
