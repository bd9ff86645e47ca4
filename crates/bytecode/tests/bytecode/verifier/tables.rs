//! Rules 1, 2 and 9: tables, functions, source map.

use super::{accepted, module, refused, refuses_changed, start};
use obverse_bytecode::verify::Rule;
use obverse_bytecode::{Constant, ErrorDeclaration, Function, Item, Module, SourceFile, Variable};
use obverse_isa::Type;

/// Gives a table of a module so many entries.
type Fill<'a> = dyn Fn(&mut Module, usize) + 'a;

#[test]
fn rule_1_tables_fit_their_index() {
    const MOST: usize = u16::MAX as usize;
    let name = String::new;
    let variable = || Variable { name: name(), of_type: Type::Int, measures: None };
    let item = || Item { name: name(), keyframes: Vec::new() };
    let file = || SourceFile { name: name(), text: String::new() };
    let error = |module: &Module| -> ErrorDeclaration { module.errors[0].clone() };
    let fill: [(&str, &Fill); 10] = [
        ("constants", &|module, size| module.constants.resize(size, Constant::Int(0))),
        ("joint configurations", &|module, size| module.joints.resize(size, (name(), [0.0; 6]))),
        ("items", &|module, size| module.items.resize(size, item())),
        ("keyframes", &|module, size| module.keyframes.resize(size, name())),
        ("tools", &|module, size| module.tools.resize(size, name())),
        ("errors", &|module, size| module.errors.resize(size, error(module))),
        ("checkpoints", &|module, size| module.checkpoints.resize(size, name())),
        ("reasons", &|module, size| module.reasons.resize(size, name())),
        ("variables", &|module, size| module.globals.resize(size, variable())),
        ("source files", &|module, size| module.sources.resize(size, file())),
    ];
    for (table, fill) in fill {
        let why = format!("there are 65536 {table}, and no more than 65535 can be");
        refuses_changed(Rule::Tables, &why, |module| fill(module, MOST + 1));
        let mut module = start("");
        fill(&mut module, MOST);
        accepted(module);
    }
}

#[test]
fn rule_1_functions_fit_their_index() {
    let many = |count: usize| {
        let mut module = start("");
        let plain = module.functions[2].clone();
        let code = module.code[plain.first as usize..plain.end as usize].to_vec();
        while module.functions.len() < count {
            let first = module.code.len() as u32;
            let end = first + code.len() as u32;
            module.functions.push(Function { first, end, ..plain.clone() });
            module.code.extend(&code);
        }
        module
    };
    accepted(many(65535));
    refused(many(65536), Rule::Tables, None, "there are 65536 functions");
}

#[test]
fn rule_1_numbers_are_finite_and_keyframes_have_names() {
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for at in 0..6 {
            let why = "joint configuration `home` is not finite";
            refuses_changed(Rule::Tables, why, |module| module.joints[0].1[at] = wrong);
        }
        for at in 0..3 {
            let why = "a keyframe of item `peg` is not finite";
            refuses_changed(Rule::Tables, why, |module| {
                module.items[0].keyframes[0].position_m[at] = wrong;
            });
            refuses_changed(Rule::Tables, why, |module| {
                module.items[0].keyframes[0].rotation_rad[at] = wrong;
            });
        }
    }
    let why = "item `peg` has a keyframe without a name";
    refuses_changed(Rule::Tables, why, |module| module.items[0].keyframes[0].name = 1);
    let why = "item `peg` has two keyframes of one name";
    refuses_changed(Rule::Tables, why, |module| {
        let again = module.items[0].keyframes[0];
        module.items[0].keyframes.push(again);
    });
}

#[test]
fn rule_1_errors_name_what_is_there() {
    let with = |clauses: &str| format!(".error e fatal\n{clauses}\n");
    let build = |clauses: &str| start(&format!("{}.cell c", with(clauses)));
    let using = "error `e` names a function that is not there";
    refused(build(".recover using #3"), Rule::Tables, None, using);
    refused(build(".otherwise using #3"), Rule::Tables, None, using);
    accepted(build(".recover using #2\n.otherwise using #2"));
    let senseless = "the reversal of error `e` makes no sense";
    for clause in [
        "checkpoint #1",
        "actions 1 perturbed random -0.001",
        "actions 1 perturbed random 0x7ff0000000000000",
        "actions 1 perturbed random 0x7ff8000000000000",
    ] {
        let clause = format!(".recover reversing fixed {clause}");
        refused(build(&clause), Rule::Tables, None, senseless);
    }
    accepted(build(".recover reversing learned sequence perturbed random 0"));
    accepted(build(".recover reversing fixed checkpoint #0"));
}

