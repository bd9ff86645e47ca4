//! The layout of source text, by examples: what stays on a line, what is broken, what is aligned,
//! and where comments go. That nothing else changes is a law over generated programs.

use obverse_syntax::format::{format, print};
use obverse_syntax::parse;

/// Formats, and the result is what is expected and stays so.
#[track_caller]
fn becomes(source: &str, expected: &str) {
    assert_eq!(format(source).as_deref(), Ok(expected));
    assert_eq!(format(expected).as_deref(), Ok(expected), "a second time");
}

#[track_caller]
fn stays(source: &str) {
    becomes(source, source);
}

#[test]
fn blanks_and_indentation_are_set() {
    becomes(
        "sequence main(a:int,b :length){\nmove   to p.above\n\tx+=-1*( a+b )\nset 0\nlow }",
        "sequence main(a: int, b: length) {\n  move to p.above\n  x += -1 * (a + b)\n  \
         set 0 low\n}\n",
    );
    becomes("joints a = [1,2 ,3,]deg", "joints a = [1, 2, 3] deg\n");
    becomes("var a = 20mm + 1.50\t s", "var a = 20 mm + 1.50 s\n");
    becomes("var a = 3 mm / s var b = 3mm/s", "var a = 3 mm / s\nvar b = 3 mm/s\n");
}

#[test]
fn words_that_may_be_left_out_stay_as_written() {
    stays("error e { recover by reversing up to 1 actions, slower }\n");
    stays("error e { recover by reversing 1 action }\n");
    stays("sequence main() {\n  call f()\n  call f\n  move ((gap)) backwards in tcp\n}\n");
}

#[test]
fn a_block_stays_on_one_line_if_it_was_and_fits() {
    stays("sequence main { speed slow { move to a } }\n");
    becomes(
        "sequence main { speed slow {\nmove to a } }",
        "sequence main {\n  speed slow {\n    move to a\n  }\n}\n",
    );
    let long = format!("sequence {} {{ call f; if a {{ break }} }}", "m".repeat(70));
    let broken = format!("sequence {} {{\n  call f\n  if a {{ break }}\n}}\n", "m".repeat(70));
    becomes(&long, &broken);
}

#[test]
fn an_empty_block_has_no_lines() {
    becomes("sequence main {\n ; \n}", "sequence main {}\n");
    stays("sequence main {\n  // nothing\n}\n");
}

#[test]
fn rows_stay_rows() {
    becomes(
        "sequence main {\n  set 0 high;sleep 1 s\n  set 0 low; ; sleep 1 s\n}",
        "sequence main {\n  set 0 high; sleep 1 s\n  set 0 low;  sleep 1 s\n}\n",
    );
    // What has a block has a line of its own.
    becomes(
        "sequence main {\n  move to a; speed slow { break }; move to b\n}",
        "sequence main {\n  move to a\n  speed slow { break }\n  move to b\n}\n",
    );
}

#[test]
fn one_blank_line_stays_where_there_were_some() {
    becomes(
        "\n\n// a\n\n\ncell \"a\"\nsequence main {\n\n  break\n\n\n\n  break\n\n}\n\n",
        "// a\n\ncell \"a\"\nsequence main {\n  break\n\n  break\n}\n",
    );
}

#[test]
fn declarations_of_a_kind_are_aligned() {
    becomes(
        "io a { set 0 high; sleep 1 s } reverse long_b\n\
         io long_b { set 10 low; sleep 1 s } reverse a",
        "io a      { set 0 high; sleep 1 s } reverse long_b\n\
         io long_b { set 10 low; sleep 1 s } reverse a\n",
    );
    becomes(
        "var a = 1\nvar abc: int = 2\n\nvar ab = 3\n// and\nvar a = 4",
        "var a        = 1\nvar abc: int = 2\n\nvar ab = 3\n// and\nvar a = 4\n",
    );
    becomes(
        "sequence s { \n move to a\n move to ab reversible always\n \
         move to abc reversible always }",
        "sequence s {\n  move to a\n  move to ab  reversible always\n  \
         move to abc reversible always\n}\n",
    );
    // Not where a line would become too long.
    stays(&format!("var a = \"\"\nvar {} = 1\n", "b".repeat(95)).replace("\"\"", "123456"));
}

#[test]
fn branches_stand_as_they_were_written() {
    stays("sequence s {\n  if a { break } else { return }\n}\n");
    becomes(
        "sequence s {\n  if abc { break }\n  else if a { return }\n  \
         else { call f } ending when a\n}",
        "sequence s {\n  if abc    { break }\n  else if a { return }\n  \
         else      { call f } ending when a\n}\n",
    );
    becomes(
        "sequence s {\n  if abc\n {\n break }\n  else { return }\n}",
        "sequence s {\n  if abc {\n    break\n  } else {\n    return\n  }\n}\n",
    );
    becomes(
        "sequence s {\n  do { set 0 low }\n  in reverse { set 1 low }\n}",
        "sequence s {\n  do         { set 0 low }\n  in reverse { set 1 low }\n}\n",
    );
}

