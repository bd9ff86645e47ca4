//! What a program declares, by name.

use super::expression::{Readings, evaluate};
use super::value::{Value, si};
use obverse_geometry::{JointConfiguration, Pose};
use obverse_syntax::ast::{
    AdvancedMove, Cleanup, ErrorDeclaration, Expression, IoOperation, Item, ItemDeclaration,
    Program, Sequence, Signal, Vector,
};
use std::collections::HashMap;

/// The declarations of a program.
#[derive(Default)]
pub(super) struct Names<'p> {
    pub(super) io: HashMap<&'p str, &'p IoOperation<'p>>,
    pub(super) errors: HashMap<&'p str, &'p ErrorDeclaration<'p>>,
    pub(super) moves: HashMap<&'p str, &'p AdvancedMove<'p>>,
    pub(super) sequences: HashMap<&'p str, &'p Sequence<'p>>,
    /// The numbers of outputs and inputs.
    signals: HashMap<&'p str, u64>,
    /// In the order of their declarations.
    pub(super) joints: Vec<(&'p str, JointConfiguration)>,
    /// In the order of their declarations.
    pub(super) items: Vec<&'p ItemDeclaration<'p>>,
    /// The sequence that the program begins with.
    pub(super) main: Option<&'p Sequence<'p>>,
    /// What runs at its end.
    pub(super) cleanup: Option<&'p Cleanup<'p>>,
}

impl<'p> Names<'p> {
    /// Those of a program.
    pub(super) fn of(program: &'p Program<'p>) -> Self {
        let mut names = Self::default();
        for item in &program.items {
            match item {
                Item::Io(io) => _ = names.io.insert(io.name.value, io),
                Item::Error(error) => _ = names.errors.insert(error.name.value, error),
                Item::AdvancedMove(guarded) => _ = names.moves.insert(guarded.name.value, guarded),
                Item::Sequence(sequence) => names.sequence(sequence),
                Item::Joints(joints) => {
                    let values = JointConfiguration(numbers(&joints.values));
                    names.joints.push((joints.name.value, values));
                }
                Item::ItemDeclaration(item) => names.items.push(item),
                Item::Signal(entry) => {
                    names.signals.insert(entry.name.value, entry.number.value);
                }
                Item::Cleanup(cleanup) => names.cleanup = Some(cleanup),
                Item::Allow(_) | Item::Cell(_) | Item::Import(_) | Item::Variable(_) => {}
            }
        }
        names
    }

    /// The program begins with `main`, or else with the last sequence that needs no arguments.
    fn sequence(&mut self, sequence: &'p Sequence<'p>) {
        self.sequences.insert(sequence.name.value, sequence);
        let is_candidate = !sequence.is_action && sequence.parameters.is_empty();
        if is_candidate && self.main.is_none_or(|known| known.name.value != "main") {
            self.main = Some(sequence);
        }
    }

    /// The number of an output or an input.
    pub(super) fn line(&self, signal: Signal<'_>) -> u16 {
        let number = match signal {
            Signal::Number(number) => Some(number),
            Signal::Name(name) => self.signals.get(name).copied(),
        };
        number.and_then(|number| u16::try_from(number).ok()).unwrap_or(u16::MAX)
    }

    /// A joint configuration or an item as a value.
    pub(super) fn value(&self, name: &str) -> Option<Value> {
        let joints = self.joints.iter().position(|(known, _)| *known == name);
        let item = self.items.iter().position(|item| item.name.value == name);
        let index = |place: usize| u16::try_from(place).ok();
        match (joints.and_then(index), item.and_then(index)) {
            (Some(joints), _) => Some(Value::Joints(joints)),
            (None, Some(item)) => Some(Value::Item(item)),
            (None, None) => None,
        }
    }

    /// A keyframe of an item in the item's frame.
    pub(super) fn keyframe(&self, item: u16, name: &str) -> Option<Pose> {
        let item = self.items.get(usize::from(item))?;
        let keyframe = item.keyframes.iter().find(|keyframe| keyframe.name.value == name)?;
        let rotation_rad = keyframe.rotation.as_ref().map_or([0.0; 3], numbers);
        Some(Pose::from_rotation_vector(numbers(&keyframe.position), rotation_rad))
    }
}

/// The numbers of a vector in metres or radians.
fn numbers<const COUNT: usize>(vector: &Vector<'_>) -> [f64; COUNT] {
    let unit = vector.unit.map_or("", |unit| unit.value);
    let mut numbers = [0.0; COUNT];
    for (number, element) in numbers.iter_mut().zip(&vector.elements) {
        *number = si(constant(element), unit);
    }
    numbers
}

/// A number that is known before the program runs.
fn constant(element: &Expression<'_>) -> f64 {
    evaluate(element, &|_| None, &Readings::default()).map_or(f64::NAN, Value::real)
}
