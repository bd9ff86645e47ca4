//! The laws of the formatter over generated programs, written with random blanks, line ends and
//! comments: what is formatted means the same, keeps its comments and stays as it is.

use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_bytecode::Module;
use obverse_compiler::compile;
use obverse_syntax::format::{format, print};
use obverse_syntax::parse;

/// To format changes neither code nor tables, loses and moves no comment, and a second time changes
/// nothing. The tree alone is printed as a program that means the same, too.
///
/// # Errors
/// Those of the randomness.
pub fn formats(u: &mut Unstructured<'_>) -> Result<bool> {
    let noise = noise(u.arbitrary()?);
    // Each is compiled and written out several times.
    let source = programs::generate(u, Options { max_statements: 30, ..Options::default() })?;
    let untidy = untidy(&mut Unstructured::new(&noise), &source)?;
    let expected = meaning(&source);
    assert!(meaning(&untidy) == expected, "the untidy text means something else\n{untidy}");
    let text = format(&untidy).unwrap_or_else(|found| panic!("{found:?}\n{untidy}"));
    assert!(meaning(&text) == expected, "the formatted text means something else\n{text}");
    assert_eq!(comments(&text), comments(&untidy), "comments\n{untidy}\n{text}");
    assert_eq!(format(&text).as_ref(), Ok(&text), "a second time\n{untidy}");
    let printed = print(&parse(&untidy).program);
    assert!(meaning(&printed) == expected, "the printed text means something else\n{printed}");
    assert_eq!(format(&printed).as_ref(), Ok(&printed), "printed, then formatted");
    Ok(true)
}

/// A text that is cut off anywhere is formatted, or there are diagnostics.
///
/// # Errors
/// Those of the randomness.
pub fn cut_off(u: &mut Unstructured<'_>) -> Result<bool> {
    let noise = noise(u.arbitrary()?);
    let end: usize = u.arbitrary()?;
    let source = programs::generate(u, Options::default())?;
    let text = untidy(&mut Unstructured::new(&noise), &source)?;
    let mut end = end % (text.len() + 1);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    match format(&text[..end]) {
        Ok(formatted) => assert_eq!(format(&formatted).as_ref(), Ok(&formatted), "{text}"),
        Err(diagnostics) => assert!(!diagnostics.is_empty(), "no reason\n{text}"),
    }
    Ok(true)
}

/// What a program compiles to, its source map and the places where it mentions what its workcell
/// must have aside: those are not those of another layout.
pub fn meaning(source: &str) -> Module {
    let compiled = compile("program.obv", source);
    match compiled.module {
        Some(module) => {
            Module { sources: Vec::new(), source_map: Vec::new(), mentions: Vec::new(), ..module }
        }
        None => panic!("it does not compile: {:#?}\n{source}", compiled.diagnostics),
    }
}

/// Randomness of its own for what is between tokens: a program may have used up all of the other.
fn noise(seed: u64) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 56) as u8
    };
    (0..1 << 16).map(|_| next()).collect()
}

/// What may stand in place of the end of a line.
const LINE_ENDS: [&str; 7] = ["\n", "\n", "\r\n", "\r", ";", " ; \n", " "];

/// The same program with other blanks and line ends, and with comments.
fn untidy(u: &mut Unstructured<'_>, source: &str) -> Result<String> {
    let mut text = String::with_capacity(2 * source.len());
    let mut is_quoted = false;
    let mut count = 0;
    for (index, c) in source.char_indices() {
        is_quoted ^= c == '"';
        let before = source[..index].chars().next_back().unwrap_or(' ');
        let after = source[index + c.len_utf8()..].chars().next().unwrap_or(' ');
        // A unit stands on the line of its number.
        let is_of_number = matches!(before, '0'..='9' | ']') && after.is_alphabetic();
        match c {
            _ if is_quoted => text.push(c),
            ' ' if is_of_number => text.push_str(u.choose(&[" ", "  ", "\t"])?),
            ' ' => between(u, &mut text, &[" "], &mut count)?,
            '\n' => {
                between(u, &mut text, &[""], &mut count)?;
                between(u, &mut text, &LINE_ENDS, &mut count)?;
            }
            '(' | ')' | ',' | '{' | '}' | '[' => {
                between(u, &mut text, &[""], &mut count)?;
                text.push(c);
                between(u, &mut text, &[""], &mut count)?;
            }
            _ => text.push(c),
        }
    }
    Ok(text)
}

/// What may stand between two tokens: mostly one of these.
fn between(
    u: &mut Unstructured<'_>,
    text: &mut String,
    usual: &[&str],
    count: &mut u32,
) -> Result<()> {
    match u.int_in_range(0..=19)? {
        19 => {
            *count += 1;
            let end = u.choose(&["\n", "\r\n", "\n\n", "\r"])?;
            text.push_str(&format!(" // {count}{end}"));
        }
        18 => text.push_str(u.choose(&["\n", " \n\n\n ", "\r\n\t"])?),
        _ => text.push_str(u.choose(usual)?),
    }
    Ok(())
}

/// The comments of a text in their order.
fn comments(text: &str) -> Vec<&str> {
    let lines = text.split(['\n', '\r']);
    lines.filter_map(|line| Some(line[line.find("//")?..].trim_end())).collect()
}
