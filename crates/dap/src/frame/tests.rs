//! What is between messages, and what is not one, is told apart, and costs no message but itself.

use super::*;

const LONGEST: usize = 1 << 20;

/// Everything that is found among bytes, which come so many at once.
fn found(bytes: &[u8], at_once: usize) -> Vec<Frame> {
    struct Slow<'b>(&'b [u8], usize);
    impl Read for Slow<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let count = self.1.min(into.len()).min(self.0.len());
            let (now, later) = self.0.split_at(count);
            into[..count].copy_from_slice(now);
            self.0 = later;
            Ok(count)
        }
    }
    let mut reader = Reader::new(Slow(bytes, at_once), LONGEST);
    let mut frames = Vec::new();
    loop {
        let frame = reader.read();
        let is_end = matches!(frame, Frame::End(_));
        frames.push(frame);
        if is_end {
            return frames;
        }
    }
}

/// The same, however the bytes come; what is said shows only what has come by then.
fn all(bytes: &[u8]) -> Vec<Frame> {
    let bare = |frame: &Frame| match frame {
        Frame::Wrong(_) => Frame::Wrong(String::new()),
        frame => frame.clone(),
    };
    let at_once = found(bytes, usize::MAX);
    for count in [1, 7] {
        let slowly: Vec<Frame> = found(bytes, count).iter().map(bare).collect();
        assert_eq!(slowly, at_once.iter().map(bare).collect::<Vec<_>>(), "{count} at once");
    }
    at_once
}

/// A message, framed.
fn framed(message: &str) -> String {
    format!("Content-Length: {}\r\n\r\n{message}", message.len())
}

fn whys(frames: &[Frame]) -> Vec<&str> {
    let mut whys = Vec::new();
    for frame in frames {
        if let Frame::Wrong(why) = frame {
            whys.push(why.as_str());
        }
    }
    whys
}

fn messages(frames: &[Frame]) -> Vec<&[u8]> {
    let mut messages = Vec::new();
    for frame in frames {
        if let Frame::Message(bytes) = frame {
            messages.push(bytes.as_slice());
        }
    }
    messages
}

#[test]
fn what_is_written_is_read() {
    let mut bytes = Vec::new();
    for message in [&b"{}"[..], b"", "ü\r\n\r\n".as_bytes()] {
        write(&mut bytes, message).expect("memory can be written");
    }
    bytes.extend(b"\r\n\ncontent-length:2\nContent-Type: x\n\n[]");
    let expected = [
        Frame::Message(b"{}".to_vec()),
        Frame::Message(Vec::new()),
        Frame::Message("ü\r\n\r\n".as_bytes().to_vec()),
        Frame::Message(b"[]".to_vec()),
        Frame::End(None),
    ];
    assert_eq!(all(&bytes), expected);
}

/// Each of these is said once, and the messages behind it are found, the next one too.
#[test]
fn behind_what_is_no_header_the_next_message_is_found() {
    let wrong = [
        ("hello\r\n\r\n", "`hello` is no line of a header"),
        ("\u{1}\u{2}{\"seq\":1}\r\n", "`{\"seq\":1}` is no line"),
        ("garbage", "garbageContent-Length"),
        ("{\"seq\": 3, \"type\": \"request\"}", "`{\"seq\": 3"),
        ("Content-Length: abc\r\n\r\n{\"command\":\"x\"}", "`abc` is not the length"),
        ("Content-Length: -1\r\n\r\n", "`-1` is not the length"),
        ("Content-Length:\r\n\r\n", "`` is not the length"),
        ("Content-Length: 99999999999\r\n\r\n{}", "a message of 99999999999 bytes is not read"),
        ("Content-Length: 18446744073709551617\r\n\r\n", "18446744073709551617 bytes"),
        ("Content-Length 4\r\n\r\n", "`Content-Length 4` is no line"),
        ("Content-Type: x\r\n\r\n", "must say `Content-Length`"),
        ("Content-Length: 50\r\n\r\n{}", "a message of 50 bytes ends after 2"),
        ("Content-Length: 9\r\n\r\n{}", "a message of 9 bytes ends after 2"),
        ("Content-Length: 24\r\n\r\n{}", "a message of 24 bytes ends after 2"),
        ("Content-Length: 5", "`5Content-Length: 3` is not the length"),
        ("Content-Length: 2\r\nhello\r\n\r\n", "`hello` is no line"),
    ];
    for (wrong, why) in wrong {
        let frames = all(format!("{wrong}{}{}", framed("[1]"), framed("[22]")).as_bytes());
        assert!(whys(&frames)[0].contains(why), "{wrong}: {frames:?}");
        assert_eq!(whys(&frames).len(), 1, "{wrong}: {frames:?}");
        assert_eq!(messages(&frames), [&b"[1]"[..], b"[22]"], "{wrong}");
        assert_eq!(frames.last(), Some(&Frame::End(None)), "{wrong}");
    }
}

