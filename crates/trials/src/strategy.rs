//! The strategies that campaigns compare, by name. What each of them does is not known here.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// How a run goes on after an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Strategy {
    /// As the program itself says.
    Declared,
    /// Not at all: a person is called.
    Stop,
    /// The action again from where the arm stands, three times.
    Retry,
    /// The arm backs up by 0.30 m and the action is tried again, six times.
    BackUp,
    /// The program again from its start.
    Restart,
    /// By the sequences that the user wrote for it.
    Explicit,
    /// Back by this many actions, every time.
    Fixed(u32),
    /// Back further each time the same error comes from the same place.
    Escalating,
    /// Back as far as experience says.
    Learned,
    /// Back exactly as far as the true cause asks for, which only a simulation can tell.
    Oracle,
}

impl Strategy {
    /// All that are compared, in the order of the tables.
    pub const ALL: [Self; 9] = [
        Self::Stop,
        Self::Retry,
        Self::BackUp,
        Self::Restart,
        Self::Explicit,
        Self::Fixed(2),
        Self::Escalating,
        Self::Learned,
        Self::Oracle,
    ];

    /// How the driver of machines knows it.
    #[must_use]
    pub fn answer(self) -> obverse_recovery::Strategy {
        use obverse_recovery::Strategy as Answer;
        match self {
            Self::Declared => Answer::Declared,
            Self::Stop => Answer::Stop,
            Self::Retry => Answer::Retry { times: 3 },
            Self::BackUp => Answer::BackUp { distance_m: 0.30, times: 6 },
            Self::Restart => Answer::Restart { times: 3 },
            Self::Explicit => Answer::Explicit,
            Self::Fixed(depth) => Answer::Fixed { actions: depth as usize },
            Self::Escalating => Answer::Escalating,
            Self::Learned => Answer::Learned,
            Self::Oracle => Answer::Oracle,
        }
    }

    /// The strategies of a list such as `stop,fixed:2,learned`; `all` stands for [`Self::ALL`].
    ///
    /// # Errors
    /// What of it is no strategy, or stands there twice.
    pub fn list(text: &str) -> Result<Vec<Self>, StrategyError> {
        let mut list = Vec::new();
        for name in text.split(',').map(str::trim) {
            let named = match name {
                "all" => Self::ALL.to_vec(),
                _ => vec![name.parse()?],
            };
            for strategy in named {
                if list.contains(&strategy) {
                    return Err(StrategyError::Twice(strategy));
                }
                list.push(strategy);
            }
        }
        Ok(list)
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.answer().name())
    }
}

impl FromStr for Strategy {
    type Err = StrategyError;

    fn from_str(name: &str) -> Result<Self, StrategyError> {
        use obverse_recovery::Strategy as Answer;
        Ok(match Answer::from_name(name) {
            Some(Answer::Declared) => Self::Declared,
            Some(Answer::Stop) => Self::Stop,
            Some(Answer::Retry { .. }) => Self::Retry,
            Some(Answer::BackUp { .. }) => Self::BackUp,
            Some(Answer::Restart { .. }) => Self::Restart,
            Some(Answer::Explicit) => Self::Explicit,
            Some(Answer::Fixed { actions }) => Self::Fixed(actions as u32),
            Some(Answer::Escalating) => Self::Escalating,
            Some(Answer::Learned) => Self::Learned,
            Some(Answer::Oracle) => Self::Oracle,
            None if name.starts_with("fixed:") => {
                return Err(StrategyError::Depth(name.to_owned()));
            }
            None => return Err(StrategyError::Unknown(name.to_owned())),
        })
    }
}

impl Serialize for Strategy {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Strategy {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        name.parse().map_err(serde::de::Error::custom)
    }
}

/// Why a text is no list of strategies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StrategyError {
    /// There is no strategy of this name.
    Unknown(String),
    /// The depth of a fixed one is no number of actions.
    Depth(String),
    /// One is named twice.
    Twice(Strategy),
}

impl fmt::Display for StrategyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(
                f,
                "there is no strategy `{name}`: there are stop, retry, back-up, restart, explicit, \
                 fixed:D, escalating, learned, oracle and declared, and `all` for the first nine"
            ),
            Self::Depth(name) => write!(
                f,
                "`{name}` must name a number of actions from 1 to {}, as in fixed:2 for going back \
                 by two",
                obverse_recovery::Strategy::FIXED_MAX
            ),
            Self::Twice(strategy) => write!(f, "the strategy {strategy} is named twice"),
        }
    }
}

impl std::error::Error for StrategyError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_strategy_and_back() {
        for strategy in Strategy::ALL.into_iter().chain([Strategy::Declared, Strategy::Fixed(17)]) {
            assert_eq!(strategy.to_string().parse(), Ok(strategy));
        }
    }

    #[test]
    fn lists_keep_their_order_and_name_each_once() {
        let list = Strategy::list("learned, stop,fixed:3");
        assert_eq!(list, Ok(vec![Strategy::Learned, Strategy::Stop, Strategy::Fixed(3)]));
        assert_eq!(Strategy::list("all"), Ok(Strategy::ALL.to_vec()));
        let twice = Err(StrategyError::Twice(Strategy::Stop));
        assert_eq!(Strategy::list("stop,all"), twice);
    }

    #[test]
    fn what_is_no_strategy_is_said() {
        for wrong in ["", "Stop", "fixed", "stop,,retry"] {
            assert!(matches!(Strategy::list(wrong), Err(StrategyError::Unknown(_))), "{wrong}");
        }
        for wrong in ["fixed:", "fixed:0", "fixed:-1", "fixed:02", "fixed:1001", "fixed:5000000000"]
        {
            assert!(matches!(Strategy::list(wrong), Err(StrategyError::Depth(_))), "{wrong}");
        }
    }
}
