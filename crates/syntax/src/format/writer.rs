//! What all of the tree is written with: pieces, lists, blocks. Each piece is the next token of the
//! source, if there is one, so that comments stay where they are; and else the text that the tree
//! asks for. It knows no grammar.

use super::cursor::Cursor;
use super::piece::{Braces, Column, File, Gap, Glue, Member, Node, Piece};
use crate::ast::Program;
use std::borrow::Cow;

/// Makes pieces of a tree.
pub(super) struct Writer<'s> {
    source: Option<Cursor<'s>>,
    /// The nodes of the member in hand.
    nodes: Vec<Node<'s>>,
    /// What the next piece has before it, in place of what is usual for it.
    glue: Option<Glue>,
    /// Where the next piece is aligned.
    column: Option<Column>,
    /// Whether the next piece begins a branch.
    is_link: bool,
    /// How deep in an expression it is.
    pub(super) nesting: u16,
}

/// How a block is set.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Style {
    /// Without a source: whether it stands on several lines.
    pub(super) is_broken: bool,
    /// Whether it is aligned with those of the lines around.
    pub(super) is_table: bool,
}

impl Style {
    /// Of a declaration.
    pub(super) fn table(is_broken: bool) -> Self {
        Self { is_broken, is_table: true }
    }
}

impl<'s> Writer<'s> {
    /// With the tokens of a source text.
    pub(super) fn of_source(source: &'s str) -> Self {
        Self { source: Some(Cursor::new(source)), ..Self::of_tree() }
    }

    /// With what the tree says alone.
    pub(super) fn of_tree() -> Self {
        let (source, nodes, glue, column) = (None, Vec::new(), None, None);
        Self { source, nodes, glue, column, is_link: false, nesting: 0 }
    }

    /// A whole file.
    pub(super) fn program(mut self, program: &Program<'s>) -> File<'s> {
        let members = self.items(&program.items);
        self.skip_separators();
        File { members, end: self.take("").1 }
    }

    /// Whether there is a source.
    pub(super) fn has_source(&self) -> bool {
        self.source.is_some()
    }

    /// A word or sign of the language, with a blank before it.
    pub(super) fn word(&mut self, text: &'static str) {
        debug_assert!(self.source.is_none() || self.is_next(text), "not the next token: {text}");
        self.text(text);
    }

    /// Several words.
    pub(super) fn words(&mut self, texts: &[&'static str]) {
        texts.iter().for_each(|text| self.word(text));
    }

    /// A sign with nothing before it.
    pub(super) fn tight(&mut self, text: &'static str) {
        self.glue(Glue::Tight);
        self.word(text);
    }

    /// A word of which the source has perhaps another form.
    pub(super) fn text(&mut self, text: impl Into<Cow<'s, str>>) {
        let piece = self.piece(text.into());
        self.nodes.push(Node::Piece(piece));
    }

    /// Sets what is before the next piece.
    pub(super) fn glue(&mut self, glue: Glue) {
        self.glue.get_or_insert(glue);
    }

    /// Aligns the next piece.
    pub(super) fn column(&mut self, column: Column) {
        self.column = Some(column);
    }

    /// Begins a branch with the next piece.
    pub(super) fn link(&mut self) {
        self.is_link = true;
    }

    /// Whether the source goes on with this token.
    pub(super) fn is_next(&self, text: &str) -> bool {
        self.source.as_ref().is_some_and(|source| source.peek() == text)
    }

    /// How many such tokens follow in the source before a place, if there is a source.
    pub(super) fn count_next(&self, text: &str, end: u32) -> Option<usize> {
        self.source.as_ref().map(|source| source.count(text, end))
    }

    /// Elements with commas between them, in brackets. There is no comma after the last.
    pub(super) fn list<T>(
        &mut self,
        [open, close]: [&'static str; 2],
        elements: &[T],
        write: impl Fn(&mut Self, &T),
    ) {
        self.word(open);
        for (index, element) in elements.iter().enumerate() {
            if index > 0 {
                self.tight(",");
            }
            self.glue(if index > 0 { Glue::Break(self.nesting) } else { Glue::Tight });
            self.nested(|writer| write(writer, element));
        }
        if let Some(source) = &mut self.source {
            source.skip(",");
        }
        self.tight(close);
    }

    /// What is a level deeper in an expression than what is around it.
    pub(super) fn nested(&mut self, write: impl FnOnce(&mut Self)) {
        self.nesting = self.nesting.saturating_add(1);
        write(self);
        self.nesting = self.nesting.saturating_sub(1);
    }

    /// A block.
    pub(super) fn braces<T>(&mut self, members: &[T], style: Style, write: impl Fn(&mut Self, &T)) {
        if style.is_table {
            self.column(Column::Block);
        }
        let open = self.piece(Cow::Borrowed("{"));
        let members = self.members(members, write);
        self.skip_separators();
        let close = self.piece(Cow::Borrowed("}"));
        let has_lines = members.iter().any(|member| member.gap().has_newline);
        let is_broken = match self.source {
            // A line that ends in a member makes no block of several lines.
            Some(_) => has_lines || close.gap.has_newline,
            None => style.is_broken,
        };
        let is_table = style.is_table;
        self.nodes.push(Node::Block(Braces { open, members, close, is_broken, is_table }));
    }

    /// What stands one below the other.
    pub(super) fn members<T>(
        &mut self,
        members: &[T],
        write: impl Fn(&mut Self, &T),
    ) -> Vec<Member<'s>> {
        members.iter().map(|member| self.member(|writer| write(writer, member))).collect()
    }

    /// One of these.
    pub(super) fn member(&mut self, write: impl FnOnce(&mut Self)) -> Member<'s> {
        self.skip_separators();
        let outer = std::mem::take(&mut self.nodes);
        write(self);
        let nodes = std::mem::replace(&mut self.nodes, outer);
        let mut member = Member { nodes, is_in_row: self.source.is_some() };
        member.is_in_row &= !member.gap().has_newline;
        member
    }

    fn skip_separators(&mut self) {
        if let Some(source) = &mut self.source {
            while source.skip(";") {}
        }
    }

    fn piece(&mut self, text: Cow<'s, str>) -> Piece<'s> {
        let glue = self.glue.take().unwrap_or(Glue::Blank);
        let (text, gap) = self.take(text);
        let column = self.column.take();
        Piece { text, glue, gap, column, is_link: std::mem::take(&mut self.is_link) }
    }

    /// The next token of the source, or this one.
    fn take(&mut self, text: impl Into<Cow<'s, str>>) -> (Cow<'s, str>, Gap<'s>) {
        match &mut self.source {
            Some(source) => source.take(),
            None => (text.into(), Gap::default()),
        }
    }
}
