//! Files as they are read: whole, once, and only if they stay what they are meanwhile; and the
//! folder of a program, which its compiler asks for what the program imports.

use crate::problem::plain;
use obverse_compiler::Loader;
use std::fs::{self, File, Metadata};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// The largest file that is read, in bytes.
pub(crate) const MAX_FILE_BYTES: u64 = 256 << 20;

/// How many files of a folder are looked through for one that was meant.
const MAX_LISTED: usize = 1_000;

/// Read a file, if it is one and not too large.
///
/// # Errors
/// Why not, in words that follow the file's name.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, String> {
    read_at_most(path, MAX_FILE_BYTES)
}

/// Read a file, if it is one and has at most so many bytes.
///
/// # Errors
/// Why not, in words that follow the file's name.
pub(crate) fn read_at_most(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let cannot = |error: std::io::Error| format!("cannot be read: {}", plain(&error));
    // Before it is opened, since opening a pipe waits for who writes to it.
    let kind = fs::metadata(path).map_err(cannot)?;
    if kind.is_dir() {
        return Err("this is a folder; name a file in it".to_owned());
    }
    if !kind.is_file() {
        return Err("this is no regular file; save what it gives to one".to_owned());
    }
    let mut bytes = Vec::new();
    let mut file = File::open(path).map_err(cannot)?;
    let before = file.metadata().map_err(cannot)?;
    file.by_ref().take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(cannot)?;
    let length = bytes.len() as u64;
    if length > most {
        return Err(format!("larger than {} MiB, the most allowed", most >> 20));
    }
    if has_changed(&before, &file.metadata().map_err(cannot)?, length) {
        return Err("it changed while it was read; try again when it is complete".to_owned());
    }
    Ok(bytes)
}

/// Whether a regular file is not what it was, or not what was read.
fn has_changed(before: &Metadata, after: &Metadata, length: u64) -> bool {
    let times = before.modified().ok().zip(after.modified().ok());
    before.is_file()
        && (after.len() != length || times.is_some_and(|(before, after)| before != after))
}

/// The folder of a program. Nothing outside of it is read, wherever links lead.
pub(crate) struct ProgramFolder {
    /// As the command line names it.
    folder: PathBuf,
    /// Where it truly is, if it is there.
    real: Option<PathBuf>,
}

impl ProgramFolder {
    /// The folder that a file is in.
    pub(crate) fn of(file: &Path) -> Self {
        let folder = file.with_file_name("");
        let named = if folder.as_os_str().is_empty() { Path::new(".") } else { &folder };
        let real = fs::canonicalize(named).ok();
        Self { folder, real }
    }
}

impl Loader for ProgramFolder {
    fn name(&mut self, path: &str) -> Result<String, String> {
        let real = fs::canonicalize(self.folder.join(path)).map_err(|error| plain(&error))?;
        let within = self.real.as_ref().and_then(|folder| real.strip_prefix(folder).ok());
        let within = within.ok_or("a link leads out of the program's folder")?;
        let metadata = fs::metadata(&real).map_err(|error| plain(&error))?;
        if metadata.is_dir() {
            return Err("this is a folder; name a file in it".to_owned());
        }
        if !metadata.is_file() {
            return Err("this is no regular file".to_owned());
        }
        let part = |component: Component<'_>| match component {
            Component::Normal(part) => part.to_str().map(str::to_owned),
            _ => None,
        };
        let parts: Option<Vec<String>> = within.components().map(part).collect();
        parts.map(|parts| parts.join("/")).ok_or_else(|| "its name is no text".to_owned())
    }

    fn read(&mut self, name: &str) -> Result<String, String> {
        let bytes = read(&self.folder.join(name))?;
        String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            format!("this is no text: byte {at} (counted from 0) is not UTF-8")
        })
    }

    fn files(&mut self, folder: &str) -> Vec<String> {
        let Some(real) = &self.real else { return Vec::new() };
        // Of a folder elsewhere, to which a link may lead, nothing is told.
        let folder = fs::canonicalize(real.join(folder)).ok();
        let folder = folder.filter(|folder| folder.starts_with(real));
        let entries = folder.and_then(|folder| fs::read_dir(folder).ok());
        let entries = entries.into_iter().flatten().flatten().take(MAX_LISTED);
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| name.ends_with(".obv")).collect();
        names.sort();
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that is gone when the test is over.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let folder =
                std::env::temp_dir().join(format!("obverse_{name}_{}", std::process::id()));
            fs::create_dir_all(&folder).expect("a folder");
            Self(folder)
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_file_that_grows_or_shrinks_has_changed() {
        let scratch = Scratch::new("grows");
        let path = scratch.0.join("f");
        fs::write(&path, "four").expect("a file");
        let before = fs::metadata(&path).expect("metadata");
        assert!(!has_changed(&before, &before, 4));
        assert!(has_changed(&before, &before, 3), "less was read than there is");
        fs::write(&path, "fours").expect("a file");
        assert!(has_changed(&before, &fs::metadata(&path).expect("metadata"), 4));
    }

    #[test]
    fn a_file_that_vanishes_is_an_error() {
        let scratch = Scratch::new("vanishes");
        fs::write(scratch.0.join("f.obv"), "").expect("a file");
        let mut folder = ProgramFolder::of(&scratch.0.join("main.obv"));
        assert_eq!(folder.name("f.obv"), Ok("f.obv".to_owned()));
        fs::remove_file(scratch.0.join("f.obv")).expect("it was there");
        assert!(folder.read("f.obv").is_err_and(|why| why.contains("no such file")));
        assert!(folder.name("f.obv").is_err());
    }
}
