//! What a row of instructions is as a whole: the class of a statement.

use crate::facts::Facts;
use crate::few::Few;
use crate::graph::Graph;
use crate::sets::Calls;
use crate::{Horizon, Reach, is_never};
use obverse_bytecode::{Function, Module};
use obverse_isa::{Class, Instr};
use std::ops::Range;

/// The class of a statement: that of what is hardest to take back in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Standing {
    /// It can be taken back in any state.
    Always,
    /// It can be taken back once it has been run, from what it recorded.
    AfterForward,
    /// It is not taken back.
    Never,
}

impl Standing {
    /// The name of the class.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Always => "always",
            Self::AfterForward => "after-forward",
            Self::Never => "never",
        }
    }
}

impl Reach<'_> {
    /// The class of a row of instructions: never if something stops going back behind it that is in
    /// it or in what it calls.
    #[must_use]
    pub fn standing(&self, range: Range<u32>) -> Standing {
        if !self.left_by(range.clone()).is_empty() {
            return Standing::Never;
        }
        let code = &self.module.code[range.start as usize..range.end as usize];
        code.iter().map(|instr| of_instr(instr, &self.standings)).max().unwrap_or(Standing::Always)
    }

    /// What a row of instructions may leave behind it that stops going back, within it or in what
    /// it calls: the first few.
    #[must_use]
    pub fn left_by(&self, range: Range<u32>) -> Vec<Horizon> {
        let mut left = Few::default();
        let mut pc = range.end;
        while pc > range.start {
            pc -= 1;
            let instr = &self.module.code[pc as usize];
            match *instr {
                _ if is_never(instr) => left.add(&Few::of(Horizon::Never(pc))),
                Instr::Call { function, .. } => {
                    for exit in self.exits(function.index()) {
                        left.add(&self.within.at(exit));
                    }
                }
                Instr::BlockSkip { from } | Instr::BlockReplace { from, .. }
                    if from.0 >= range.start =>
                {
                    pc = from.0;
                }
                _ => {}
            }
        }
        left.horizons().collect()
    }

    fn exits(&self, function: usize) -> Vec<u32> {
        let (graph, facts): (&Graph, &Facts) = (&self.graph, &self.facts);
        let contexts = graph.contexts_of(function);
        let exits = contexts.flat_map(|context| graph.contexts[context as usize].exits);
        exits.filter(|&exit| facts.at(exit).is_reached).collect()
    }
}

/// Whether calls of each function leave a record.
pub(crate) fn of_functions(module: &Module, calls: &Calls) -> Vec<Standing> {
    let mut standings: Vec<Standing> = module.functions.iter().map(|f| own(module, f)).collect();
    let callers = calls.reversed();
    let records = |index: &usize| standings[*index] == Standing::AfterForward;
    let mut changed: Vec<usize> = (0..standings.len()).filter(records).collect();
    while let Some(callee) = changed.pop() {
        for &caller in &callers[callee] {
            let caller = caller as usize;
            if standings[caller] == Standing::Always {
                standings[caller] = Standing::AfterForward;
                changed.push(caller);
            }
        }
    }
    standings
}

/// A function without what it calls. Its frame is recorded if there is anything in it.
fn own(module: &Module, function: &Function) -> Standing {
    let has_frame =
        !function.locals.is_empty() || function.counters > 0 || !function.slots.is_empty();
    let code = &module.code[function.first as usize..function.end as usize];
    let records = |instr: &Instr| match instr {
        Instr::Return {} => has_frame,
        instr => matches!(instr.info().class, Class::AfterForward(_)),
    };
    if code.iter().any(records) { Standing::AfterForward } else { Standing::Always }
}

fn of_instr(instr: &Instr, functions: &[Standing]) -> Standing {
    match (instr, instr.info().class) {
        (Instr::Call { function, .. }, _) => functions[function.index()],
        (_, Class::AfterForward(_)) => Standing::AfterForward,
        // Only those behind which nothing stops are left.
        (_, Class::Always | Class::Never(_)) => Standing::Always,
    }
}
