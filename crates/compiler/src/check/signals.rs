//! Outputs and inputs of the workcell: the entries of an I/O map, and where they are used, by name
//! or by number. Knows nothing of what is done with them.

use super::Checker;
use super::names::Meaning;
use crate::report::warning;
use obverse_bytecode::Mentioned;
use obverse_isa::Bit;
use obverse_syntax::ast::{Signal, SignalDeclaration, SignalKind};
use obverse_syntax::codes::Code;
use obverse_syntax::span::{Span, Spanned};

impl<'s> Checker<'s> {
    /// `output gripper = 0`, `input part_present = 3`
    pub(super) fn declare_signal(&mut self, entry: &SignalDeclaration<'s>) {
        let is_line = u16::try_from(entry.number.value).is_ok();
        let bit = self.line(entry.number);
        let (meaning, word) = match entry.kind {
            SignalKind::Output => (Meaning::Output(bit), "output"),
            SignalKind::Input => (Meaning::Input(bit), "input"),
        };
        self.declare(entry.name, meaning);
        let name = entry.name.value.to_owned();
        let what = match entry.kind {
            SignalKind::Output => Mentioned::Output { name, bit: bit.0 },
            SignalKind::Input => Mentioned::Input { name, bit: bit.0 },
        };
        self.mention(what, entry.span);
        if is_line && let Some(first) = self.signals.insert((entry.kind, bit.0), entry.name) {
            let message = format!("{word} {} has two names", bit.0);
            let at = format!("the {word} of `{}`", first.value);
            self.reports.add(
                warning(Code::TwoNames, entry.number.span, message, at)
                    .with_label(first.span, "named here")
                    .with_help("give each name a number of its own"),
            );
        }
    }

    /// The output that is meant.
    pub(super) fn output(&mut self, signal: Spanned<Signal<'s>>) -> Bit {
        self.signal(signal, "an output", |meaning| matches!(meaning, Meaning::Output(_)))
    }

    /// The input that is meant.
    pub(super) fn input(&mut self, signal: Spanned<Signal<'s>>) -> Bit {
        self.signal(signal, "an input", |meaning| matches!(meaning, Meaning::Input(_)))
    }

    fn signal(
        &mut self,
        signal: Spanned<Signal<'s>>,
        needed: &str,
        wanted: fn(Meaning) -> bool,
    ) -> Bit {
        let name = match signal.value {
            Signal::Number(number) => return self.line(Spanned::new(number, signal.span)),
            Signal::Name(name) => Spanned::new(name, signal.span),
        };
        match self.resolve(name, needed, wanted) {
            Some(Meaning::Output(bit) | Meaning::Input(bit)) => bit,
            _ => Bit(0),
        }
    }

    /// A line of the workcell by its number.
    fn line(&mut self, number: Spanned<u64>) -> Bit {
        Bit(u16::try_from(number.value).unwrap_or_else(|_| {
            let message = format!("there is no line {}; they go from 0 to 65535", number.value);
            self.reports.error(Code::OutOfRange, number.span, message, "no line has this number");
            0
        }))
    }

    /// Note where the program speaks of something that its workcell must have.
    pub(super) fn mention(&mut self, what: Mentioned, span: Span) {
        let place = self.sources.locate(span);
        let file = u16::try_from(place.file).unwrap_or(u16::MAX);
        let Span { start, end } = place.span;
        self.module.mentions.push(obverse_bytecode::Mention { what, file, start, end });
    }
}
