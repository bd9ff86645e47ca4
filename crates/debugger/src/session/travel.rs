//! Moving: by instructions, by statements, out of calls, on to breakpoints, forward and back.
//!
//! Forward is the same live and rewound: hop by hop, from one place that may matter to the next.
//! Live in reverse every instruction is a hop. Rewound, going back is looking for the newest moment
//! before this one at which a run forward would have stopped.

use super::search::is_over;
use super::{Declined, PIECE, Session, look_at};
use crate::breakpoint::{Before, Breakpoint, Hit};
use crate::place::is_at_statement;
use crate::recording::Moment;
use crate::rewound::{Halted, Rewound};
use obverse_bytecode::Module;
use obverse_recovery::{Advance, Ending};
use obverse_vm::{Direction, Refusal, State, Stop, Stops, can_stop_at};
use obverse_workcell::Workcell;

/// How long a step is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grain {
    /// One instruction.
    Instruction,
    /// To the beginning of a statement of the source.
    Statement,
}

/// How to go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// A step, into calls.
    Step(Grain),
    /// A step over calls.
    Next(Grain),
    /// Out of the call.
    Finish,
    /// Until something stops it.
    Continue,
    /// Until the run is past the error that is due, or it is given up.
    Recover,
}

/// Why a command came to its end.
#[derive(Clone, Debug, PartialEq)]
pub enum Halt {
    /// It did what it was to do.
    Done,
    /// Breakpoints.
    Hits(Vec<Hit>),
    /// The machine or the workcell.
    Stopped(Stop),
    /// The run has ended in something else than where the machine stands.
    Ended(Ending),
    /// The arm is held: nothing moves before a person's command, and nothing has.
    Held,
    /// Live, it would go back over a variable that was changed by hand.
    Changed,
    /// The end of what is recorded.
    EndOfRecording,
    /// The start of what is recorded.
    StartOfRecording,
    /// It has run as many instructions as one command may.
    Limit,
    /// Somebody interrupted it.
    Interrupted,
    /// The recording does not fit the program.
    Lost,
}

impl Halt {
    /// What cannot be taken back, if that is what stopped it.
    #[must_use]
    pub fn refusal(&self) -> Option<&Refusal> {
        match self {
            Self::Stopped(Stop::Refused(refusal)) => Some(refusal),
            _ => None,
        }
    }
}

/// What a walk began with.
#[derive(Clone, Copy)]
struct Origin {
    depth: usize,
    walk: Walk,
}

impl Origin {
    fn of(walk: Walk, state: &State) -> Self {
        Self { depth: state.frames().len(), walk }
    }

    /// Whether a walk that made a hop is where it was to go.
    fn is_there(self, module: &Module, state: &State) -> bool {
        let depth = state.frames().len();
        let is_at = |grain: Grain| match grain {
            Grain::Instruction => true,
            Grain::Statement => is_at_statement(module, state),
        };
        match self.walk {
            Walk::Step(grain) => is_at(grain),
            Walk::Next(grain) => depth <= self.depth && is_at(grain),
            Walk::Finish => depth < self.depth && state.operands().is_empty(),
            Walk::Continue | Walk::Recover => false,
        }
    }

    /// Where nothing can be missed: the stops, and where the call returns that is under way.
    fn stops(self, module: &Module, state: &State, stops: Option<&Stops>) -> Option<Stops> {
        let stops = stops?;
        let depth = match self.walk {
            Walk::Continue | Walk::Recover => return Some(stops.clone()),
            Walk::Step(_) => return None,
            Walk::Next(_) => self.depth,
            Walk::Finish => self.depth.checked_sub(1)?,
        };
        let frame = state.frames().get(depth)?;
        let is_plain = state.branches().is_empty() && can_stop_at(module, frame.return_pc);
        is_plain.then(|| stops.with(frame.return_pc))
    }
}

/// Where a walk back may stop.
struct Place {
    moment: Moment,
    hits: Vec<Hit>,
    /// Whether it is where the walk was to go.
    is_there: bool,
}

