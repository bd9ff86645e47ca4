//! Output: to a file whole or not at all, and to a standard output that may be closed any time.

use crate::show::Problem;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// Write a file by way of a neighbour that takes its name only when it is complete, so that what was
/// there is kept if anything goes wrong.
pub(crate) fn file(path: &Path, bytes: &[u8]) -> Result<(), Problem> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    let Some(name) = name else {
        return Err(Problem::new(format!("{}: this names no file", path.display())));
    };
    let neighbour = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
    let written = fs::File::create(&neighbour)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&neighbour, path));
    written.map_err(|error| {
        // What could not be written need not stay; that it cannot be removed changes nothing.
        let _ = fs::remove_file(&neighbour);
        Problem::new(format!("{}: cannot be written: {error}", path.display()))
    })
}

/// Print text. A reader that has gone away ends the process quietly, as a pipe's writer should.
pub(crate) fn out(text: &str) {
    let mut stdout = io::stdout().lock();
    if stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).is_err() {
        std::process::exit(0);
    }
}

/// Print a line.
pub(crate) fn line(text: &str) {
    out(&format!("{text}\n"));
}
