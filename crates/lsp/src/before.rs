//! The text before the word that somebody is writing, in pieces. It knows no names, and what may
//! follow is for others to say.

use obverse_syntax::highlight::{Piece, PieceKind, pieces};

/// The text before the word in hand.
pub(crate) struct Before<'w> {
    pub(crate) text: &'w str,
    /// Its pieces, without comments.
    pub(crate) pieces: Vec<Piece>,
}

impl<'w> Before<'w> {
    /// What is before an offset of a text; none within a text in quotes or a comment.
    pub(crate) fn of(text: &'w str, offset: usize) -> Option<Self> {
        let until = text.get(..offset)?;
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let word = until.trim_end_matches(is_word).len();
        let digits = until[word..].bytes().take_while(u8::is_ascii_digit).count();
        let text = &until[..word + digits];
        let line = text.rfind(['\n', '\r']).map_or(0, |end| end + 1);
        let pieces = pieces(text);
        let is_commented = pieces.last().is_some_and(|last| {
            last.kind == PieceKind::Comment && last.span.end as usize == text.len()
        });
        let is_quoted = text[line..].matches('"').count() % 2 == 1;
        if is_commented || is_quoted {
            return None;
        }
        let pieces = pieces.into_iter().filter(|piece| piece.kind != PieceKind::Comment).collect();
        Some(Self { text, pieces })
    }

    /// A piece as text; nothing where there is none.
    pub(crate) fn at(&self, index: usize) -> &'w str {
        let piece = self.pieces.get(index);
        let range = piece.map(|piece| piece.span.start as usize..piece.span.end as usize);
        range.and_then(|range| self.text.get(range)).unwrap_or("")
    }

    /// The piece so many pieces ago, as text.
    pub(crate) fn ago(&self, count: usize) -> &'w str {
        self.pieces.len().checked_sub(count).map_or("", |index| self.at(index))
    }

    /// What stands between a piece and the one before it, or the beginning.
    pub(crate) fn gap_before(&self, index: usize) -> &'w str {
        let before = index.checked_sub(1).and_then(|before| self.pieces.get(before));
        let start = before.map_or(0, |before| before.span.end as usize);
        let end = self.pieces.get(index).map_or(self.text.len(), |piece| piece.span.start as usize);
        self.text.get(start..end).unwrap_or("")
    }

    /// What stands behind the last piece.
    pub(crate) fn rest(&self) -> &'w str {
        self.gap_before(self.pieces.len())
    }

    /// Whether the line of the last piece goes on.
    pub(crate) fn is_same_line(&self) -> bool {
        !self.rest().contains(['\n', '\r'])
    }
}
