//! Motions: where they go, and what their reverse needs.

use super::Checker;
use super::expression::Need;
use super::frame::NamedPosition;
use super::names::{Found, Meaning, Symbol};
use crate::tree::{Expression, ExpressionKind, Motion, StatementKind};
use crate::types::ValueType;
use obverse_isa::{Axis, Frame, ItemId, KeyframeId, Path};
use obverse_syntax::ast::{FrameWord, Heading, Name, Target};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::{Span, Spanned};

/// What a motion goes to where its target is a name.
enum Named {
    Joints(Expression),
    Position(obverse_isa::SlotId),
}

impl<'s> Checker<'s> {
    /// `move …`
    pub(super) fn motion(
        &mut self,
        target: &Target<'s>,
        is_linear: bool,
        always: Option<Span>,
        span: Span,
    ) -> Option<StatementKind> {
        let path = if is_linear { Path::Linear } else { Path::Joint };
        let before = self.frame.named;
        self.lose_position("this motion goes to no joint configuration by name", span);
        let motion = match target {
            Target::Named(name) => match self.named_target(*name)? {
                Named::Joints(joints) => {
                    if let ExpressionKind::Joints(to) = joints.kind {
                        self.frame.named = NamedPosition::Known(to);
                        if let Some(always) = always {
                            return self.always(before, to, path, always);
                        }
                    }
                    Motion::Joints(joints, path)
                }
                Named::Position(slot) => Motion::Position(slot, path),
            },
            Target::Keyframe { item, keyframe } => {
                let (item, keyframe) = self.keyframe_target(*item, *keyframe)?;
                Motion::Keyframe(item, keyframe, path)
            }
            Target::Relative { distance, heading, frame } => {
                let need = Need::new(ValueType::LENGTH, "`move`");
                let distance = self.value(distance, &need);
                let (axis, frame) = direction(heading.value, *frame);
                Motion::Relative(distance, axis, frame)
            }
            Target::Turned(turn) => {
                let angle = self.value(&turn.angle, &Need::new(ValueType::ANGLE, "`turn`"));
                let advance = match &turn.advance {
                    Some(advance) => {
                        self.value(advance, &Need::new(ValueType::LENGTH, "`advancing`"))
                    }
                    None => Expression::real(0.0, ValueType::LENGTH, span),
                };
                let (axis, frame) = direction(turn.heading.value, turn.frame);
                Motion::Turned(angle, advance, axis, frame)
            }
        };
        if let Some(always) = always {
            let message = "only a move to a joint configuration can be reversible always";
            let diagnostic =
                Diagnostic::error(Code::NoNamedPosition, always, message, "asked for here")
                    .with_label(span, "goes elsewhere")
                    .with_help("without it, the move goes back to where it was recorded to begin");
            self.reports.add(diagnostic);
            return None;
        }
        Some(StatementKind::Move(motion))
    }

    /// A move whose reverse goes to the configuration that the program named last.
    fn always(
        &mut self,
        before: NamedPosition,
        to: obverse_isa::JointsId,
        path: Path,
        always: Span,
    ) -> Option<StatementKind> {
        match before {
            NamedPosition::Known(from) => Some(StatementKind::Move(Motion::Always(from, to, path))),
            NamedPosition::Lost(why, place) => {
                let message = "which position the program named last is not known here";
                let diagnostic =
                    Diagnostic::error(Code::NoNamedPosition, always, message, "asked for here")
                        .with_label(place, why)
                        .with_help("name a joint configuration just before, or leave this out");
                self.reports.add(diagnostic);
                None
            }
        }
    }

    fn named_target(&mut self, name: Name<'s>) -> Option<Named> {
        let is_target = |meaning| match meaning {
            Meaning::Joints(_) | Meaning::Position(_) => true,
            Meaning::Global(_, of_type) | Meaning::Local(_, of_type) => {
                matches!(of_type, ValueType::Joints | ValueType::Unknown)
            }
            _ => false,
        };
        if let Found::Here(Symbol { meaning: Meaning::Item(item), name: declared, .. }) =
            self.names.find(name.value)
        {
            self.report_whole_item(name, declared.span, item);
            return None;
        }
        let meaning = self.resolve(name, "a joint configuration or a position", is_target)?;
        let kind = match meaning {
            Meaning::Position(slot) => return Some(Named::Position(slot)),
            Meaning::Joints(joints) => ExpressionKind::Joints(joints),
            Meaning::Global(global, ValueType::Joints) => ExpressionKind::Global(global),
            Meaning::Local(local, ValueType::Joints) => ExpressionKind::Local(local),
            _ => return None,
        };
        let of_type = ValueType::Joints;
        Some(Named::Joints(Expression { kind, of_type, span: name.span }))
    }

