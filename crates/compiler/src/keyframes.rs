//! Which items reach which parameters, and whether they have the keyframes that are asked of them.
//!
//! A parameter that is an item may be passed on, so that what is asked of it is known only when
//! all sequences are. Knows nothing of motions.

use crate::report::Reports;
use obverse_bytecode::Module;
use obverse_isa::{FunctionId, ItemId, KeyframeId, LocalId};
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Diagnostic;
use obverse_syntax::span::Span;
use std::collections::{HashMap, HashSet};

/// How many parameters are followed in all before it is too much: each item through each
/// parameter it reaches.
const MAX_FOLLOWED: usize = 10_000_000;

/// A parameter of a function.
pub(crate) type Parameter = (FunctionId, LocalId);

/// What is done with the parameters that are items.
#[derive(Debug, Default)]
pub(crate) struct KeyframeFlow {
    asked: HashMap<Parameter, Vec<(KeyframeId, Span)>>,
    passed: HashMap<Parameter, Vec<Parameter>>,
    given: Vec<(ItemId, Parameter, Span)>,
    /// By item, where it is declared.
    declared: Vec<Span>,
}

impl KeyframeFlow {
    /// The next item is declared here.
    pub(crate) fn declare(&mut self, at: Span) {
        self.declared.push(at);
    }

    /// With the place where the item is declared, which may be in another file.
    pub(crate) fn with_item(&self, diagnostic: Diagnostic, item: ItemId) -> Diagnostic {
        match self.declared.get(item.index()) {
            Some(at) => diagnostic.with_label(*at, "the item is declared here"),
            None => diagnostic,
        }
    }

    /// A keyframe of a parameter is moved to.
    pub(crate) fn ask(&mut self, parameter: Parameter, keyframe: KeyframeId, at: Span) {
        self.asked.entry(parameter).or_default().push((keyframe, at));
    }

    /// A parameter is passed on as another.
    pub(crate) fn pass(&mut self, from: Parameter, to: Parameter) {
        self.passed.entry(from).or_default().push(to);
    }

    /// An item is passed as a parameter.
    pub(crate) fn give(&mut self, item: ItemId, to: Parameter, at: Span) {
        self.given.push((item, to, at));
    }

    /// Report the items that lack a keyframe they are asked for.
    pub(crate) fn check(&self, module: &Module, reports: &mut Reports) {
        let mut settled = HashSet::new();
        let mut followed = 0;
        for &(item, parameter, at) in &self.given {
            if followed > MAX_FOLLOWED {
                let message = "items are passed on through too many sequences".to_owned();
                return reports.error(Code::TooMany, at, message, "this item among them");
            }
            if settled.insert((item, parameter)) {
                followed += self.check_item(item, parameter, at, module, reports);
            }
        }
    }

    /// Follow an item through the parameters that it reaches; how many there are.
    fn check_item(
        &self,
        item: ItemId,
        parameter: Parameter,
        at: Span,
        module: &Module,
        reports: &mut Reports,
    ) -> usize {
        let Some(declared) = module.items.get(item.index()) else { return 0 };
        let mut seen = HashSet::from([parameter]);
        let mut reported = HashSet::new();
        let mut to_visit = vec![parameter];
        while let Some(parameter) = to_visit.pop() {
            for &(keyframe, asked_at) in self.asked.get(&parameter).into_iter().flatten() {
                let has = declared.keyframes.iter().any(|known| known.name == keyframe.0);
                if has || !reported.insert(keyframe) {
                    continue;
                }
                let name = &module.keyframes[keyframe.index()];
                let message = format!(
                    "the item `{}` has no keyframe `{name}`, and what it is passed to needs one",
                    declared.name
                );
                let diagnostic =
                    Diagnostic::error(Code::UnknownKeyframe, at, message, "passed here")
                        .with_label(asked_at, "the keyframe is moved to here");
                reports.add_unknown(name, self.with_item(diagnostic, item));
            }
            for &next in self.passed.get(&parameter).into_iter().flatten() {
                if seen.insert(next) {
                    to_visit.push(next);
                }
            }
        }
        seen.len()
    }
}
