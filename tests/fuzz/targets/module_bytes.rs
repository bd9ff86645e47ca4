//! The bytes of a module: decoded, verified, run, taken back.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _came_in = obverse_testkit::hostile::module_bytes(bytes);
});
