//! Outputs with their recent past, and inputs that follow rules; wires that stick and flicker.
//!
//! Knows nothing of what the wires are connected to.

use crate::cell::{InputFlaw, InputRule};
use crate::random::{self, Stream, counter_of};

/// How many past changes of an output are kept for inputs that follow it with a delay.
const PAST_MAX: usize = 64;
/// How long an input that flickers keeps a level, in seconds.
const FLICKER_S: f64 = 0.001;

/// The level of an output now and before.
#[derive(Clone, Debug, Default)]
pub(crate) struct Output {
    /// What it was last set to.
    pub(crate) level: bool,
    /// What it is: something else if it sticks.
    pub(crate) actual: bool,
    /// When it changed and to what, oldest first.
    past: Vec<(f64, bool)>,
    /// The level before the oldest change that is kept.
    before: bool,
    /// How often it should have changed.
    changes: u64,
}

impl Output {
    /// Set it; whether it changed. Whether the change of a number sticks is asked for each.
    pub(crate) fn set(
        &mut self,
        level: bool,
        now_s: f64,
        sticks: impl FnOnce(u64) -> bool,
    ) -> bool {
        self.level = level;
        if level == self.actual {
            return false;
        }
        self.changes += 1;
        if sticks(self.changes - 1) {
            return false;
        }
        self.actual = level;
        if self.past.len() == PAST_MAX {
            self.before = self.past.remove(0).1;
        }
        self.past.push((now_s, level));
        true
    }

    /// Whether it is not what it was set to.
    pub(crate) fn is_stuck(&self) -> bool {
        self.level != self.actual
    }

    /// The level at a time not after now.
    fn level_at(&self, time_s: f64) -> bool {
        let change = self.past.iter().rev().find(|(at_s, _)| *at_s <= time_s);
        change.map_or(self.before, |(_, level)| *level)
    }

    /// When a change is seen next that is seen so much later than it is made, after a time.
    pub(crate) fn next_seen_s(&self, delay_s: f64, after_s: f64) -> Option<f64> {
        let seen_s = |at_s: f64| {
            // Rounded up where the sum is not yet so much later, as the level is looked up.
            let sum_s = at_s + delay_s;
            if at_s <= sum_s - delay_s { sum_s } else { sum_s.next_up() }
        };
        self.past.iter().map(|(at_s, _)| seen_s(*at_s)).find(|seen_s| *seen_s > after_s)
    }

    /// When it changed last before a time.
    fn changed_before(&self, time_s: f64) -> Option<f64> {
        let change = self.past.iter().rev().find(|(at_s, _)| *at_s <= time_s);
        change.map(|(at_s, _)| *at_s)
    }
}

/// What inputs follow.
#[derive(Clone, Copy)]
pub(crate) struct Sources<'a> {
    pub(crate) outputs: &'a [Output],
    pub(crate) now_s: f64,
    pub(crate) is_holding: bool,
    /// Whether the part of a feeder is at its place.
    pub(crate) is_part_there: &'a dyn Fn(usize) -> bool,
}

impl Sources<'_> {
    /// The level of an input whose wire is as it should be.
    pub(crate) fn level(&self, rule: &InputRule) -> bool {
        match rule {
            InputRule::Constant(level) => *level,
            InputRule::FollowsOutput { output, delay_s } => {
                let output = self.outputs.get(usize::from(*output));
                output.is_some_and(|output| output.level_at(self.now_s - delay_s))
            }
            InputRule::At(changes) => {
                let after = changes.partition_point(|(at_s, _)| *at_s <= self.now_s);
                after > 0 && changes[after - 1].1
            }
            InputRule::Holding => self.is_holding,
            InputRule::PartThere { feeder } => (self.is_part_there)(*feeder),
        }
    }

    /// When the level that it has now came about, if it changed since the last look.
    fn changed_at_s(&self, rule: &InputRule) -> f64 {
        let at_s = match rule {
            InputRule::FollowsOutput { output, delay_s } => self
                .outputs
                .get(usize::from(*output))
                .and_then(|output| output.changed_before(self.now_s - delay_s))
                .map(|at_s| at_s + delay_s),
            InputRule::At(changes) => {
                let after = changes.partition_point(|(at_s, _)| *at_s <= self.now_s);
                after.checked_sub(1).map(|last| changes[last].0)
            }
            InputRule::Constant(_) | InputRule::Holding | InputRule::PartThere { .. } => None,
        };
        at_s.unwrap_or(self.now_s).min(self.now_s)
    }
}

/// The wire of an input that may stick or flicker.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wire {
    /// What it should show.
    due: bool,
    shown: bool,
    changes: u64,
    flickers_until_s: f64,
}

impl Wire {
    /// A wire that shows what it should.
    pub(crate) fn new(level: bool) -> Self {
        Self { due: level, shown: level, changes: 0, flickers_until_s: f64::NEG_INFINITY }
    }

    /// Take note of what the input of this number should show now.
    pub(crate) fn follow(
        &mut self,
        flaw: &InputFlaw,
        rule: &InputRule,
        sources: &Sources<'_>,
        seed: u64,
        input: usize,
    ) {
        let level = sources.level(rule);
        if level == self.due {
            return;
        }
        self.due = level;
        let number = counter_of(input, self.changes);
        self.changes += 1;
        if random::happens(flaw.stick, seed, Stream::InputStick, number) {
            return;
        }
        self.shown = level;
        if random::happens(flaw.bounce, seed, Stream::InputBounce, number) {
            self.flickers_until_s = sources.changed_at_s(rule) + flaw.bounce_s;
        }
    }

