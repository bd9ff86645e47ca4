//! The law `laws::compiles` over random bytes.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = obverse_testkit::laws::compiles(&mut arbitrary::Unstructured::new(bytes));
});
