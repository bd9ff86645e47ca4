//! The bytes of a module: what is written reads back, and whatever else is refused with its place.

use crate::support::{arbitrary_module, everything};
use obverse_bytecode::codec::{self, HEADER_BYTES, LIMIT_BYTES, MODULE};
use obverse_bytecode::{
    DecodeErrorKind, Module, Variable, assemble, decode, encode, fingerprint, verify,
};
use obverse_isa::{FINGERPRINT, Type};

fn bytes(module: &Module) -> Vec<u8> {
    encode(module).unwrap_or_else(|error| panic!("{error}"))
}

/// A module of little more than its header.
fn small() -> Vec<u8> {
    let text =
        "obvasm 1\n.function main start\n.local x int\nenter\npush.int 3\nstore.local x\nhalt";
    bytes(&assemble(text).unwrap_or_else(|errors| panic!("{errors:?}")))
}

/// A module's bytes around any payload, with all that the header promises.
fn around(payload: &[u8]) -> Vec<u8> {
    let mut bytes = MODULE.magic.to_vec();
    bytes.extend(MODULE.version.to_le_bytes());
    bytes.extend(FINGERPRINT.to_le_bytes());
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(fingerprint(payload).to_le_bytes());
    bytes.extend(payload);
    bytes
}

/// What is wrong with bytes that are no module.
#[track_caller]
fn refusal(bytes: &[u8]) -> DecodeErrorKind {
    decode(bytes).unwrap_err().kind
}

fn payload_error(payload: &[u8]) -> String {
    match decode(&around(payload)).map_err(|error| error.kind) {
        Err(DecodeErrorKind::Payload { why }) => why,
        other => panic!("{other:?}"),
    }
}

#[test]
fn modules_round_trip() {
    for module in [Module::default(), everything()] {
        let written = bytes(&module);
        assert_eq!(decode(&written).map(|back| bytes(&back)), Ok(written));
    }
    arbtest::arbtest(|u| {
        let written = bytes(&arbitrary_module(u)?);
        assert_eq!(decode(&written).map(|back| bytes(&back)), Ok(written));
        Ok(())
    });
}

#[test]
fn the_header_is_as_documented() {
    let written = small();
    assert_eq!(around(&written[HEADER_BYTES..]), written);
    assert_eq!(&written[..12], b"OBVERSE\0\x05\0\0\0");
}

#[test]
fn each_field_of_the_header_has_its_error() {
    let damaged = |at: usize| {
        let mut bytes = small();
        bytes[at] ^= 0x10;
        refusal(&bytes)
    };
    let payload = small().len() - HEADER_BYTES;
    for at in 0..8 {
        assert_eq!(damaged(at), DecodeErrorKind::Magic);
    }
    for at in 8..12 {
        let found = MODULE.version ^ (0x10 << (8 * (at - 8)));
        assert_eq!(damaged(at), DecodeErrorKind::Version { found });
    }
    for at in 12..20 {
        let found = FINGERPRINT ^ (0x10 << (8 * (at - 12)));
        assert_eq!(damaged(at), DecodeErrorKind::Table { found });
    }
    for at in 20..28 {
        let stated = payload as u64 ^ (0x10 << (8 * (at - 20)));
        let expected = if stated > LIMIT_BYTES as u64 {
            DecodeErrorKind::TooLarge { stated }
        } else {
            DecodeErrorKind::Length { stated, found: payload }
        };
        assert_eq!(damaged(at), expected);
    }
    for at in 28..36 {
        assert_eq!(damaged(at), DecodeErrorKind::Checksum);
    }
}

#[test]
fn every_flip_of_a_byte_is_refused() {
    let sound = small();
    for at in 0..sound.len() {
        for flip in 1..=u8::MAX {
            let mut bytes = sound.clone();
            bytes[at] ^= flip;
            let refusal = refusal(&bytes);
            assert!(at < HEADER_BYTES || refusal == DecodeErrorKind::Checksum, "{at}");
        }
    }
}

