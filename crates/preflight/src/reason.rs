//! The table of reasons: why a move has its grade, a row a reason, with the page that explains it.
//!
//! A code is stable: it is never given another meaning nor used again. `P01xx` is fine, `P02xx`
//! needs another configuration, `P03xx` limits, `P04xx` reach, `P05xx` collision, `P06xx` is not
//! known before running. Knows nothing of how any of it is found out.

/// What can be said of a move before running.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Grade {
    /// It goes where it should and meets nothing.
    Reachable,
    /// What decides it is only known when the program runs.
    NotKnown,
    /// The goal can be reached, but not by this path from the configuration that the arm is in.
    OtherConfiguration,
    /// A joint would leave its range, or a number of the command is out of bounds.
    OutOfLimits,
    /// No configuration of the arm reaches the goal.
    OutOfReach,
    /// The arm, the tool or the held item meets something that it should not.
    InCollision,
}

impl Grade {
    /// In the order from fine to worst.
    pub const ALL: [Self; 6] = [
        Self::Reachable,
        Self::NotKnown,
        Self::OtherConfiguration,
        Self::OutOfLimits,
        Self::OutOfReach,
        Self::InCollision,
    ];

    /// In words, for people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Reachable => "reachable",
            Self::NotKnown => "not known before running",
            Self::OtherConfiguration => "reachable only in another configuration",
            Self::OutOfLimits => "out of limits",
            Self::OutOfReach => "out of reach",
            Self::InCollision => "in collision",
        }
    }

    /// In one word, for machines.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Reachable => "reachable",
            Self::NotKnown => "not_known",
            Self::OtherConfiguration => "other_configuration",
            Self::OutOfLimits => "out_of_limits",
            Self::OutOfReach => "out_of_reach",
            Self::InCollision => "in_collision",
        }
    }

    /// Whether a run that comes to the move ends there with a fault.
    #[must_use]
    pub fn is_wrong(self) -> bool {
        self > Self::NotKnown
    }
}

macro_rules! reasons {
    ($($name:ident $code:literal $grade:ident $title:literal $why:literal)*) => {
        /// Why a move has its grade.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Reason {
            $(#[doc = concat!($code, ": ", $title, ".")] $name,)*
        }

        impl Reason {
            /// Every reason, in the table's order.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The stable code: `P0100`.
            #[must_use]
            pub fn code(self) -> &'static str {
                match self { $(Self::$name => $code,)* }
            }

            /// The grade that it leads to.
            #[must_use]
            pub fn grade(self) -> Grade {
                match self { $(Self::$name => Grade::$grade,)* }
            }

            /// In a few words.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)* }
            }

            /// The page that explains it: what was found, why, and what to do.
            #[must_use]
            pub fn explanation(self) -> &'static str {
                match self {
                    $(Self::$name => concat!($code, ": ", $title, "\n\n", $why, "\n"),)*
                }
            }
        }
    };
}

impl std::str::FromStr for Reason {
    type Err = UnknownReason;

    fn from_str(text: &str) -> Result<Self, UnknownReason> {
        let found = Self::ALL.iter().find(|reason| reason.code().eq_ignore_ascii_case(text));
        found.copied().ok_or(UnknownReason)
    }
}

/// A text that is the code of no reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownReason;

impl std::fmt::Display for UnknownReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("no such reason; the codes of `obverse check` look like P0501")
    }
}

impl std::error::Error for UnknownReason {}

