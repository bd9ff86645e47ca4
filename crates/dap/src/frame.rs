//! One message among bytes: a header that says how long it is, an empty line, and so many bytes. So
//! do editors frame both of their protocols.
//!
//! What is no message is said as soon as it is seen to be none, and what follows is searched for
//! the next header that is one. Such a header is looked for in messages too: none holds one, since
//! JSON has line ends between its parts alone, so that a length that is too large takes no more
//! than the message that it is of. Knows nothing of what a message says.

use std::io::{self, Read, Write};

/// The longest header, in bytes.
pub const MAX_HEADER: usize = 4 << 10;
/// What a header must say.
const LENGTH: &[u8] = b"content-length";
/// The longest line that says a length, in bytes: what of the end of lost bytes is kept.
const MAX_LENGTH_LINE: usize = 64;
/// How many bytes are read at once.
const PIECE: usize = 16 << 10;

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

/// Finds messages among bytes.
pub struct Reader<R> {
    input: R,
    /// What was read and is in no frame yet.
    bytes: Vec<u8>,
    /// Whether what follows is no message, which was said: a header is searched for.
    is_lost: bool,
    longest: usize,
}

/// What the header at the beginning of bytes is.
enum Header {
    /// There is more of it to come.
    Half,
    /// So many bytes, and so many are the message behind them.
    Of(usize, usize),
    /// None, and why; nothing is in so many bytes.
    Wrong(usize, String),
}

impl<R: Read> Reader<R> {
    /// That finds messages of at most so many bytes.
    pub fn new(input: R, longest: usize) -> Self {
        Self { input, bytes: Vec::new(), is_lost: false, longest }
    }

    /// Read what is next.
    pub fn read(&mut self) -> Frame {
        self.find().unwrap_or_else(|error| {
            Frame::End(Some(format!("what is sent cannot be read: {error}")))
        })
    }

    fn find(&mut self) -> io::Result<Frame> {
        loop {
            if self.is_lost {
                self.is_lost = !self.skip();
            }
            if !self.is_lost {
                match header(&self.bytes, self.longest) {
                    Header::Half => {}
                    Header::Of(begin, length) => return self.message(begin, length),
                    Header::Wrong(count, why) => {
                        self.bytes.drain(..count);
                        self.is_lost = true;
                        return Ok(Frame::Wrong(why));
                    }
                }
            }
            if self.more()? == 0 {
                let is_half = !self.is_lost && !self.bytes.trim_ascii().is_empty();
                let half = "its sender went away in the middle of a header".to_owned();
                return Ok(Frame::End(is_half.then_some(half)));
            }
        }
    }

    /// Pass over what is before the next header; whether there is one.
    fn skip(&mut self) -> bool {
        let found = length_line(&self.bytes);
        let kept = self.bytes.len().saturating_sub(MAX_LENGTH_LINE);
        self.bytes.drain(..found.unwrap_or(kept));
        found.is_some()
    }

    fn message(&mut self, begin: usize, length: usize) -> io::Result<Frame> {
        self.bytes.drain(..begin);
        let mut searched: usize = 0;
        loop {
            let until = self.bytes.len().min(length);
            let from = searched.saturating_sub(MAX_LENGTH_LINE);
            let found = length_line(&self.bytes[from..until]).map(|at| from + at);
            let found =
                found.or_else(|| half_line(&self.bytes[..until]).filter(|_| until == length));
            if let Some(at) = found {
                self.bytes.drain(..at);
                let why = format!("a message of {length} bytes ends after {at}: another begins");
                return Ok(Frame::Wrong(why));
            }
            if until == length {
                let behind = self.bytes.split_off(length);
                return Ok(Frame::Message(std::mem::replace(&mut self.bytes, behind)));
            }
            searched = until;
            if self.more()? == 0 {
                return Ok(Frame::End(Some(format!(
                    "its sender went away in the middle of a message: {until} of {length} bytes"
                ))));
            }
        }
    }

    /// Read some more; how many bytes.
    fn more(&mut self) -> io::Result<usize> {
        let before = self.bytes.len();
        self.bytes.resize(before + PIECE, 0);
        let read = loop {
            match self.input.read(&mut self.bytes[before..]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => break read,
            }
        };
        self.bytes.truncate(before + *read.as_ref().unwrap_or(&0));
        read
    }
}

