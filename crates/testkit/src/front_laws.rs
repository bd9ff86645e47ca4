//! Laws of the front end over generated programs: what is cut off, and how lines end. Knows nothing
//! of machines.

use crate::programs::{self, Options};
use arbitrary::{Result, Unstructured};
use obverse_compiler::compile;
use obverse_syntax::codes::Code;
use obverse_syntax::diagnostic::Severity;

/// In how many places each program is cut.
const CUTS: usize = 4;

/// A program that is cut off anywhere gives messages within what is left of it, or a module, and
/// never both an error and a module. Whether any of the cuts was a mistake.
///
/// # Errors
/// Only those of the randomness.
///
/// # Panics
/// If the law does not hold.
pub fn cut_off_anywhere(u: &mut Unstructured<'_>) -> Result<bool> {
    let text = programs::generate(u, Options::default())?;
    let mut is_wrong = false;
    for place in 0..CUTS {
        // Spread over the text, so that few random bytes are enough.
        let step = text.len() / CUTS;
        let end = place * step + u.int_in_range(0..=step)?;
        let cut = &text[..end];
        let compiled = compile("cut.obv", cut);
        for diagnostic in &compiled.diagnostics {
            let labels = diagnostic.labels.iter().map(|label| label.span);
            let changes = diagnostic.suggestion.iter().chain(&diagnostic.choices);
            let changed = changes.map(|change| change.span);
            for span in labels.chain(changed).chain([diagnostic.primary.span]) {
                let range = span.start as usize..span.end as usize;
                assert!(cut.get(range).is_some(), "{diagnostic:?}\n{cut}");
            }
            assert!(!diagnostic.message.is_empty() && !diagnostic.message.ends_with('.'));
        }
        let has_error = compiled.diagnostics.iter().any(|one| one.severity == Severity::Error);
        assert_eq!(compiled.module.is_none(), has_error, "an error, or a module:\n{cut}");
        let depth = cut.matches('{').count() - cut.matches('}').count();
        assert!(depth == 0 || has_error, "a block is open:\n{cut}");
        // What is cut off may declare it.
        let unknown = compiled.diagnostics.iter().find(|one| one.code == Code::UnknownName);
        assert!(depth == 0 || unknown.is_none(), "{unknown:?}\n{cut}");
        is_wrong |= has_error;
    }
    Ok(is_wrong)
}

/// However its lines end, a program is the same code, and its diagnostics stand on the same lines.
///
/// # Errors
/// Only those of the randomness.
///
/// # Panics
/// If the law does not hold.
pub fn line_ends_mean_nothing(u: &mut Unstructured<'_>) -> Result<bool> {
    // Each is compiled four times.
    let text = programs::generate(u, Options { max_statements: 40, ..Options::default() })?;
    let plain = compile("plain.obv", &text);
    for end in ["\r\n", "\r", "\n\n"] {
        let other = compile("plain.obv", &text.replace('\n', end));
        let code =
            |module: &obverse_bytecode::Module| (module.code.clone(), module.constants.clone());
        assert_eq!(plain.module.as_ref().map(code), other.module.as_ref().map(code), "{text}");
        let codes: Vec<_> = plain.diagnostics.iter().map(|one| one.code).collect();
        let others: Vec<_> = other.diagnostics.iter().map(|one| one.code).collect();
        assert_eq!(codes, others, "{text}");
    }
    Ok(plain.module.is_some())
}
