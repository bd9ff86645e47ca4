//! What a campaign asks of whatever it tries: seeded assemblies, and what can be learned from them.

use crate::outcome::Outcome;
use crate::strategy::Strategy;

/// Something that is assembled again and again.
pub trait Case: Sync {
    /// What the strategy that learns goes by.
    type Memory: Clone + Send + Sync;
    /// What one assembly teaches.
    type Lesson: Send;
    /// Where one thread assembles.
    type Stand<'c>: Stand<Self::Memory, Self::Lesson>
    where
        Self: 'c;

    /// A place to assemble, which keeps what can be used again.
    fn stand(&self) -> Self::Stand<'_>;

    /// Add what one assembly taught. Lessons come in the order of the runs.
    fn learn(&self, memory: &mut Self::Memory, lesson: Self::Lesson);
}

/// A place where one assembly is made after another.
pub trait Stand<Memory, Lesson> {
    /// Make one. What comes of it follows from the arguments alone, whatever was made here before.
    fn assemble(&mut self, seed: u64, strategy: Strategy, memory: &Memory) -> Assembly<Lesson>;
}

/// What came of an assembly.
#[derive(Clone, Debug)]
pub struct Assembly<Lesson> {
    /// How it went.
    pub outcome: Outcome,
    /// What it teaches.
    pub lesson: Lesson,
}