#[test]
fn a_module_cut_off_anywhere_is_refused() {
    let sound = small();
    for end in 0..sound.len() {
        let found = end.saturating_sub(HEADER_BYTES);
        let stated = (sound.len() - HEADER_BYTES) as u64;
        let expected = match end {
            0..8 => DecodeErrorKind::Magic,
            8..HEADER_BYTES => DecodeErrorKind::Short { bytes: end, needed: HEADER_BYTES },
            _ => DecodeErrorKind::Length { stated, found },
        };
        assert_eq!(refusal(&sound[..end]), expected);
    }
}

#[test]
fn a_payload_cut_off_anywhere_is_refused_whatever_its_checksum() {
    let sound = bytes(&everything());
    let payload = &sound[HEADER_BYTES..];
    for end in 0..payload.len() {
        payload_error(&payload[..end]);
    }
}

#[test]
fn bytes_after_the_module_are_refused() {
    let mut longer = small();
    longer.push(0);
    let payload = small().len() - HEADER_BYTES;
    let expected = DecodeErrorKind::Length { stated: payload as u64, found: payload + 1 };
    assert_eq!(refusal(&longer), expected);
    let why = payload_error(&longer[HEADER_BYTES..]);
    assert_eq!(why, format!("it ends after {payload} of {} bytes", payload + 1));
}

/// Any eight bytes of a payload may be the length of something: as a length they ask for more than
/// there is memory for, and nothing of it is allocated.
#[test]
fn huge_lengths_are_refused() {
    let sound = bytes(&everything());
    let payload = &sound[HEADER_BYTES..];
    for length in [u64::MAX, 1 << 40] {
        assert!(!payload_error(&length.to_le_bytes()).is_empty());
        for at in 0..payload.len() - 8 {
            let mut hostile = payload.to_vec();
            hostile[at..at + 8].copy_from_slice(&length.to_le_bytes());
            let _ = decode(&around(&hostile));
        }
    }
}

#[test]
fn a_payload_of_anything_is_refused_or_a_module() {
    arbtest::arbtest(|u| {
        let payload: Vec<u8> = u.arbitrary()?;
        if let Ok(module) = decode(&around(&payload)) {
            assert_eq!(bytes(&module), around(&payload));
        }
        Ok(())
    });
}

/// Payloads with a few bytes changed and a valid checksum: refused, or modules of the same bytes.
#[test]
fn damaged_payloads_are_refused_or_modules() {
    let sound = bytes(&everything());
    let payload = &sound[HEADER_BYTES..];
    let mut modules = 0;
    for at in 0..payload.len() {
        for byte in [1, 0xff] {
            let mut damaged = payload.to_vec();
            damaged[at] = byte;
            let written = around(&damaged);
            if let Ok(module) = decode(&written) {
                assert_eq!(bytes(&module), written);
                let _ = verify(module);
                modules += 1;
            }
        }
    }
    assert!(modules > 0);
}

/// The one place where a payload differs from another one.
fn difference(a: &Module, b: &Module) -> usize {
    let (a, b) = (bytes(a), bytes(b));
    let mut places = (HEADER_BYTES..a.len()).filter(|&at| a[at] != b[at]);
    let place = places.next().unwrap();
    assert_eq!((a.len(), places.next()), (b.len(), None));
    place - HEADER_BYTES
}

