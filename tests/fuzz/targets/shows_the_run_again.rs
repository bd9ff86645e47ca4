//! The law `tape_laws::shows_the_run_again` over random bytes.
#![no_main]
use obverse_testkit::tape_laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = tape_laws::shows_the_run_again(&mut arbitrary::Unstructured::new(bytes));
});