impl<'p, C: Workcell> Session<'p, C> {
    /// Go on, in a direction. Live this commands the workcell; rewound it shows what was.
    pub fn go(&mut self, direction: Direction, walk: Walk) -> Halt {
        let halt = match (&self.view, direction) {
            (None, _) if self.run.cell().is_some() => self.go_live(direction, walk),
            (_, Direction::Forward) => self.go_shown(walk),
            (_, Direction::Reverse) => self.go_shown_back(walk),
        };
        if let Halt::Hits(hits) = &halt {
            let gone: Vec<u32> = hits.iter().map(|hit| hit.id).collect();
            let before = self.breakpoints.len();
            self.breakpoints.retain(|it| !(it.is_temporary && gone.contains(&it.id)));
            if self.breakpoints.len() < before {
                self.stops = None;
            }
        }
        halt
    }

    /// The same forward, no further than to a breakpoint that is there for this walk alone.
    pub fn go_until(&mut self, breakpoint: Breakpoint, walk: Walk) -> Halt {
        self.breakpoints.push(Breakpoint { id: 0, ..breakpoint });
        self.stops = None;
        let halt = self.go(Direction::Forward, walk);
        self.breakpoints.retain(|it| it.id != 0);
        self.stops = None;
        match halt {
            Halt::Hits(mut hits) => {
                hits.retain(|hit| hit.id != 0);
                if hits.is_empty() { Halt::Done } else { Halt::Hits(hits) }
            }
            halt => halt,
        }
    }

    fn go_live(&mut self, direction: Direction, walk: Walk) -> Halt {
        if self.is_held() {
            return Halt::Held;
        }
        let module = self.module();
        let origin = Origin::of(walk, self.run.machine().state());
        let all = self.stops();
        let until = self.run.recording().end.after(self.limit);
        let mut stops = origin.stops(module, self.run.machine().state(), all.as_ref());
        let mut depth = origin.depth;
        loop {
            if self.run.recording().end >= until {
                return Halt::Limit;
            }
            if self.take_interrupt() {
                return Halt::Interrupted;
            }
            if direction == Direction::Reverse && self.is_at_change() {
                return Halt::Changed;
            }
            let state = self.run.machine().state();
            if depth != state.frames().len() && walk != Walk::Continue {
                depth = state.frames().len();
                stops = origin.stops(module, state, all.as_ref());
            }
            let most = until.0 - self.run.recording().end.0;
            if let Some(halt) = self.hop((direction, walk), stops.as_ref(), most) {
                return halt;
            }
            if self.is_there(origin) {
                return Halt::Done;
            }
        }
    }

    /// Whether a walk of the live run is where it was to go.
    fn is_there(&self, origin: Origin) -> bool {
        match origin.walk {
            Walk::Recover => !self.is_recovering(),
            _ => origin.is_there(self.module(), self.run.machine().state()),
        }
    }

    /// Whether going back further would be over a variable that was changed by hand.
    fn is_at_change(&self) -> bool {
        let steps = self.run.machine().state().steps();
        self.run.changed_at().is_some_and(|changed| steps <= changed)
    }

    /// Live, to the next place that may matter: why that is the end of the walk, if it is.
    fn hop(
        &mut self,
        (direction, walk): (Direction, Walk),
        stops: Option<&Stops>,
        most: u64,
    ) -> Option<Halt> {
        loop {
            let before = self.look(|look| Before::of(&self.breakpoints, look));
            let moment = self.run.recording().end;
            let (way, halt) = match direction {
                Direction::Forward => {
                    let way = self.direction();
                    (way, self.advance(stops, most).and_then(|advance| self.halt_of(advance, walk)))
                }
                Direction::Reverse => (direction, self.take_back().map(Halt::Stopped)),
            };
            // Where nothing was done, nothing is come to.
            let has_moved = self.run.recording().end > moment;
            let hits = if has_moved { self.hits(&before, way) } else { Vec::new() };
            if halt.is_some() {
                return halt;
            }
            if !hits.is_empty() {
                return Some(Halt::Hits(hits));
            }
            let is_past = walk == Walk::Recover && !self.is_recovering();
            if has_moved || is_past {
                return None;
            }
        }
    }

