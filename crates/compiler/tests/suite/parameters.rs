//! Ranges and defaults of parameters, and named arguments.

use crate::common::{code_of, module};
use crate::diagnostics::check;
use obverse_compiler::{Defaults, Loader, compile, compile_with};

const LIFT: &str = "action lift(height: length in 5 mm to 60 mm = 20 mm, times: int = 1) {\n\
                    repeat times times { move height up } }\n";

#[test]
fn arguments_go_to_their_parameters() {
    let calls = |call: &str| code_of(&format!("{LIFT}sequence main {{ {call} }}"), "main");
    let positional = calls("call lift(12 mm, 3)");
    assert_eq!(calls("call lift(height: 12 mm, times: 3)"), positional);
    assert_eq!(calls("call lift(times: 3, height: 12 mm)"), positional);
    assert_eq!(calls("call lift(12 mm, times: 3)"), positional);
    assert_eq!(calls("call lift"), calls("call lift(20 mm, 1)"));
    assert_eq!(calls("call lift(times: 2)"), calls("call lift(20 mm, 2)"));
}

#[test]
fn what_is_computed_is_looked_at_when_the_action_begins() {
    let source = format!("{LIFT}sequence main {{ call lift }}");
    let text = code_of(&source, "lift");
    assert!(text.contains("require"), "{text}");
    let reasons = module(&source).reasons;
    assert_eq!(reasons, ["lift requires height in 5 mm to 60 mm"]);
}

#[test]
fn mistakes_of_declarations() {
    check(
        "action a(x: length in 5 mm to 60 mm = 61 mm, y: int in 9 to 3, z: bool in 1 to 2,\n\
         u: length = 3 s, v: force in 1 N to w = 2 N, w: int in 1 to 2 = 2) {\n\
         if z { wait 1 s } repeat y + w times { move x up move u up } wait v / 1 N * 1 s }\n\
         sequence main { call a(z: true, y: 4) }",
        &[
            r#"E0212 1:39 "61 mm""#,
            r#"E0210 1:56 "9 to 3""#,
            r#"E0201 1:75 "1 to 2""#,
            r#"E0202 2:13 "3 s""#,
            r#"E0101 2:37 "w""#,
        ],
    );
}

#[test]
fn mistakes_of_calls() {
    let source = format!(
        "{LIFT}sequence main {{\n call lift(61 mm)\n call lift(hight: 6 mm)\n \
         call lift(6 mm, height: 7 mm)\n call lift(height: 6 mm, 2)\n call lift(6 mm, 1, 2)\n}}"
    );
    check(
        &source,
        &[
            r#"E0212 4:12 "61 mm""#,
            r#"E0213 5:12 "hight""#,
            r#"E0213 6:18 "height""#,
            r#"E0213 7:26 "2""#,
            r#"E0208 8:2 "call lift(6 mm, 1, 2)""#,
        ],
    );
}

#[test]
fn a_unit_before_a_default_is_one() {
    let source = "action a(x: length in 5 mm to 60 mm = 20 mm) { move x up }";
    let compiled = compile("a.obv", &format!("{source} sequence main {{ call a }}"));
    assert_eq!(compiled.diagnostics, []);
    let parameter = &compiled.actions[0].parameters[0];
    assert_eq!((parameter.range, parameter.default), (Some([5.0, 60.0]), Some(20.0)));
    assert_eq!((parameter.unit, parameter.is_left_to_default), ("mm", true));
}

/// A loader of nothing.
struct Nothing;

impl Loader for Nothing {
    fn name(&mut self, _: &str) -> Result<String, String> {
        Err("nothing".to_owned())
    }

    fn read(&mut self, _: &str) -> Result<String, String> {
        Err("nothing".to_owned())
    }
}

#[test]
fn other_defaults_are_those_of_a_program_written_so() {
    let source = format!("{LIFT}sequence main {{ call lift }}");
    let key = |name: &str| ("lift".to_owned(), name.to_owned());
    let defaults = Defaults::from([(key("height"), 30.0), (key("times"), 4.0), (key("no"), 1.0)]);
    let other = compile_with("test.obv", &source, &mut Nothing, &defaults);
    let written = source.replace("= 20 mm", "= 30 mm").replace("int = 1", "int = 4");
    let (other, written) = (other.module.expect("a module"), module(&written));
    assert_eq!((other.code, other.constants), (written.code, written.constants));
}
