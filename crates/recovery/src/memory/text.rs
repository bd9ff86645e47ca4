//! The text of a memory: how it is kept, and what is refused of a text.
//!
//! People read it, change it and take places out of it; what was cut off anywhere is no memory.
//! Knows nothing of what follows from what is known.

use super::{ATTEMPTS_MAX, DEPTH_MAX, Kind, Known, Memory};
use crate::code::MemoryCode;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The version of the text.
const VERSION: u32 = 3;
/// The most kinds of incident that a text may hold.
const KINDS_MAX: usize = 100_000;

/// What recoveries a memory is of: errors and places are names, and those of one program say
/// nothing of another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The name of the program's file.
    pub program: String,
    /// The name of the workcell's.
    pub cell: String,
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} in {}", self.program, self.cell)
    }
}

/// All that can be said of a text of another version.
#[derive(Deserialize)]
struct Versioned {
    version: u32,
}

/// The text of a memory.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    version: u32,
    program: String,
    cell: String,
    #[serde(default)]
    place: Vec<PlaceText>,
    /// Stands last: a text that was cut off between two places has none.
    end: Option<End>,
}

/// That a text is whole. It says nothing of how much there is, so that people may take out a place.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct End {}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlaceText {
    error: String,
    at: String,
    #[serde(default)]
    incident: Vec<KindText>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KindText {
    depths: Vec<usize>,
    enough: bool,
    times: u64,
}

/// A text that is no memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MemoryError {
    /// It is no text of this kind, or was torn.
    Malformed {
        /// What is wrong, with its line where that is known.
        why: String,
    },
    /// It is of another version.
    Version {
        /// That which it says.
        found: u32,
    },
    /// It is of another program, or of another workcell.
    Foreign {
        /// Of what it is.
        found: Subject,
        /// Of what it was to be.
        wanted: Subject,
    },
    /// It says what no run can have come to.
    Impossible {
        /// The error.
        error: String,
        /// The place.
        place: String,
        /// What.
        what: &'static str,
    },
}

impl MemoryError {
    /// Its code.
    #[must_use]
    pub fn code(&self) -> MemoryCode {
        match self {
            Self::Malformed { .. } => MemoryCode::Malformed,
            Self::Version { .. } => MemoryCode::Version,
            Self::Foreign { .. } => MemoryCode::Foreign,
            Self::Impossible { .. } => MemoryCode::Impossible,
        }
    }
}

impl fmt::Display for MemoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed { why } => write!(f, "this is no memory of recoveries: {why}"),
            Self::Version { found } => write!(
                f,
                "this memory is of version {found}, and this is for version {VERSION}; move it \
                 away to begin anew"
            ),
            Self::Foreign { found, wanted } => write!(
                f,
                "this memory is of {found}, and not of {wanted}, of which it says nothing; name \
                 another file, or change `program` and `cell` in it if only names have changed"
            ),
            Self::Impossible { error, place, what } => {
                write!(f, "what it says of error {error} at `{place}` cannot be: {what}")
            }
        }
    }
}

impl std::error::Error for MemoryError {}

const HEAD: &str = "\
# What was learned of how far to go back, by error and place: how far each attempt of an incident
# went back, in actions, whether the last was enough, and how often that was so. Take out a
# [[place]], or the whole file, to forget it. The [end] says that the file is whole, and stays last.
";

impl Memory {
    /// It as text, to be kept, and of what it is.
    #[must_use]
    pub fn to_text(&self, of: &Subject) -> String {
        let kind = |(kind, times): (&Kind, &u64)| KindText {
            depths: kind.depths.clone(),
            enough: kind.is_enough,
            times: *times,
        };
        let place = |((error, at), known): (&(String, String), &Known)| PlaceText {
            error: error.clone(),
            at: at.clone(),
            incident: known.times.iter().map(kind).collect(),
        };
        let text = Text {
            version: VERSION,
            program: of.program.clone(),
            cell: of.cell.clone(),
            place: self.places.iter().map(place).collect(),
            end: Some(End {}),
        };
        format!("{HEAD}{}", toml::to_string(&text).unwrap_or_default())
    }

    /// The memory of a text that is of this.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn from_text(text: &str, of: &Subject) -> Result<Self, MemoryError> {
        let malformed = |why: &dyn fmt::Display| MemoryError::Malformed { why: why.to_string() };
        let Versioned { version } = toml::from_str(text).map_err(|error| malformed(&error))?;
        if version != VERSION {
            return Err(MemoryError::Version { found: version });
        }
        let text: Text = toml::from_str(text).map_err(|error| malformed(&error))?;
        let found = Subject { program: text.program, cell: text.cell };
        if found != *of {
            return Err(MemoryError::Foreign { found, wanted: of.clone() });
        }
        if text.end.is_none() {
            let why = "it was cut off: the last line of one that is whole says `[end]`";
            return Err(malformed(&why));
        }
        if text.place.iter().map(|place| place.incident.len()).sum::<usize>() > KINDS_MAX {
            return Err(malformed(&"it is too long"));
        }
        let mut memory = Self::default();
        for PlaceText { error, at, incident } in text.place {
            let mut known = Known::default();
            if incident.is_empty() {
                let what = "nothing happened there; take the [[place]] out to forget it";
                return Err(MemoryError::Impossible { error, place: at, what });
            }
            for kind in incident {
                check(&kind).map_err(|what| MemoryError::Impossible {
                    error: error.clone(),
                    place: at.clone(),
                    what,
                })?;
                let key = Kind { depths: kind.depths, is_enough: kind.enough };
                let times = known.times.entry(key).or_default();
                *times = times.saturating_add(kind.times);
            }
            let place = (error, at);
            if memory.places.contains_key(&place) {
                let ((error, place), what) = (place, "it is there twice");
                return Err(MemoryError::Impossible { error, place, what });
            }
            memory.places.insert(place, known);
        }
        Ok(memory)
    }
}

