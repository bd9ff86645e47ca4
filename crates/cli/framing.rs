//! Messages on a stream as language servers have them: a header that says how many bytes follow.
//! It knows bytes, and nothing of what they say.

use std::io::{BufRead, Read, Write};

/// The most bytes that a message may have.
pub(crate) const MAX_MESSAGE_BYTES: usize = 64 << 20;

/// The most bytes that a header may have.
const MAX_HEADER_BYTES: u64 = 8 << 10;

/// Read the next message; none where the stream ends between two.
///
/// # Errors
/// Why no further message can be read, in a sentence.
pub(crate) fn read(stream: &mut impl BufRead) -> Result<Option<Vec<u8>>, String> {
    let Some(length) = header(stream)? else { return Ok(None) };
    if length > MAX_MESSAGE_BYTES {
        let limit = MAX_MESSAGE_BYTES >> 20;
        return Err(format!("a message of {length} bytes; {limit} MiB are the most allowed"));
    }
    let mut message = Vec::new();
    let read = stream.take(length as u64).read_to_end(&mut message);
    read.map_err(|error| format!("a message cannot be read: {error}"))?;
    match message.len() == length {
        true => Ok(Some(message)),
        false => Err(format!("a message ends after {} of {length} bytes", message.len())),
    }
}

/// How long the next message is.
fn header(stream: &mut impl BufRead) -> Result<Option<usize>, String> {
    let mut lines = stream.take(MAX_HEADER_BYTES);
    let mut length = None;
    let mut is_first = true;
    loop {
        let mut line = Vec::new();
        let read = lines.read_until(b'\n', &mut line);
        read.map_err(|error| format!("a header cannot be read: {error}"))?;
        if line.is_empty() && is_first {
            return Ok(None);
        }
        is_first = false;
        let text = String::from_utf8_lossy(&line);
        let Some(text) = text.strip_suffix('\n').map(|text| text.trim_end_matches('\r')) else {
            return Err(match lines.limit() {
                0 => format!("a header of more than {MAX_HEADER_BYTES} bytes"),
                _ => "the stream ends within a header".to_owned(),
            });
        };
        if text.is_empty() {
            let none = "a header without `Content-Length`".to_owned();
            return length.map(Some).ok_or(none);
        }
        let Some((name, value)) = text.split_once(':') else {
            return Err(format!("`{}` is no line of a header", shortened(text)));
        };
        if name.eq_ignore_ascii_case("Content-Length") {
            let number = value.trim().parse::<usize>();
            length = Some(number.map_err(|_| format!("`{}` is no length", shortened(value)))?);
        }
    }
}

/// The beginning of a text that may be long and anything.
fn shortened(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// Write a message.
///
/// # Errors
/// Those of the stream.
pub(crate) fn write(stream: &mut impl Write, message: &str) -> std::io::Result<()> {
    write!(stream, "Content-Length: {}\r\n\r\n{message}", message.len())?;
    stream.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(stream: &str) -> (Vec<String>, Option<String>) {
        let mut stream = stream.as_bytes();
        let mut messages = Vec::new();
        loop {
            match read(&mut stream) {
                Ok(Some(message)) => messages.push(String::from_utf8_lossy(&message).into_owned()),
                Ok(None) => return (messages, None),
                Err(why) => return (messages, Some(why)),
            }
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let mut stream = Vec::new();
        for message in ["{}", "", "ä\r\n\r\n"] {
            write(&mut stream, message).expect("memory");
        }
        let stream = String::from_utf8(stream).expect("text");
        let (messages, why) = all(&stream);
        assert_eq!((messages, why), (vec!["{}".into(), String::new(), "ä\r\n\r\n".into()], None));
        let (messages, _) = all("content-length: 2\nContent-Type: x\n\n{}");
        assert_eq!(messages, ["{}"]);
    }

    #[test]
    fn what_cannot_be_read_is_said() {
        let why = |stream: &str| all(stream).1.unwrap_or_default();
        assert_eq!(why("Content-Length: 5\r\n\r\n{}"), "a message ends after 2 of 5 bytes");
        assert_eq!(why("Content-Length: -1\r\n\r\n{}"), "` -1` is no length");
        assert_eq!(why("hello\r\n\r\n"), "`hello` is no line of a header");
        assert_eq!(why("\r\n{}"), "a header without `Content-Length`");
        assert_eq!(why("Content-Le"), "the stream ends within a header");
        let large = format!("Content-Length: {}\r\n\r\n", u64::MAX);
        assert!(why(&large).contains("64 MiB"), "{}", why(&large));
        assert!(why(&"x".repeat(9000)).contains("more than 8192 bytes"));
    }
}
