//! Motions, and what is set, waited for and remembered between them.

use super::Generator;
use super::scope::Type;
use arbitrary::Result;

const FRAMES: [&str; 4] = ["", " in tcp", " in toolmount", " in base"];
const SPEEDS: [&str; 5] = ["slow", "very slow", "normal", "fast", "very fast"];

impl Generator<'_, '_> {
    /// `move …`
    pub(super) fn motion(&mut self) -> Result<()> {
        if !self.has_arm() {
            return self.output();
        }
        if self.one_in(6)? {
            let turn = self.turn()?;
            self.line(&turn);
            self.frame.knows_position = false;
            return Ok(());
        }
        let (target, is_named) = self.target()?;
        let linearly = self.choose(&["", " linearly"])?;
        let is_always = is_named && self.frame.knows_position && self.one_in(2)?;
        let always = if is_always { " reversible always" } else { "" };
        self.line(&format!("move {target}{linearly}{always}"));
        self.frame.knows_position = is_named;
        Ok(())
    }

    /// Where to, and whether that is a joint configuration by name.
    fn target(&mut self) -> Result<(String, bool)> {
        let positions = self.frame.positions.clone();
        let items = self.readable(Type::Item).into_iter().chain(self.items.clone());
        let items: Vec<String> = items.collect();
        Ok(match self.below(6)? {
            0 | 1 => (format!("to {}", self.choose(&self.joints.clone())?), true),
            2 if !positions.is_empty() => (format!("to {}", self.choose(&positions)?), false),
            3 if !items.is_empty() => {
                let keyframe = self.choose(&["grasp", "above"])?;
                (format!("to {}.{keyframe}", self.choose(&items)?), false)
            }
            4 => {
                let variables = self.readable(Type::Joints);
                match variables.is_empty() {
                    true => (self.way(false)?, false),
                    false => (format!("to {}", self.choose(&variables)?), false),
                }
            }
            _ => (self.way(false)?, false),
        })
    }

    /// `20 mm up in base`; of an advanced move it is more than nothing.
    pub(super) fn way(&mut self, is_positive: bool) -> Result<String> {
        let distance = match self.below(3)? {
            0 => format!("{} mm", self.below(300)? + 1),
            1 => format!("({} * 2)", self.bounded(Type::Length)?),
            _ => format!("({})", self.bounded(Type::Length)?),
        };
        let distance = match is_positive && distance.starts_with('(') {
            true => format!("(abs({distance}) + 1 mm)"),
            false => distance,
        };
        Ok(format!("{distance} {}", self.direction()?))
    }

    /// `forward in tcp`
    fn direction(&mut self) -> Result<String> {
        let heading = self.choose(&[
            "forward", "backward", "left", "right", "up", "down", "x", "y", "z", "-x", "-y", "-z",
        ])?;
        let frame = self.choose(&FRAMES)?;
        Ok(format!("{heading}{frame}"))
    }

    /// `turn 720 deg advancing 2 mm forward in tcp`
    pub(super) fn turn(&mut self) -> Result<String> {
        let angle = match self.below(2)? {
            0 => format!("{} deg", self.below(1000)?),
            _ => format!("({})", self.bounded(Type::Angle)?),
        };
        let advance = match self.below(3)? {
            0 => String::new(),
            1 => format!(" advancing {} mm", self.below(30)?),
            _ => format!(" advancing ({})", self.bounded(Type::Length)?),
        };
        Ok(format!("turn {angle}{advance} {}", self.direction()?))
    }

    /// `position p`
    pub(super) fn remember(&mut self) -> Result<()> {
        if !self.has_arm() {
            return self.output();
        }
        let positions = self.frame.positions.clone();
        let free = &positions[self.frame.kept_positions.min(positions.len())..];
        let name = match free.is_empty() || self.one_in(2)? {
            true => self.name("here"),
            false => self.choose(free)?,
        };
        self.line(&format!("position {name}"));
        if !positions.contains(&name) {
            self.frame.positions.push(name);
        }
        Ok(())
    }

    /// `speed slow`, `tool gripper`, to the end of the sequence.
    pub(super) fn setting(&mut self) -> Result<String> {
        Ok(match self.below(2)? {
            0 => format!("speed {}", self.choose(&SPEEDS)?),
            _ => format!("tool {}", self.choose(&["gripper", "probe", "welder0"])?),
        })
    }

    /// `set 0 high`, `toggle 3`, perhaps with its settling time.
    pub(super) fn output(&mut self) -> Result<()> {
        let bit = self.any_output()?;
        match self.below(3)? {
            0 => self.line(&format!("toggle {bit}")),
            1 => self.line(&format!("set {bit} low")),
            _ => self.line(&format!("set {bit} high")),
        }
        for _ in 0..self.below(3)? {
            let time = self.duration()?;
            self.line(&format!("sleep {time}"));
        }
        Ok(())
    }

    /// A time that is not negative and not long.
    pub(super) fn duration(&mut self) -> Result<String> {
        let names = self.readable(Type::Time);
        Ok(match self.below(4)? {
            0 if !names.is_empty() => format!("abs({})", self.choose(&names)?),
            1 if self.frame.may_read && self.has_dice() => {
                format!("random(1 ms, {} ms)", self.below(20)? + 1)
            }
            2 => format!("0.{} s", self.below(100)?),
            _ => format!("{} ms", self.below(50)?),
        })
    }

    /// `speed slow` of an advanced move.
    pub(super) fn speed(&mut self) -> Result<String> {
        Ok(format!("speed {}", self.choose(&SPEEDS)?))
    }
}