    /// What it shows at a time.
    pub(crate) fn level(&self, now_s: f64, seed: u64, input: usize) -> bool {
        if now_s >= self.flickers_until_s {
            return self.shown;
        }
        // A cast of a float saturates, and times are not negative.
        let number = counter_of(input, (now_s / FLICKER_S) as u64);
        random::unit(seed, Stream::InputFlicker, number) < 0.5
    }

    /// When it may show another level next while it flickers, after a time.
    pub(crate) fn next_flicker_s(&self, now_s: f64) -> Option<f64> {
        let slot_s = ((now_s / FLICKER_S).floor() + 1.0) * FLICKER_S;
        let next_s = if slot_s > now_s { slot_s } else { now_s + FLICKER_S };
        (now_s < self.flickers_until_s).then_some(next_s.min(self.flickers_until_s))
    }

    /// Whether it does not show what it should.
    pub(crate) fn is_stuck(&self) -> bool {
        self.shown != self.due
    }

    /// Whether it flickers at a time.
    pub(crate) fn is_flickering(&self, now_s: f64) -> bool {
        now_s < self.flickers_until_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(rule: &InputRule, outputs: &[Output], now_s: f64, is_holding: bool) -> bool {
        Sources { outputs, now_s, is_holding, is_part_there: &|_| false }.level(rule)
    }

    fn set(output: &mut Output, level: bool, now_s: f64) {
        output.set(level, now_s, |_| false);
    }

    #[test]
    fn an_input_follows_an_output_after_its_delay() {
        let rule = InputRule::FollowsOutput { output: 0, delay_s: 0.5 };
        let mut outputs = vec![Output::default()];
        set(&mut outputs[0], true, 1.0);
        assert!(!level(&rule, &outputs, 1.49, false));
        assert!(level(&rule, &outputs, 1.5, false));
        set(&mut outputs[0], false, 1.6);
        assert!(level(&rule, &outputs, 2.0, false));
        assert!(!level(&rule, &outputs, 2.1, false));
    }

    #[test]
    fn the_past_of_an_output_is_bounded() {
        let mut output = Output::default();
        for change in 0..1_001_u32 {
            set(&mut output, change % 2 == 0, f64::from(change));
        }
        assert!(output.past.len() <= PAST_MAX);
        assert!(output.level_at(1_000.0) && !output.level_at(999.0));
    }

    #[test]
    fn an_output_that_sticks_is_tried_again_when_it_is_set_again() {
        let mut output = Output::default();
        assert!(!output.set(true, 0.0, |change| change == 0));
        assert!(output.is_stuck() && output.level && !output.actual);
        assert!(output.set(true, 1.0, |change| change == 0));
        assert!(!output.is_stuck() && output.actual && !output.level_at(0.5));
    }

    #[test]
    fn a_wire_sticks_until_its_level_is_due_again() {
        let flaw = InputFlaw { stick: 1.0, ..InputFlaw::default() };
        let mut outputs = vec![Output::default()];
        let mut wire = Wire::new(false);
        let rule = InputRule::FollowsOutput { output: 0, delay_s: 0.0 };
        for (level, is_stuck) in [(true, true), (false, false), (true, true)] {
            set(&mut outputs[0], level, 1.0);
            let there = |_| false;
            let sources =
                Sources { outputs: &outputs, now_s: 1.0, is_holding: false, is_part_there: &there };
            wire.follow(&flaw, &rule, &sources, 1, 0);
            assert!(!wire.level(1.0, 1, 0));
            assert_eq!(wire.is_stuck(), is_stuck);
        }
    }

    #[test]
    fn a_wire_flickers_for_its_time_after_the_change_and_not_after_the_look() {
        let flaw = InputFlaw { bounce: 1.0, bounce_s: 0.1, ..InputFlaw::default() };
        let mut outputs = vec![Output::default()];
        set(&mut outputs[0], true, 1.0);
        let rule = InputRule::FollowsOutput { output: 0, delay_s: 0.5 };
        let there = |_| false;
        let sources =
            Sources { outputs: &outputs, now_s: 1.55, is_holding: false, is_part_there: &there };
        let mut wire = Wire::new(false);
        wire.follow(&flaw, &rule, &sources, 1, 0);
        let shown: Vec<bool> =
            (0..50).map(|step| wire.level(1.55 + 1e-3 * f64::from(step), 1, 0)).collect();
        assert!(shown.contains(&true) && shown.contains(&false));
        assert!(wire.is_flickering(1.59) && !wire.is_flickering(1.6));
        assert!((0..50).all(|step| wire.level(1.6 + 1e-3 * f64::from(step), 1, 0)));
    }

    #[test]
    fn an_input_changes_at_its_times() {
        let rule = InputRule::At(vec![(1.0, true), (2.0, false)]);
        let at = |now_s| level(&rule, &[], now_s, false);
        assert_eq!([at(0.0), at(1.0), at(1.9), at(2.0)], [false, true, true, false]);
    }

    #[test]
    fn constant_and_holding_inputs() {
        assert!(level(&InputRule::Constant(true), &[], 0.0, false));
        assert!(level(&InputRule::Holding, &[], 0.0, true));
        assert!(!level(&InputRule::Holding, &[], 0.0, false));
    }
}
