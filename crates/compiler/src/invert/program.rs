//! The program around the sequence: what is inverted with it, in which order, what is known where
//! each begins, and what the inverse needs of the rest.

use super::block::Inverter;
use super::checked::Checked;
use super::effect::{Declared, Effect, Facts, Key, Value, constant};
use super::refusal::refusal;
use super::walk;
use obverse_syntax::ast::{
    AdvancedMove, Allow, Block, IoOperation, Item, Name, Program, Sequence, Signal, SignalKind,
    Statement, StatementKind, VariableDeclaration,
};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::format::print;
use obverse_syntax::span::{Span, Spanned};
use std::collections::{BTreeSet, HashMap, HashSet};

/// What the name of an inverse ends with. That of its inverse does not.
const SUFFIX: &str = "_inverse";

/// What is to be inverted, and what is known of the program.
pub(super) struct Plan<'s> {
    program: &'s Program<'s>,
    pub(super) checked: Checked<'s>,
    pub(super) root: &'s str,
    /// What is inverted, callees before callers.
    order: Vec<&'s Sequence<'s>>,
    sequences: HashMap<&'s str, &'s Sequence<'s>>,
    io: HashMap<&'s str, &'s IoOperation<'s>>,
    advanced_moves: HashMap<&'s str, &'s AdvancedMove<'s>>,
    joints: HashSet<&'s str>,
    items: HashSet<&'s str>,
    globals: HashSet<&'s str>,
    /// The numbers of outputs by name.
    outputs: HashMap<&'s str, u64>,
    /// What a call changes, by sequence.
    effects: HashMap<&'s str, Effect<'s>>,
    /// A call that leads to each sequence but the root: in which sequence it stands, and where.
    call_sites: HashMap<&'s str, (&'s str, Span)>,
    /// Whether the program begins with the sequence, and its inverse with the inverse.
    is_begun_with: bool,
    /// The names of inverses, by the names of what they are the inverses of.
    inverse_names: HashMap<&'s str, String>,
}

impl<'s> Declared<'s> for Plan<'s> {
    fn io(&self, name: &str) -> Option<&IoOperation<'s>> {
        self.io.get(name).copied()
    }

    fn number(&self, output: Signal<'_>) -> u64 {
        match output {
            Signal::Number(number) => number,
            // A program that compiles declares the name.
            Signal::Name(name) => self.outputs.get(name).copied().unwrap_or(u64::MAX),
        }
    }

    fn effect_of_call(&self, name: &str) -> Effect<'s> {
        self.effects.get(name).cloned().unwrap_or_else(Effect::open)
    }

    fn is_joints(&self, name: &str) -> bool {
        self.joints.contains(name)
    }
}

impl<'s> Plan<'s> {
    /// What it takes to invert a sequence of a program.
    pub(super) fn of(
        program: &'s Program<'s>,
        checked: Checked<'s>,
        root: &str,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut plan = Self {
            program,
            checked,
            root: "",
            order: Vec::new(),
            sequences: HashMap::new(),
            io: HashMap::new(),
            advanced_moves: HashMap::new(),
            joints: HashSet::new(),
            items: HashSet::new(),
            globals: HashSet::new(),
            outputs: HashMap::new(),
            effects: HashMap::new(),
            call_sites: HashMap::new(),
            is_begun_with: false,
            inverse_names: HashMap::new(),
        };
        for item in &program.items {
            match item {
                Item::Io(io) => _ = plan.io.insert(io.name.value, io),
                Item::Joints(joints) => _ = plan.joints.insert(joints.name.value),
                Item::Variable(variable) => _ = plan.globals.insert(variable.name.value),
                Item::Sequence(one) => _ = plan.sequences.insert(one.name.value, one),
                Item::AdvancedMove(one) => _ = plan.advanced_moves.insert(one.name.value, one),
                Item::ItemDeclaration(item) => _ = plan.items.insert(item.name.value),
                Item::Signal(entry) => {
                    if entry.kind == SignalKind::Output {
                        plan.outputs.insert(entry.name.value, entry.number.value);
                    }
                }
                Item::Cell(_)
                | Item::Import(_)
                | Item::Error(_)
                | Item::Cleanup(_)
                | Item::Allow(_) => {}
            }
        }
        plan.find_effects();
        if let Some(root) = plan.sequences.get(root) {
            plan.root = root.name.value;
            let (order, again) = plan.after_callees(&[root], inverted_calls);
            if let Some(again) = again {
                let message = "a sequence that calls itself has no inverse";
                let why = "this leads back into a sequence that is under way";
                let help = "write the repetition as a loop";
                return Err(vec![refusal(again, message, why).with_help(help)]);
            }
            for sequence in order.iter().rev() {
                for (callee, span) in inverted_calls(sequence) {
                    plan.call_sites.entry(callee).or_insert((sequence.name.value, span));
                }
            }
            plan.order = order;
            plan.is_begun_with = plan.begins_with_root();
        }
        let names = plan.io.keys().chain(plan.sequences.keys());
        plan.inverse_names = names.map(|name| (*name, inverse_name(name))).collect();
        Ok(plan)
    }

