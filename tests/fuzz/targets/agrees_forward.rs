//! The law `laws::agrees_forward` over random bytes.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = obverse_testkit::laws::agrees_forward(&mut arbitrary::Unstructured::new(bytes));
});
