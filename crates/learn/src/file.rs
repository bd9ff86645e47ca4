//! The file that keeps what was learned: values with their units, and the evidence for them. It
//! knows nothing of a disk, nor of the program that the values are for.

use serde::{Deserialize, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;

/// What the file says that it is.
const FORMAT: &str = "obverse parameters";
/// The version of the format.
const FORMAT_VERSION: u32 = 1;

/// Below this a whole number is written as one.
const WHOLE_MAX: f64 = 1e15;

const HEAD: &str = "\
# Parameters of an action, learned in simulation. `obverse run --parameters` with this file puts
# them in the place of the defaults; the values may be changed by hand, the evidence is of these.
";

/// What was learned of the parameters of an action.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterFile {
    format: String,
    format_version: u32,
    /// The file name of the program, for people.
    pub program: String,
    /// The action.
    pub action: String,
    /// What tells the program that it was learned for from others, whatever their files are
    /// called; none where who changed the file has taken it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program_digest: Option<String>,
    /// The values, by parameter.
    pub parameters: BTreeMap<String, Value>,
    /// How it is known that they are good.
    pub evidence: Evidence,
}

/// A value of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Value {
    /// The number.
    #[serde(serialize_with = "plainly")]
    pub value: f64,
    /// Its unit; empty for a number without one.
    pub unit: String,
}

/// A number as people write it: 3, and not 3.0.
fn plainly<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match value.fract() == 0.0 && value.abs() < WHOLE_MAX {
        true => serializer.serialize_i64(*value as i64),
        false => serializer.serialize_f64(*value),
    }
}

/// How it is known that parameters are good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// How many runs confirmed the choice, with seeds that nothing was chosen by.
    pub runs: u64,
    /// How many of them succeeded.
    pub successes: u64,
    /// Where the chance of success lies with 95 % confidence: not below.
    pub low: f64,
    /// Not above.
    pub high: f64,
    /// How many of as many runs succeed with the defaults.
    pub successes_of_defaults: u64,
    /// How many candidates there were.
    pub candidates: u64,
    /// How many runs chose among them.
    pub search_runs: u64,
    /// What all seeds follow from.
    pub seed: u64,
    /// The version of Obverse. It stands last, so that a file that is cut off has none.
    pub version: String,
}

/// Why a text is no parameter file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileError {
    /// It is no TOML, or has not the keys that it must have.
    Malformed(String),
    /// It is of something else.
    Foreign,
    /// It is of another version.
    Version(u32),
    /// The value of a parameter is not finite.
    NotFinite(String),
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed(why) => {
                write!(f, "not a whole parameter file: {why}; learn it again by `obverse learn`")
            }
            Self::Foreign => {
                write!(f, "not a parameter file: it does not say `format = \"{FORMAT}\"`")
            }
            Self::Version(found) => write!(
                f,
                "a parameter file of version {found}, and this reads version {FORMAT_VERSION}; \
                 learn it again by `obverse learn`"
            ),
            Self::NotFinite(name) => write!(f, "the value of `{name}` is not finite"),
        }
    }
}

impl std::error::Error for FileError {}

impl ParameterFile {
    /// What is kept of these values.
    #[must_use]
    pub fn new(
        (program, program_digest): (&str, String),
        action: &str,
        parameters: BTreeMap<String, Value>,
        evidence: Evidence,
    ) -> Self {
        let (program, action) = (program.to_owned(), action.to_owned());
        let program_digest = Some(program_digest);
        let (format, format_version) = (FORMAT.to_owned(), FORMAT_VERSION);
        Self { format, format_version, program, action, program_digest, parameters, evidence }
    }

    /// Whether a text is such a file for this action of this program, be it torn or of another
    /// version: what learning the same again may replace.
    #[must_use]
    pub fn is_of(text: &str, program: &str, action: &str) -> bool {
        match Self::from_text(text) {
            Ok(file) => file.program == program && file.action == action,
            Err(FileError::Foreign) => false,
            Err(FileError::Malformed(_)) => text.starts_with(HEAD),
            Err(FileError::Version(_) | FileError::NotFinite(_)) => true,
        }
    }

