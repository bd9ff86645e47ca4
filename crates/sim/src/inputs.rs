//! Outputs with their recent past, and inputs that follow rules.
//!
//! Knows nothing of what the wires are connected to.

use crate::cell::InputRule;

/// How many past changes of an output are kept for inputs that follow it with a delay.
const PAST_MAX: usize = 64;

/// The level of an output now and before.
#[derive(Clone, Debug, Default)]
pub(crate) struct Output {
    pub(crate) level: bool,
    /// When it changed and to what, oldest first.
    past: Vec<(f64, bool)>,
    /// The level before the oldest change that is kept.
    before: bool,
}

impl Output {
    pub(crate) fn set(&mut self, level: bool, now_s: f64) {
        if level == self.level {
            return;
        }
        self.level = level;
        if self.past.len() == PAST_MAX {
            self.before = self.past.remove(0).1;
        }
        self.past.push((now_s, level));
    }

    /// The level at a time not after now.
    fn level_at(&self, time_s: f64) -> bool {
        let change = self.past.iter().rev().find(|(at_s, _)| *at_s <= time_s);
        change.map_or(self.before, |(_, level)| *level)
    }
}

/// The level of an input.
pub(crate) fn level(rule: &InputRule, outputs: &[Output], now_s: f64, holding: bool) -> bool {
    match rule {
        InputRule::Constant(level) => *level,
        InputRule::FollowsOutput { output, delay_s } => {
            outputs.get(usize::from(*output)).is_some_and(|o| o.level_at(now_s - delay_s))
        }
        InputRule::At(changes) => {
            let after = changes.partition_point(|(at_s, _)| *at_s <= now_s);
            after > 0 && changes[after - 1].1
        }
        InputRule::Holding => holding,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_follows_an_output_after_its_delay() {
        let rule = InputRule::FollowsOutput { output: 0, delay_s: 0.5 };
        let mut outputs = vec![Output::default()];
        outputs[0].set(true, 1.0);
        assert!(!level(&rule, &outputs, 1.49, false));
        assert!(level(&rule, &outputs, 1.5, false));
        outputs[0].set(false, 1.6);
        assert!(level(&rule, &outputs, 2.0, false));
        assert!(!level(&rule, &outputs, 2.1, false));
    }

    #[test]
    fn the_past_of_an_output_is_bounded() {
        let mut output = Output::default();
        for change in 0..1_001_u32 {
            output.set(change % 2 == 0, f64::from(change));
        }
        assert!(output.past.len() <= PAST_MAX);
        assert!(output.level_at(1_000.0) && !output.level_at(999.0));
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