/// What no more bytes can make right is said before they come.
#[test]
fn what_is_wrong_is_said_before_more_comes() {
    struct Once(&'static [u8]);
    impl Read for Once {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            assert!(!self.0.is_empty(), "more is waited for");
            self.0.read(into)
        }
    }
    for wrong in [&b"Content-Length: abc\r\n"[..], b"Content-Length: 99999999999\r\n", b"{\"seq"] {
        let frame = Reader::new(Once(wrong), LONGEST).read();
        assert!(matches!(frame, Frame::Wrong(_)), "{frame:?}");
    }
}

#[test]
fn what_is_too_long_is_passed_over_in_little_memory() {
    let mut bytes = format!("Content-Length: {}\r\n\r\n", LONGEST + 1).into_bytes();
    bytes.extend(std::iter::repeat_n(b' ', LONGEST + 1));
    bytes.extend(framed("[]").as_bytes());
    let mut reader = Reader::new(&bytes[..], LONGEST);
    assert!(matches!(reader.read(), Frame::Wrong(_)));
    assert_eq!(reader.read(), Frame::Message(b"[]".to_vec()));
    assert!(reader.bytes.capacity() < 8 * PIECE, "{}", reader.bytes.capacity());
    let line = "x".repeat(MAX_HEADER + 1);
    assert!(matches!(all(line.as_bytes())[..], [Frame::Wrong(_), Frame::End(None)]));
    let many = "a: b\r\n".repeat(MAX_HEADER);
    assert!(matches!(all(many.as_bytes())[..], [Frame::Wrong(_), Frame::End(None)]));
}

#[test]
fn half_a_message_is_said_to_be_one() {
    for half in ["Content-Le", "Content-Length: 3\r\n", "Content-Length: 3\r\n\r\n{}"] {
        assert!(matches!(all(half.as_bytes())[..], [Frame::End(Some(_))]), "{half}");
    }
}

/// Whatever comes before, put together from what headers are made of, no message behind it is lost.
#[test]
fn whatever_comes_before_no_message_behind_it_is_lost() {
    const PARTS: [&str; 20] = [
        "Content-Length: ",
        "content-length:",
        "Content-Le",
        "Content-Type: x\r\n",
        ":",
        "\r\n",
        "\n",
        "\r",
        "0",
        "1",
        "7",
        "33",
        "99999999999",
        "{}",
        "{\"seq\":",
        "é",
        " ",
        "abc",
        "-",
        "\u{0}",
    ];
    let mut state: u64 = 1;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    for round in 0..20_000 {
        let count = random(12);
        let before: String = (0..count).map(|_| PARTS[random(PARTS.len())]).collect();
        let bytes = format!("{before}{}{}", framed("{\"a\":1}"), framed("[\"b\"]"));
        let frames = found(bytes.as_bytes(), 1 + random(80));
        let messages = messages(&frames);
        let is_last = messages.ends_with(&[b"{\"a\":1}", b"[\"b\"]"]);
        assert!(is_last, "round {round}: {before:?}: {frames:?}");
    }
}