/// The header at the beginning of bytes; empty lines before it are passed over.
fn header(bytes: &[u8], longest: usize) -> Header {
    let mut begin = 0;
    let mut length = None;
    let mut is_empty = true;
    loop {
        let rest = &bytes[begin..];
        let Some(end) = rest.iter().position(|byte| *byte == b'\n') else {
            return half(rest, begin);
        };
        if begin + end > MAX_HEADER {
            return too_long(begin);
        }
        let line = rest[..end].trim_ascii();
        match (line.is_empty(), length) {
            (true, Some(length)) => return Header::Of(begin + end + 1, length),
            (true, None) if is_empty => {}
            (true, None) => {
                return Header::Wrong(begin, "a header must say `Content-Length`".to_owned());
            }
            (false, _) => match said(line, longest) {
                Err(why) => return Header::Wrong(begin + begun(&rest[..end]), why),
                Ok(said) => length = said.or(length),
            },
        }
        is_empty &= line.is_empty();
        begin += end + 1;
    }
}

/// How much of a line that is wrong is the name of a length: behind it one that is right may be.
fn begun(line: &[u8]) -> usize {
    let name = line.trim_ascii_start();
    let is_length = name.get(..LENGTH.len()).is_some_and(|it| it.eq_ignore_ascii_case(LENGTH));
    if is_length { line.len() - name.len() + LENGTH.len() } else { 0 }
}

/// A header of which the last line is not there yet.
fn half(line: &[u8], begin: usize) -> Header {
    let line = line.trim_ascii();
    if begin + line.len() > MAX_HEADER {
        return too_long(begin);
    }
    let name = line.split(|byte| *byte == b':').next().unwrap_or_default();
    match name.iter().all(is_of_name) {
        true => Header::Half,
        false => Header::Wrong(begin, no_line(line)),
    }
}

fn too_long(begin: usize) -> Header {
    Header::Wrong(begin, format!("this is no header: it is longer than {MAX_HEADER} bytes"))
}

fn is_of_name(byte: &u8) -> bool {
    byte.is_ascii_alphanumeric() || b"-_ \t".contains(byte)
}

fn no_line(line: &[u8]) -> String {
    format!("`{}` is no line of a header", shortened(line))
}

/// The length that a line of a header says, if it is about that.
fn said(line: &[u8], longest: usize) -> Result<Option<usize>, String> {
    let colon = line.iter().position(|byte| *byte == b':');
    let colon = colon.filter(|colon| line[..*colon].iter().all(is_of_name));
    let Some(colon) = colon else { return Err(no_line(line)) };
    let (name, value) = (line[..colon].trim_ascii(), &line[colon + 1..]);
    match name.eq_ignore_ascii_case(LENGTH) {
        true => number(value.trim_ascii(), longest).map(Some),
        // What is before a header without a line end between makes it no other line.
        false if position(line, LENGTH).is_some() => Err(no_line(line)),
        false => Ok(None),
    }
}

fn number(text: &[u8], longest: usize) -> Result<usize, String> {
    let is_number = !text.is_empty() && text.iter().all(u8::is_ascii_digit);
    if !is_number {
        return Err(format!("`{}` is not the length of a message", shortened(text)));
    }
    let number = std::str::from_utf8(text).ok().and_then(|text| text.parse().ok());
    number.filter(|number| *number <= longest).ok_or_else(|| {
        let length = shortened(text);
        format!("a message of {length} bytes is not read: the longest is {longest}")
    })
}

/// The beginning of what may be long and anything.
fn shortened(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(160)]);
    text.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// Where the first line begins that says a length, if one does: as it must be, to its end.
fn length_line(bytes: &[u8]) -> Option<usize> {
    let mut from = 0;
    loop {
        let at = from + position(&bytes[from..], LENGTH)?;
        let rest = &bytes[at..bytes.len().min(at + MAX_LENGTH_LINE)];
        let end = rest.iter().position(|byte| *byte == b'\n');
        let line = end.map(|end| rest[LENGTH.len()..end].trim_ascii());
        let digits = line.and_then(|line| line.strip_prefix(b":")).map(<[u8]>::trim_ascii);
        if digits.is_some_and(|it| !it.is_empty() && it.iter().all(u8::is_ascii_digit)) {
            return Some(at);
        }
        from = at + LENGTH.len();
    }
}

/// Where at the end of bytes such a line begins that ends behind them.
fn half_line(bytes: &[u8]) -> Option<usize> {
    let is_begun = |at: &usize| {
        let (name, rest) = bytes[*at..].split_at(LENGTH.len().min(bytes.len() - at));
        let is_rest = |byte: &u8| byte.is_ascii_digit() || b": \t\r".contains(byte);
        name.eq_ignore_ascii_case(&LENGTH[..name.len()]) && rest.iter().all(is_rest)
    };
    (bytes.len().saturating_sub(MAX_LENGTH_LINE)..bytes.len()).find(is_begun)
}

/// Where a word first is, in letters of either case.
fn position(bytes: &[u8], word: &[u8]) -> Option<usize> {
    bytes.windows(word.len()).position(|window| window.eq_ignore_ascii_case(word))
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
mod tests;