    /// Why a walk ends with what came of going on, if it does.
    fn halt_of(&self, advance: Advance, walk: Walk) -> Option<Halt> {
        let stop = match advance {
            Advance::On => return None,
            Advance::Stopped(stop) => stop,
            Advance::Ended(Ending::Finished | Ending::Unhandled(_)) => Stop::Finished,
            Advance::Ended(Ending::Fault { fault, pc, direction }) => {
                Stop::Fault { fault, pc, direction }
            }
            Advance::Ended(Ending::Trap(trap)) => Stop::Trap(trap),
            Advance::Ended(ending) => return Some(Halt::Ended(ending)),
        };
        // A recovery goes on by itself wherever it can.
        let goes_on = match &stop {
            Stop::Due { .. } => true,
            Stop::Fault { .. } => self.is_recovering() && !self.is_held(),
            _ => false,
        };
        (walk != Walk::Recover || !goes_on).then_some(Halt::Stopped(stop))
    }

    /// The breakpoints that are come to here.
    fn hits(&mut self, before: &Before, direction: Direction) -> Vec<Hit> {
        let found: Vec<Hit> = self.look(|look| {
            let hit = |it: &Breakpoint| it.hit(before, look, direction);
            self.breakpoints.iter().filter_map(hit).collect()
        });
        self.counted(found)
    }

    /// Those of some hits that stop a run, all being counted, and what they tell.
    fn counted(&mut self, found: Vec<Hit>) -> Vec<Hit> {
        let mut hits = Vec::new();
        for hit in found {
            let breakpoint = self.breakpoints.iter_mut().find(|it| it.id == hit.id);
            let Some(breakpoint) = breakpoint else { continue };
            breakpoint.hits += 1;
            if breakpoint.stops_now() {
                match &hit.log {
                    Some(text) => self.told.push((hit.id, text.clone())),
                    None => hits.push(hit),
                }
            }
        }
        hits
    }

    /// What breakpoints have told since it was last asked for.
    pub fn take_told(&mut self) -> Vec<(u32, String)> {
        std::mem::take(&mut self.told)
    }

    /// Rewound, forward over what is recorded.
    fn go_shown(&mut self, walk: Walk) -> Halt {
        let module = self.module();
        let Some(mut view) = self.view.take() else { return Halt::EndOfRecording };
        let origin = Origin::of(walk, view.machine().state());
        let all = self.stops();
        let until = view.moment().after(self.limit).min(self.run.recording().end);
        let halt = loop {
            let stops = origin.stops(module, view.machine().state(), all.as_ref());
            let before = look_at(module, self.run.recording(), &view, |look| {
                Before::of(&self.breakpoints, look)
            });
            let direction = view.direction(self.run.recording());
            let from = view.moment();
            let to = from.after(PIECE).min(until);
            let halted = view.walk_on(self.run.recording(), to, stops.as_ref());
            if halted == Halted::Lost {
                break Halt::Lost;
            }
            self.view = Some(view);
            // Where nothing was gone over, nothing is come to.
            let has_moved = self.moment() > from;
            let hits = if has_moved { self.hits(&before, direction) } else { Vec::new() };
            let Some(shown) = self.view.take() else { return Halt::Lost };
            view = shown;
            if !hits.is_empty() {
                break Halt::Hits(hits);
            }
            if is_over(&halted, &view, to, until) {
                let is_end = view.moment() >= self.run.recording().end;
                break if is_end { Halt::EndOfRecording } else { Halt::Limit };
            }
            if origin.is_there(module, view.machine().state()) {
                break Halt::Done;
            }
            if self.take_interrupt() {
                break Halt::Interrupted;
            }
        };
        self.view = Some(view);
        halt
    }

    /// Rewound, back to the newest moment before this one at which the walk would have stopped.
    fn go_shown_back(&mut self, walk: Walk) -> Halt {
        let now = self.moment();
        let Some(mut shown) = self.view.clone() else { return Halt::StartOfRecording };
        let origin = Origin::of(walk, shown.machine().state());
        let stops = match walk {
            Walk::Continue => self.stops(),
            _ => None,
        };
        let mut end = now;
        loop {
            let piece = self.places_in(&mut shown, (end, now), origin, stops.as_ref());
            let Ok((begin, places)) = piece else { return Halt::Interrupted };
            for place in places.into_iter().rev() {
                let hits = self.counted(place.hits);
                if place.is_there || !hits.is_empty() {
                    self.show(Some(place.moment));
                    return if hits.is_empty() { Halt::Done } else { Halt::Hits(hits) };
                }
            }
            if begin == Moment(0) {
                self.show(Some(Moment(0)));
                return Halt::StartOfRecording;
            }
            end = begin;
        }
    }

