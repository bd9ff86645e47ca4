//! Going on by what is typed: back where an editor has no button, and on from errors.

use crate::console::{Done, Result, Typed};
use crate::debuggee::Debuggee;
use crate::motion::Going;
use crate::words;
use obverse_debugger::{Declined, Mode, Walk};
use obverse_vm::Direction;

pub(crate) fn back(it: &mut Debuggee<'_, '_, '_>, typed: &Typed<'_>, walk: Walk) -> Result {
    it.refuse_moving()?;
    match typed.rest {
        "" => Ok(Done::Back(Going::new(&it.session, Direction::Reverse, walk))),
        rest => Err(format!("nothing follows it here, and `{rest}` does: type it again to go on")),
    }
}

pub(crate) fn recover(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    it.refuse_moving()?;
    match it.session.mode() {
        Mode::Rewound => Err(Declined::NotLive.to_string()),
        _ if it.session.is_held() => Err(words::HELD.to_owned()),
        _ if it.session.is_recovering() => {
            let going = Going::new(&it.session, Direction::Forward, Walk::Recover);
            Ok(Done::Goes("recovering".to_owned(), going))
        }
        _ => Err(Declined::NothingDue.to_string()),
    }
}

pub(crate) fn release(it: &mut Debuggee<'_, '_, '_>, _: &Typed<'_>) -> Result {
    if !it.session.is_held() {
        return Err("no stop holds the arm".to_owned());
    }
    it.session.release().map_err(|why| why.to_string())?;
    Ok(Done::Told("the arm may move again; nothing has moved".to_owned()))
}
