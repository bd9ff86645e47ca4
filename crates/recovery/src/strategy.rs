//! The ways of recovering, and how much may be spent on one error.

/// What it takes a person to put an error right, in seconds: going back is given up where it is
/// expected to take longer.
pub const PERSON_S: f64 = 300.0;

/// What is done when an error is due whose recovery is reversal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strategy {
    /// What the program declares.
    Declared,
    /// Nothing: a person is called.
    Stop,
    /// The action again where the arm stands, so many times.
    Retry {
        /// At most.
        times: u32,
    },
    /// The tool straight back, and then the action again, so many times.
    BackUp {
        /// How far, in metres.
        distance_m: f64,
        /// At most.
        times: u32,
    },
    /// The program from its start again where the arm stands, so many times.
    Restart {
        /// At most.
        times: u32,
    },
    /// The sequence that the program names for when reversal is given up, at once.
    Explicit,
    /// So many actions back, each time.
    Fixed {
        /// How many.
        actions: usize,
    },
    /// One action further back each time.
    Escalating,
    /// As far back as experience says.
    Learned,
    /// As far back as somebody says who knows what will come of it.
    Oracle,
}

impl Strategy {
    /// The most actions that a strategy can be told to go back by each time.
    pub const FIXED_MAX: usize = 1000;

    /// The strategy of a name: `declared`, `stop`, `retry`, `back-up`, `restart`, `explicit`,
    /// `fixed:N`, `escalating`, `learned`, `oracle`. Those that a number belongs to have the number
    /// that is usual elsewhere: three tries in place, six after backing up 0.30 m (as Nav2).
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "declared" => Self::Declared,
            "stop" => Self::Stop,
            "retry" => Self::Retry { times: 3 },
            "back-up" => Self::BackUp { distance_m: 0.30, times: 6 },
            "restart" => Self::Restart { times: 3 },
            "explicit" => Self::Explicit,
            "escalating" => Self::Escalating,
            "learned" => Self::Learned,
            "oracle" => Self::Oracle,
            other => {
                let actions = other.strip_prefix("fixed:")?.parse().ok()?;
                let fixed = Self::Fixed { actions };
                // `fixed:02` would be the same strategy by another name.
                let is_one = (1..=Self::FIXED_MAX).contains(&actions) && fixed.name() == other;
                is_one.then_some(fixed)?
            }
        })
    }

    /// The name that it is asked for by.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Declared => "declared".to_owned(),
            Self::Stop => "stop".to_owned(),
            Self::Retry { .. } => "retry".to_owned(),
            Self::BackUp { .. } => "back-up".to_owned(),
            Self::Restart { .. } => "restart".to_owned(),
            Self::Explicit => "explicit".to_owned(),
            Self::Fixed { actions } => format!("fixed:{actions}"),
            Self::Escalating => "escalating".to_owned(),
            Self::Learned => "learned".to_owned(),
            Self::Oracle => "oracle".to_owned(),
        }
    }

    /// Whether, when it gives up, what the error says under `otherwise` follows: where the strategy
    /// replaces the depth alone. Others stand for themselves, and a person is called.
    #[must_use]
    pub fn goes_on_when_given_up(self) -> bool {
        !matches!(
            self,
            Self::Stop | Self::Retry { .. } | Self::BackUp { .. } | Self::Restart { .. }
        )
    }
}

/// How much may be spent on recovering from an error at a place before it is given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// How often.
    pub attempts: u32,
    /// How long, in seconds of the workcell's clock.
    pub time_s: f64,
    /// How far the arm goes, in metres of the tool centre point.
    pub distance_m: f64,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { attempts: 8, time_s: 600.0, distance_m: 50.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::Strategy;

    #[test]
    fn a_strategy_is_found_by_its_name() {
        for name in [
            "declared",
            "stop",
            "retry",
            "back-up",
            "restart",
            "explicit",
            "fixed:3",
            "escalating",
            "learned",
            "oracle",
        ] {
            assert_eq!(Strategy::from_name(name).map(Strategy::name).as_deref(), Some(name));
        }
        assert_eq!(
            Strategy::from_name("fixed:1000").map(Strategy::name),
            Some("fixed:1000".into())
        );
        for wrong in [
            "",
            "fixed",
            "fixed:",
            "fixed:0",
            "fixed:-1",
            "fixed:x",
            "fixed:02",
            "fixed:+2",
            "fixed:1001",
            "Learned",
        ] {
            assert_eq!(Strategy::from_name(wrong), None, "{wrong}");
        }
    }
}
