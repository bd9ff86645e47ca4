//! How messages come in, also while a run is under way.
//!
//! A thread of its own reads them and hands them over one at a time: as long as one is not taken,
//! nothing more is read, and the run under way is asked to halt so that it can be.

use crate::frame::{Frame, Reader};
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The longest message, in bytes.
const MAX_MESSAGE: usize = 1 << 20;
/// How long a message waits before a run is asked to halt for it, again and again.
const PATIENCE: Duration = Duration::from_millis(1);
/// How long to look for the message that a run was halted for.
const LOOK: Duration = Duration::from_millis(10);

/// What asks a run to halt, as soon as there is one.
type Bell = Arc<Mutex<Option<Arc<AtomicBool>>>>;

/// Where messages come in.
pub(crate) struct Inbox {
    receiver: Receiver<Frame>,
    bell: Bell,
}

impl Inbox {
    /// Begin to read.
    pub(crate) fn of(input: impl Read + Send + 'static) -> Self {
        let (sender, receiver) = sync_channel(0);
        let bell = Bell::default();
        let heard = bell.clone();
        // It ends with its input or with whom it hands to; nobody waits for it.
        std::thread::spawn(move || listen(input, &sender, &heard));
        Self { receiver, bell }
    }

    /// Ask this run to halt when there is a message.
    pub(crate) fn ring(&self, interrupter: Arc<AtomicBool>) {
        *self.bell.lock().unwrap_or_else(PoisonError::into_inner) = Some(interrupter);
    }

    /// Ask no run to halt for a while.
    pub(crate) fn hush(&self) {
        *self.bell.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// The next message, whenever it comes.
    pub(crate) fn next(&self) -> Frame {
        self.receiver.recv().unwrap_or(Frame::End(None))
    }

    /// The message that is there, if there is one.
    pub(crate) fn take(&self) -> Option<Frame> {
        self.receiver.recv_timeout(LOOK).ok()
    }
}

fn listen(input: impl Read, sender: &SyncSender<Frame>, bell: &Bell) {
    let mut input = Reader::new(input, MAX_MESSAGE);
    loop {
        let mut frame = input.read();
        let is_end = matches!(frame, Frame::End(_));
        loop {
            match sender.try_send(frame) {
                Ok(()) => break,
                Err(TrySendError::Disconnected(_)) => return,
                Err(TrySendError::Full(unsent)) => frame = unsent,
            }
            if let Some(interrupter) = &*bell.lock().unwrap_or_else(PoisonError::into_inner) {
                interrupter.store(true, Ordering::Relaxed);
            }
            std::thread::sleep(PATIENCE);
        }
        if is_end {
            return;
        }
    }
}
