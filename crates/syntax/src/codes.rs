//! The table of diagnostic codes: one row a code, with the page that explains it.
//!
//! A code is stable: a row may be reworded, but its code is never given another meaning nor used
//! again. `E00xx` is text and grammar, `E01xx` names, `E02xx` types and units, `E03xx` statements,
//! structure and errors, `E04xx` reversal, `E05xx` files, `E06xx` forks, `E07xx` inversion; `W00xx`
//! warnings, `W04xx` those about reversal, `W05xx` about files, `W06xx` about forks. It knows
//! nothing of how a mistake is found or shown.

mod errors;
mod warnings;

use errors::errors;
use warnings::warnings;

macro_rules! codes {
    ($($name:ident $code:literal $title:literal
       why $why:literal wrong $wrong:literal right $right:literal)*) => {
        /// A kind of diagnostic.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = concat!($code, ": ", $title, ".")] $name,)*
        }

        impl Code {
            /// Every code, in the table's order.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The stable code: `E0001`.
            #[must_use]
            pub fn as_str(self) -> &'static str {
                match self { $(Self::$name => $code,)* }
            }

            /// What is wrong, in a few words.
            #[must_use]
            pub fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)* }
            }

            /// Why it is wrong, and what is asked for.
            #[must_use]
            pub fn reason(self) -> &'static str {
                match self { $(Self::$name => $why,)* }
            }

            /// The page that explains it: what, why, an example wrong and the same right.
            #[must_use]
            pub fn explanation(self) -> &'static str {
                match self {
                    $(Self::$name if $wrong.is_empty() => {
                        concat!($code, ": ", $title, "\n\n", $why, "\n")
                    })*
                    $(Self::$name => concat!(
                        $code, ": ", $title, "\n\n", $why,
                        "\n\nWrong:\n\n", $wrong, "\n\nRight:\n\n", $right, "\n",
                    ),)*
                }
            }

            /// A whole program that has this mistake, and none of another kind; empty where one
            /// cannot be shown.
            #[must_use]
            pub fn wrong_example(self) -> &'static str {
                match self { $(Self::$name => $wrong,)* }
            }

            /// The same program without it.
            #[must_use]
            pub fn right_example(self) -> &'static str {
                match self { $(Self::$name => $right,)* }
            }
        }
    };
}

impl std::str::FromStr for Code {
    type Err = UnknownCode;

    fn from_str(text: &str) -> Result<Self, UnknownCode> {
        let found = Self::ALL.iter().find(|code| code.as_str().eq_ignore_ascii_case(text));
        found.copied().ok_or(UnknownCode)
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.as_str())
    }
}

/// A text that is the code of no row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownCode;

impl std::fmt::Display for UnknownCode {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("no such diagnostic code; codes look like E0001 or W0001")
    }
}

impl std::error::Error for UnknownCode {}

// The examples are whole programs: tests hold that the wrong one gets its code and no other, and
// that the right one gets none.
warnings! { errors codes }
