//! Sequences and blocks: the inverses of their statements in reverse order, and which statement is
//! inverted by whom.

use super::effect::{Effect, Facts};
use super::output::body_text;
use super::place::{Arm, Spot, Tool};
use super::program::Plan;
use super::pure;
use super::refusal::{Refusals, refusal};
use super::walk;
use obverse_syntax::ast::{
    Block, Expression, IoOperation, Primitive, Sequence, Statement, StatementKind,
};
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::{Span, Spanned};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

/// Inverts sequences, callees before callers.
pub(super) struct Inverter<'p> {
    pub(super) plan: &'p Plan<'p>,
    /// What is known where each sequence begins.
    entries: HashMap<&'p str, Facts<'p>>,
    /// What callers must know of what has been inverted.
    pub(super) summaries: HashMap<&'p str, Summary<'p>>,
    refusals: Refusals,
    pub(super) io: NewIo<'p>,
    /// What is known at the statement in hand.
    pub(super) facts: Facts<'p>,
    pub(super) arm: Arm<'p>,
    pub(super) tool: Tool<'p>,
    /// What is done by statements that do not go back to former levels, and where.
    pub(super) opaque: Vec<(Effect<'p>, Span)>,
    /// The sequence in hand.
    pub(super) name: &'p str,
    /// Its parameters.
    pub(super) parameters: Vec<&'p str>,
    /// The call that the sequence in hand begins with, whose first move is its own.
    pub(super) first_call: Option<Span>,
    pub(super) first_move: Option<FirstMove<'p>>,
}

/// The I/O operations of the inverse that the program does not have, by the name of the one that
/// each is the inverse of; and those that are kept since they are the inverse of another.
#[derive(Default)]
pub(super) struct NewIo<'p> {
    /// Those of the program without a counterpart, by what they do.
    pub(super) known: HashMap<String, Vec<&'p IoOperation<'p>>>,
    pub(super) made: BTreeMap<&'p str, IoOperation<'p>>,
    pub(super) kept: BTreeSet<&'p str>,
}

/// Where a sequence begins, if its first statement about the arm is a move to a place with a name.
#[derive(Clone, Debug)]
pub(super) struct FirstMove<'p> {
    pub(super) spot: Spot<'p>,
    pub(super) is_linear: bool,
}

/// What a call does to the arm.
#[derive(Clone, Debug)]
pub(super) enum Summary<'p> {
    /// It ends where it began.
    Stays,
    /// It goes some way.
    Strays,
    /// It goes to a place with a name first, and ends at another.
    Goes(Box<FirstMove<'p>>, Spot<'p>),
    /// It has been refused.
    Refused,
}

/// A statement of an inverse.
pub(super) struct Emitted<'p> {
    pub(super) statement: Statement<'p>,
    /// For a call: the move that it begins with.
    pub(super) first_move: Option<FirstMove<'p>>,
}

impl<'p> Emitted<'p> {
    pub(super) fn new(kind: StatementKind<'p>, span: Span) -> Self {
        Self { statement: Statement { kind, span }, first_move: None }
    }

    /// Whether it is a move that the next statement begins with anyway.
    fn is_repeated_by(&self, next: &Self) -> bool {
        let (StatementKind::Move { target, linear, always: None }, Some(first)) =
            (&self.statement.kind, &next.first_move)
        else {
            return false;
        };
        let spot = Spot::of(target, first.spot.tool);
        *linear == first.is_linear && spot.is_some_and(|spot| spot.is_same(&first.spot))
    }
}

impl<'p> Inverter<'p> {
    pub(super) fn new(plan: &'p Plan<'p>, entries: HashMap<&'p str, Facts<'p>>) -> Self {
        let mut io = NewIo::default();
        for one in plan.io_operations().filter(|one| one.counterpart.is_none()) {
            io.known.entry(body_text(&one.primitives)).or_default().push(one);
        }
        Self {
            plan,
            entries,
            summaries: HashMap::new(),
            refusals: Refusals::default(),
            io,
            facts: Facts::default(),
            arm: Arm::new(),
            tool: None,
            opaque: Vec::new(),
            name: "",
            parameters: Vec::new(),
            first_call: None,
            first_move: None,
        }
    }

