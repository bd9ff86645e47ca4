//! The law `machine_laws::barrier` over random bytes.
#![no_main]
use obverse_testkit::machine_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = machine_laws::barrier(&mut arbitrary::Unstructured::new(bytes));
});