    /// The name of the inverse of a sequence or I/O operation.
    pub(super) fn inverse_name(&self, name: Name<'s>) -> Name<'_> {
        let inverse = self.inverse_names.get(name.value);
        Spanned::new(inverse.map_or(name.value, String::as_str), name.span)
    }

    /// The name of a variable of the program as it is declared.
    fn global_name(&self, name: &str) -> &'s str {
        self.globals.get(name).copied().unwrap_or("")
    }

    /// The name of an I/O operation as it is declared.
    pub(super) fn io_name(&self, name: &str) -> Option<&'s str> {
        self.io.get(name).map(|io| io.name.value)
    }

    /// The advanced move of this name.
    pub(super) fn advanced_move(&self, name: &str) -> Option<&'s AdvancedMove<'s>> {
        self.advanced_moves.get(name).copied()
    }

    /// The calls that lead from the root to a sequence, the innermost first.
    pub(super) fn calls_to(&self, name: &'s str) -> impl Iterator<Item = Span> {
        let mut inner = name;
        std::iter::from_fn(move || {
            if inner == self.root {
                return None;
            }
            let (caller, span) = self.call_sites.get(inner)?;
            inner = caller;
            Some(*span)
        })
    }

    /// Every I/O operation.
    pub(super) fn io_operations(&self) -> impl Iterator<Item = &'s IoOperation<'s>> {
        self.program.items.iter().filter_map(|item| match item {
            Item::Io(io) => Some(io),
            _ => None,
        })
    }

    pub(super) fn is_global(&self, name: &str) -> bool {
        self.globals.contains(name)
    }

    /// Whether a name means the same in every sequence.
    pub(super) fn is_of_program(&self, name: &str) -> bool {
        self.is_global(name) || self.is_constant(name)
    }

    /// Whether a name is never assigned.
    pub(super) fn is_constant(&self, name: &str) -> bool {
        self.is_joints(name) || self.is_item(name)
    }

    /// Whether a call of a sequence may assign a variable of the program.
    pub(super) fn assigns(&self, name: &'s str) -> bool {
        let (mut seen, mut to_visit) = (HashSet::new(), vec![name]);
        while let Some(name) = to_visit.pop() {
            let Some(sequence) = self.sequence(name).filter(|_| seen.insert(name)) else {
                continue;
            };
            let mut assigns = false;
            walk::each_in(&sequence.body, &mut |statement| match &statement.kind {
                StatementKind::Assign { name, .. } => assigns |= self.is_global(name.value),
                StatementKind::Call { name, .. } => to_visit.push(name.value),
                _ => {}
            });
            if assigns {
                return true;
            }
        }
        false
    }

    fn is_item(&self, name: &str) -> bool {
        self.items.contains(name)
    }

    pub(super) fn sequence(&self, name: &str) -> Option<&'s Sequence<'s>> {
        self.sequences.get(name).copied()
    }

    fn find_effects(&mut self) {
        let all: Vec<&Sequence<'s>> = self.sequences.values().copied().collect();
        // Of what calls itself nothing is known.
        for sequence in self.after_callees(&all, all_calls).0 {
            let effect = Effect::of_block(&sequence.body, self);
            let effect = effect.of_variables(|name| self.globals.contains(name));
            self.effects.insert(sequence.name.value, effect);
        }
    }

    /// These sequences and what they call, each after what it calls; and a call of what is under
    /// way, if there is one.
    fn after_callees(
        &self,
        roots: &[&'s Sequence<'s>],
        calls: fn(&'s Sequence<'s>) -> Vec<(&'s str, Span)>,
    ) -> (Vec<&'s Sequence<'s>>, Option<Span>) {
        let (mut done, mut again) = (Vec::new(), None);
        let mut is_done: HashMap<&str, bool> = HashMap::new();
        for &root in roots {
            if is_done.contains_key(root.name.value) {
                continue;
            }
            is_done.insert(root.name.value, false);
            let mut under_way = vec![(root, calls(root))];
            while let Some((sequence, left)) = under_way.last_mut() {
                let Some((name, span)) = left.pop() else {
                    is_done.insert(sequence.name.value, true);
                    done.push(*sequence);
                    under_way.pop();
                    continue;
                };
                let Some(callee) = self.sequence(name) else { continue };
                match is_done.get(name) {
                    Some(false) => again = again.or(Some(span)),
                    Some(true) => {}
                    None => {
                        is_done.insert(name, false);
                        under_way.push((callee, calls(callee)));
                    }
                }
            }
        }
        (done, again)
    }

    /// What is known where each sequence begins: what all its callers know.
    fn entries(&self) -> HashMap<&'s str, Facts<'s>> {
        let mut entries: HashMap<&'s str, Facts<'s>> = HashMap::new();
        if self.is_begun_with {
            entries.insert(self.root, self.first_values());
        }
        for sequence in self.order.iter().rev() {
            let facts = entries.get(sequence.name.value).cloned().unwrap_or_default();
            self.each_call(&sequence.body, facts, &mut |name, facts| {
                let facts = facts.clone().of_program(|name| self.globals.contains(name));
                entries.entry(name).and_modify(|known| known.meet(&facts)).or_insert(facts);
            });
        }
        entries
    }

    fn each_call(
        &self,
        block: &'s Block<'s>,
        mut facts: Facts<'s>,
        visit: &mut impl FnMut(&'s str, &Facts<'s>),
    ) {
        for statement in &block.statements {
            match &statement.kind {
                StatementKind::Call { name, .. } => visit(name.value, &facts),
                StatementKind::SkipInReverse(_) | StatementKind::ReplaceInReverse { .. } => {}
                _ => {
                    for block in statement.blocks() {
                        let mut inside = facts.clone();
                        inside.at_head(statement, self);
                        self.each_call(block, inside, visit);
                    }
                }
            }
            facts.after(statement, self);
        }
    }

    /// Whether the program begins with the sequence: it is the main sequence, or all that this
    /// calls. And what becomes of the variables of the program is known: otherwise nobody could
    /// say with which values an inverse program begins.
    fn begins_with_root(&self) -> bool {
        let (Some(main), Some(root)) = (main_of(self.program), self.sequence(self.root)) else {
            return false;
        };
        let calls_it = match main.body.statements.as_slice() {
            [Statement { kind: StatementKind::Call { name, arguments }, .. }] => {
                name.value == self.root && arguments.is_empty()
            }
            _ => false,
        };
        let mut facts = self.first_values();
        root.body.statements.iter().for_each(|statement| facts.after(statement, self));
        let effect = self.effect_of_call(self.root);
        let mut changed = effect.variables();
        (main.name.value == self.root || calls_it)
            && !effect.is_open()
            && changed.all(|name| facts.constant(name).is_some())
    }

    /// The variables of the program as they begin.
    fn first_values(&self) -> Facts<'s> {
        let mut facts = Facts::default();
        for item in &self.program.items {
            if let Item::Variable(variable) = item
                && let Some(value) = constant(&variable.value, self)
            {
                facts.set(Key::Variable(variable.name.value), Value::Constant(value));
            }
        }
        facts
    }

    /// A variable of the program as it begins in the inverse. If the program begins with the
    /// sequence, so does the inverse program with the inverse, and the variable with the value that
    /// it has after the sequence.
    fn first_value<'p>(
        &'p self,
        variable: &VariableDeclaration<'p>,
        last: &Facts<'p>,
    ) -> VariableDeclaration<'p> {
        let name = self.global_name(variable.name.value);
        let is_changed = self.is_begun_with && self.effect_of_call(self.root).changes(name);
        match last.constant(name).filter(|_| is_changed) {
            Some(value) => VariableDeclaration { value: value.clone(), ..variable.clone() },
            None => variable.clone(),
        }
    }

    /// The inverse as a program, and whether that begins with it.
    pub(super) fn inverse(&self) -> Result<(Program<'_>, bool), Vec<Diagnostic>> {
        let mut inverter = Inverter::new(self, self.entries());
        let mut inverses: HashMap<&str, Sequence<'_>> = HashMap::new();
        for sequence in &self.order {
            let inverse = inverter.sequence(sequence);
            inverses.insert(sequence.name.value, inverse);
        }
        let last = inverter.facts.clone();
        let mut io = inverter.into_result()?;
        let mut items = Vec::new();
        for item in &self.program.items {
            let (inverse, is_kept) = match item {
                Item::Sequence(sequence) => {
                    (inverses.remove(sequence.name.value).map(Item::Sequence), false)
                }
                Item::Io(one) => {
                    let name = one.name.value;
                    (io.made.remove(name).map(Item::Io), io.kept.contains(name))
                }
                Item::Cell(_) => (None, true),
                _ => (None, false),
            };
            let item = match item {
                Item::Variable(variable) => Item::Variable(self.first_value(variable, &last)),
                _ => item.clone(),
            };
            items.push(Part { item, is_inverse: false, is_needed: is_kept });
            let made = |item| Part { item, is_inverse: true, is_needed: true };
            items.extend(inverse.map(made));
        }
        self.refuse_two_meanings(&items)?;
        let mut program = Program { items: needed(items) };
        let is_begun_with = self.add_main(&mut program);
        Ok((program, is_begun_with))
    }

    /// What stands in blocks that are kept whole calls sequences of the program as they are: none
    /// of their names may be that of an inverse.
    fn refuse_two_meanings(&self, parts: &[Part<'_>]) -> Result<(), Vec<Diagnostic>> {
        let made: HashSet<&str> = parts
            .iter()
            .filter(|part| part.is_inverse)
            .filter_map(|part| part.item.name())
            .map(|name| name.value)
            .collect();
        let mut found = Vec::new();
        for sequence in &self.order {
            walk::each_in(&sequence.body, &mut |statement| {
                if is_kept_whole(&statement.kind) {
                    walk::each_statement(statement, &mut |inner| found.extend(named(inner)));
                }
            });
        }
        let mut seen: HashSet<&str> = HashSet::new();
        while let Some((name, span)) = found.pop() {
            if !seen.insert(name) {
                continue;
            }
            if made.contains(name) {
                let message = format!("`{name}` would mean two things in the inverse");
                let why = "this is called as it stands, and an inverse has the same name";
                return Err(vec![
                    refusal(span, &message, why).with_help("give one of them another name"),
                ]);
            }
            if let Some(sequence) = self.sequence(name) {
                walk::each_in(&sequence.body, &mut |inner| found.extend(named(inner)));
            }
        }
        Ok(())
    }

    /// A main sequence, if the program would not begin with the inverse anyway, or should not:
    /// where the program does not begin with the sequence, nobody may take it for what it begins
    /// with.
    fn add_main<'p>(&'p self, program: &mut Program<'p>) -> bool {
        let Some(root) = self.sequence(self.root) else { return false };
        let name = self.inverse_name(root.name);
        let main = main_of(program);
        let is_main = |main: &Sequence<'_>| main.name.value == name.value && self.is_begun_with;
        if main.is_some_and(|main| is_main(main) || main.name.value == "main") {
            return main.is_some_and(is_main);
        }
        let span = root.name.span;
        let call = StatementKind::Call { name, arguments: Vec::new() };
        let is_changing = self.assigns(self.root) && !self.is_begun_with;
        // Nobody knows the arguments, or with which values the variables begin.
        let is_called = root.parameters.is_empty() && !is_changing;
        let statements = if is_called { vec![Statement { kind: call, span }] } else { Vec::new() };
        if !is_called {
            program.items.insert(0, Item::Allow(unused_here(span)));
        }
        program.items.push(Item::Sequence(Sequence {
            name: Spanned::new("main", span),
            is_action: false,
            parameters: Vec::new(),
            body: Block { statements, span },
            span,
        }));
        is_called
    }
}

