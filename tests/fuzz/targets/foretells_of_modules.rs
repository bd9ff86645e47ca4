//! The law `preflight_laws::foretells_of_modules` over random bytes.
#![no_main]
use obverse_testkit::preflight_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = preflight_laws::foretells_of_modules(&mut arbitrary::Unstructured::new(bytes));
});
