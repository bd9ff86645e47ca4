//! What the writer gives to the layout: pieces of text with what must be known to set them, and
//! blocks of members. Neither words nor columns of the output are known here.

use std::borrow::Cow;

/// What stands between a piece and the one before on a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Glue {
    /// Nothing.
    Tight,
    /// A blank.
    Blank,
    /// A blank, or a new line where there is no room. So deep in an expression: a line is broken
    /// where it is least deep.
    Break(u16),
}

/// Where lines of a kind that follow each other are aligned, in the order in which these places
/// stand on a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Column {
    /// Where the line begins.
    Start,
    /// The `=` of a declaration.
    Value,
    /// The `{` of a declaration, or of a branch.
    Block,
    /// What follows the n-th `;`.
    Member(usize),
    /// The words about reversal that end a line.
    Reversal,
}

/// A comment, with its slashes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comment<'s> {
    pub(super) text: &'s str,
    /// Whether it stands on the line of what is before it.
    pub(super) is_trailing: bool,
    /// Whether a blank line stands before it.
    pub(super) is_apart: bool,
}

/// What was written between two tokens.
#[derive(Clone, Debug, Default)]
pub(super) struct Gap<'s> {
    pub(super) comments: Vec<Comment<'s>>,
    /// Whether the line ends in it.
    pub(super) has_newline: bool,
    /// Whether a blank line stands after the last comment.
    pub(super) has_blank_line: bool,
}

/// A token, or several that are never parted.
#[derive(Clone, Debug)]
pub(super) struct Piece<'s> {
    pub(super) text: Cow<'s, str>,
    pub(super) glue: Glue,
    pub(super) gap: Gap<'s>,
    /// Where it is aligned with others.
    pub(super) column: Option<Column>,
    /// Whether it begins a further branch of a statement: `else`, `in reverse`.
    pub(super) is_link: bool,
}

/// A part of a statement, clause or declaration.
#[derive(Clone, Debug)]
pub(super) enum Node<'s> {
    Piece(Piece<'s>),
    Block(Braces<'s>),
}

/// A block with its braces.
#[derive(Clone, Debug)]
pub(super) struct Braces<'s> {
    pub(super) open: Piece<'s>,
    pub(super) members: Vec<Member<'s>>,
    pub(super) close: Piece<'s>,
    /// Whether it stands on several lines even if it fits on one.
    pub(super) is_broken: bool,
    /// Whether what follows a `;` in it is aligned with the same in the lines around.
    pub(super) is_table: bool,
}

/// A declaration, a statement, a clause: what may have a line of its own. It begins with a piece.
#[derive(Clone, Debug)]
pub(super) struct Member<'s> {
    pub(super) nodes: Vec<Node<'s>>,
    /// Whether it was written on the line where the one before it ends.
    pub(super) is_in_row: bool,
}

/// A whole file.
#[derive(Clone, Debug)]
pub(super) struct File<'s> {
    pub(super) members: Vec<Member<'s>>,
    /// What stands after the last member.
    pub(super) end: Gap<'s>,
}

impl Gap<'_> {
    const fn none() -> Self {
        Self { comments: Vec::new(), has_newline: false, has_blank_line: false }
    }
}

impl<'s> Node<'s> {
    /// The piece that it begins with.
    pub(super) fn first(&self) -> &Piece<'s> {
        match self {
            Self::Piece(piece) => piece,
            Self::Block(braces) => &braces.open,
        }
    }

    /// Whether it can stand on one line: there is no comment in it, nor anything that asks for
    /// lines of its own.
    fn is_flat(&self) -> bool {
        match self {
            Self::Piece(piece) => piece.gap.comments.is_empty(),
            Self::Block(braces) => {
                let is_plain =
                    (!braces.is_broken || braces.is_empty()) && braces.open.gap.comments.is_empty();
                let inside = |member: &Member<'_>| member.nodes.iter().all(Node::is_flat);
                is_plain
                    && braces.close.gap.comments.is_empty()
                    && braces.members.iter().all(inside)
            }
        }
    }
}

impl Braces<'_> {
    /// Whether there is nothing in it, not even a comment.
    pub(super) fn is_empty(&self) -> bool {
        self.members.is_empty() && self.close.gap.comments.is_empty()
    }
}

impl<'s> Member<'s> {
    /// What was written before it.
    pub(super) fn gap(&self) -> &Gap<'s> {
        self.nodes.first().map_or(const { &Gap::none() }, |node| &node.first().gap)
    }

    /// Its first word.
    pub(super) fn key(&self) -> &str {
        self.nodes.first().map_or("", |node| &node.first().text)
    }

    /// Puts a blank line before it, if so asked.
    pub(super) fn set_apart(&mut self, is_apart: bool) {
        if let Some(Node::Piece(piece)) = self.nodes.first_mut() {
            piece.gap.has_blank_line |= is_apart;
        }
    }

    /// Whether it can stand on one line, comments before it aside.
    pub(super) fn is_flat(&self) -> bool {
        self.nodes.iter().skip(1).all(Node::is_flat)
    }

    /// Whether it has no block.
    pub(super) fn is_plain(&self) -> bool {
        self.nodes.iter().all(|node| matches!(node, Node::Piece(_)))
    }
}