/// What is said of an inverse that the program around it does not call.
fn unused_here<'p>(span: Span) -> Allow<'p> {
    let reason = "who calls the inverse uses it, with what it needs";
    Allow {
        code: Spanned::new(Code::Unused.as_str(), span),
        in_file: true,
        reason: Spanned::new(reason, span),
        span,
    }
}

/// The sequence that a program begins with: `main`, or else the last without parameters.
fn main_of<'p, 's>(program: &'p Program<'s>) -> Option<&'p Sequence<'s>> {
    let sequences = || {
        program.items.iter().filter_map(|item| match item {
            Item::Sequence(sequence) => Some(sequence),
            _ => None,
        })
    };
    let begins = |sequence: &&Sequence<'_>| !sequence.is_action && sequence.parameters.is_empty();
    sequences().find(|one| one.name.value == "main").or_else(|| sequences().rfind(begins))
}

/// What a sequence calls that is inverted with it: not what stands in blocks that are kept whole.
fn inverted_calls<'s>(sequence: &'s Sequence<'s>) -> Vec<(&'s str, Span)> {
    fn collect<'s>(block: &'s Block<'s>, calls: &mut Vec<(&'s str, Span)>) {
        for statement in &block.statements {
            match &statement.kind {
                StatementKind::Call { name, .. } => calls.push((name.value, statement.span)),
                kind if is_kept_whole(kind) => {}
                _ => statement.blocks().into_iter().for_each(|block| collect(block, calls)),
            }
        }
    }
    let mut calls = Vec::new();
    collect(&sequence.body, &mut calls);
    calls
}

