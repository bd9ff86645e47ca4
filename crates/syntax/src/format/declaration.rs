//! Declarations as pieces.

use super::piece::{Column, Glue, Member};
use super::writer::{Style, Writer};
use crate::ast::{
    Allow, Behaviour, Bound, Cause, Change, Continuation, Depth, ErrorClause, Expression, Extent,
    Item, JointsDeclaration, Keyframe, MoveClause, Name, Otherwise, Parameter, Recovery, Respond,
    Sequence, Severity, SignalKind, ValueRange,
};
use crate::span::Spanned;

impl<'s> Writer<'s> {
    /// What stands at the top of a file, each on lines of its own. Without a source, what is long
    /// or of another kind than the one before stands apart from it.
    pub(super) fn items(&mut self, items: &[Item<'s>]) -> Vec<Member<'s>> {
        let mut members = self.members(items, Self::item);
        members.iter_mut().for_each(|member| member.is_in_row = false);
        let is_apart = |pair: &[Item<'s>]| {
            let is_same_kind = std::mem::discriminant(&pair[0]) == std::mem::discriminant(&pair[1]);
            let is_long =
                matches!(pair[1], Item::Sequence(_) | Item::Error(_) | Item::AdvancedMove(_))
                    || matches!(pair[1], Item::Cleanup(_));
            is_long || !is_same_kind
        };
        for (pair, member) in items.windows(2).zip(members.iter_mut().skip(1)) {
            member.set_apart(!self.has_source() && is_apart(pair));
        }
        members
    }

    fn item(&mut self, item: &Item<'s>) {
        match item {
            Item::Cell(path) => {
                self.word("cell");
                self.quoted(path.value);
            }
            Item::Import(import) => {
                self.word("import");
                if import.is_library {
                    self.word("library");
                }
                self.quoted(import.path.value);
            }
            Item::Signal(entry) => {
                self.named(
                    match entry.kind {
                        SignalKind::Output => "output",
                        SignalKind::Input => "input",
                    },
                    entry.name.value,
                );
                self.column(Column::Value);
                self.word("=");
                self.index(entry.number);
            }
            Item::Io(io) => {
                self.named("io", io.name.value);
                self.braces(&io.primitives, Style::table(false), Self::primitive);
                if let Some(counterpart) = io.counterpart {
                    self.column(Column::Reversal);
                    self.named("reverse", counterpart.value);
                }
            }
            Item::Joints(joints) => self.joints(joints),
            Item::ItemDeclaration(item) => {
                self.named("item", item.name.value);
                let style = Style::table(item.keyframes.len() > 1);
                self.braces(&item.keyframes, style, Self::keyframe);
            }
            Item::Error(error) => {
                self.named("error", error.name.value);
                let style = Style::table(error.clauses.len() > 1);
                self.braces(&error.clauses, style, Self::error_clause);
            }
            Item::AdvancedMove(advanced) => {
                self.word("advanced");
                self.named("move", advanced.name.value);
                let style = Style { is_broken: true, is_table: false };
                self.braces(&advanced.clauses, style, Self::move_clause);
                if let Some(counterpart) = advanced.counterpart {
                    self.named("reverse", counterpart.value);
                }
            }
            Item::Variable(variable) => self.variable(variable),
            Item::Sequence(sequence) => self.sequence(sequence),
            Item::Cleanup(cleanup) => {
                self.word("cleanup");
                self.body(&cleanup.body, !cleanup.body.statements.is_empty());
            }
            Item::Allow(allow) => self.allow(allow),
        }
    }

    /// `allow W0001 in file "why"`
    pub(super) fn allow(&mut self, allow: &Allow<'s>) {
        self.named("allow", allow.code.value);
        if allow.in_file {
            self.words(&["in", "file"]);
        }
        self.quoted(allow.reason.value);
    }

    fn joints(&mut self, joints: &JointsDeclaration<'s>) {
        self.named("joints", joints.name.value);
        self.column(Column::Value);
        self.word("=");
        self.vector(&joints.values);
    }

    fn keyframe(&mut self, keyframe: &Keyframe<'s>) {
        self.named("keyframe", keyframe.name.value);
        self.column(Column::Value);
        self.word("=");
        self.vector(&keyframe.position);
        if let Some(rotation) = &keyframe.rotation {
            self.vector(rotation);
        }
    }

    fn sequence(&mut self, sequence: &Sequence<'s>) {
        self.named(if sequence.is_action { "action" } else { "sequence" }, sequence.name.value);
        if !sequence.parameters.is_empty() || self.is_next("(") {
            self.glue(Glue::Tight);
            self.list(["(", ")"], &sequence.parameters, |writer, parameter| {
                writer.parameter(parameter);
            });
        }
        self.body(&sequence.body, !sequence.body.statements.is_empty());
    }

    /// `depth: length in 5 mm to 60 mm = 20 mm`
    fn parameter(&mut self, parameter: &Parameter<'s>) {
        self.text(parameter.name.value);
        self.tight(":");
        self.text(parameter.type_name.value);
        if let Some(ValueRange { least, most }) = &parameter.range {
            self.word("in");
            self.sum(least);
            self.word("to");
            self.sum(most);
        }
        if let Some(default) = &parameter.default {
            self.word("=");
            self.expression(default);
        }
    }

    fn error_clause(&mut self, clause: &Spanned<ErrorClause<'s>>) {
        match &clause.value {
            ErrorClause::Severity(severity) => {
                self.word("severity");
                self.word(match severity {
                    Severity::Warning => "warning",
                    Severity::Recoverable => "recoverable",
                    Severity::Fatal => "fatal",
                });
            }
            ErrorClause::Recover(recovery) => {
                self.word("recover");
                self.recovery(recovery);
            }
            ErrorClause::Otherwise(otherwise) => {
                self.word("otherwise");
                match otherwise {
                    Otherwise::Using(name) => self.named("using", name.value),
                    Otherwise::Operator => self.word("operator"),
                    Otherwise::Stop => self.word("stop"),
                }
            }
            ErrorClause::Respond(respond) => {
                self.word("respond");
                self.words(match respond {
                    Respond::AtOnce => &["at", "once"],
                    Respond::AfterAction => &["after", "current", "action"],
                    Respond::AfterSequence => &["after", "current", "sequence"],
                });
            }
            ErrorClause::Then(continuation) => {
                self.word("then");
                self.words(match continuation {
                    Continuation::Action => &["return", "to", "action"],
                    Continuation::NextAction => &["continue"],
                    Continuation::Sequence => &["return", "to", "sequence"],
                    Continuation::Program => &["restart", "program"],
                    Continuation::Stop => &["stop"],
                });
            }
            ErrorClause::On(causes) => {
                self.word("on");
                self.in_a_row(causes, |writer, cause| match cause {
                    Cause::Fault(fault) => writer.several(fault.value.text()),
                    Cause::Input { input, high, .. } => {
                        writer.word("input");
                        writer.signal(input.value);
                        writer.word(if *high { "high" } else { "low" });
                    }
                    Cause::Force(above) => {
                        writer.words(&["force", ">"]);
                        writer.expression(above);
                    }
                });
            }
            ErrorClause::GiveUp(bounds) => {
                self.words(&["give", "up", "after"]);
                self.in_a_row(bounds, |writer, bound| match bound {
                    Bound::Attempts(times) => {
                        writer.index(*times);
                        writer.word("times");
                    }
                    Bound::Cost(cost) => writer.expression(cost),
                });
            }
        }
    }

    /// One thing or more, with commas between.
    fn in_a_row<T>(&mut self, things: &[T], mut write: impl FnMut(&mut Self, &T)) {
        for (index, thing) in things.iter().enumerate() {
            if index > 0 {
                self.tight(",");
                self.glue(Glue::Break(0));
            }
            write(self, thing);
        }
    }

    /// The words of a text.
    fn several(&mut self, text: &'static str) {
        text.split(' ').for_each(|word| self.word(word));
    }

    fn recovery(&mut self, recovery: &Recovery<'s>) {
        match recovery {
            Recovery::Using(name) => self.named("using", name.value),
            Recovery::Reversing { depth, extent, changes } => {
                self.words(&["by", "reversing"]);
                match depth {
                    Depth::Fixed => {}
                    Depth::Escalating => self.word("escalating"),
                    Depth::Doubling => self.words(&["escalating", "doubling"]),
                    Depth::Learned => self.word("learned"),
                }
                self.extent(*depth, extent);
                for change in changes {
                    self.tight(",");
                    self.glue(Glue::Break(0));
                    match &change.value {
                        Change::Perturbed { within, at_random } => {
                            self.word("perturbed");
                            if *at_random {
                                self.words(&["at", "random"]);
                            }
                            self.expression(within);
                        }
                        Change::Slower => self.word("slower"),
                        Change::Lighter => self.word("lighter"),
                    }
                }
            }
        }
    }

    /// How far; `up` may stand before any of them.
    fn extent(&mut self, depth: Depth, extent: &Extent<'s>) {
        let is_bound = !self.has_source() && depth != Depth::Fixed;
        if is_bound || self.is_next("up") {
            self.word("up");
        }
        match extent {
            Extent::Actions(count) => {
                if is_bound || self.is_next("to") {
                    self.word("to");
                }
                self.index(*count);
                self.text(if count.value == 1 { "action" } else { "actions" });
            }
            Extent::Checkpoint(name) => {
                self.word("to");
                self.named("checkpoint", name.value);
            }
            Extent::Sequence => self.words(&["to", "start", "of", "sequence"]),
        }
    }

    fn move_clause(&mut self, clause: &Spanned<MoveClause<'s>>) {
        match &clause.value {
            MoveClause::Requires { condition, otherwise } => {
                self.requires(condition, otherwise.as_ref());
            }
            MoveClause::Distance { distance, heading, frame } => {
                self.word("distance");
                self.way(distance, heading.value, *frame);
            }
            MoveClause::Turn(turn) => self.turn(turn),
            MoveClause::StopIf(condition) => {
                self.words(&["stop", "if"]);
                self.expression(condition);
            }
            MoveClause::Speed(speed) => self.speed(*speed),
            MoveClause::SucceedsIf(condition) => {
                self.words(&["succeeds", "if"]);
                self.expression(condition);
            }
            MoveClause::OppositeForce => self.words(&["opposite", "force", "in", "reverse"]),
            MoveClause::OnSuccess(behaviours) => self.behaviours("success", behaviours),
            MoveClause::OnFailure(behaviours) => self.behaviours("failure", behaviours),
        }
    }

    /// `requires CONDITION else throw NAME`
    pub(super) fn requires(&mut self, condition: &Expression<'s>, otherwise: Option<&Name<'s>>) {
        self.word("requires");
        self.expression(condition);
        if let Some(error) = otherwise {
            self.word("else");
            self.named("throw", error.value);
        }
    }

    fn behaviours(&mut self, word: &'static str, behaviours: &[Spanned<Behaviour<'s>>]) {
        self.words(&["on", word]);
        let style = Style { is_broken: behaviours.len() > 1, is_table: false };
        self.braces(behaviours, style, |writer, behaviour| match &behaviour.value {
            Behaviour::ReturnToInitialPosition => {
                writer.words(&["return", "to", "initial", "position"]);
            }
            Behaviour::RepeatWithPerturbation { within, times } => {
                writer.words(&["repeat", "with", "perturbation"]);
                if let Some(within) = within {
                    writer.expression(within);
                }
                writer.index(*times);
                writer.word("times");
            }
            Behaviour::Throw(name) => writer.named("throw", name.value),
        });
    }
}
