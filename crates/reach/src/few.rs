//! Sets of horizons of which the first few are kept. The first few of a union are those of the
//! first few of its parts, so nothing that is kept depends on the order of the unions.

use crate::Horizon;

/// How many horizons of one point are kept by identity.
pub const MAX_KEPT: usize = 8;

/// The start of the program as a number: no never-instruction stands there.
const START: u32 = 0;

/// The first horizons of a set, and whether there are more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Few {
    kept: [u32; MAX_KEPT],
    len: u8,
    is_more: bool,
}

impl Few {
    pub(crate) fn of(horizon: Horizon) -> Self {
        let mut few = Self::default();
        few.insert(match horizon {
            Horizon::Start => START,
            Horizon::Never(pc) => pc,
        });
        few
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.is_more |= other.is_more;
        other.numbers().iter().for_each(|&number| self.insert(number));
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(crate) fn is_more(&self) -> bool {
        self.is_more
    }

    /// The start first, then by instruction.
    pub(crate) fn horizons(&self) -> impl Iterator<Item = Horizon> + '_ {
        self.numbers().iter().map(|&number| match number {
            START => Horizon::Start,
            pc => Horizon::Never(pc),
        })
    }

    fn numbers(&self) -> &[u32] {
        &self.kept[..usize::from(self.len)]
    }

    fn insert(&mut self, number: u32) {
        let len = usize::from(self.len);
        let at = self.kept[..len].partition_point(|&kept| kept < number);
        if self.kept[..len].get(at) == Some(&number) {
            return;
        }
        if len == MAX_KEPT {
            self.is_more = true;
        } else {
            self.len += 1;
        }
        if at < MAX_KEPT {
            let len = usize::from(self.len);
            self.kept[at..len].rotate_right(1);
            self.kept[at] = number;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn few(pcs: impl IntoIterator<Item = u32>) -> Few {
        let mut few = Few::default();
        pcs.into_iter().for_each(|pc| few.add(&Few::of(Horizon::Never(pc))));
        few
    }

    #[test]
    fn the_first_are_kept_in_any_order() {
        assert_eq!(few([5, 3, 9, 3]), few([9, 5, 3]));
        assert_eq!(few(1..=20), few((1..=20).rev()));
        assert!(few(1..=9).is_more() && !few(1..=8).is_more());
    }

    #[test]
    fn a_union_is_that_of_the_whole() {
        let mut union = few([4, 8, 15, 16, 23, 42]);
        union.add(&few([1, 2, 3, 50]));
        assert_eq!(union, few([4, 8, 15, 16, 23, 42, 1, 2, 3, 50]));
        union.add(&Few::of(Horizon::Start));
        assert_eq!(union.horizons().next(), Some(Horizon::Start));
    }
}