    /// Where the newest piece before a moment begins, and the places in it, before now and oldest
    /// first, at which a walk back may stop.
    fn places_in(
        &self,
        shown: &mut Rewound<'p>,
        (end, now): (Moment, Moment),
        origin: Origin,
        stops: Option<&Stops>,
    ) -> Result<(Moment, Vec<Place>), Declined> {
        let (module, breakpoints) = (self.module(), &self.breakpoints);
        let recording = self.run.recording();
        let mut places = Vec::new();
        let mut before: Option<(Moment, Before)> = None;
        self.look_through(shown, end, stops, |shown| {
            let moment = shown.moment();
            let state = shown.machine().state();
            look_at(module, recording, shown, |look| {
                // Of what was before the first place of a piece nothing is known here: the piece
                // before ends with it.
                let known = before.as_ref().filter(|(then, _)| *then < moment);
                let is_first = moment == Moment(0);
                if moment < now && (known.is_some() || is_first) {
                    let none = Before::default();
                    let before = known.map_or(&none, |(_, before)| before);
                    let hit = |it: &Breakpoint| it.hit(before, look, Direction::Reverse);
                    let hits: Vec<Hit> = breakpoints.iter().filter_map(hit).collect();
                    let is_there = origin.is_there(module, state);
                    if is_there {
                        // Nothing before it is come to.
                        places.clear();
                    }
                    if is_there || !hits.is_empty() {
                        places.push(Place { moment, hits, is_there });
                    }
                }
                before = Some((moment, Before::of(breakpoints, look)));
            });
        })
        .map(|begin| (begin, places))
    }

    /// Show a moment of the run, or the run where it has come to.
    pub(super) fn show(&mut self, moment: Option<Moment>) {
        let Some(moment) = moment else {
            let is_live = self.run.cell().is_some();
            self.view = (!is_live).then(|| self.run.rewound());
            return;
        };
        let mut view = self.view.take().unwrap_or_else(|| self.run.rewound());
        view.go_to(self.run.recording(), self.run.timeline(), moment);
        self.view = Some(view);
    }

    /// The moment that is shown; none if that is the run where it has come to.
    pub(super) fn shown(&self) -> Option<Moment> {
        self.view.as_ref().map(Rewound::moment)
    }

    /// To where the run has come to: live again, if it is.
    pub fn go_to_end(&mut self) {
        self.jumped();
        self.show(None);
    }

    /// To a moment of the run, rewound.
    ///
    /// # Errors
    /// If there is no such moment.
    pub fn go_to(&mut self, moment: Moment) -> Result<(), Declined> {
        let end = self.run.recording().end;
        if moment > end {
            return Err(Declined::NoMoment { asked: moment, end });
        }
        self.jumped();
        self.show(Some(moment));
        Ok(())
    }

    /// To a bookmark.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn go_to_bookmark(&mut self, name: &str) -> Result<(), Declined> {
        let known = || self.bookmarks.keys().cloned().collect();
        let moment = self.bookmarks.get(name).copied();
        let missing = || Declined::NoBookmark { name: name.to_owned(), known: known() };
        self.go_to(moment.ok_or_else(missing)?)
    }

    /// Remember what is shown, so that the jump that follows can be undone.
    pub(super) fn jumped(&mut self) {
        if self.jumps.len() == super::MAX_JUMPS {
            self.jumps.remove(0);
        }
        self.jumps.push(self.shown());
    }

    /// Undo the last jump.
    ///
    /// # Errors
    /// If there is none.
    pub fn undo_jump(&mut self) -> Result<(), Declined> {
        let shown = self.jumps.pop().ok_or(Declined::NoJump)?;
        self.show(shown);
        Ok(())
    }
}
