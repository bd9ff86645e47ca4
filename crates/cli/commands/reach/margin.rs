//! The margin alone: the class of each line that does anything, for who shows parts of a program.

use super::draw::Pens;
use super::page::Page;
use super::words::Words;
use obverse_bytecode::Module;
use obverse_reach::{Reach, Standing};
use std::collections::HashMap;

/// The class of what stands on lines.
pub(crate) struct Margin {
    /// By file and line, from 1; of a program without a source, by instruction.
    classes: HashMap<(u16, usize), Standing>,
}

impl Margin {
    /// That of a program.
    pub(crate) fn of(module: &Module) -> Self {
        let page = Page::of(module, &Reach::of(module), &Words::new(module));
        let class = |row: &super::page::Row| Some(((row.file, row.number), row.standing()?));
        Self { classes: page.rows.iter().filter_map(class).collect() }
    }

    /// The class of a line, if it does anything.
    pub(crate) fn class(&self, file: u16, line: usize) -> Option<Standing> {
        self.classes.get(&(file, line)).copied()
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