    /// The text of the file.
    #[must_use]
    pub fn to_text(&self) -> String {
        // Texts and finite numbers can always be written.
        let body = toml::to_string(self).unwrap_or_default();
        format!("{HEAD}\n{body}")
    }

    /// Read a text.
    ///
    /// # Errors
    /// Why it is no such file.
    pub fn from_text(text: &str) -> Result<Self, FileError> {
        let malformed = |error: toml::de::Error| FileError::Malformed(plain(&error));
        let table: toml::Table = text.parse().map_err(malformed)?;
        if table.get("format").and_then(toml::Value::as_str) != Some(FORMAT) {
            return Err(FileError::Foreign);
        }
        match table.get("format_version").and_then(toml::Value::as_integer) {
            Some(version) if version == i64::from(FORMAT_VERSION) => {}
            Some(version) => {
                return Err(FileError::Version(u32::try_from(version).unwrap_or(u32::MAX)));
            }
            None => return Err(FileError::Malformed("it has no `format_version`".to_owned())),
        }
        let file: Self = table.try_into().map_err(malformed)?;
        let not_finite = |(_, value): &(&String, &Value)| !value.value.is_finite();
        match file.parameters.iter().find(not_finite) {
            Some((name, _)) => Err(FileError::NotFinite(name.clone())),
            None => Ok(file),
        }
    }
}

/// What a reader says, on a line.
fn plain(error: &toml::de::Error) -> String {
    error.message().lines().collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> ParameterFile {
        let value = |value, unit: &str| Value { value, unit: unit.to_owned() };
        let parameters = BTreeMap::from([
            ("depth".to_owned(), value(12.5, "mm")),
            ("rounds".to_owned(), value(3.0, "")),
        ]);
        let evidence = Evidence {
            runs: 500,
            successes: 480,
            low: 0.94,
            high: 0.97,
            successes_of_defaults: 300,
            candidates: 64,
            search_runs: 1500,
            seed: 7,
            version: "0.1.0".to_owned(),
        };
        ParameterFile::new(("a.obv", "1f".to_owned()), "insert", parameters, evidence)
    }

    #[test]
    fn what_is_written_is_read() {
        let text = file().to_text();
        assert_eq!(ParameterFile::from_text(&text), Ok(file()), "{text}");
        assert!(text.contains("value = 3\n") && text.contains("value = 12.5\n"), "{text}");
    }

    #[test]
    fn what_learning_again_may_replace_is_of_the_same_action() {
        let text = file().to_text();
        let is_of = ParameterFile::is_of;
        assert!(is_of(&text, "a.obv", "insert") && is_of(&text[..400], "a.obv", "insert"));
        assert!(!is_of(&text, "b.obv", "insert") && !is_of(&text, "a.obv", "pick"));
        assert!(!is_of("[arm]", "a.obv", "insert") && !is_of("", "a.obv", "insert"));
    }

    #[test]
    fn a_file_that_is_cut_off_anywhere_is_refused() {
        let text = file().to_text();
        let whole = text.trim_end().len();
        for end in 0..whole {
            assert!(ParameterFile::from_text(&text[..end]).is_err(), "{}", &text[..end]);
        }
    }

    #[test]
    fn what_is_foreign_or_of_another_version_is_refused() {
        let text = file().to_text();
        let read = |text: &str| ParameterFile::from_text(text);
        assert_eq!(read("[arm]\nhome_rad = []"), Err(FileError::Foreign));
        let newer = text.replace("format_version = 1", "format_version = 2");
        assert_eq!(read(&newer), Err(FileError::Version(2)));
        let more = text.replace("[evidence]", "[evidence]\nluck = 1");
        assert!(matches!(read(&more), Err(FileError::Malformed(why)) if why.contains("luck")));
        let endless = text.replace("12.5", "inf");
        assert_eq!(read(&endless), Err(FileError::NotFinite("depth".to_owned())));
    }
}