#[test]
fn types_and_instructions_are_checked() {
    let variable = |of_type| Variable { name: "x".to_owned(), of_type, measures: None };
    let with = |of_type| Module { globals: vec![variable(of_type)], ..Module::default() };
    let mut payload = bytes(&with(Type::Int))[HEADER_BYTES..].to_vec();
    payload[difference(&with(Type::Int), &with(Type::Tool))] = Type::ALL.len() as u8;
    assert!(payload_error(&payload).contains("no type has the code 7"));

    let code = |last: &str| {
        let text = format!("obvasm 1\n.code\nhalt\n{last}");
        assemble(&text).unwrap_or_else(|errors| panic!("{errors:?}"))
    };
    let at = difference(&code("halt"), &code("enter"));
    let sound = bytes(&code("halt"))[HEADER_BYTES..].to_vec();
    for (offset, byte, why) in [
        (0, 0xff, "instruction 1: no opcode has the code 0xff"),
        (0, 0, "instruction 1: no opcode has the code 0x00"),
        (1, 1, "instruction 1: the bytes after the operands are not zero"),
        (7, 1, "instruction 1: the bytes after the operands are not zero"),
    ] {
        let mut payload = sound.clone();
        payload[at + offset] = byte;
        assert!(payload_error(&payload).contains(why), "{}", payload_error(&payload));
    }
    let mut payload = sound;
    payload.remove(at + 7);
    payload[at - 16] -= 1;
    assert!(payload_error(&payload).contains("the code is 15 bytes, which is no multiple of 8"));
}

#[test]
fn names_are_text() {
    let module = Module { cell: Some("ab".to_owned()), ..Module::default() };
    let other = Module { cell: Some("aB".to_owned()), ..Module::default() };
    let mut payload = bytes(&module)[HEADER_BYTES..].to_vec();
    payload[difference(&module, &other)] = 0xff;
    assert!(!payload_error(&payload).is_empty());
}

#[test]
fn a_module_that_is_too_large_is_not_written() {
    let module = Module { cell: Some("x".repeat(LIMIT_BYTES + 1)), ..Module::default() };
    let refusal = encode(&module).map(|bytes| bytes.len()).unwrap_err().kind;
    assert!(matches!(refusal, DecodeErrorKind::TooLarge { .. }));
}

/// Other files of ours have the same header, and are never taken for modules.
#[test]
fn a_file_of_another_format_is_refused() {
    let other = codec::Format { magic: *b"OTHER\0\0\0", name: "thing", ..MODULE };
    let sealed = codec::seal(other, &7u32).unwrap();
    assert_eq!(codec::open::<u32>(other, &sealed), Ok(7));
    assert_eq!(refusal(&sealed), DecodeErrorKind::Magic);
    let error = codec::open::<u32>(other, &small()).unwrap_err();
    assert_eq!(error.to_string(), "byte 0: this is no thing: it does not begin as one does");
    let newer = codec::Format { version: 9, ..other };
    let error = codec::open::<u32>(newer, &sealed).unwrap_err();
    assert_eq!(error.kind, DecodeErrorKind::Version { found: MODULE.version });
    let longer = codec::open::<u16>(other, &sealed).unwrap_err();
    assert!(matches!(longer.kind, DecodeErrorKind::Payload { .. }));
}

#[test]
fn errors_say_where() {
    let text = |bytes: &[u8]| decode(bytes).unwrap_err().to_string();
    assert_eq!(text(b""), "byte 0: this is no module: it does not begin as one does");
    let expected = "byte 10: the module ends here, and its header alone takes 36 bytes";
    assert_eq!(text(&small()[..10]), expected);
    let mut old = small();
    old[8] = 0;
    let expected = "byte 8: the module has format version 0, and this is version 5; compile the \
                    program again";
    assert_eq!(text(&old), expected);
    let mut other = small();
    other[12..20].fill(0);
    assert!(
        text(&other)
            .starts_with("byte 12: the module was made for instruction table 0000000000000000,")
    );
    let mut cut = small();
    cut.pop();
    assert!(text(&cut).starts_with("byte 20: the header says that "));
    cut[27] = 0xff;
    assert!(text(&cut).starts_with("byte 20: the module asks for "));
    let mut damaged = small();
    damaged[40] ^= 1;
    assert_eq!(text(&damaged), "byte 28: the checksum does not fit the bytes; the file is damaged");
    assert!(text(&around(&[])).starts_with("byte 36: the payload is no module: "));
}
