//! Places that a run has yet to get past.
//!
//! A place is an action by its entry in the source map, and how deep in calls it is. Knows nothing
//! of why somebody waits for it to be passed.

/// A place that the run has yet to get past.
#[derive(Clone, Debug)]
pub(crate) struct Passage {
    /// The entry in the source map of the action there, by its first instruction.
    pub(crate) entry: u32,
    /// How many calls are under way where the run goes on.
    pub(crate) depth: usize,
    /// Whether the run has yet to come there again: it began anew before that place.
    pub(crate) is_ahead: bool,
    /// Whether a call that was made from there is yet to return, over which nothing goes back.
    pub(crate) is_answering: bool,
}

impl Passage {
    /// An action was begun. Whether the run has got past the place with it: it is another action,
    /// behind that place, and in no call that was made from there.
    pub(crate) fn is_passed_with(&mut self, entry: u32, depth: usize) -> bool {
        if entry == self.entry {
            self.is_ahead = false;
            return false;
        }
        !self.is_ahead && depth <= self.depth
    }

    /// The run has gone over what cannot be taken back. Whether it has got past the place with it:
    /// neither before that place nor in what is done about it there.
    pub(crate) fn is_passed_with_a_barrier(&self) -> bool {
        !self.is_ahead && !self.is_answering
    }

    /// A call has returned to so many calls under way. Whether it is the one that was made from
    /// there.
    pub(crate) fn is_answered_with(&mut self, depth: usize) -> bool {
        let is_answered = self.is_answering && depth <= self.depth;
        self.is_answering &= !is_answered;
        is_answered
    }
}

#[cfg(test)]
mod tests {
    use super::Passage;

    #[test]
    fn another_action_as_deep_or_less_is_past_it_and_what_is_called_from_there_is_not() {
        let mut passage = Passage { entry: 7, depth: 2, is_ahead: false, is_answering: false };
        assert!(!passage.is_passed_with(9, 3), "in a call");
        assert!(!passage.is_passed_with(7, 2), "the same again");
        assert!(passage.is_passed_with(9, 2));
        assert!(passage.is_passed_with(9, 1));
    }

    #[test]
    fn what_lies_ahead_again_is_passed_once_the_run_has_come_there() {
        let mut passage = Passage { entry: 7, depth: 2, is_ahead: true, is_answering: false };
        assert!(!passage.is_passed_with(5, 2), "the sequence begins anew");
        assert!(!passage.is_passed_with(7, 2));
        assert!(passage.is_passed_with(9, 2));
    }

    #[test]
    fn it_is_answered_by_the_first_return_to_it_and_by_no_other() {
        let mut passage = Passage { entry: 7, depth: 2, is_ahead: false, is_answering: true };
        assert!(!passage.is_answered_with(3), "within the call");
        assert!(passage.is_answered_with(2));
        assert!(!passage.is_answered_with(2), "another call");
    }
}
