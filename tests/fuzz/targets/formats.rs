//! The law `format_laws::formats` over random bytes.
#![no_main]
use obverse_testkit::format_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = format_laws::formats(&mut arbitrary::Unstructured::new(bytes));
});