/// Whether the blocks of a statement stand in an inverse as they are.
fn is_kept_whole(kind: &StatementKind<'_>) -> bool {
    matches!(
        kind,
        StatementKind::SkipInReverse(_)
            | StatementKind::ReplaceInReverse { .. }
            | StatementKind::KeepInReverse(_)
    )
}

fn all_calls<'s>(sequence: &'s Sequence<'s>) -> Vec<(&'s str, Span)> {
    let mut calls = Vec::new();
    walk::each_in(&sequence.body, &mut |statement| {
        if let StatementKind::Call { name, .. } = &statement.kind {
            calls.push((name.value, statement.span));
        }
    });
    calls
}

/// The inverse of `pick` is `pick_inverse`, and that of `pick_inverse` is `pick`.
pub(super) fn inverse_name(name: &str) -> String {
    match name.strip_suffix(SUFFIX).filter(|rest| !rest.is_empty()) {
        Some(rest) => rest.to_owned(),
        None => format!("{name}{SUFFIX}"),
    }
}

/// What a statement calls as it stands.
fn named<'s>(statement: &Statement<'s>) -> Option<(&'s str, Span)> {
    match &statement.kind {
        StatementKind::Call { name, .. } | StatementKind::Io(name) => {
            Some((name.value, statement.span))
        }
        _ => None,
    }
}

