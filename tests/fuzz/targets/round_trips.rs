//! The law `machine_laws::round_trips` over random bytes.
#![no_main]
use obverse_testkit::machine_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = machine_laws::round_trips(&mut arbitrary::Unstructured::new(bytes));
});
