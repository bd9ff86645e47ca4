//! One message among bytes: a header that says how long it is, an empty line, and so many bytes.
//!
//! Lengths are limited before anything is kept, and what is too long is passed over, so that the
//! next message is found. Knows nothing of what a message says.

use std::io::{self, BufRead, Read, Write};

/// The longest header, in bytes.
pub const MAX_HEADER: usize = 4 << 10;
/// The longest message, in bytes.
pub const MAX_MESSAGE: u64 = 1 << 20;

/// What was found among bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Frame {
    /// A message.
    Message(Vec<u8>),
    /// No message, and why; there may be one behind it.
    Wrong(String),
    /// The end, and what is wrong with it unless it is between two messages.
    End(Option<String>),
}

/// Read what is next.
pub fn read(input: &mut impl BufRead) -> Frame {
    let found = header(input).and_then(|length| match length {
        Ok(length) => body(input, length),
        Err(other) => Ok(other),
    });
    found.unwrap_or_else(|error| Frame::End(Some(format!("the client cannot be read: {error}"))))
}

/// The length that a header says, or what was found in its place.
fn header(input: &mut impl BufRead) -> io::Result<Result<u64, Frame>> {
    let mut length = None;
    let mut total = 0;
    loop {
        let mut line = Vec::new();
        let rest = (MAX_HEADER + 1 - total) as u64;
        let count = input.by_ref().take(rest).read_until(b'\n', &mut line)?;
        total += count;
        if count == 0 {
            let half = "the client went away in the middle of a header".to_owned();
            return Ok(Err(Frame::End((total > 0).then_some(half))));
        }
        if total > MAX_HEADER {
            let why = format!("this is no header: it is longer than {MAX_HEADER} bytes");
            return Ok(Err(Frame::Wrong(why)));
        }
        let line = String::from_utf8_lossy(&line);
        match line.trim_end().split_once(':') {
            Some((name, value)) if name.eq_ignore_ascii_case("content-length") => {
                length = Some(value.trim().parse().map_err(|_| value.trim().to_owned()));
            }
            None if line.trim().is_empty() && total > count => break,
            _ => {}
        }
    }
    Ok(match length {
        Some(Ok(length)) => Ok(length),
        Some(Err(text)) => Err(Frame::Wrong(format!("`{text}` is not the length of a message"))),
        None => Err(Frame::Wrong("a header must say `Content-Length`".to_owned())),
    })
}

fn body(input: &mut impl BufRead, length: u64) -> io::Result<Frame> {
    let mut taken = input.take(length);
    if length > MAX_MESSAGE {
        io::copy(&mut taken, &mut io::sink())?;
        return Ok(Frame::Wrong(format!(
            "a message of {length} bytes is not read: the longest is {MAX_MESSAGE}"
        )));
    }
    let mut bytes = Vec::new();
    taken.read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < length {
        let why = "the client went away in the middle of a message";
        return Ok(Frame::End(Some(why.to_owned())));
    }
    Ok(Frame::Message(bytes))
}

/// Write a message.
///
/// # Errors
/// If it cannot be written.
pub fn write(output: &mut dyn Write, message: &[u8]) -> io::Result<()> {
    write!(output, "Content-Length: {}\r\n\r\n", message.len())?;
    output.write_all(message)?;
    output.flush()
}

#[cfg(test)]
mod tests {
    //! What is between messages, and what is not one, is told apart.

    use super::*;

    fn all(bytes: &[u8]) -> Vec<Frame> {
        let mut input = bytes;
        let mut frames = Vec::new();
        loop {
            let frame = read(&mut input);
            let is_end = matches!(frame, Frame::End(_));
            frames.push(frame);
            if is_end {
                return frames;
            }
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let mut bytes = Vec::new();
        for message in [&b"{}"[..], b"", "ü".as_bytes()] {
            write(&mut bytes, message).expect("memory can be written");
        }
        let expected = [
            Frame::Message(b"{}".to_vec()),
            Frame::Message(Vec::new()),
            Frame::Message("ü".as_bytes().to_vec()),
            Frame::End(None),
        ];
        assert_eq!(all(&bytes), expected);
    }

    #[test]
    fn behind_garbage_the_next_message_is_found() {
        let garbage = ["hello\r\n\r\n", "Content-Length: -1\r\n\r\n", "Content-Length: x\r\n\r\n"];
        for wrong in garbage {
            let bytes = format!("{wrong}content-length:2\r\nOther: 1\r\n\r\n{{}}");
            let frames = all(bytes.as_bytes());
            assert!(matches!(frames[0], Frame::Wrong(_)), "{frames:?}");
            assert_eq!(frames[1..], [Frame::Message(b"{}".to_vec()), Frame::End(None)]);
        }
    }

    #[test]
    fn what_is_too_long_is_passed_over() {
        let mut bytes = format!("Content-Length: {}\r\n\r\n", MAX_MESSAGE + 1).into_bytes();
        bytes.extend(std::iter::repeat_n(b' ', MAX_MESSAGE as usize + 1));
        bytes.extend(b"Content-Length: 2\r\n\r\n[]");
        let frames = all(&bytes);
        assert!(matches!(frames[0], Frame::Wrong(_)));
        assert_eq!(frames[1..], [Frame::Message(b"[]".to_vec()), Frame::End(None)]);
        let line = "x".repeat(MAX_HEADER + 1);
        assert!(matches!(all(line.as_bytes())[0], Frame::Wrong(_)));
    }

    #[test]
    fn half_a_message_is_said_to_be_one() {
        for half in ["Content-Le", "Content-Length: 3\r\n", "Content-Length: 3\r\n\r\n{}"] {
            assert!(matches!(all(half.as_bytes())[..], [Frame::End(Some(_))]), "{half}");
        }
    }
}
