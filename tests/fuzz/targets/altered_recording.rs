//! A valid recording, altered as the bytes say: made a machine, walked back and forth.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _came_in = obverse_testkit::hostile::altered_recording(bytes);
});
