//! A contract for each opcode: `tests/ops/<mnemonic>.obvasm` says what is before, after, and back
//! again, and here the machine is held to it. Contracts are asserted, never blessed; the format is
//! explained in `contract`. Knows no opcode by name: the tests are the rows of the table.

mod contract;

use obverse_isa::{Opcode, for_each_op};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ops")
}

fn holds(opcode: Opcode) {
    let row = opcode.info();
    let path = folder().join(row.mnemonic).with_extension_added();
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| {
        panic!(
            "`{}` has no contract: write tests/ops/{}.obvasm with what is before, after and back \
             ({error})",
            row.mnemonic, row.mnemonic
        )
    });
    let contract = contract::parse(&text).unwrap_or_else(|error| panic!("{error}"));
    if let Err(broken) = contract::run::holds(row, &contract) {
        panic!("tests/ops/{}.obvasm: {broken}", row.mnemonic);
    }
}

/// A mnemonic has dots of its own, so that `with_extension` would cut it.
trait WithExtensionAdded {
    fn with_extension_added(self) -> PathBuf;
}

impl WithExtensionAdded for PathBuf {
    fn with_extension_added(mut self) -> PathBuf {
        self.as_mut_os_string().push(".obvasm");
        self
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
    let files: BTreeSet<String> = std::fs::read_dir(folder())
        .expect("tests/ops can be read")
        .map(|entry| entry.expect("tests/ops can be read").file_name().into_string())
        .map(|name| name.expect("names are text"))
        .collect();
    let rows: BTreeSet<String> =
        obverse_isa::OPS.iter().map(|row| format!("{}.obvasm", row.mnemonic)).collect();
    assert_eq!(files, rows, "one file a row, one row a file");
}
