//! Pieces to lines: what stands on one line, where a line is broken, where comments go. It knows
//! no words of the language.

use super::line::{Key, Line, Lines};
use super::piece::{Braces, Column, Comment, File, Gap, Glue, Member, Node, Piece};
use super::{INDENT, MAX_COLUMNS};

/// How much further to the right a broken line goes on.
const CONTINUATION: usize = 2 * INDENT;

/// The text of a file.
pub(super) fn text(file: &File<'_>) -> String {
    let mut layout = Layout::default();
    layout.members(&file.members, 0);
    layout.comments(&file.end.comments, 0);
    layout.lines.into_text()
}

/// The text of a member on one line, however long.
pub(super) fn line(member: &Member<'_>) -> String {
    let mut cells = Cells::default();
    cells.nodes(&member.nodes, false, false);
    cells.0.into_iter().map(|(_, text)| text).collect()
}

#[derive(Default)]
struct Layout<'s> {
    lines: Lines<'s>,
    /// How many tables there have been.
    tables: usize,
}

impl<'s> Layout<'s> {
    fn members(&mut self, members: &[Member<'s>], indent: usize) {
        let mut rest = members;
        while let [first, ..] = rest {
            self.gap(first.gap(), indent);
            let count = row_length(rest, indent);
            let (row, after) = rest.split_at(count);
            match row {
                [one] => self.member(one, indent),
                _ => {
                    let mut cells = Cells::default();
                    cells.row(row, true);
                    self.lines.push(Line::new(indent, cells.0, Key::word(first.key())));
                }
            }
            rest = after;
        }
    }

    fn member(&mut self, member: &Member<'s>, indent: usize) {
        if member.is_flat() {
            let branches = branches(&member.nodes);
            let fits = |cells: &Vec<Cell>| indent + width(cells) <= MAX_COLUMNS;
            let is_table = branches.len() > 1;
            let lines: Vec<Vec<Cell>> =
                branches.into_iter().map(|branch| cells_of(branch, is_table)).collect();
            if lines.iter().all(fits) {
                let key = match lines.as_slice() {
                    [_] => Key::word(member.key()),
                    _ => {
                        self.tables += 1;
                        Key::Table(self.tables)
                    }
                };
                for cells in lines {
                    self.lines.push(Line::new(indent, cells, key.clone()));
                }
                return;
            }
        }
        self.broken(&member.nodes, indent);
    }

    /// What does not stand on one line: all its blocks stand on several, and what is between them
    /// is broken where there is no room.
    fn broken(&mut self, nodes: &[Node<'s>], indent: usize) {
        let mut line = OpenLine { indent, text: String::new() };
        for (index, node) in nodes.iter().enumerate() {
            let piece = node.first();
            if index > 0 && !piece.gap.comments.is_empty() {
                self.close(&mut line, indent + if piece.is_link { 0 } else { CONTINUATION });
                self.comments(&piece.gap.comments, line.indent);
            } else if let Glue::Break(depth) = piece.glue
                && line.width() + unbroken(&nodes[index..], depth) > MAX_COLUMNS
            {
                self.close(&mut line, indent + CONTINUATION);
            }
            line.push(piece);
            let Node::Block(braces) = node else { continue };
            if braces.is_empty() {
                line.text.push('}');
            } else {
                self.close(&mut line, indent);
                self.inside(braces, indent + INDENT);
                line.text.push('}');
            }
        }
        self.close(&mut line, indent);
    }

    /// What is between braces.
    fn inside(&mut self, braces: &Braces<'s>, indent: usize) {
        self.lines.begin_block();
        self.members(&braces.members, indent);
        self.comments(&braces.close.gap.comments, indent);
    }

    /// Ends a line, the next being so far to the right.
    fn close(&mut self, line: &mut OpenLine, indent: usize) {
        let text = std::mem::take(&mut line.text);
        if !text.is_empty() {
            self.lines.push(Line::new(line.indent, vec![(Column::Start, text)], Key::Alone));
        }
        line.indent = indent;
    }

    fn gap(&mut self, gap: &Gap<'s>, indent: usize) {
        self.comments(&gap.comments, indent);
        if gap.has_blank_line {
            self.lines.blank();
        }
    }

    fn comments(&mut self, comments: &[Comment<'s>], indent: usize) {
        for comment in comments {
            if comment.is_trailing && self.lines.trail(comment.text) {
                continue;
            }
            if comment.is_apart {
                self.lines.blank();
            }
            let cells = vec![(Column::Start, comment.text.to_owned())];
            self.lines.push(Line::new(indent, cells, Key::Alone));
        }
    }
}

/// A line that is being put together.
struct OpenLine {
    indent: usize,
    text: String,
}

impl OpenLine {
    fn width(&self) -> usize {
        self.indent + self.text.chars().count()
    }

    fn push(&mut self, piece: &Piece<'_>) {
        if !self.text.is_empty() && piece.glue != Glue::Tight {
            self.text.push(' ');
        }
        self.text.push_str(&piece.text);
    }
}

/// How many members, from the first on, stand on one line with `;` between: they were written so,
/// have no blocks, and fit.
fn row_length(members: &[Member<'_>], indent: usize) -> usize {
    let is_simple = |member: &Member<'_>| member.is_plain() && member.is_flat();
    let follows = |member: &&Member<'_>| {
        member.is_in_row && is_simple(member) && member.gap().comments.is_empty()
    };
    if !members.first().is_some_and(is_simple) {
        return 1;
    }
    // More than there are columns do not fit, and looking on would be done again for each of them.
    let count = 1 + members[1..].iter().take(MAX_COLUMNS).take_while(follows).count();
    let mut cells = Cells::default();
    cells.row(&members[..count], false);
    if indent + width(&cells.0) <= MAX_COLUMNS { count } else { 1 }
}

/// The branches that were written one below the other; else all as one.
fn branches<'n, 's>(nodes: &'n [Node<'s>]) -> Vec<&'n [Node<'s>]> {
    let is_link = |node: &Node<'_>| node.first().is_link;
    let is_table = nodes.iter().any(|node| is_link(node) && node.first().gap.has_newline);
    match is_table {
        true => nodes.chunk_by(|_, next| !is_link(next)).collect(),
        false => vec![nodes],
    }
}

/// How wide it is before there is the next place to break that is no deeper, a blank before it
/// included.
fn unbroken(nodes: &[Node<'_>], depth: u16) -> usize {
    let first = usize::from(nodes[0].first().glue != Glue::Tight);
    let mut width = first + nodes[0].first().text.chars().count();
    for node in &nodes[1..] {
        let piece = node.first();
        let is_place = matches!(piece.glue, Glue::Break(other) if other <= depth);
        if is_place || !piece.gap.comments.is_empty() {
            break;
        }
        width += usize::from(piece.glue != Glue::Tight) + piece.text.chars().count();
        if let Node::Block(_) = node {
            break;
        }
    }
    width
}

/// A part of a line, which begins at a place where it may be aligned.
type Cell = (Column, String);

fn width(cells: &[Cell]) -> usize {
    cells.iter().map(|(_, text)| text.chars().count() + 1).sum::<usize>().saturating_sub(1)
}

fn cells_of(nodes: &[Node<'_>], is_branch: bool) -> Vec<Cell> {
    let mut cells = Cells::default();
    cells.nodes(nodes, true, is_branch);
    cells.0
}

/// A line in one piece.
#[derive(Default)]
struct Cells(Vec<Cell>);

impl Cells {
    /// Members with `;` between; aligned after these.
    fn row(&mut self, members: &[Member<'_>], is_aligned: bool) {
        for (index, member) in members.iter().enumerate() {
            if index > 0 {
                self.push(";", Glue::Tight, None);
            }
            let column = (is_aligned && index > 0).then_some(Column::Member(index));
            if let Some(column) = column {
                self.0.push((column, String::new()));
            }
            self.nodes(&member.nodes, false, false);
        }
    }

    /// A member, aligned at its columns or not.
    fn nodes(&mut self, nodes: &[Node<'_>], is_aligned: bool, is_branch: bool) {
        for node in nodes {
            let piece = node.first();
            let is_brace = is_branch && matches!(node, Node::Block(_));
            let column = if is_brace { Some(Column::Block) } else { piece.column };
            self.push(&piece.text, piece.glue, column.filter(|_| is_aligned));
            let Node::Block(braces) = node else { continue };
            self.row(&braces.members, is_aligned && braces.is_table);
            self.push("}", if braces.is_empty() { Glue::Tight } else { Glue::Blank }, None);
        }
    }

    fn push(&mut self, text: &str, glue: Glue, column: Option<Column>) {
        match (self.0.last_mut(), column) {
            (Some((_, last)), None) => {
                if !last.is_empty() && glue != Glue::Tight {
                    last.push(' ');
                }
                last.push_str(text);
            }
            (_, column) => self.0.push((column.unwrap_or(Column::Start), text.to_owned())),
        }
    }
}
