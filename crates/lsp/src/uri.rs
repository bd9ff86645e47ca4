//! Addresses of files as editors write them, and paths. It knows no file system.

use lsp_types::Uri;

/// What the address of a file of the library begins with.
pub const LIBRARY_SCHEME: &str = "obverse-library:";

/// The path of a file, with `/` between folders; none for what is no file.
pub(crate) fn path_of(uri: &Uri) -> Option<String> {
    let rest = uri.0.strip_prefix("file://")?;
    // Before the path there may be a host, which is this one.
    let path = rest.get(rest.find('/')?..)?;
    let path = path.split(['?', '#']).next().unwrap_or(path);
    let path = decoded(path)?;
    // `/c:/folder/file`
    let is_drive =
        |bytes: &[u8]| bytes.len() > 2 && bytes[0].is_ascii_alphabetic() && bytes[1] == b':';
    match path.strip_prefix('/').filter(|rest| is_drive(rest.as_bytes())) {
        Some(drive) => Some(drive.to_owned()),
        None => Some(path),
    }
}

/// The address of a file.
pub(crate) fn uri_of(path: &str) -> Uri {
    let mut uri = "file://".to_owned();
    if !path.starts_with('/') {
        uri.push('/');
    }
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' => {
                uri.push(char::from(byte));
            }
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    Uri(uri)
}

/// The folder of a path, and the name in it.
pub(crate) fn split(path: &str) -> (&str, &str) {
    path.rsplit_once('/').map_or(("", path), |(folder, name)| match folder {
        "" => ("/", name),
        _ => (folder, name),
    })
}

/// A path from a folder.
pub(crate) fn join(folder: &str, path: &str) -> String {
    match folder {
        "" => path.to_owned(),
        _ => format!("{}/{path}", folder.trim_end_matches('/')),
    }
}

/// A text with `%20` and the like as what they stand for.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digit = |byte: Option<u8>| char::from(byte?).to_digit(16);
        let value = digit(rest.next())? * 16 + digit(rest.next())?;
        bytes.push(u8::try_from(value).ok()?);
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(uri: &str) -> Option<String> {
        path_of(&Uri(uri.to_owned()))
    }

    #[test]
    fn a_file_has_one_address() {
        assert_eq!(path("file:///home/a%20b/%C3%A4.obv").as_deref(), Some("/home/a b/ä.obv"));
        assert_eq!(path("file://localhost/a.obv").as_deref(), Some("/a.obv"));
        assert_eq!(path("file:///c%3A/cell/a.obv").as_deref(), Some("c:/cell/a.obv"));
        assert_eq!(uri_of("/home/a b/ä.obv").0, "file:///home/a%20b/%C3%A4.obv");
        assert_eq!(uri_of("c:/a.obv").0, "file:///c%3A/a.obv");
    }

    #[test]
    fn what_is_no_file_has_no_path() {
        for uri in ["untitled:Untitled-1", "file:", "file://", "file:///%", "file:///%FF", ""] {
            assert_eq!(path(uri), None, "{uri}");
        }
    }

    #[test]
    fn paths_are_cut_at_their_last_folder() {
        assert_eq!(split("/cell/main.obv"), ("/cell", "main.obv"));
        assert_eq!(split("/main.obv"), ("/", "main.obv"));
        assert_eq!(split("main.obv"), ("", "main.obv"));
        assert_eq!(join("/", "a.obv"), "/a.obv");
        assert_eq!(join("/cell", "a.obv"), "/cell/a.obv");
    }
}
