//! The ways of recovering, and how much may be spent on one error.

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
    /// Whether, when it gives up, the code after the error goes on, or a person is called.
    #[must_use]
    pub fn goes_on_when_given_up(self) -> bool {
        matches!(self, Self::Declared | Self::Explicit)
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
