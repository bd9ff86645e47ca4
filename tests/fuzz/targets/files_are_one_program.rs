//! The law `files::files_are_one_program` over random bytes.
#![no_main]
use obverse_testkit::files;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _held = files::files_are_one_program(&mut arbitrary::Unstructured::new(bytes));
});
