//! The imports of a text that has not been parsed yet, so that every file of a program is there
//! before the first is. It knows three tokens: what follows from one, or is wrong with it, it does
//! not know.

use crate::ast::Import;
use crate::sources::Sources;
use crate::span::Span;
use crate::token::Token;
use crate::tree;
use logos::Logos;

/// The paths that a file imports, in the order written. Those of the tree are among them.
#[must_use]
pub fn imports(sources: &Sources, file: usize) -> Vec<Import<'_>> {
    let range = sources.range(file);
    let text = &sources.whole()[..range.end];
    if !text[range.start..].contains("import") {
        return Vec::new();
    }
    let mut tokens = Token::lexer(text);
    tokens.bump(range.start);
    let mut found = Vec::new();
    let mut before = [None; 2];
    while let Some(token) = tokens.next() {
        let place = tokens.span();
        let token = token.ok();
        let is_library = before == [Some(Token::Import), Some(Token::Library)];
        let is_import = is_library || before[1] == Some(Token::Import);
        if is_import && token == Some(Token::Text) {
            let Span { start, end } = Span::new(place.start as u32, place.end as u32);
            found.push(Import { is_library, path: tree::quoted(text, start, end) });
        }
        before = [before[1], token];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_import_is_the_word_and_a_text() {
        let mut sources = Sources::one("a", "import \"b\"");
        let text = "// import \"c\"\nimport // d\n \"d\" var import = 3 cell \"import\" import";
        sources.add("b", text);
        let found =
            |file| imports(&sources, file).iter().map(|one| one.path.value).collect::<Vec<_>>();
        assert_eq!((found(0), found(1)), (vec!["b"], vec!["d"]));
        let span = imports(&sources, 1)[0].path.span;
        assert_eq!(sources.locate(span).file, 1);
        assert_eq!(&sources.whole()[span.start as usize..span.end as usize], "\"d\"");
    }
    #[test]
    fn an_import_of_the_library_says_so() {
        let sources = Sources::one("a", "import library \"b\" library \"c\" import \"d\"");
        let found = imports(&sources, 0);
        let found: Vec<_> = found.iter().map(|one| (one.is_library, one.path.value)).collect();
        assert_eq!(found, [(true, "b"), (false, "d")]);
    }
}