fn check(kind: &KindText) -> Result<(), &'static str> {
    if kind.depths.is_empty() {
        Err("nothing was tried")
    } else if kind.depths.len() > ATTEMPTS_MAX {
        Err("that is more attempts than are remembered")
    } else if kind.depths.contains(&0) {
        Err("it went back by 0 actions")
    } else if kind.depths.iter().any(|&depth| depth > DEPTH_MAX) {
        Err("that is further than is told apart")
    } else if kind.times == 0 {
        Err("it never happened; take the [[place.incident]] out to forget it")
    } else if kind.times > 1 << 40 {
        Err("that is more often than can be")
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn subject() -> Subject {
        Subject { program: "p.obv".to_owned(), cell: "c.toml".to_owned() }
    }

    #[test]
    fn a_memory_is_the_same_after_its_text() {
        let mut memory = Memory::default();
        memory.learn("jam", "sequence \"main\": advance insert", &[1, 2], true);
        memory.learn("jam", "sequence \"main\": advance insert", &[1, 2], false);
        memory.learn("empty", "elsewhere", &[40], true);
        assert_eq!(Memory::from_text(&memory.to_text(&subject()), &subject()), Ok(memory));
    }

    #[test]
    fn a_memory_of_another_program_or_cell_is_refused() {
        let text = Memory::default().to_text(&subject());
        for wanted in [
            Subject { program: "q.obv".to_owned(), ..subject() },
            Subject { cell: "d.toml".to_owned(), ..subject() },
        ] {
            let refused = Memory::from_text(&text, &wanted).unwrap_err();
            assert_eq!(refused, MemoryError::Foreign { found: subject(), wanted });
        }
        let old = Memory::from_text("version = 1\n", &subject());
        assert_eq!(old, Err(MemoryError::Version { found: 1 }), "which names no program");
    }

    #[test]
    fn what_no_run_can_have_learned_is_refused() {
        let text = |incident: &str| {
            format!(
                "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\
                 [[place]]\nerror = \"jam\"\nat = \"here\"\nincident = [{incident}]\n[end]\n"
            )
        };
        let what = |incident: &str| {
            Memory::from_text(&text(incident), &subject()).unwrap_err().to_string()
        };
        let of =
            |depths: &str| what(&format!("{{ depths = [{depths}], enough = true, times = 1 }}"));
        assert!(of("").contains("nothing was tried"));
        assert!(what("").contains("nothing happened there"));
        assert!(what("{ depths = [1], enough = true, times = 0 }").contains("never happened"));
        assert!(of("1, 0").contains("0 actions"));
        assert!(of("99").contains("further"));
        assert!(of("-1").contains("no memory"));
        assert!(of(&"1,".repeat(17)).contains("more attempts"));
        let other = Memory::from_text("version = 7\n", &subject()).unwrap_err();
        assert_eq!(other, MemoryError::Version { found: 7 });
        let torn = &Memory::from_text(&text("{ depths = [1],")[..60], &subject());
        assert!(matches!(torn, Err(MemoryError::Malformed { .. })));
    }

    /// Cut off anywhere it is refused, between two places too; a place taken out is forgotten.
    #[test]
    fn a_text_is_whole_or_refused_and_may_be_shortened_by_hand() {
        let mut memory = Memory::default();
        for error in ["empty", "jam", "lost"] {
            memory.learn(error, "here", &[1, 2], true);
            memory.learn(error, "here", &[1], false);
        }
        let text = memory.to_text(&subject());
        // The line end behind the last line may be missing.
        for length in (0..text.len() - 1).filter(|at| text.is_char_boundary(*at)) {
            assert!(Memory::from_text(&text[..length], &subject()).is_err(), "{length} bytes");
        }
        let table = "\n[[place]]\n";
        let first = text.find(table).expect("a place");
        let second = first + 1 + text[first + 1..].find(table).expect("another place");
        let shorter = format!("{}{}", &text[..first], &text[second..]);
        let kept = Memory::from_text(&shorter, &subject()).expect("it is whole");
        assert_eq!(kept.places().collect::<Vec<_>>(), [("jam", "here"), ("lost", "here")]);
    }
}
