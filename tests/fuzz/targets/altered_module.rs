//! A valid module, altered as the bytes say: verified, run, taken back.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _came_in = obverse_testkit::hostile::altered_module(bytes);
});
