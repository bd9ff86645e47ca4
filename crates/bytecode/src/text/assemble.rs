//! The assembler: text as a module, in two passes. The first reads the tables and where labels are;
//! the second what names them, since a name may come before what it names.

use super::declare::declare;
use super::error::AsmError;
use super::resolve::resolve;
use crate::module::Module;

/// The module that a text says, not yet verified. Of what [`disassemble`](super::disassemble())
/// wrote, the same module.
///
/// # Errors
/// What is wrong with the text, in its order; at most [`MAX_ERRORS`](super::MAX_ERRORS).
pub fn assemble(text: &str) -> Result<Module, Vec<AsmError>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut declared = declare(text);
    let resolved = resolve(&mut declared);
    declared.errors.finish()?;
    let mut module = declared.module;
    resolved.put_into(&mut module);
    Ok(module)
}