#[test]
fn rule_1_a_fault_raises_one_error_within_bounds() {
    let build = |clauses: &str| start(&format!(".error e fatal\n{clauses}"));
    let twice = "error `e` has a fault twice, or another error has it";
    for faults in ["collision collision", "missing collision"] {
        refused(build(&format!(".on {faults}")), Rule::Tables, None, twice);
    }
    let of_both = ".on collision missing\n.error f fatal\n.on stopped_short collision";
    refused(build(of_both), Rule::Tables, None, "error `f` has a fault twice");
    let senseless = "the bounds of error `e` make no sense";
    for bounds in ["attempts 0", "time 0", "distance -1", "time 0x7ff8000000000000"] {
        refused(build(&format!(".bounds {bounds}")), Rule::Tables, None, senseless);
    }
    accepted(build(".on collision missing\n.bounds attempts 1 time 0.5 distance 2"));
    let senseless = "what is watched for error `e` makes no sense";
    for watched in ["force 0", "force -1", "force 0x7ff8000000000000"] {
        refused(build(&format!(".watch {watched}")), Rule::Tables, None, senseless);
    }
    refused(build(&".watch input 1 low\n".repeat(65)), Rule::Tables, None, senseless);
    accepted(build(&".watch input 1 low\n.watch force 0.5\n".repeat(32)));
}

#[test]
fn rule_2_what_runs_at_the_end_is_one_function_without_parameters() {
    let text = |end: &str| {
        format!("obvasm 1\n.function f start\nenter\nhalt\n.function g {end}\nenter\nreturn")
    };
    let why = "function `g`: what runs at the end is one function of that kind, without parameters";
    let wrong = ["cleanup", "sequence\n.cleanup g", "cleanup\n.cleanup g\n.parameter p int"];
    for end in wrong {
        refused(module(&text(end)), Rule::Functions, None, why);
    }
    let gone = module(&text("sequence\n.cleanup #9"));
    refused(gone, Rule::Functions, None, "what runs at the end is a function that is not there");
    accepted(module(&text("cleanup\n.cleanup g")));
}

#[test]
fn rule_1_variables_begin_as_something() {
    for of in ["joints", "item"] {
        let why = format!("variable `v` is of type {of}, and the module has none");
        let global = format!("obvasm 1\n.global v {of}\n.function f start\nenter\nhalt");
        let local = format!("obvasm 1\n.function f start\n.local v {of}\nenter\nhalt");
        for text in [global, local] {
            refused(module(&text), Rule::Tables, None, &why);
            accepted(module(&format!("{text}\n.joints a 0 0 0 0 0 0\n.item b")));
        }
    }
}

#[test]
fn rule_2_the_first_function_is_the_start() {
    let why = "the start is the first function, without parameters";
    let text = |kind: &str| format!("obvasm 1\n.function f {kind}\nenter\nreturn");
    for kind in ["sequence", "action", "io", "advanced_move", "replacement"] {
        refused(module(&text(kind)), Rule::Functions, None, why);
    }
    let two = "obvasm 1\n.function f start\nenter\nhalt\n.function g start\nenter\nhalt";
    refused(module(two), Rule::Functions, None, why);
    let parameters = "obvasm 1\n.function f start\n.parameter p int\nenter\nhalt";
    refused(module(parameters), Rule::Functions, None, why);
}

#[test]
fn rule_2_functions_cover_the_code() {
    let text = |first: &str, second: &str| {
        let functions = format!(".function f start\n{first}\n.function g io\n{second}\n");
        module(&format!("obvasm 1\n{functions}.code\nenter\nhalt\nenter\nreturn"))
    };
    accepted(text(".range 0 2", ".range 2 4"));
    let gap = "does not begin where the one before it ends";
    refused(text(".range 1 2", ".range 2 4"), Rule::Functions, None, gap);
    refused(text(".range 0 2", ".range 1 4"), Rule::Functions, None, gap);
    refused(text(".range 0 2", ".range 3 4"), Rule::Functions, None, gap);
    refused(text(".range 0 2", ".range 2 2"), Rule::Functions, None, gap);
    refused(text(".range 0 2", ".range 2 1"), Rule::Functions, None, gap);
    let behind = "function `g` ends behind the code";
    refused(text(".range 0 2", ".range 2 5"), Rule::Functions, None, behind);
    refused(text(".range 0 2", ".range 2 4294967295"), Rule::Functions, None, behind);
    let none = "there is code that belongs to no function";
    let rest = "obvasm 1\n.function f start\nenter\nhalt\n.code\nenter\nreturn";
    refused(module(rest), Rule::Functions, None, none);
    refused(module("obvasm 1\n.code\nenter\nhalt"), Rule::Functions, None, none);
    refused(Module::default(), Rule::Functions, None, none);
}