    /// The I/O operations that the inverses need beside those of the program.
    ///
    /// # Errors
    /// What has no inverse.
    pub(super) fn into_result(self) -> Result<NewIo<'p>, Vec<Diagnostic>> {
        self.refusals.into_result().map(|()| self.io)
    }

    pub(super) fn refuse(&mut self, diagnostic: Diagnostic) {
        self.refusals.add(diagnostic, self.plan.calls_to(self.name));
    }

    /// Refuses what reads the outside: it may say something else when the inverse runs.
    pub(super) fn require_pure(&mut self, expression: &Expression<'p>) {
        if let Some(span) = pure::reading(expression) {
            let message = "what depends on a reading or a random draw has no inverse";
            self.refuse(
                refusal(span, message, "this may say something else when the inverse runs")
                    .with_help("keep it out of the sequence, for example as a parameter"),
            );
        }
    }

    /// The inverse of a sequence. What is called in it has been inverted.
    pub(super) fn sequence(&mut self, sequence: &'p Sequence<'p>) -> Sequence<'p> {
        self.facts = self.entries.get(sequence.name.value).cloned().unwrap_or_default();
        self.name = sequence.name.value;
        (self.arm, self.tool) = (Arm::new(), None);
        let names = sequence.parameters.iter().map(|parameter| parameter.name.value);
        self.parameters = names.collect();
        (self.first_call, self.first_move) = (None, None);
        self.refuse_names_given_twice(sequence);
        let refused_before = self.refusals.len();
        let head = self.head(sequence);
        let body = self.statements(&sequence.body.statements[head.len..]);
        let is_refused = self.refusals.len() > refused_before || self.arm.is_refused();
        let first = self.head_of_inverse(&head, sequence, is_refused);
        let is_refused = is_refused || self.refusals.len() > refused_before;
        let summary = match (&self.first_move, self.arm.spot()) {
            _ if is_refused => Summary::Refused,
            (Some(first), Some(last)) => Summary::Goes(Box::new(first.clone()), last.clone()),
            (None, _) if self.arm.is_same(&Arm::new()) => Summary::Stays,
            _ => Summary::Strays,
        };
        self.summaries.insert(sequence.name.value, summary);
        let statements = joined(first.into_iter().chain(body).collect());
        Sequence {
            name: self.plan.inverse_name(sequence.name),
            is_action: sequence.is_action,
            parameters: sequence.parameters.clone(),
            body: Block { statements, span: sequence.body.span },
            span: sequence.span,
        }
    }

    /// Blocks change places in an inverse, and with them the variables that are seen in both.
    fn refuse_names_given_twice(&mut self, sequence: &'p Sequence<'p>) {
        let mut declared: BTreeMap<&str, Span> = BTreeMap::new();
        let mut found = Vec::new();
        walk::each_in(&sequence.body, &mut |statement| {
            let (name, is_variable) = match &statement.kind {
                StatementKind::Variable(variable) => (variable.name, true),
                StatementKind::For { name, .. } => (*name, false),
                _ => return,
            };
            let Some(first) = declared.insert(name.value, name.span) else { return };
            if is_variable {
                let message = format!("`{}` is declared twice in this sequence", name.value);
                found.push(
                    refusal(name.span, &message, "the inverse could not tell them apart")
                        .with_label(first, "the first is here")
                        .with_help("give one of them another name"),
                );
            }
        });
        found.into_iter().for_each(|diagnostic| self.refuse(diagnostic));
    }

    /// The inverse of a block, at its place.
    pub(super) fn block(&mut self, block: &'p Block<'p>) -> Block<'p> {
        let statements = self.statements(&block.statements);
        Block { statements: joined(statements), span: block.span }
    }

    /// The inverses of statements in a row, in reverse order.
    fn statements(&mut self, statements: &'p [Statement<'p>]) -> Vec<Emitted<'p>> {
        let mut groups: Vec<Vec<Emitted<'p>>> = Vec::new();
        let variables = self.variables(statements);
        let mut index = 0;
        while let Some(statement) = statements.get(index) {
            let unit = index..index + unit_length(&statements[index..]);
            index = unit.end;
            let mut group = match statement.kind {
                StatementKind::Variable(_) => Vec::new(),
                // Only the statements in its blocks are followed on the way.
                _ if statement.blocks().is_empty() => self.unit(&statements[unit.clone()]),
                _ => {
                    let facts = self.facts.clone();
                    let group = self.unit(&statements[unit.clone()]);
                    self.facts = facts;
                    group
                }
            };
            for statement in &statements[unit.clone()] {
                self.facts.after(statement, self.plan);
                self.forget_changed(statement);
            }
            let last_used = |range: &Range<usize>| unit.contains(&(range.end - 1));
            let declared = variables.iter().filter(|(range, _)| last_used(range));
            let declared: Vec<_> = declared
                .filter_map(|(range, variable)| {
                    self.declaration(&statements[range.clone()], variable)
                })
                .collect();
            group.splice(0..0, declared);
            groups.push(group);
        }
        groups.into_iter().rev().flatten().collect()
    }

    /// What the arm was known by may be changed by a statement.
    fn forget_changed(&mut self, statement: &Statement<'p>) {
        let effect = Effect::of_statement(statement, self.plan);
        for name in effect.variables() {
            self.arm.forget(name, statement.span);
        }
        if effect.is_open() {
            let plan = self.plan;
            self.arm.forget_all(|name| plan.is_constant(name), statement.span);
        }
    }

    /// The inverse of a statement, or of an output with the settling times after it.
    fn unit(&mut self, unit: &'p [Statement<'p>]) -> Vec<Emitted<'p>> {
        let [statement, settling @ ..] = unit else { return Vec::new() };
        let span = statement.span;
        let one = |kind| vec![Emitted::new(kind, span)];
        match &statement.kind {
            StatementKind::Move { target, linear, always } => {
                self.motion(target, *linear, *always, span)
            }
            StatementKind::Call { name, arguments } => self.call(*name, arguments, span),
            StatementKind::Primitive(primitive) => self.output(primitive, settling, span),
            StatementKind::Io(name) => self.io_operation(*name, span).into_iter().collect(),
            StatementKind::Advance(name) => match self.advanced_move(*name, span) {
                Some(inverse) => one(StatementKind::Advance(inverse)),
                None => {
                    self.arm = Arm::refused();
                    Vec::new()
                }
            },
            StatementKind::Wait(time) => {
                self.require_pure(time);
                one(statement.kind.clone())
            }
            StatementKind::WaitUntil { otherwise: None, timeout, .. } => {
                self.require_pure(timeout);
                one(statement.kind.clone())
            }
            StatementKind::Checkpoint(_) => one(statement.kind.clone()),
            StatementKind::Assign { name, operator, value } => {
                self.assign(*name, *operator, value, span).into_iter().collect()
            }
            StatementKind::If { .. }
            | StatementKind::While { .. }
            | StatementKind::Repeat { .. }
            | StatementKind::For { .. } => self.control(statement).into_iter().collect(),
            StatementKind::Speed { block: Some(block), speed } => {
                let block = Some(self.block(block));
                one(StatementKind::Speed { speed: *speed, block })
            }
            StatementKind::Tool { block: Some(block), name } => {
                let outer = self.tool.replace(name.value);
                let block = Some(self.block(block));
                self.tool = outer;
                one(StatementKind::Tool { name: *name, block })
            }
            StatementKind::SkipInReverse(block) => one(self.skipped(block, span)),
            StatementKind::ReplaceInReverse { block, replacement } => {
                one(self.replaced(block, replacement, span))
            }
            StatementKind::KeepInReverse(block) => one(self.kept(block, span)),
            StatementKind::Fork(branches) => {
                if let Some(refused) = self.plan.checked.refusal_of_fork(span) {
                    self.refuse(refused);
                }
                one(StatementKind::Fork(branches.iter().map(|branch| self.block(branch)).collect()))
            }
            StatementKind::Variable(_) | StatementKind::Allow(_) => Vec::new(),
            StatementKind::WithInReverse { .. }
            | StatementKind::WaitUntil { .. }
            | StatementKind::Remember(_)
            | StatementKind::Loop(_)
            | StatementKind::Break
            | StatementKind::Return
            | StatementKind::Speed { .. }
            | StatementKind::Tool { .. }
            | StatementKind::Barrier(_)
            | StatementKind::Irreversible { .. }
            | StatementKind::Throw(_)
            | StatementKind::Requires { .. } => {
                self.refuse(never(statement));
                self.arm = Arm::refused();
                Vec::new()
            }
        }
    }
}

