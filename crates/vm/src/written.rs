//! The classes of calls, blocks and forks, held to the table at compile time.
//!
//! Every other opcode is called through the trait of its class. These are written out in the step
//! loop, since calls change the frame, blocks what going back means, and forks whose turn it is,
//! which no opcode can see.

use obverse_isa::{Class, Family, OPS, Opcode, RecordKind};

/// What the step loop does. A row of the table that says otherwise does not compile.
const WRITTEN_HERE: &[(Opcode, Class)] = &[
    (Opcode::Call, Class::Always),
    (Opcode::Enter, Class::Always),
    (Opcode::Return, Class::AfterForward(RecordKind::Frame)),
    (Opcode::Halt, Class::Always),
    (Opcode::Checkpoint, Class::Always),
    (Opcode::BlockBegin, Class::Always),
    (Opcode::BlockSkip, Class::Always),
    (Opcode::BlockReplace, Class::Always),
    (Opcode::Fork, Class::Always),
    (Opcode::ForkNext, Class::AfterForward(RecordKind::Switch)),
    (Opcode::ForkJoin, Class::AfterForward(RecordKind::Switch)),
    (Opcode::ForkLeave, Class::AfterForward(RecordKind::Tasks)),
];

const _: () = {
    let mut row = 0;
    while row < OPS.len() {
        let info = &OPS[row];
        if matches!(info.family, Family::Frame | Family::Reversal | Family::Task) {
            let mut is_right = matches!(info.class, Class::Never(_));
            let mut at = 0;
            while at < WRITTEN_HERE.len() {
                let (opcode, class) = &WRITTEN_HERE[at];
                is_right |= *opcode as u8 == info.code && is_same_class(class, &info.class);
                at += 1;
            }
            assert!(is_right, "a row that the step loop does itself is not of its code's class");
        }
        row += 1;
    }
};

const fn is_same_class(written: &Class, row: &Class) -> bool {
    match (written, row) {
        (Class::Always, Class::Always) => true,
        (Class::AfterForward(written), Class::AfterForward(row)) => *written as u8 == *row as u8,
        _ => false,
    }
}
