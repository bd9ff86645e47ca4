//! Programs as long as asked for, as a cell of many stations would have them: what the front end is
//! measured on. The same length gives the same text; nothing is random. Knows no mistakes.

use std::fmt::Write;

/// What stands at the top of every such program: some fifty lines of declarations.
const HEAD: &str = r#"// A line of many stations, each with a sequence of its own.
cell "line.toml"

io grip    { set 0 high; sleep 0.3 s } reverse release
io release { set 0 low;  sleep 0.3 s }
io lamp    { toggle 4 }

joints home  = [0, -90, 90, -90, -90, 0] deg
joints ready = [3.425, -1.0, 1.2, -1.8, -1.57, 0.3] rad

item part {
  keyframe above = [0, 0, -80] mm
  keyframe grasp = [0, 0, 0] mm [0, 180, 0] deg
}

error jammed {
  severity recoverable
  recover by reversing escalating up to 4 actions, perturbed 1 mm
  otherwise using clear_the_line
  respond after current action
  then return to sequence
}

var produced = 0
var rejected = 0
var clearance: length = 20 mm

sequence clear_the_line {
  io release
  move to home
}

advanced move insert {
  requires holding
  distance 300 mm forward in tcp
  stop if force > 5 N
  speed slow
  succeeds if distance > 200 mm
  on failure {
    return to initial position
    repeat with perturbation 1 mm 3 times
    throw jammed
  }
}

action pick(what: item, gap: length) {
  move to what.above
  speed slow { move to what.grasp linearly }
  io grip
  move (gap + clearance) up in base
}

"#;

/// What each station does, between its head and its end.
const STATION: &str = "\
  // Fetch a part, look whether it is there, and try again if it is not.
  var attempts = 0
  var offset = gap * 2 + 0.5 mm
  checkpoint begun
  move to home
  while attempts < rounds and not holding {
    call pick(part, offset)
    attempts += 1
    if input 3 and attempts < 5 {
      move 20 mm up in base
      produced += 1
    } else {
      offset = offset + 1 mm
      wait 0.1 s
    }
  }

  if not holding {
    rejected += 1
    io lamp
    return
  }

  // Put it into its place.
  move to ready linearly
  advance insert
  for turn from 1 to 3 {
    move (1 mm * real(turn)) forward in tcp
    sleep 0.05 s
  }
  wait until input 5 high for up to 2 s else {
    throw jammed
  }
  speed slow {
    io release
    move 40 mm up in base
  }
  move to home
";

/// The lines of a station beside what it does: its head, its end, a blank one, and the call of it.
const FRAME_LINES: usize = 4;

/// The source text of a program of about so many lines, at least of one station. At most 60 000
/// stations, two and a half million lines, fit into a module.
#[must_use]
pub fn program(lines: usize) -> String {
    let each = STATION.lines().count() + FRAME_LINES;
    let stations = (lines.saturating_sub(HEAD.lines().count()) / each).max(1);
    let mut text = String::with_capacity(HEAD.len() + stations * (STATION.len() + 100));
    text.push_str(HEAD);
    for index in 0..stations {
        let _ = writeln!(text, "sequence station_{index}(gap: length, rounds: int) {{");
        text.push_str(STATION);
        text.push_str("}\n\n");
    }
    text.push_str("sequence main {\n");
    for index in 0..stations {
        let _ = writeln!(text, "  call station_{index}({} mm, {})", index % 7 + 1, index % 5);
    }
    text.push_str("  if rejected > produced { throw jammed }\n}\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use obverse_bytecode::verify;

    #[test]
    fn a_program_is_as_long_as_asked_for_and_compiles_without_a_word() {
        for lines in [1, 1_000, 20_000] {
            let text = program(lines);
            let count = text.lines().count();
            assert!(count.abs_diff(lines) < 110, "{count} for {lines}");
            let compiled = obverse_compiler::compile("line.obv", &text);
            assert_eq!(compiled.diagnostics, []);
            assert!(compiled.module.is_some_and(|module| verify(module).is_ok()));
        }
    }
}
