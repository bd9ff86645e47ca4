//! A contract for each opcode: `tests/ops/<mnemonic>.obvasm` says what is before, after, and back
//! again, and here the machine is held to it. Contracts are asserted, never blessed; the format is
//! explained in `contract`. Knows no opcode by name: the tests are the rows of the table.

mod contract;

use obverse_isa::{Opcode, for_each_op};
use std::collections::BTreeSet;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/ops");

fn holds(opcode: Opcode) {
    let row = opcode.info();
    let name = format!("{}.obvasm", row.mnemonic);
    let text = std::fs::read_to_string(format!("{FOLDER}/{name}")).unwrap_or_else(|error| {
        panic!("write tests/ops/{name} with what is before, after and back: {error}")
    });
    let held = contract::parse(&text).and_then(|contract| contract::run::holds(row, &contract));
    if let Err(broken) = held {
        panic!("tests/ops/{name}: {broken}");
    }
}

macro_rules! contracts {
    ($(
        $(#[doc = $doc:literal])+
        $code:literal $ident:ident $mnemonic:literal ($($field:ident: $ty:ty),*)
        [$($picture:tt)*] $class:ident $(($payload:tt))? $family:ident;
    )*) => {
        #[allow(non_snake_case, reason = "a test is named as its row")]
        mod row {
            $(#[test]
            fn $ident() {
                super::holds(obverse_isa::Opcode::$ident);
            })*
        }
    };
}

for_each_op!(contracts);

#[test]
fn every_file_is_the_contract_of_a_row() {
    let files: BTreeSet<String> = std::fs::read_dir(FOLDER)
        .expect("tests/ops can be read")
        .map(|entry| entry.expect("tests/ops can be read").file_name().into_string())
        .map(|name| name.expect("names are text"))
        .collect();
    let rows: BTreeSet<String> =
        obverse_isa::OPS.iter().map(|row| format!("{}.obvasm", row.mnemonic)).collect();
    assert_eq!(files, rows, "one file a row, one row a file");
}
