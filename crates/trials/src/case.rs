//! What a campaign asks of whatever it tries: seeded assemblies, and what can be learned from them.

use crate::outcome::Outcome;
use crate::strategy::Strategy;

/// Something that is assembled again and again.
pub trait Case: Sync {
    /// What the strategy that learns goes by.
    type Memory: Clone + Sync;
    /// Where one thread assembles.
    type Stand<'c>: Stand
    where
        Self: 'c;

    /// A place to assemble by what was learned, which keeps what can be used again.
    fn stand<'c>(&'c self, memory: &'c Self::Memory) -> Self::Stand<'c>;

    /// Add what one assembly taught. They come in the order of the runs.
    fn learn(&self, memory: &mut Self::Memory, outcome: &Outcome);
}

/// A place where one assembly is made after another.
pub trait Stand {
    /// Make one. What comes of it follows from the seed, the strategy and what was learned before
    /// the place was made, whatever was made here meanwhile.
    fn assemble(&mut self, seed: u64, strategy: Strategy) -> Outcome;
}
