//! The law `invert_laws::inverts_twice` over random bytes.
#![no_main]
use obverse_testkit::invert_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = invert_laws::inverts_twice(&mut arbitrary::Unstructured::new(bytes));
});