/// How many statements are one: an output and the settling times after it, or any other.
fn unit_length(statements: &[Statement<'_>]) -> usize {
    let is_output = |statement: &Statement<'_>| {
        matches!(
            statement.kind,
            StatementKind::Primitive(Primitive::Set { .. } | Primitive::Toggle { .. })
        )
    };
    let is_sleep = |statement: &&Statement<'_>| {
        matches!(statement.kind, StatementKind::Primitive(Primitive::Sleep { .. }))
    };
    match statements.first().is_some_and(is_output) {
        true => 1 + statements[1..].iter().take_while(is_sleep).count(),
        false => 1,
    }
}

/// The statements, without moves that what follows begins with.
fn joined(emitted: Vec<Emitted<'_>>) -> Vec<Statement<'_>> {
    let repeated: Vec<bool> = (0..emitted.len())
        .map(|index| emitted.get(index + 1).is_some_and(|next| emitted[index].is_repeated_by(next)))
        .collect();
    let kept = emitted.into_iter().zip(repeated).filter(|(_, is_repeated)| !is_repeated);
    kept.map(|(emitted, _)| emitted.statement).collect()
}

/// What is said of a statement that has no inverse whatever stands around it.
fn never(statement: &Statement<'_>) -> Diagnostic {
    let (message, why, help) = match &statement.kind {
        StatementKind::WaitUntil { .. } => (
            "a wait with an `else` has no inverse",
            "which way is taken depends on the input",
            "put it in front of the sequence",
        ),
        StatementKind::Remember(_) => (
            "a remembered position has no inverse",
            "where the arm is here is only known when the program runs",
            "name the place with `joints`",
        ),
        StatementKind::Loop(_) => (
            "a loop without a condition has no inverse",
            "an inverse would not know how often it went round",
            "count it by `repeat` or `for`",
        ),
        StatementKind::Break | StatementKind::Return => (
            "a way out of the middle has no inverse",
            "an inverse would not know that it was taken",
            "use `if .. else ..`, or `while .. entered when ..`",
        ),
        StatementKind::Speed { .. } | StatementKind::Tool { .. } => (
            "a setting that begins in the middle of a sequence has no inverse",
            "what it was before is not known",
            "give it a block, or set it where the sequence begins",
        ),
        StatementKind::WithInReverse { .. } => (
            "a block that is gone back over otherwise than it came has no inverse",
            "an inverse has no words for how this was done going forward",
            "leave the parameters out, or give them to the inverse by hand",
        ),
        StatementKind::Barrier(_) | StatementKind::Irreversible { .. } => (
            "what cannot be taken back has no inverse",
            "the program says that this is not taken back",
            "invert what is before it and what is after it by themselves",
        ),
        _ => (
            "a `throw` has no inverse",
            "what follows depends on how the error is recovered from",
            "check what it is thrown for before the sequence, and leave it out of this one",
        ),
    };
    let reason = match &statement.kind {
        StatementKind::Barrier(reason) | StatementKind::Irreversible { reason, .. } => Some(reason),
        _ => None,
    };
    let diagnostic = refusal(statement.span, message, why).with_help(help);
    match reason {
        Some(Spanned { value, .. }) => diagnostic.with_note(format!("its reason: {value}")),
        None => diagnostic,
    }
}
