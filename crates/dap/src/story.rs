//! What is done about errors, in words, as a client is told it.

use obverse_bytecode::Module;
use obverse_recovery::{Step, Teller, words};
use obverse_vm::{Event, Observer};
use obverse_workcell::Workcell;
use std::sync::{Arc, Mutex, PoisonError};

/// What has been told, until it is taken.
#[derive(Clone, Default)]
pub(crate) struct Told(Arc<Mutex<Vec<String>>>);

impl Told {
    pub(crate) fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Tells the steps of recoveries. What the robot does a client sees for itself.
pub(crate) struct Story<'m> {
    pub(crate) module: &'m Module,
    pub(crate) told: Told,
}

impl Observer for Story<'_> {
    fn on_event(&mut self, _: &Event, _: &dyn Workcell) {}
}

impl Teller for Story<'_> {
    fn on_step(&mut self, step: &Step<'_>, cell: &dyn Workcell) {
        let line = format!("{:.2} s: {}", cell.now_s(), words(self.module, step));
        self.told.0.lock().unwrap_or_else(PoisonError::into_inner).push(line);
    }
}
