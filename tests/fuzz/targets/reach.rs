//! The law `reach_laws::reach_of_modules` over random bytes.
#![no_main]
use obverse_testkit::reach_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = reach_laws::reach_of_modules(&mut arbitrary::Unstructured::new(bytes));
});
