//! What a person is told of a recovery, and what a person is asked.

use crate::ending::GiveUp;
use crate::incident::Incident;
use obverse_isa::ErrorId;
use obverse_vm::{Alteration, Observer};
use obverse_workcell::{Fault, Workcell};

/// Why a run goes back as far as it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// The program, or the strategy, says so.
    Said,
    /// To a checkpoint, or the start of a sequence.
    Place,
    /// One further than the last time, or twice as far.
    Further,
    /// By what was learned.
    Learned {
        /// The chance that it is enough.
        chance: f64,
        /// How long it is expected to take until the run is past the error, in seconds.
        expected_s: f64,
        /// How many recoveries from this error here are known.
        known: u64,
    },
    /// Nothing further back can be taken back: it was to be further.
    AsFarAsPossible,
    /// Somebody knows that it is best.
    Foreseen,
}

/// A step of a recovery.
#[derive(Clone, Debug, PartialEq)]
pub enum Step<'a> {
    /// A fault of the workcell becomes an error of the program.
    Fault {
        /// What happened.
        fault: &'a Fault,
        /// The instruction.
        pc: u32,
        /// The error.
        error: ErrorId,
    },
    /// A fault in the cleanup, which goes on behind what it has stopped.
    PassedOver {
        /// What happened.
        fault: &'a Fault,
        /// The instruction.
        pc: u32,
    },
    /// A person gave the fresh command without which nothing moves after a stop.
    Released,
    /// The run goes back.
    Back {
        /// The error and what was tried before.
        incident: &'a Incident,
        /// How many actions.
        actions: usize,
        /// The instruction that the way back leads to.
        to: u32,
        /// Why so far.
        why: Why,
    },
    /// The arm is where a motion began: of what came since it has nothing to take back.
    RoundTrip {
        /// The error and what was tried before.
        incident: &'a Incident,
        /// The motion.
        pc: u32,
    },
    /// The arm stays, and the program alone goes back.
    InPlace {
        /// The error and what was tried before.
        incident: &'a Incident,
        /// How far the tool was backed up before, in metres, which may be less than was asked for.
        backed_up_m: Option<f64>,
    },
    /// The way back was blocked.
    Blocked {
        /// The error and what was tried.
        incident: &'a Incident,
        /// What happened.
        fault: &'a Fault,
        /// The instruction that was being reversed.
        pc: u32,
    },
    /// The run goes forward again.
    Again {
        /// The error and what was tried, this attempt included.
        incident: &'a Incident,
        /// What is done otherwise.
        change: Option<Alteration>,
    },
    /// The run is past the error.
    Recovered {
        /// The error and what was tried.
        incident: &'a Incident,
    },
    /// The error is given up.
    GivenUp {
        /// The error and what was tried.
        incident: &'a Incident,
        /// Why.
        why: GiveUp,
    },
    /// A person is called to put it right.
    Operator {
        /// The error and what was tried.
        incident: &'a Incident,
    },
}

/// Who is told of a run and its recoveries.
pub trait Teller: Observer {
    /// A step of a recovery, with the workcell after it.
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell);
}

impl Teller for () {
    fn on_step(&mut self, _: &Step<'_>, _: &dyn Workcell) {}
}

/// A person at the cell.
pub trait Operator {
    /// Whether a person gives the fresh command without which nothing moves after a stop.
    fn release(&mut self, fault: &Fault) -> bool;
}

/// Nobody is there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unattended;

impl Operator for Unattended {
    fn release(&mut self, _: &Fault) -> bool {
        false
    }
}
