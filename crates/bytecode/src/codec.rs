//! The bytes of a module, or of another file of ours: a header with a checksum over the payload's
//! bytes, and the payload.
//!
//! ```text
//! offset  size  what
//!      0     8  magic: "OBVERSE\0" for a module
//!      8     4  format version, little endian
//!     12     8  fingerprint of the instruction table
//!     20     8  length of the payload
//!     28     8  xxh3-64 of the payload's bytes
//!     36        payload, by bincode
//! ```
//!
//! The one place that knows bincode, whose line is no longer maintained, so that it can be
//! replaced. Whatever the bytes, decoding asks for a few times [`LIMIT_BYTES`] at the most, since
//! what is read may be larger in memory than in the file.

use crate::module::Module;
use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use obverse_isa::FINGERPRINT;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt;
use xxhash_rust::xxh3::xxh3_64;

/// What kind of file it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// The first bytes of such a file.
    pub magic: [u8; 8],
    /// The version of the format.
    pub version: u32,
    /// What it is, in messages.
    pub name: &'static str,
    /// What to do with one of another version.
    pub remedy: &'static str,
}

/// A module.
pub const MODULE: Format = Format {
    magic: *b"OBVERSE\0",
    version: 5,
    name: "module",
    remedy: "compile the program again",
};
/// The largest payload, in bytes.
pub const LIMIT_BYTES: usize = 64 << 20;
/// The length of the header.
pub const HEADER_BYTES: usize = 36;

/// Bytes that are no file of the format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecodeError {
    /// The format.
    pub format: Format,
    /// Where in the file the header stands, in bytes: several may follow each other in one.
    pub at: usize,
    /// What is wrong.
    pub kind: DecodeErrorKind,
}

/// What is wrong with bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DecodeErrorKind {
    /// They end too early.
    Short {
        /// How many there are.
        bytes: usize,
        /// How many there should be at the least.
        needed: usize,
    },
    /// They do not begin as a module does.
    Magic,
    /// They are of another version of the format.
    Version {
        /// The version they are of.
        found: u32,
    },
    /// They were made under another instruction table.
    Table {
        /// The fingerprint of that table.
        found: u64,
    },
    /// The payload is not as long as the header says.
    Length {
        /// What the header says.
        stated: u64,
        /// How long it is.
        found: usize,
    },
    /// The payload is larger than any module may be.
    TooLarge {
        /// What the header says.
        stated: u64,
    },
    /// The payload's bytes are not those that were written.
    Checksum,
    /// The payload is no module.
    Payload {
        /// What is wrong with it.
        why: String,
    },
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Format { name, version, remedy, .. } = self.format;
        let at = |byte: usize| self.at + byte;
        match &self.kind {
            DecodeErrorKind::Short { bytes, needed } => write!(
                f,
                "byte {}: the {name} ends here, and its header alone takes {needed} bytes",
                at(*bytes)
            ),
            DecodeErrorKind::Magic => {
                write!(f, "byte {}: this is no {name}: it does not begin as one does", at(0))
            }
            DecodeErrorKind::Version { found } => write!(
                f,
                "byte {}: the {name} has format version {found}, and this is version {version}; \
                 {remedy}",
                at(8)
            ),
            DecodeErrorKind::Table { found } => write!(
                f,
                "byte {}: the {name} was made for instruction table {found:016x}, and this is \
                 {FINGERPRINT:016x}; {remedy}",
                at(12)
            ),
            DecodeErrorKind::Length { stated, found } => write!(
                f,
                "byte {}: the header says that {stated} bytes follow, and {found} do; the file was \
                 cut off or added to",
                at(20)
            ),
            DecodeErrorKind::TooLarge { stated } => write!(
                f,
                "byte {}: the {name} asks for {stated} bytes, and none has more than {LIMIT_BYTES}",
                at(20)
            ),
            DecodeErrorKind::Checksum => {
                let at = at(28);
                write!(f, "byte {at}: the checksum does not fit the bytes; the file is damaged")
            }
            DecodeErrorKind::Payload { why } => {
                write!(f, "byte {}: the payload is no {name}: {why}", at(HEADER_BYTES))
            }
        }
    }
}

impl DecodeError {
    /// Whether what is there, of so many bytes, may be the beginning of what was meant.
    #[must_use]
    pub fn is_cut_off(&self, bytes: usize) -> bool {
        match self.kind {
            DecodeErrorKind::Length { stated, found } => stated > found as u64,
            _ => bytes < HEADER_BYTES,
        }
    }
}

impl std::error::Error for DecodeError {}

