//! The law `invert_laws::inverse_goes_back` over random bytes.
#![no_main]
use obverse_testkit::invert_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = invert_laws::inverse_goes_back(&mut arbitrary::Unstructured::new(bytes));
});
