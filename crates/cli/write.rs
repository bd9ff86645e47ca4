//! Output: to a file whole or not at all, and to a standard output that may be closed any time.

use crate::files;
use crate::problem::{Problem, plain};
use std::borrow::Cow;
use std::fs;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Check that a file can become what a command is about to make, before anything is done: its
/// folder is there and takes files, it is a regular file or none, and it is none of the files that
/// the command reads.
pub(crate) fn check(path: &Path, what: &str, inputs: &[PathBuf]) -> Result<(), Problem> {
    let cannot = |why: String| Err(Problem::of_file(path, why));
    check_text(path, what, inputs)?;
    for name in [path, &target(path)?] {
        let extension = name.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        if matches!(extension, "obv" | "obvasm" | "toml") {
            return cannot(format!(
                "the {what} is no text; `.{extension}` is for files that people write"
            ));
        }
    }
    Ok(())
}

/// The same for a file that people read.
pub(crate) fn check_text(path: &Path, what: &str, inputs: &[PathBuf]) -> Result<(), Problem> {
    let cannot = |why: String| Err(Problem::of_file(path, why));
    if path.file_name().is_none() || path.is_dir() {
        return cannot(format!("this is a folder; name a file for the {what}"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return cannot(format!("cannot be written: there is no folder {}", folder.display()));
    }
    let target = target(path)?;
    if let Some(input) = inputs.iter().find(|input| is_same(&target, input)) {
        return cannot(format!("the {what} would overwrite {}", input.display()));
    }
    try_out(path, &target)
}

/// Check that a file that is there may be replaced: that it is what a command of Obverse wrote
/// there, by what is in it.
pub(crate) fn check_own(
    path: &Path,
    what: &str,
    is_own: impl Fn(&str) -> bool,
) -> Result<(), Problem> {
    if !path.exists() {
        return Ok(());
    }
    let bytes = files::read(path).map_err(|why| Problem::of_file(path, why))?;
    if String::from_utf8(bytes).is_ok_and(|text| is_own(&text)) {
        return Ok(());
    }
    let why = format!(
        "this file is there already, is not {what}, and is not overwritten; name another, or \
         remove it"
    );
    Err(Problem::of_file(path, why))
}

/// Check that a folder takes a file, by one that is gone at once.
fn try_out(path: &Path, target: &Path) -> Result<(), Problem> {
    let neighbour = neighbour(target);
    let tried = fs::File::create(&neighbour).and_then(|_| fs::remove_file(&neighbour));
    tried.map_err(|error| Problem::of_file(path, format!("cannot be written: {}", plain(&error))))
}

/// Where a file is written until it is complete: short, so that it fits wherever the name itself
/// does.
fn neighbour(target: &Path) -> PathBuf {
    target.with_file_name(format!(".{}.part", std::process::id()))
}

/// The file that a path names: where it is a symbolic link, what that leads to. A regular file, or
/// none yet: a device or a pipe is written to, not replaced, and nothing here does that.
fn target(path: &Path) -> Result<PathBuf, Problem> {
    let is_link = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink());
    let target = match is_link {
        true => fs::canonicalize(path).map_err(|error| {
            let why = plain(&error);
            Problem::of_file(path, format!("this link leads nowhere: {why}; name a file"))
        })?,
        false => path.to_owned(),
    };
    match fs::metadata(&target) {
        Ok(metadata) if !metadata.is_file() => {
            Err(Problem::of_file(path, "this is no regular file, and is not replaced by one"))
        }
        _ => Ok(target),
    }
}

/// Whether two paths lead to one file.
fn is_same(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// Write a file by way of a neighbour that takes its name only when it is complete, so that what
/// was there is kept if anything goes wrong. Who may read and write it stays as it was.
pub(crate) fn file(path: &Path, bytes: &[u8]) -> Result<(), Problem> {
    let target = target(path)?;
    let neighbour = neighbour(&target);
    let written = fs::File::create(&neighbour)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| match fs::metadata(&target) {
            Ok(metadata) => fs::set_permissions(&neighbour, metadata.permissions()),
            Err(_) => Ok(()),
        })
        .and_then(|()| fs::rename(&neighbour, &target));
    written.map_err(|error| {
        // What could not be written need not stay; that it cannot be removed changes nothing.
        let _ = fs::remove_file(&neighbour);
        Problem::of_file(path, format!("cannot be written: {}", plain(&error)))
    })
}

/// Wait until nobody else is changing a file, and keep others from it as long as this lives. What
/// is locked is a neighbour of the file, which takes another one's place when it is written.
pub(crate) fn lock(path: &Path) -> Result<fs::File, Problem> {
    let target = target(path)?;
    let mut name = std::ffi::OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(".lock");
    let neighbour = target.with_file_name(name);
    let opened = fs::File::options().create(true).write(true).truncate(false).open(neighbour);
    let locked = opened.and_then(|file| file.lock().map(|()| file));
    locked.map_err(|error| {
        Problem::of_file(path, format!("cannot be locked to write it: {}", plain(&error)))
    })
}

/// A text without what would command a terminal; every byte stays in its place.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let is_command = |c: char| c.is_control() && !matches!(c, '\n' | '\r' | '\t');
    if !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let mut kept = String::with_capacity(text.len());
    for c in text.chars() {
        match is_command(c) {
            true => kept.extend(std::iter::repeat_n('?', c.len_utf8())),
            false => kept.push(c),
        }
    }
    Cow::Owned(kept)
}

/// Print text. A reader that has gone away ends the process quietly, as a pipe's writer should; any
/// other failure is an error.
pub(crate) fn out(text: &str) {
    bytes_out(printable(text).as_bytes());
}

/// Print a text that is meant for a file: every byte of it, unless people look at it.
pub(crate) fn exactly(text: &str) {
    match io::stdout().is_terminal() {
        true => out(text),
        false => bytes_out(text.as_bytes()),
    }
}

fn bytes_out(bytes: &[u8]) {
    let mut stdout = io::stdout().lock();
    let Err(error) = stdout.write_all(bytes).and_then(|()| stdout.flush()) else {
        return;
    };
    if error.kind() == ErrorKind::BrokenPipe {
        std::process::exit(0);
    }
    crate::show::problem(&Problem::new(format!(
        "standard output cannot be written: {}",
        plain(&error)
    )));
    std::process::exit(2);
}

/// Print a line.
pub(crate) fn line(text: &str) {
    out(&format!("{text}\n"));
}

/// Print text that was made [`printable`] before it was coloured.
pub(crate) fn coloured(text: &str) {
    bytes_out(text.as_bytes());
}
