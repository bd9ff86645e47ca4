//! Codes of what is wrong with a text: a row a code, with the page that explains it.
//!
//! [`table!`] makes a type of a table of rows, [`Page`] is what a row says, [`mod@index`] the pages
//! of many codes as one. A code is stable: a row may be reworded, but its code is never given
//! another meaning nor used again. Knows no code, and nothing of how what is wrong is found.

pub mod index;

/// What is said of a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Page {
    /// The stable code: `E0001`.
    pub code: &'static str,
    /// What is wrong, in a few words.
    pub title: &'static str,
    /// Why it is wrong, and what is asked for.
    pub reason: &'static str,
    /// A text that has this mistake, and none of another kind; empty where one cannot be shown.
    pub wrong: &'static str,
    /// The same text without it.
    pub right: &'static str,
}

impl Page {
    /// The page as text: what, why, an example wrong and the same right.
    #[must_use]
    pub fn explanation(&self) -> String {
        let Self { code, title, reason, wrong, right } = self;
        let examples = match wrong.is_empty() {
            true => String::new(),
            false => format!("\n\nWrong:\n\n{wrong}\n\nRight:\n\n{right}"),
        };
        format!("{code}: {title}\n\n{reason}{examples}\n")
    }
}

/// An enum of the rows of a table: its name, what it is, and a row a code.
#[macro_export]
macro_rules! table {
    ($kind:ident $about:literal
     $($name:ident $code:literal $title:literal
       why $why:literal wrong $wrong:literal right $right:literal)*) => {
        #[doc = $about]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $kind {
            $(#[doc = concat!($code, ": ", $title, ".")] $name,)*
        }

        impl $kind {
            /// Every code, in the table's order.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The stable code.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$name => $code,)* }
            }

            /// What is said of each, in the table's order.
            pub fn pages() -> impl Iterator<Item = $crate::Page> {
                Self::ALL.iter().map(|code| code.page())
            }

            /// What is said of it.
            #[must_use]
            pub const fn page(self) -> $crate::Page {
                match self {
                    $(Self::$name => $crate::Page {
                        code: $code,
                        title: $title,
                        reason: $why,
                        wrong: $wrong,
                        right: $right,
                    },)*
                }
            }
        }

        impl std::str::FromStr for $kind {
            type Err = $crate::UnknownCode;

            fn from_str(text: &str) -> Result<Self, $crate::UnknownCode> {
                let found = Self::ALL.iter().find(|one| one.as_str().eq_ignore_ascii_case(text));
                found.copied().ok_or($crate::UnknownCode)
            }
        }

        impl std::fmt::Display for $kind {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str(self.as_str())
            }
        }
    };
}

/// A text that is the code of no row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownCode;

impl std::fmt::Display for UnknownCode {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("no such code; codes look like E0001 or W0001")
    }
}

impl std::error::Error for UnknownCode {}