fn configuration() -> Configuration<LittleEndian, Fixint, Limit<LIMIT_BYTES>> {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<LIMIT_BYTES>()
}

/// The bytes of a module.
///
/// # Errors
/// If it is larger than [`LIMIT_BYTES`].
pub fn encode(module: &Module) -> Result<Vec<u8>, DecodeError> {
    seal(MODULE, module)
}

/// The module of these bytes. It is not yet verified.
///
/// # Errors
/// If they are none; nothing of them is kept.
pub fn decode(bytes: &[u8]) -> Result<Module, DecodeError> {
    open(MODULE, bytes)
}

/// What tells one module from another: the hash of its bytes.
#[must_use]
pub fn fingerprint(bytes: &[u8]) -> u64 {
    xxh3_64(bytes)
}

/// The bytes of a file of a format.
///
/// # Errors
/// If it is larger than [`LIMIT_BYTES`].
pub fn seal<T: Serialize>(format: Format, content: &T) -> Result<Vec<u8>, DecodeError> {
    let error = |kind| DecodeError { format, at: 0, kind };
    let payload = bincode::serde::encode_to_vec(content, configuration())
        .map_err(|why| error(DecodeErrorKind::Payload { why: why.to_string() }))?;
    if payload.len() > LIMIT_BYTES {
        return Err(error(DecodeErrorKind::TooLarge { stated: payload.len() as u64 }));
    }
    let mut bytes = Vec::with_capacity(HEADER_BYTES + payload.len());
    bytes.extend_from_slice(&format.magic);
    bytes.extend_from_slice(&format.version.to_le_bytes());
    bytes.extend_from_slice(&FINGERPRINT.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&xxh3_64(&payload).to_le_bytes());
    bytes.extend_from_slice(&payload);
    Ok(bytes)
}

/// The content of a file of a format.
///
/// # Errors
/// If the bytes are none; nothing of them is kept.
pub fn open<T: DeserializeOwned>(format: Format, bytes: &[u8]) -> Result<T, DecodeError> {
    let (content, end) = open_at(format, bytes, 0)?;
    if end != bytes.len() {
        let (stated, found) = ((end - HEADER_BYTES) as u64, bytes.len() - HEADER_BYTES);
        let kind = DecodeErrorKind::Length { stated, found };
        return Err(DecodeError { format, at: 0, kind });
    }
    Ok(content)
}

/// The content of one of several that follow each other in a file, and where it ends.
///
/// # Errors
/// If the bytes from there on do not begin with one; nothing of them is kept.
pub fn open_at<T: DeserializeOwned>(
    format: Format,
    bytes: &[u8],
    at: usize,
) -> Result<(T, usize), DecodeError> {
    let error = |kind| DecodeError { format, at, kind };
    let payload = payload(format, bytes.get(at..).unwrap_or_default()).map_err(error)?;
    let (content, read) = bincode::serde::decode_from_slice::<T, _>(payload, configuration())
        .map_err(|why| error(DecodeErrorKind::Payload { why: why.to_string() }))?;
    if read != payload.len() {
        let why = format!("it ends after {read} of {} bytes", payload.len());
        return Err(error(DecodeErrorKind::Payload { why }));
    }
    Ok((content, at + HEADER_BYTES + payload.len()))
}

/// The payload that bytes begin with.
fn payload(format: Format, bytes: &[u8]) -> Result<&[u8], DecodeErrorKind> {
    if !bytes.starts_with(&format.magic) {
        return Err(DecodeErrorKind::Magic);
    }
    let (header, payload) = bytes
        .split_at_checked(HEADER_BYTES)
        .ok_or(DecodeErrorKind::Short { bytes: bytes.len(), needed: HEADER_BYTES })?;
    let number = |at: usize, width: usize| {
        let mut wide = [0; 8];
        wide[..width].copy_from_slice(&header[at..at + width]);
        u64::from_le_bytes(wide)
    };
    let version = number(8, 4) as u32;
    if version != format.version {
        return Err(DecodeErrorKind::Version { found: version });
    }
    let table = number(12, 8);
    if table != FINGERPRINT {
        return Err(DecodeErrorKind::Table { found: table });
    }
    let stated = number(20, 8);
    if stated > LIMIT_BYTES as u64 {
        return Err(DecodeErrorKind::TooLarge { stated });
    }
    let Some(payload) = payload.get(..stated as usize) else {
        return Err(DecodeErrorKind::Length { stated, found: payload.len() });
    };
    if xxh3_64(payload) != number(28, 8) {
        return Err(DecodeErrorKind::Checksum);
    }
    Ok(payload)
}
