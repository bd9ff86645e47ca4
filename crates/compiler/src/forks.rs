//! What branches of a fork may not share: devices that they command, variables that they assign.
//!
//! What a function uses itself is gathered once; a branch is then followed through its calls, the
//! nearest first, so that what is reported has the shortest chain of reasons. That is quadratic
//! where many forks call most of the program, and has a bound, beyond which the program is refused.
//! Which devices there are and what each statement uses is in `uses`.

use crate::effects::Effects;
use crate::report::{Reports, warning};
use crate::tree::{Block, Body, Function, Program, StatementKind};
use crate::uses::{Edge, How, Resource, Uses, of_functions};
use obverse_bytecode::FunctionKind;
use obverse_isa::FunctionId;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::{Diagnostic, Label};
use obverse_syntax::span::Span;
use std::collections::{BTreeMap, VecDeque};

/// How many uses and calls are followed for all forks of a program.
const MAX_FOLLOWED: usize = 10_000_000;

/// How many calls of a chain are shown.
const MAX_SHOWN: usize = 6;

/// Report what the branches of each fork share.
pub(crate) fn check(program: &Program, effects: &Effects, reports: &mut Reports) {
    if !has_fork(program) {
        return;
    }
    let functions = of_functions(program, effects);
    let mut follower = Follower { program, effects, functions, followed: 0 };
    let mut is_too_large = false;
    for (_, function) in program.numbered() {
        let Body::Block(block) = &function.body else { continue };
        block.each_statement(&mut |statement| {
            let StatementKind::Fork(branches) = &statement.kind else { return };
            let used = branches.iter().map(|branch| follower.branch(branch)).collect();
            let fork = Fork { program, function, span: statement.span };
            match used {
                Some(used) => fork.check(used, reports),
                // What was too much for one is so for those that follow.
                None if std::mem::replace(&mut is_too_large, true) => {}
                None => fork.report_too_large(reports),
            }
        });
    }
}

fn has_fork(program: &Program) -> bool {
    let mut found = false;
    for (_, function) in program.numbered() {
        if let Body::Block(block) = &function.body {
            let is_fork = |kind: &StatementKind| matches!(kind, StatementKind::Fork(_));
            block.each_statement(&mut |statement| found |= is_fork(&statement.kind));
        }
    }
    found
}

/// How a branch comes to use something: the chain of calls, and what the last function does.
struct Origin {
    calls: Vec<Edge>,
    span: Span,
}

/// What a branch uses, each in each way once.
type Used = BTreeMap<(Resource, How), Origin>;

/// Follows branches through their calls.
struct Follower<'p> {
    program: &'p Program,
    effects: &'p Effects,
    /// What each function uses itself.
    functions: Vec<Uses>,
    followed: usize,
}

/// By function: the call that leads there, and the function that it is in, if any.
type Reached = BTreeMap<FunctionId, (Edge, Option<FunctionId>)>;

impl Follower<'_> {
    /// What a branch uses; none if too much has been followed.
    fn branch(&mut self, branch: &Block) -> Option<Used> {
        let own = Uses::of_block(branch, self.program, self.effects);
        let origin = |span| Origin { calls: Vec::new(), span };
        let mut used: Used = own.uses.iter().map(|(key, span)| (*key, origin(*span))).collect();
        let mut reached = Reached::new();
        let mut to_visit = VecDeque::new();
        follow(&own, None, &mut reached, &mut to_visit);
        while let Some(function) = to_visit.pop_front() {
            let uses = &self.functions[function.index() - 1];
            self.followed += uses.uses.len() + uses.calls.len() + 1;
            if self.followed > MAX_FOLLOWED {
                return None;
            }
            for (key, span) in uses.uses.iter().filter(|(key, _)| !key.0.is_local()) {
                let origin = || Origin { calls: chain(&reached, function), span: *span };
                used.entry(*key).or_insert_with(origin);
            }
            follow(uses, Some(function), &mut reached, &mut to_visit);
        }
        Some(used)
    }
}

/// What is called and has not been reached before is visited later.
fn follow(
    uses: &Uses,
    caller: Option<FunctionId>,
    reached: &mut Reached,
    to_visit: &mut VecDeque<FunctionId>,
) {
    for edge in &uses.calls {
        reached.entry(edge.callee).or_insert_with(|| {
            to_visit.push_back(edge.callee);
            (*edge, caller)
        });
    }
}

/// The calls that lead to a function, from the branch on.
fn chain(reached: &Reached, function: FunctionId) -> Vec<Edge> {
    let mut calls = Vec::new();
    let mut next = Some(function);
    while let Some((edge, caller)) = next.and_then(|function| reached.get(&function)) {
        calls.push(*edge);
        next = *caller;
    }
    calls.reverse();
    calls
}

