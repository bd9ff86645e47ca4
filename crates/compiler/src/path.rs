//! Paths of imports and workcells, as text: from the one that a file names to one from the folder
//! of the program. It knows no file system.

/// Where a path leads that is imported in `importer`, itself a path from the folder of the program.
///
/// # Errors
/// Why none can be meant: a program is what is in its folder, so that it is the same wherever that
/// is put, and a text from elsewhere reads nothing outside of it.
pub(crate) fn resolve(importer: &str, written: &str) -> Result<String, &'static str> {
    if written.is_empty() {
        return Err("the path is empty");
    }
    if written.contains('\\') {
        return Err("write `/` between folders, on every system");
    }
    if written.contains(|c: char| c.is_control()) {
        return Err("a path has no control characters");
    }
    if written.starts_with('/') || written.contains(':') {
        return Err("a path begins at the folder of this file");
    }
    let mut parts: Vec<&str> = importer.split('/').collect();
    parts.pop();
    for part in written.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.pop().is_none() => return Err("this leads out of the program's folder"),
            ".." => {}
            _ => parts.push(part),
        }
    }
    match written.rsplit('/').next() {
        Some("" | "." | "..") => Err("this names a folder; name a file in it"),
        _ => Ok(parts.join("/")),
    }
}

/// A workcell file that is named in a file of the program: relative to that file if it is relative,
/// as an import, but wherever it leads.
pub(crate) fn beside(importer: &str, written: &str) -> String {
    let is_absolute = written.starts_with(['/', '\\']) || written.contains(':');
    match importer.rsplit_once('/').filter(|_| !is_absolute) {
        Some((folder, _)) => format!("{folder}/{written}"),
        None => written.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_begin_at_the_folder_of_the_importer() {
        let resolved = |importer, written| resolve(importer, written).expect("a path");
        assert_eq!(resolved("main.obv", "poses.obv"), "poses.obv");
        assert_eq!(resolved("main.obv", "./cell//poses.obv"), "cell/poses.obv");
        assert_eq!(resolved("cell/poses.obv", "more.obv"), "cell/more.obv");
        assert_eq!(resolved("cell/left/poses.obv", "../../io.obv"), "io.obv");
        assert_eq!(resolved("main.obv", "a/../b.obv"), "b.obv");
    }

    #[test]
    fn what_leads_elsewhere_is_refused() {
        let refused = [
            ("main.obv", ""),
            ("main.obv", "/etc/passwd"),
            ("main.obv", "C:/poses.obv"),
            ("main.obv", "cell\\poses.obv"),
            ("main.obv", "../poses.obv"),
            ("cell/poses.obv", "../../io.obv"),
            ("main.obv", "a/../../b.obv"),
            ("main.obv", "cell/"),
            ("main.obv", "."),
            ("cell/poses.obv", ".."),
            ("main.obv", "a\u{0}b"),
        ];
        for (importer, written) in refused {
            assert!(resolve(importer, written).is_err(), "{importer} {written}");
        }
    }

    #[test]
    fn a_workcell_is_beside_the_file_that_names_it() {
        assert_eq!(beside("main.obv", "../cell.toml"), "../cell.toml");
        assert_eq!(beside("poses/left.obv", "cell.toml"), "poses/cell.toml");
        assert_eq!(beside("poses/left.obv", "/cells/cell.toml"), "/cells/cell.toml");
    }
}