/// A declaration of the program, or an inverse.
struct Part<'p> {
    item: Item<'p>,
    is_inverse: bool,
    is_needed: bool,
}

/// What inverses need, themselves included: what is named in them, and what is named in that.
fn needed(mut parts: Vec<Part<'_>>) -> Vec<Item<'_>> {
    let mut by_name: HashMap<&str, usize> = HashMap::new();
    for (index, part) in parts.iter().enumerate() {
        // That of an inverse comes first: what has its name otherwise is not meant.
        if let Some(Spanned { value: name, .. }) = part.item.name()
            && (part.is_inverse || !by_name.contains_key(name))
        {
            by_name.insert(name, index);
        }
    }
    let mut to_visit: Vec<usize> =
        (0..parts.len()).filter(|&index| parts[index].is_needed).collect();
    while let Some(index) = to_visit.pop() {
        for word in words_of(&parts[index].item) {
            if let Some(&found) = by_name.get(word.as_str())
                && !std::mem::replace(&mut parts[found].is_needed, true)
            {
                to_visit.push(found);
            }
        }
    }
    parts.into_iter().filter(|part| part.is_needed).map(|part| part.item).collect()
}

/// The words that a declaration is written with; the names that it needs are among them.
fn words_of(item: &Item<'_>) -> BTreeSet<String> {
    let text = print(&Program { items: vec![item.clone()] });
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split(|c| !is_of_word(c)).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}
