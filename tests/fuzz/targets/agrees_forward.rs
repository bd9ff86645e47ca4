//! The law `laws::agrees_forward` over random bytes.
#![no_main]
use obverse_testkit::laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = laws::agrees_forward(&mut arbitrary::Unstructured::new(bytes));
});
