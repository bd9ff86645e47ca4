//! The bytes of a recording: read, made a machine, walked back and forth.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _came_in = obverse_testkit::hostile::tape_bytes(bytes);
});
