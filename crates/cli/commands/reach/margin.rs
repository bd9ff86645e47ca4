//! The margin alone: the class of each line that does anything, and the brackets around lines that
//! can go back equally far, for who shows parts of a program.

use super::draw::{Pens, edges};
use super::page::Page;
use super::words::Words;
use obverse_bytecode::Module;
use obverse_reach::{Reach, Standing};
use std::collections::HashMap;

/// What is drawn beside a line.
#[derive(Clone, Copy)]
pub(crate) struct Mark {
    /// The part of a bracket.
    pub(crate) bracket: char,
    /// The class of what stands there, if that does anything.
    pub(crate) class: Option<Standing>,
}

/// What is drawn beside the lines of a program.
pub(crate) struct Margin {
    /// By file and line, from 1; of a program without a source, by instruction.
    marks: HashMap<(u16, usize), Mark>,
}

impl Margin {
    /// That of a program.
    pub(crate) fn of(module: &Module) -> Self {
        let page = Page::of(module, &Reach::of(module), &Words::new(module));
        let marks = page.rows.iter().zip(edges(&page.rows)).map(|(row, edge)| {
            let mark = Mark { bracket: Pens::LINES.bracket(edge), class: row.standing() };
            ((row.file, row.number), mark)
        });
        Self { marks: marks.collect() }
    }

    /// What is beside a line.
    pub(crate) fn mark(&self, file: u16, line: usize) -> Mark {
        let nothing = Mark { bracket: ' ', class: None };
        self.marks.get(&(file, line)).copied().unwrap_or(nothing)
    }
}

/// The sign that a class is drawn with.
pub(crate) fn sign(class: Option<Standing>) -> char {
    class.map_or(' ', |class| Pens::LINES.of(class))
}

/// Where going back from an instruction may end, in words.
pub(crate) fn ends(module: &Module, pc: u32) -> Vec<String> {
    let (reach, words) = (Reach::of(module), Words::new(module));
    words.ends(&reach, &reach.at(pc))
}
