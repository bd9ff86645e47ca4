//! How orders stand in a file: the numbers of the instruction table's names, which are no data of
//! a format by themselves.

use crate::recording;
use obverse_isa::{ErrorId, GlobalId, LocalId};
use obverse_vm::{Alteration, Aside};
use serde::{Deserialize, Serialize};

/// Slower by, force factor, and where and how far aside in metres.
type Altered = (u8, Option<f64>, Option<(u32, [f64; 2])>);

/// See [`recording::Order`].
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(crate) enum Order {
    Forward,
    Reverse,
    Unwind,
    Raise(u16),
    PassOver,
    Leave,
    Note(u32),
    Alter(Option<Altered>),
    SetGlobal(u16, u64),
    SetLocal(u32, u8, u64),
    Change,
}

impl From<recording::Order> for Order {
    fn from(order: recording::Order) -> Self {
        use recording::Order as To;
        match order {
            To::Forward => Self::Forward,
            To::Reverse => Self::Reverse,
            To::Unwind => Self::Unwind,
            To::Raise(error) => Self::Raise(error.0),
            To::PassOver => Self::PassOver,
            To::Leave => Self::Leave,
            To::Note(index) => Self::Note(index),
            To::Alter(alteration) => Self::Alter(alteration.map(|it| {
                let aside = it.aside.map(|aside| (aside.pc, aside.by_m));
                (it.slower, it.force_factor, aside)
            })),
            To::Change => Self::Change,
            To::SetGlobal(global, value) => Self::SetGlobal(global.0, value),
            To::SetLocal(frame, local, value) => Self::SetLocal(frame, local.0, value),
        }
    }
}

impl From<Order> for recording::Order {
    fn from(order: Order) -> Self {
        match order {
            Order::Forward => Self::Forward,
            Order::Reverse => Self::Reverse,
            Order::Unwind => Self::Unwind,
            Order::Raise(error) => Self::Raise(ErrorId(error)),
            Order::PassOver => Self::PassOver,
            Order::Leave => Self::Leave,
            Order::Note(index) => Self::Note(index),
            Order::Alter(alteration) => {
                Self::Alter(alteration.map(|(slower, force_factor, aside)| Alteration {
                    slower,
                    force_factor,
                    aside: aside.map(|(pc, by_m)| Aside { pc, by_m }),
                }))
            }
            Order::Change => Self::Change,
            Order::SetGlobal(global, value) => Self::SetGlobal(GlobalId(global), value),
            Order::SetLocal(frame, local, value) => Self::SetLocal(frame, LocalId(local), value),
        }
    }
}