#[test]
fn long_lines_are_broken_after_commas_and_before_operators() {
    let number = "1234567890";
    let list = [number; 9].join(", ");
    let (first, rest) = list.split_at(12 * 7);
    becomes(
        &format!("joints abc = [{list}] rad"),
        &format!("joints abc = [{}\n    {rest}] rad\n", first.trim_end()),
    );
    let name = "n".repeat(30);
    becomes(
        &format!("var a = {name} + {name} * {name} - {name}"),
        &format!("var a = {name}\n    + {name} * {name}\n    - {name}\n"),
    );
}

#[test]
fn long_conditions_are_broken_where_they_are_least_deep() {
    let limits = |word: &str, count: usize| vec!["limit > 100"; count].join(word);
    let condition = |text: &str| format!("sequence main {{ if {text} {{ break }} }}");
    let broken = |text: &str| format!("sequence main {{\n  if {text} {{\n    break\n  }}\n}}\n");
    becomes(
        &condition(&limits(" and ", 7)),
        &broken(&format!("{}\n      and limit > 100", limits(" and ", 6))),
    );
    let inner = format!("(limit > 200 or {})", limits(" and ", 2));
    becomes(
        &condition(&format!("{} and {inner} and holding", limits(" and ", 4))),
        &broken(&format!("{}\n      and {inner} and holding", limits(" and ", 4))),
    );
    let sum = format!("{} > 1", ["summand_of_a_sum"; 6].join(" + "));
    let (first, last) = sum.split_at(19 * 4 - 3);
    becomes(
        &condition(&format!("holding or {sum}")),
        &broken(&format!("holding\n      or {}\n      {}", first.trim(), last.trim())),
    );
}

#[test]
fn comments_stay_where_they_are() {
    stays(
        "// head\n\nio a { set 0 high } // behind\n// own\nsequence main { // open\n  // first\n  \
         break // one\n\n  // last\n  // really\n} // closed\n// end\n",
    );
    becomes(
        "sequence main {\nbreak//a \n; // b\n  ;// c\nreturn }",
        "sequence main {\n  break //a\n  // b\n  // c\n  return\n}\n",
    );
    becomes(
        "sequence main { call f(1, // a\n // b\n 2)\nif x // c\n{ break } // d\n else { } }",
        "sequence main {\n  call f(1, // a\n      // b\n      2)\n  if x // c\n      {\n    \
         break\n  } // d\n  \
         else {}\n}\n",
    );
}

#[test]
fn comments_behind_lines_are_aligned() {
    becomes(
        "var a = 1 // a\nvar abc = 1     // b\ncell \"c\" // c",
        "var a   = 1 // a\nvar abc = 1 // b\ncell \"c\"    // c\n",
    );
}

#[test]
fn lines_end_with_a_line_feed() {
    becomes("\u{FEFF}// a\r\n// b\r\r\n// c\rcell \"x\"\r", "// a\n// b\n\n// c\ncell \"x\"\n");
    becomes("", "");
    becomes(" \r\n", "");
    becomes("// only", "// only\n");
}

#[test]
fn a_text_with_mistakes_is_not_formatted() {
    let source = "sequence main { mov to a }";
    assert_eq!(format(source), Err(parse(source).diagnostics));
    // What the names mean is not looked at.
    stays("sequence main { move to nowhere }\n");
}

#[test]
fn a_tree_is_printed_with_the_parentheses_that_it_needs() {
    let source = "var a = (1 + 2) * 3 - (4 - (5 / 6)) mod -(-7)\n\
                  var b = not (x and (y or z)) or (p < q) == (not r)\n\
                  sequence s {\n  move (a + 1) up\n}\n";
    let printed = "var a = (1 + 2) * 3 - (4 - 5 / 6) mod --7\n\
                   var b = not (x and (y or z)) or (p < q) == (not r)\n\n\
                   sequence s {\n  move (a + 1) up\n}\n";
    assert_eq!(print(&parse(source).program), printed);
}

#[test]
fn a_long_file_is_formatted_whole() {
    let source = "// c\nvar a = f(1, 2);\n".repeat(20_000);
    let formatted = format(&source).expect("a program");
    assert_eq!(formatted.matches("// c\n").count(), 20_000);
    assert_eq!(formatted.matches("var a = f(1, 2)\n").count(), 20_000);
}
