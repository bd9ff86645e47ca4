//! Sequences that call themselves without end: where that is said, and of which it is not.

use crate::diagnostics::check;

#[test]
fn a_sequence_that_always_calls_itself_is_warned_of() {
    check(
        r#"
error jam { then stop }
sequence plain { wait 1 s call plain }
sequence within { speed slow { irreversible "glue" { call within } } }
sequence branch { if holding { call branch } call once }
sequence leaves { if holding { return } call leaves }
sequence throws { if holding { throw jam } call throws }
sequence given_up { call throws call given_up }
sequence counted { repeat 3 times { call counted } }
sequence once { wait 1 s }
sequence main {
  call plain call within call branch call leaves call throws call given_up call counted
}
"#,
        &[r#"W0005 2:27 "call plain""#, r#"W0005 3:54 "call within""#],
    );
}

#[test]
fn a_circle_of_calls_is_warned_of_where_it_closes() {
    check(
        r#"
sequence a { call b }
sequence b { wait 1 s call c call aside }
sequence c { call a }
sequence d { if holding { call e } call once }
sequence e { call d }
sequence once { wait 1 s }
sequence aside { call c }
sequence main { call a call d }
"#,
        &[r#"W0005 3:14 "call a""#],
    );
    let source = "sequence a { call b }\nsequence b { call a }\nsequence main { call b }";
    let found = &obverse_compiler::compile("test.obv", source).diagnostics[0];
    assert_eq!(found.message, "`a` calls itself, by way of `b`, whatever happens, without end");
    let labels: Vec<&str> = found.labels.iter().map(|label| label.text.as_str()).collect();
    assert_eq!(labels, ["this", "which calls `b`"]);
}

#[test]
fn a_row_of_calls_may_be_long() {
    let mut source = String::new();
    for index in 0..20_000 {
        source += &format!("sequence s{index} {{ call s{} }}\n", index + 1);
    }
    source += "sequence s20000 { call s0 }\nsequence main { call s0 }";
    let found = obverse_compiler::compile("test.obv", &source).diagnostics;
    assert_eq!((found.len(), found[0].code.as_str()), (1, "W0005"));
}
