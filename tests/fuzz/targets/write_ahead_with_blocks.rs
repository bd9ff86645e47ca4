//! The law `machine_laws::write_ahead_with_blocks` over random bytes.
#![no_main]
use obverse_testkit::machine_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = machine_laws::write_ahead_with_blocks(&mut arbitrary::Unstructured::new(bytes));
});