reasons! {
    Fine "P0100" Reachable "the goal is reached and nothing is met on the way"
        "The joints stay in their ranges all along the path, and neither the arm nor the tool nor \
         what is held touches a fixture or an item harder than the workcell allows. This holds \
         where everything is at the place that the workcell file gives; offsets that the file \
         leaves uncertain are not in it. A guarded move is meant to touch: its contact is no \
         collision, and its range and reach are checked over the whole distance."
    LineSingular "P0201" OtherConfiguration "the straight line passes a singularity"
        "On the way two joints turn about the same line, or the arm is stretched, and the joints \
         would have to jump. The goal itself can be reached.\n\nGo there by joints (leave out \
         `linearly`), or begin the line in another configuration."
    LineLeavesRange "P0202" OtherConfiguration "a joint leaves its range on the straight line"
        "Following the line in the configuration that the arm is in, a joint would have to turn \
         further than it may. The goal can be reached with the joints turned otherwise.\n\nGo \
         there by joints, or begin the line with that joint turned back by a whole turn."
    LineLeavesReach "P0203" OtherConfiguration "in this configuration the line leaves reach"
        "Both ends can be reached, and a point between them cannot, at least not in the \
         configuration that the arm is in.\n\nGo there by joints, or by a place in between."
    LineEndsOtherwise "P0204" OtherConfiguration "the straight line ends in another configuration"
        "The joints that are asked for cannot be had at the end of the line: following it, the arm \
         gets to the same pose with other joints.\n\nGo there by joints, or name the joints in the \
         configuration in which the line begins."
    GoalOutOfRange "P0301" OutOfLimits "a joint would be outside its range"
        "The goal needs a joint outside the range that the workcell file gives it \
         (`limits_deg`). Nothing is ever clipped: the command is refused.\n\nName another goal, or \
         turn the joint by a whole turn."
    BadCommand "P0302" OutOfLimits "a number of the command is out of bounds"
        "A force limit that is not above zero, a displacement that is no number or longer than \
         any arm: the workcell refuses such a command."
    GoalOutOfReach "P0401" OutOfReach "no configuration reaches the goal"
        "The arm is too short for the goal, or the goal is too near to its base, with the tool \
         turned as it is asked to be."
    ArmCollides "P0501" InCollision "the arm meets something"
        "A link of the arm is pressed against a fixture or an item harder than `stop_force_n` \
         of the workcell file. How far along the path, and what meets what, is said beside \
         it.\n\nGo by a place in between, or come in another configuration."
    ToolCollides "P0502" InCollision "the tool meets something"
        "The tool is pressed against a fixture or an item harder than the workcell allows. If it \
         is meant to touch, say so: an advanced move with `stop if force`."
    HeldCollides "P0503" InCollision "the held item meets something"
        "What the gripper holds is pressed against a fixture or another item harder than the \
         workcell allows. Without the item the same path may well be free: look at where it was \
         taken, and how it sticks out.\n\nIf it is meant to touch, say so: an advanced move with \
         `stop if force`."
    StoppedByForce "P0504" InCollision "the way back is stopped by its force limit"
        "Going back, something is met with more force than the limit that the program sets for \
         the way back. A run would stop there with a fault, and can try again.\n\nSet a higher \
         limit, or go back another way."
    StartNotKnown "P0601" NotKnown "where the arm comes from is only known when the program runs"
        "The goal can be reached, as far as that can be said; but the path begins where a guarded \
         move was stopped, or at a place that was drawn or measured.\n\nA move to a named joint \
         configuration before it makes it known."
    GoalNotKnown "P0602" NotKnown "the goal is only known when the program runs"
        "The distance or the position comes from a reading, a draw, or a variable that has many \
         values there."
    SettingNotKnown "P0603" NotKnown "how the arm moves is only known when the program runs"
        "Which tool is mounted, how fast the arm goes, what force stops it, or by which path it \
         goes back depends on what happens before."
    HeldNotKnown "P0604" NotKnown "what is held and where things lie is only known when it runs"
        "The gripper closed or opened at a place that is not known, or the program asks whether \
         it holds something and goes on where the answer is the other one. The path is free of \
         fixtures for the arm and the tool; items were not looked at."
    NoWay "P0605" NotKnown "no way through the program leads here"
        "Following the program from its start with all that can be known, no run comes to this \
         move: its sequence is never called, or a condition never holds, or every way to it ends \
         before."
    UnknownInstruction "P0606" NotKnown "an instruction before it is not understood by this check"
        "What an instruction before it does to the workcell is not known to the check, and so \
         neither is where the arm stands after it."
    TooMany "P0607" NotKnown "the check was given up: there are too many cases"
        "The program has more ways through it, or more different motions, than are looked at. The \
         check as a whole then counts as not done."
    DeepCalls "P0608" NotKnown "it is also called deeper within itself than is followed"
        "A sequence that calls itself is followed call by call where it is known how often it \
         does; otherwise only the first calls are looked at, and what the arm does in those within \
         them is not known."
    StopNotKnown "P0609" NotKnown "how hard it presses where contact stopped the arm is not known"
        "Where a guarded move stops, and how hard it presses then, depends on when the force is \
         read. Coming there again without a guard, or pressing on from there, the arm may press \
         harder than the workcell allows, or not as hard.\n\nLet the guarded move press less \
         (slower, with a lower limit), or go back over it with `opposite force in reverse`."
    LongContact "P0610" NotKnown "it moves in contact for longer than is looked at"
        "Something touches all along the way, and the check looks at the first part of it alone. \
         Does the arm stand free of everything where the move begins?"
    AfterFailure "P0611" NotKnown "a move before it fails"
        "On the way here a move ends with a fault, so that no run comes here that way, and where \
         the arm would stand is not known.\n\nMend that move first; then this one is looked at."
    TooManyRounds "P0612" NotKnown "the check followed 512 rounds, and there are more"
        "The check follows a loop round by round as long as there are few, and then takes all \
         further rounds together. What this move does depends on how many there were. The check as \
         a whole then counts as not done.\n\nA move to a named joint configuration in each round \
         makes it known where the arm stands; or repeat less often."
}