    /// `move to block` without a keyframe.
    fn report_whole_item(&mut self, name: Name<'s>, declared: Span, item: ItemId) {
        self.names.mark_used(name.value);
        let message = format!("`{}` is an item, and one of its keyframes is needed", name.value);
        let known = self.known_keyframes(item);
        let targets: Vec<String> =
            known.iter().map(|keyframe| format!("`{}.{keyframe}`", name.value)).collect();
        let help = match targets.as_slice() {
            [] => format!("give it one: `item {} {{ keyframe grasp = .. }}`", name.value),
            [only] => format!("write {only}"),
            [first, ..] => format!("write for example {first}; it has {}", known.join(", ")),
        };
        let diagnostic =
            Diagnostic::error(Code::WrongKind, name.span, message, "which keyframe of it?")
                .with_label(declared, "an item, declared here")
                .with_help(help);
        self.reports.add(diagnostic);
    }

    /// The names of an item's keyframes.
    fn known_keyframes(&self, item: ItemId) -> Vec<String> {
        let keyframes = self.module.items.get(item.index()).map(|item| &item.keyframes[..]);
        let names = keyframes
            .unwrap_or_default()
            .iter()
            .filter_map(|known| self.module.keyframes.get(usize::from(known.name)).cloned());
        names.collect()
    }

    fn keyframe_target(
        &mut self,
        item: Name<'s>,
        keyframe: Name<'s>,
    ) -> Option<(Expression, KeyframeId)> {
        let is_item = |meaning| {
            matches!(
                meaning,
                Meaning::Item(_) | Meaning::Local(_, ValueType::Item | ValueType::Unknown)
            )
        };
        let meaning = self.resolve(item, "an item", is_item)?;
        let id = self.keyframe(keyframe);
        let kind = match meaning {
            Meaning::Item(declared) => {
                let has_it = self.module.items.get(declared.index()).is_some_and(|declared| {
                    declared.keyframes.iter().any(|known| known.name == id.0)
                });
                if !has_it {
                    self.report_no_keyframe(item, keyframe, declared);
                    return None;
                }
                ExpressionKind::Item(declared)
            }
            Meaning::Local(local, ValueType::Item) => {
                self.keyframes.ask(self.parameter(local), id, keyframe.span);
                ExpressionKind::Local(local)
            }
            _ => return None,
        };
        Some((Expression { kind, of_type: ValueType::Item, span: item.span }, id))
    }

    fn report_no_keyframe(&mut self, item: Name<'s>, keyframe: Name<'s>, declared: ItemId) {
        let message = format!("the item `{}` has no keyframe `{}`", item.value, keyframe.value);
        let diagnostic =
            Diagnostic::error(Code::UnknownKeyframe, keyframe.span, message, "not one of its own");
        let mut diagnostic = self.keyframes.with_item(diagnostic, declared);
        let known = self.known_keyframes(declared);
        let meant = self.reports.meant(keyframe.value, known.iter().map(String::as_str));
        diagnostic = match meant {
            Some(meant) => diagnostic.did_you_mean(keyframe.span, meant),
            None if known.is_empty() => diagnostic.with_note("it has none"),
            None => diagnostic.with_note(format!("it has {}", known.join(", "))),
        };
        self.reports.add_unknown(keyframe.value, diagnostic);
    }
}

/// What a heading means in a frame, which is the tool centre point's where none is named. The tool
/// looks along its z axis, with x to the right and y downwards; the base looks along x, with y to
/// the left and z upwards.
pub(super) fn direction(heading: Heading, frame: Option<Spanned<FrameWord>>) -> (Axis, Frame) {
    let frame = match frame.map(|frame| frame.value) {
        Some(FrameWord::Base) => Frame::Base,
        Some(FrameWord::ToolMount) => Frame::ToolMount,
        Some(FrameWord::Tcp) | None => Frame::Tcp,
    };
    let is_base = frame == Frame::Base;
    let axis = match heading {
        Heading::X => Axis::PlusX,
        Heading::Y => Axis::PlusY,
        Heading::Z => Axis::PlusZ,
        Heading::MinusX => Axis::MinusX,
        Heading::MinusY => Axis::MinusY,
        Heading::MinusZ => Axis::MinusZ,
        Heading::Forward if is_base => Axis::PlusX,
        Heading::Backward if is_base => Axis::MinusX,
        Heading::Left if is_base => Axis::PlusY,
        Heading::Right if is_base => Axis::MinusY,
        Heading::Up if is_base => Axis::PlusZ,
        Heading::Down if is_base => Axis::MinusZ,
        Heading::Forward => Axis::PlusZ,
        Heading::Backward => Axis::MinusZ,
        Heading::Left => Axis::MinusX,
        Heading::Right => Axis::PlusX,
        Heading::Up => Axis::MinusY,
        Heading::Down => Axis::PlusY,
    };
    (axis, frame)
}
