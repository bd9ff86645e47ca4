//! What a name means where: the scopes of declarations and blocks, and what is known by its name
//! alone, such as checkpoints. It knows no syntax tree.

use super::{Occurrence, Role, Symbol, SymbolId, SymbolKind, Symbols};
use obverse_syntax::ast::Name;
use obverse_syntax::span::Span;
use std::collections::HashMap;

/// Everywhere.
pub(super) const EVERYWHERE: Span = Span { start: 0, end: u32::MAX };

/// Where a scope began.
#[must_use = "a scope that is not closed is seen for ever"]
pub(super) struct Scope(usize);

/// What is found while a tree is walked.
#[derive(Default)]
pub(super) struct Scopes<'s> {
    found: Symbols,
    visible: HashMap<&'s str, SymbolId>,
    hidden: Vec<(&'s str, Option<SymbolId>)>,
    /// What is one thing wherever it is named: by kind and name.
    shared: HashMap<(SymbolKind, &'s str), SymbolId>,
    keyframes: HashMap<(SymbolId, &'s str), SymbolId>,
    /// Keyframes of parameters: which item is meant is not known, so that it is all that have it.
    of_any_item: Vec<Name<'s>>,
    /// Uses of checkpoints, which may be set further down.
    checkpoints: Vec<Name<'s>>,
}

impl<'s> Scopes<'s> {
    /// A further thing, which no name leads to yet.
    pub(super) fn add(
        &mut self,
        name: Name<'s>,
        kind: SymbolKind,
        whole: Span,
        scope: Span,
        parent: Option<SymbolId>,
    ) -> SymbolId {
        let declared = vec![name.span];
        let name_text = name.value.to_owned();
        let symbol =
            Symbol { name: name_text, kind, declared, whole, scope, parent, of_type: None };
        self.found.symbols.push(symbol);
        let id = self.found.symbols.len() - 1;
        self.note(name.span, Some(id), Role::Declares);
        id
    }

    /// A name leads to a thing from here on.
    pub(super) fn show(&mut self, name: &'s str, symbol: SymbolId) {
        let before = self.visible.insert(name, symbol);
        self.hidden.push((name, before));
    }

    /// Begin a scope.
    pub(super) fn open(&self) -> Scope {
        Scope(self.hidden.len())
    }

    /// End a scope: what was shown in it is not seen any more.
    pub(super) fn close(&mut self, scope: &Scope) {
        for (name, before) in self.hidden.drain(scope.0..).rev() {
            match before {
                Some(symbol) => self.visible.insert(name, symbol),
                None => self.visible.remove(name),
            };
        }
    }

    /// What a name leads to here.
    pub(super) fn find(&self, name: &str) -> Option<SymbolId> {
        self.visible.get(name).copied()
    }

    /// The kind of a thing.
    pub(super) fn kind(&self, symbol: SymbolId) -> SymbolKind {
        self.found.symbols[symbol].kind
    }

    /// A name stands here.
    pub(super) fn note(&mut self, span: Span, symbol: Option<SymbolId>, role: Role) {
        self.found.occurrences.push(Occurrence { span, symbol, role });
    }

    /// A name is used here that leads to what can be seen.
    pub(super) fn use_name(&mut self, name: Name<'s>, role: Role) -> Option<SymbolId> {
        let symbol = self.find(name.value);
        self.note(name.span, symbol, role);
        symbol
    }

    /// A thing is named again where it could be declared.
    pub(super) fn declare_again(&mut self, symbol: SymbolId, at: Span) {
        self.found.symbols[symbol].declared.push(at);
        self.note(at, Some(symbol), Role::Declares);
    }

    /// The name of what is not the program's own.
    pub(super) fn use_foreign(&mut self, name: Name<'s>, kind: SymbolKind) {
        let next = self.found.symbols.len();
        let id = *self.shared.entry((kind, name.value)).or_insert(next);
        if id == next {
            self.found.symbols.push(Symbol {
                name: name.value.to_owned(),
                kind,
                declared: Vec::new(),
                whole: Span::default(),
                scope: EVERYWHERE,
                parent: None,
                of_type: None,
            });
        }
        self.note(name.span, Some(id), Role::Uses);
    }

    /// A checkpoint is set.
    pub(super) fn set_checkpoint(&mut self, name: Name<'s>, whole: Span, parent: Option<SymbolId>) {
        let key = (SymbolKind::Checkpoint, name.value);
        match self.shared.get(&key) {
            Some(&known) => self.declare_again(known, name.span),
            None => {
                let id = self.add(name, SymbolKind::Checkpoint, whole, EVERYWHERE, parent);
                self.shared.insert(key, id);
            }
        }
    }

    /// A checkpoint is gone back to.
    pub(super) fn use_checkpoint(&mut self, name: Name<'s>) {
        self.checkpoints.push(name);
    }

    /// An item has a keyframe.
    pub(super) fn declare_keyframe(&mut self, name: Name<'s>, whole: Span, item: SymbolId) {
        match self.keyframes.get(&(item, name.value)) {
            Some(&known) => self.declare_again(known, name.span),
            None => {
                let id = self.add(name, SymbolKind::Keyframe, whole, EVERYWHERE, Some(item));
                self.keyframes.insert((item, name.value), id);
            }
        }
    }

    /// A keyframe of an item, or of a parameter that stands for one.
    pub(super) fn use_keyframe(&mut self, name: Name<'s>, item: Option<SymbolId>) {
        match item.filter(|item| self.kind(*item) == SymbolKind::Item) {
            Some(item) => {
                let keyframe = self.keyframes.get(&(item, name.value)).copied();
                self.note(name.span, keyframe, Role::Uses);
            }
            None => self.of_any_item.push(name),
        }
    }

    /// All that was found, in order.
    pub(super) fn finish(mut self) -> Symbols {
        for name in std::mem::take(&mut self.checkpoints) {
            let known = self.shared.get(&(SymbolKind::Checkpoint, name.value)).copied();
            self.note(name.span, known, Role::Uses);
        }
        self.join_keyframes();
        self.found.occurrences.sort_by_key(|one| one.span);
        self.found
    }

    /// A keyframe that is asked of a parameter is one thing, whichever items have it.
    fn join_keyframes(&mut self) {
        let asked = std::mem::take(&mut self.of_any_item);
        let mut by_name: HashMap<&str, Vec<SymbolId>> = HashMap::new();
        for ((_, name), &id) in &self.keyframes {
            by_name.entry(name).or_default().push(id);
        }
        let mut joined: HashMap<SymbolId, SymbolId> = HashMap::new();
        let mut first_of: HashMap<&str, SymbolId> = HashMap::new();
        for name in &asked {
            let Some(ids) = by_name.get(name.value) else { continue };
            let first = ids.iter().copied().min().unwrap_or_default();
            first_of.insert(name.value, first);
            joined.extend(ids.iter().filter(|id| **id != first).map(|id| (*id, first)));
        }
        let mut others: Vec<(SymbolId, SymbolId)> = joined.iter().map(|(a, b)| (*a, *b)).collect();
        others.sort_unstable();
        for (other, first) in others {
            let declared = self.found.symbols[other].declared.clone();
            self.found.symbols[first].declared.extend(declared);
        }
        for one in &mut self.found.occurrences {
            one.symbol = one.symbol.map(|symbol| *joined.get(&symbol).unwrap_or(&symbol));
        }
        for name in asked {
            self.note(name.span, first_of.get(name.value).copied(), Role::Uses);
        }
    }
}