/// A fork whose branches are compared.
struct Fork<'p> {
    program: &'p Program,
    /// The function that it is in.
    function: &'p Function,
    span: Span,
}

/// Which branch used something first, in each way.
#[derive(Default)]
struct First {
    commands: Option<usize>,
    writes: Option<usize>,
    is_reported: bool,
}

impl Fork<'_> {
    /// Report what branches that use this share, each thing once.
    fn check(&self, used: Vec<Used>, reports: &mut Reports) {
        let mut first: BTreeMap<Resource, First> = BTreeMap::new();
        for how in [How::Commands, How::Writes, How::Reads] {
            for (branch, all) in used.iter().enumerate() {
                for (resource, _) in all.keys().filter(|key| key.1 == how) {
                    let known = first.entry(*resource).or_default();
                    if let Some(other) = clash(known, how, branch) {
                        known.is_reported = true;
                        self.report(*resource, how, [other, branch], &used, reports);
                    }
                }
            }
        }
    }

    fn report(
        &self,
        resource: Resource,
        how: How,
        [first, second]: [usize; 2],
        used: &[Used],
        reports: &mut Reports,
    ) {
        let what = self.name(resource);
        let other = if how == How::Reads { How::Writes } else { how };
        let origins = (used[first].get(&(resource, other)), used[second].get(&(resource, how)));
        let (Some(before), Some(after)) = origins else { return };
        let mut places = self.places(second, after, how, &what);
        let Label { span, text } = places.remove(0);
        let mut diagnostic = match how {
            How::Commands => {
                let message = format!("two branches of this fork use {what}");
                Diagnostic::error(Code::SharedDevice, span, message, text)
                    .with_help("leave it to one branch, or do one after the other without `fork`")
            }
            How::Writes => {
                let message = format!("two branches of this fork assign {what}");
                Diagnostic::error(Code::SharedVariable, span, message, text)
                    .with_note("which of them comes last depends on whose turn it is when")
                    .with_help("give each branch a variable of its own")
            }
            How::Reads => {
                let (reader, writer) = (second + 1, first + 1);
                let message =
                    format!("branch {reader} reads {what}, which branch {writer} assigns");
                warning(Code::ReadsOtherBranch, span, message, text)
                    .with_note("which value that is depends on whose turn it is when")
                    .with_help("read it after the fork, or have one branch do both")
            }
        };
        diagnostic.labels = self.places(first, before, other, &what);
        diagnostic.labels.append(&mut places);
        reports.add(diagnostic.with_label(self.span, "the fork begins here"));
    }

    /// The chain of reasons that a branch uses something, from the branch on.
    fn places(&self, branch: usize, origin: &Origin, how: How, what: &str) -> Vec<Label> {
        let does = how.word();
        let branch = branch + 1;
        let mut labels = Vec::new();
        let mut subject = format!("branch {branch}");
        for (index, edge) in origin.calls.iter().enumerate() {
            let name = self.function_name(edge.callee);
            if index < MAX_SHOWN {
                let text = format!("{subject} {} {name}", edge.word);
                labels.push(Label { span: edge.span, text });
            }
            subject = name;
        }
        let through = match origin.calls.len() {
            0 => String::new(),
            _ => format!(" for branch {branch}"),
        };
        let text = format!("{subject} {does} {what}{through}");
        labels.push(Label { span: origin.span, text });
        labels
    }

    fn function_name(&self, function: FunctionId) -> String {
        let function = self.program.function(function);
        match function.kind {
            FunctionKind::Replacement => "the block in reverse".to_owned(),
            FunctionKind::Cleanup => "the cleanup".to_owned(),
            _ => format!("`{}`", function.name),
        }
    }

    fn name(&self, resource: Resource) -> String {
        match resource {
            Resource::Arm => "the arm".to_owned(),
            Resource::Dice => "the random numbers".to_owned(),
            Resource::Output(bit) => format!("output {bit}"),
            Resource::Global(global) => {
                format!("`{}`", self.program.module.globals[global.index()].name)
            }
            Resource::Local(local) => {
                let known = self.function.layout.locals.get(local.index());
                known.map_or("a variable".to_owned(), |local| format!("`{}`", local.name))
            }
        }
    }

    fn report_too_large(&self, reports: &mut Reports) {
        let message = "the forks of this program call too much to be compared";
        reports.add(
            Diagnostic::error(Code::TooMany, self.span, message, "checked up to here")
                .with_note(format!("{MAX_FOLLOWED} calls and uses are followed")),
        );
    }
}

/// The branch that this one clashes with, if it does and none was reported before.
fn clash(known: &mut First, how: How, branch: usize) -> Option<usize> {
    let other = match how {
        How::Commands => *known.commands.get_or_insert(branch),
        How::Writes => *known.writes.get_or_insert(branch),
        How::Reads => known.writes?,
    };
    (other != branch && !known.is_reported).then_some(other)
}
