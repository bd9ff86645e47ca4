//! Why a command of a session was not carried out, and in which words that is said.

use crate::recording::Moment;
use crate::run::NoFork;

/// Why a command was not carried out; nothing has changed.
#[derive(Clone, Debug, PartialEq)]
pub enum Declined {
    /// What is shown is no live run: it can be rewound, and not driven.
    NotLive,
    /// There is no such moment.
    NoMoment {
        /// What was asked for.
        asked: Moment,
        /// The last that there is.
        end: Moment,
    },
    /// There is no bookmark of this name.
    NoBookmark {
        /// What was asked for.
        name: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// There was nothing like it before what is shown.
    NotBefore,
    /// There is nothing to undo.
    NoJump,
    /// There is no breakpoint of this number.
    NoBreakpoint(u32),
    /// Nothing is tried that could be left.
    NoWhatIf,
    /// The run cannot go on otherwise from here.
    NoFork(NoFork),
    /// This cannot be given a value, or none of this type.
    NotAssignable,
    /// No error is due.
    NothingDue,
    /// Somebody interrupted it.
    Interrupted,
}

impl std::fmt::Display for Declined {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotLive => write!(
                f,
                "this shows what was, and drives nothing; go to the end of a live run, or try \
                 what would have been"
            ),
            Self::NoMoment { asked, end } => {
                write!(f, "there is no moment {asked}: the recording ends at {end}")
            }
            Self::NoBookmark { name, known } if known.is_empty() => {
                write!(f, "there is no bookmark `{name}`, nor any other")
            }
            Self::NoBookmark { name, known } => {
                write!(f, "there is no bookmark `{name}`; there are {}", known.join(", "))
            }
            Self::NotBefore => write!(f, "there was no such thing before this moment"),
            Self::NoJump => write!(f, "there is no jump to undo"),
            Self::NoBreakpoint(id) => write!(f, "there is no breakpoint {id}"),
            Self::NoWhatIf => write!(f, "nothing is being tried that could be left"),
            Self::NoFork(why) => why.fmt(f),
            Self::NotAssignable => write!(f, "it cannot be given this value"),
            Self::NothingDue => write!(f, "no error is due in the run"),
            Self::Interrupted => write!(f, "it was interrupted"),
        }
    }
}

impl std::error::Error for Declined {}

impl Declined {
    /// Why, with words of the caller's where there was nothing of the kind before.
    pub fn words_or(&self, not_before: impl FnOnce() -> String) -> String {
        if *self == Self::NotBefore { not_before() } else { self.to_string() }
    }
}
