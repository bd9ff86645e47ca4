//! The bytes of a tape file, or of its parts: read, and opened in the debugger.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _came_in = obverse_testkit::hostile::tape_bytes(bytes);
});
