//! The source of a program: parsed, compiled, verified.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _came_in = obverse_testkit::hostile::source(bytes);
});