#[test]
fn rule_2_functions_have_their_ends() {
    let ends = "does not begin with enter and end with return, or halt for the start";
    let text = |first: &str, second: &str| {
        module(&format!("obvasm 1\n.function f start\n{first}\n.function g io\n{second}"))
    };
    accepted(text("enter\nhalt", "enter\nreturn"));
    for (first, second) in [
        ("enter\nreturn", "enter\nreturn"),
        ("enter\nhalt", "enter\nhalt"),
        ("enter\nhalt", "block.begin\nreturn"),
        ("block.begin\nhalt", "enter\nreturn"),
        ("halt", "enter\nreturn"),
        ("enter\nhalt", "return"),
        ("enter\nhalt", "enter"),
        ("enter\nhalt", "enter\nerror.raise #0"),
    ] {
        refused(text(first, second), Rule::Functions, None, ends);
    }
    let inner = "enter, return and halt stand at the ends of functions";
    for instr in ["enter", "return", "halt"] {
        refused(
            text(&format!("enter\n{instr}\nhalt"), "enter\nreturn"),
            Rule::Functions,
            Some(1),
            inner,
        );
        refused(
            text("enter\nhalt", &format!("enter\n{instr}\nreturn")),
            Rule::Functions,
            Some(3),
            inner,
        );
    }
}

#[test]
fn rule_2_frames_fit() {
    let text = |locals: usize, counters: usize, slots: usize, more: &str| {
        let locals = ".local x int\n".repeat(locals);
        let slots = ".slot s\n".repeat(slots);
        module(&format!(
            "obvasm 1\n.function f start\nenter\nhalt\n\
             .function g io\n{locals}{slots}.counters {counters}\n{more}\nenter\nreturn"
        ))
    };
    accepted(text(256, 0, 256, ""));
    accepted(text(1, 85, 0, ""));
    accepted(text(3, 0, 0, ".parameters 3"));
    refused(text(257, 0, 0, ""), Rule::Functions, None, "needs 257 slots, and a frame has 256");
    refused(text(2, 85, 0, ""), Rule::Functions, None, "needs 257 slots, and a frame has 256");
    let few = "function `g` has too few locals or too many positions";
    refused(text(0, 0, 257, ""), Rule::Functions, None, few);
    refused(text(3, 0, 0, ".parameters 4"), Rule::Functions, None, few);
}

#[test]
fn rule_9_the_source_map_is_in_order_and_in_the_text() {
    let text = |map: &str| {
        module(&format!(
            "obvasm 1\n.function f start\nenter\nhalt\n.source s\n| \u{fc}move\n{map}\n"
        ))
    };
    accepted(text(".map 0 0 0 6\n.map 1 0 6 6 move"));
    for (map, at) in [
        (".map 0 1 0 0", 0),
        (".map 0 0 0 7", 0),
        (".map 1 0 3 2", 1),
        (".map 1 0 1 2", 1),
        (".map 0 0 0 1", 0),
        (".map 0 0 0 0\n.map 0 0 0 0", 0),
        (".map 1 0 0 0\n.map 0 0 0 0", 0),
        (".map 2 0 0 0", 2),
        (".map 0 0 0 0\n.map 4294967295 0 0 0", 4294967295u32),
    ] {
        let why = format!("the source map's entry for instruction {at} makes no sense");
        refused(text(map), Rule::SourceMap, None, &why);
    }
}

#[test]
fn rule_9_names_of_loops_are_of_loops_in_their_order() {
    let text = |lines: &str| {
        module(&format!(
            "obvasm 1\n.function f start\n.counters 2\nenter\npush.int 1\npush.int 2\n\
             a: for.enter 0, z\nb: for.top 0, y\npush.int 1\npush.int 2\n\
             c: for.enter 1, x\nd: for.top 1, w\nw: for.next 1, d\nx: for.exit 1, c\n\
             y: for.next 0, b\nz: for.exit 0, a\nhalt\n{lines}"
        ))
    };
    accepted(text(".loop 3 i up\n.loop 7 i down\n"));
    accepted(text(".loop 7 \"\" down\n"));
    for (lines, index) in [
        (".loop 2 i up\n", 0),
        (".loop 14 i up\n", 0),
        (".loop 3 i up\n.loop 3 j up\n", 1),
        (".loop 7 i up\n.loop 3 j up\n", 1),
    ] {
        let why = format!("name {index} of loops makes no sense");
        refused(text(lines), Rule::SourceMap, None, &why);
    }
}

#[test]
fn rule_9_mentions_are_of_what_is_there_and_in_the_text() {
    let text = |mention: &str| {
        module(&format!(
            "obvasm 1\n.item i\n.tool t\n.function f start\nenter\nhalt\n.source s\n| \u{fc}move\n\
             .mention output o 9 0 0 6\n.mention {mention}\n"
        ))
    };
    accepted(text("item 0 0 0 6"));
    accepted(text("tool 0 0 6 6"));
    accepted(text("input \"\" 65535 0 2 3"));
    for mention in [
        "cell 0 0 0",
        "item 1 0 0 0",
        "tool 1 0 0 0",
        "item 0 1 0 0",
        "item 0 0 0 7",
        "tool 0 0 0 1",
    ] {
        refused(text(mention), Rule::SourceMap, None, "mention 1 makes no sense");
    }
}
