//! The tape file: the recording of a run, written piece by piece as it goes.
//!
//! A head, then what happened, in pieces, then how the run ended. Each is sealed by itself, so that
//! a run that is killed leaves a file that can be read up to its last whole piece. Neither the
//! machine's state nor its tape is in the file: both follow from the recording, by going through
//! it again. What a file says is not believed: whatever does not fit together is refused, and the
//! machine finds out the rest.

use crate::recording::{Command, Facts, Log, Moment, Order, Recording, Stretch, World};
use obverse_bytecode::codec::{self, DecodeErrorKind, Format};
use obverse_bytecode::{DecodeError, Module, decode};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// A tape file.
pub const TAPE: Format =
    Format { magic: *b"OBVTAPE\0", version: 7, name: "tape", remedy: "record the run again" };

/// The most instructions that one piece tells of: who writes begins another long before.
pub const MAX_PIECE_TICKS: u64 = 1 << 24;

/// What does not change along a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// The bytes of the module that is run.
    pub module: Vec<u8>,
    /// The program, as it was named.
    pub program: String,
    /// The workcell file; none for a bare arm.
    pub cell: Option<CellFile>,
    /// The seed of the workcell.
    pub seed: u64,
    /// The program that was run in the workcell before it; none where the workcell was as its file
    /// says.
    pub after: Option<Before>,
    /// What the program asks of the workcell that does not change.
    pub facts: Facts,
    /// The workcell at the start.
    pub start: World,
}

/// A workcell file as it was when the run began, so that what is tried is tried in no other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellFile {
    /// What it was called.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// A program that was run in the workcell before the one of a tape.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Before {
    /// The program, as it was named.
    pub program: String,
    /// The bytes of its module.
    pub module: Vec<u8>,
}

/// What happened since the piece before.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// What the workcell answered; commands number motions and faults within the piece.
    pub log: Log,
    /// How the machine was driven; notes are numbered within the piece.
    pub stretches: Vec<Stretch>,
    /// Where it ends.
    pub end: Moment,
}

#[derive(Serialize, Deserialize)]
enum Part {
    Head(Box<Head>),
    Piece(Piece),
    Ending(String),
}

/// What a tape file holds.
#[derive(Clone, Debug)]
pub struct TapeFile {
    /// What was run, and where.
    pub head: Head,
    /// The module of the head; not verified.
    pub module: Module,
    /// The run.
    pub recording: Recording,
    /// How it ended, in words; none if it was cut off.
    pub ending: Option<String>,
    /// So many bytes at the end are not whole.
    pub torn_bytes: usize,
}

impl TapeFile {
    /// What these bytes hold, up to the last whole piece.
    ///
    /// # Errors
    /// If they are no tape, or damaged elsewhere than at their end.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DecodeError> {
        let (first, mut at) = codec::open_at::<Part>(TAPE, bytes, 0)?;
        let Part::Head(head) = first else {
            return Err(misfit(0, "it has no head"));
        };
        let module = decode(&head.module)
            .map_err(|error| misfit(0, &format!("its module cannot be read: {error}")))?;
        let mut file = Self {
            recording: Recording {
                facts: head.facts.clone(),
                start: head.start.clone(),
                log: Log::default(),
                stretches: vec![Stretch { order: Order::Forward, begin: Moment(0), frame: 0 }],
                end: Moment(0),
            },
            head: *head,
            module,
            ending: None,
            torn_bytes: 0,
        };
        while at < bytes.len() {
            let (part, next) = match codec::open_at::<Part>(TAPE, bytes, at) {
                Ok(read) => read,
                Err(error) if error.is_cut_off(bytes.len() - at) => {
                    file.torn_bytes = bytes.len() - at;
                    break;
                }
                Err(error) => return Err(error),
            };
            if file.ending.is_some() {
                return Err(misfit(at, "it goes on behind its end"));
            }
            match part {
                Part::Head(_) => return Err(misfit(at, "it has two heads")),
                Part::Piece(piece) => {
                    file.recording.append(piece).map_err(|why| misfit(at, why))?;
                }
                Part::Ending(words) => file.ending = Some(words),
            }
            at = next;
        }
        Ok(file)
    }
}

