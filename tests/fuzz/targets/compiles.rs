//! The law `laws::compiles` over random bytes.
#![no_main]
use obverse_testkit::laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = laws::compiles(&mut arbitrary::Unstructured::new(bytes));
});
