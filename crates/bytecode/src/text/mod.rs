//! Assembly text: a module for people to read, and to write by hand.
//!
//! [`disassemble()`] writes everything that a module holds, and [`assemble()`] reads it back: the
//! same module, byte for byte, verified or not. Neither knows what instructions do; both derive
//! what they write and accept from the instruction table. Whatever the text or the module, neither
//! panics, and the memory they take is linear in what they are given.
//!
//! ```text
//! obvasm 1                               the first line
//! .cell "FILE"                           the workcell file
//! .const int 5   .const real 0.25        a number; `0x` and 16 digits are the bits of a real
//! .joints "NAME" 0 0 0 0 0 0             radians
//! .keyframe "NAME"
//! .item "NAME"
//!     .at KEYFRAME x y z rx ry rz        metres; axis times angle
//! .tool "NAME"
//! .error "NAME" SEVERITY                 warning, recoverable, fatal
//!     .recover none | using FUNCTION
//!     .on FAULT ...                      the faults that raise it, by the codes of a workcell
//!     .watch input N low | input N high | force NEWTONS
//!     .bounds [attempts N] [time SECONDS] [distance METRES]
//!     .recover reversing DEPTH EXTENT [perturbed PATTERN METRES] [slower] [lighter]
//!     .otherwise using FUNCTION | operator | stop
//!     .respond at_once | after_action | after_sequence
//!     .then action | next_action | sequence | program | stop
//! .checkpoint "NAME"
//! .reason "TEXT"
//! .global "NAME" TYPE [of M RAD S N]     what a real measures: exponents of metres, radians,
//!                                        seconds and newtons
//! .cleanup FUNCTION                      what runs at the end of the program
//! .function "NAME" KIND                  what follows is of this function, to the next one
//!     .parameter "NAME" TYPE [of ..]     the parameters come before the other locals
//!     .local "NAME" TYPE [of ..]
//!     .counters N
//!     .slot "NAME"
//! label:                                 a name for the next instruction, within the function
//!   @ FILE START END [ACTION]            what follows comes from these bytes of that source file
//!         push.int 3                     operands after the mnemonic, with commas between
//!     store.local x                      an effect: it ends the statement
//! .source "NAME"
//! | a line of its text                   `|"..."` with escapes where a line is not plain
//! .mention WHAT FILE START END           where the program speaks of its workcell; WHAT is `cell`,
//!                                        `item N`, `tool N`, `output "NAME" N`, `input "NAME" N`
//! .loop FIRST "NAME" up | down           what the program calls the counter of the loop that the
//!                                        instruction FIRST enters
//! ```
//!
//! DEPTH is `fixed`, `escalating`, `doubling` or `learned`; PATTERN is `spiral` or `random`; EXTENT
//! is `actions N`, `checkpoint NAME` or `sequence`. A table is in the order of its lines, which may
//! stand anywhere. A name is a word or quoted text; `#7` is the seventh of a table, counted from
//! nought, whatever its name, and `x#7`
//! the same with its name. `push.const 0.25` and `barrier "why"` add to their tables what is not
//! yet there. The `prefix` of an instruction is counted, never written. A join may leave out which
//! jump it is of if one alone names it. `;` begins a comment.
//!
//! Five lines are for modules that the verifier would refuse: `.code` begins code of no function,
//! `.range FIRST END` says where a function's code is if not below it, `.parameters N` how many
//! there are if more than locals, `.prefix N` what the next effect takes for its prefix, and `.map
//! FIRST FILE START END [ACTION]` is an entry of a source map out of order.
//!
//! Read `disassemble`, then `assemble` and `resolve`.

mod assemble;
mod declare;
mod disassemble;
mod error;
mod listing;
mod mention;
mod names;
mod nearest;
mod quote;
mod resolve;
mod said;
mod scan;
mod words;

pub use assemble::assemble;
pub use declare::DIRECTIVES;
pub use disassemble::{disassemble, disassemble_function, instruction};
pub use error::{AsmError, MAX_ERRORS};
pub use nearest::nearest;
pub use said::{SAID_COLUMNS, line_of, said};
