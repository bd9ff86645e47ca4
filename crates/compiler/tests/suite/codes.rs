//! Every diagnostic of the compiler: its example has it and no other, and the corrected one none.

use crate::common::{findings, module};
use obverse_compiler::{NoInverse, invert};
use obverse_syntax::codes::Code;

fn is_of_inversion(code: Code) -> bool {
    code.as_str().starts_with("E07")
}

fn codes_of_the_compiler() -> impl Iterator<Item = Code> {
    let is_of_compiler = |code: &Code| !code.as_str().starts_with("E00") && !is_of_inversion(*code);
    Code::ALL.iter().copied().filter(is_of_compiler)
}

#[test]
fn the_wrong_example_has_its_code_and_no_other() {
    for code in codes_of_the_compiler().filter(|code| !code.page().wrong.is_empty()) {
        let found = findings(code.page().wrong);
        assert_eq!(found.len(), 1, "{code}: {found:#?}");
        assert!(found[0].starts_with(code.as_str()), "{code}: {found:#?}");
    }
}

#[test]
fn the_right_example_compiles_without_a_word() {
    for code in codes_of_the_compiler().filter(|code| !code.page().right.is_empty()) {
        assert_eq!(findings(code.page().right), Vec::<String>::new(), "{code}");
        module(code.page().right);
    }
}

#[test]
fn the_examples_of_inversion_are_inverted_or_refused() {
    for code in Code::ALL.iter().copied().filter(|code| is_of_inversion(*code)) {
        match invert("example.obv", code.page().wrong, "main") {
            Err(NoInverse::Diagnosed(found)) => {
                let codes: Vec<Code> = found.iter().map(|one| one.code).collect();
                assert_eq!(codes, [code]);
            }
            other => panic!("{code}: {other:?}"),
        }
        assert!(invert("example.obv", code.page().right, "main").is_ok(), "{code}");
    }
}