fn misfit(at: usize, why: &str) -> DecodeError {
    DecodeError { format: TAPE, at, kind: DecodeErrorKind::Payload { why: why.to_owned() } }
}

impl Recording {
    /// Let a piece follow.
    ///
    /// # Errors
    /// What in it does not fit together, or to what was before; nothing of it is kept.
    fn append(&mut self, mut piece: Piece) -> Result<(), &'static str> {
        let log = &mut self.log;
        let ticks = piece.end.0.checked_sub(self.end.0);
        if ticks.is_none_or(|ticks| ticks > MAX_PIECE_TICKS) {
            return Err("a piece of it ends where it cannot");
        }
        piece.renumber(log).ok_or("its commands are not those of its log")?;
        let frames = (log.frames.len() + piece.log.frames.len()) as u64;
        let mut last = self.stretches.last().map_or((self.end, 0), |last| (self.end, last.frame));
        for stretch in &piece.stretches {
            let here = (stretch.begin, stretch.frame);
            if here.0 < last.0 || here.1 < last.1 || here.0 > piece.end || here.1 > frames {
                return Err("its orders are not in their order");
            }
            last = here;
        }
        let mut count = log.readings.last().map_or(0, |reading| reading.number);
        for reading in &piece.log.readings {
            if reading.number <= count {
                return Err("its readings are not in their order");
            }
            count = reading.number;
        }
        log.frames.append(&mut piece.log.frames);
        log.motions.append(&mut piece.log.motions);
        log.faults.append(&mut piece.log.faults);
        log.readings.append(&mut piece.log.readings);
        log.notes.append(&mut piece.log.notes);
        self.stretches.append(&mut piece.stretches);
        self.end = piece.end;
        Ok(())
    }
}

impl Piece {
    /// Number motions, faults and notes behind those of a log. None unless each has its number.
    fn renumber(&mut self, before: &Log) -> Option<()> {
        let number = |place: &mut u32, next: &mut usize, before: usize| {
            let is_its_own = *place as usize == *next;
            *next += 1;
            *place = u32::try_from(before + *next - 1).ok().filter(|_| is_its_own)?;
            Some(())
        };
        let (mut motions, mut faults, mut notes) = (0, 0, 0);
        for frame in &mut self.log.frames {
            if let Command::Execute(index) = &mut frame.command {
                number(index, &mut motions, before.motions.len())?;
            }
            if let Some(index) = &mut frame.fault {
                number(index, &mut faults, before.faults.len())?;
            }
        }
        for stretch in &mut self.stretches {
            if let Order::Note(index) = &mut stretch.order {
                number(index, &mut notes, before.notes.len())?;
            }
        }
        let log = &self.log;
        let are_all =
            [motions, faults, notes] == [log.motions.len(), log.faults.len(), log.notes.len()];
        are_all.then_some(())
    }
}

/// Writes a tape file. The first thing that goes wrong ends the writing, and is told in the end:
/// the run itself is no less true.
pub struct Writer<'w> {
    out: &'w mut dyn Write,
    failed: Option<io::Error>,
}

impl<'w> Writer<'w> {
    /// Begin a file.
    pub fn begin(out: &'w mut dyn Write, head: Head) -> Self {
        let mut writer = Self { out, failed: None };
        writer.part(&Part::Head(Box::new(head)));
        writer
    }

    /// Write what happened.
    pub fn piece(&mut self, piece: Piece) {
        self.part(&Part::Piece(piece));
    }

    /// Write how the run ended.
    ///
    /// # Errors
    /// What was the first to go wrong.
    pub fn end(mut self, ending: &str) -> io::Result<()> {
        self.part(&Part::Ending(ending.to_owned()));
        self.failed.map_or(Ok(()), Err)
    }

    fn part(&mut self, part: &Part) {
        if self.failed.is_some() {
            return;
        }
        let sealed = codec::seal(TAPE, part).map_err(io::Error::other);
        self.failed = sealed.and_then(|bytes| self.out.write_all(&bytes)).err();
    }
}
