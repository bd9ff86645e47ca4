//! The library: sources of actions that come with the language, and are imported by name.
//!
//! They are programs like any other: `import library "insert"` puts the declarations of one in its
//! place. Each says at its top what it needs of the program that imports it.

mod round;

/// What the name of a file of the library begins with, where it is told from those of the program.
pub const PREFIX: &str = "library:";

/// The name by which a file is imported, and what gives its text.
pub type File = (&'static str, fn() -> &'static str);

/// The files. Most are written by hand; one is made by Rust where the language cannot say what its
/// body needs.
pub const FILES: [File; 11] = [
    ("feeder", || include_str!("../library/feeder.obv")),
    ("insert", || include_str!("../library/insert.obv")),
    ("pick", || include_str!("../library/pick.obv")),
    ("place", || include_str!("../library/place.obv")),
    ("press", || include_str!("../library/press.obv")),
    ("probe", || include_str!("../library/probe.obv")),
    ("regrasp", || include_str!("../library/regrasp.obv")),
    ("round", round::text),
    ("snap", || include_str!("../library/snap.obv")),
    ("tilt", || include_str!("../library/tilt.obv")),
    ("turn", || include_str!("../library/turn.obv")),
];

/// The file of a name.
pub(crate) fn find(name: &str) -> Option<(&'static str, &'static str)> {
    FILES.iter().find(|(known, _)| *known == name).map(|(name, text)| (*name, text()))
}
