//! Random modules, made instruction by instruction so that every opcode and every shape of control
//! that the verifier admits occurs, also those that no source program leads to.
//!
//! Every generated module verifies and, on a [`Ledger`](crate::Ledger), ends. Knows nothing of the
//! source language.

use arbitrary::{Result, Unstructured};
use obverse_bytecode::{
    Bounds, CodeBuilder, Constant, Continuation, ErrorDeclaration, Function, FunctionKind, Item,
    Keyframe, Mark, Module, Otherwise, Recovery, Respond, Severity, Variable,
};
use obverse_isa::{
    Axis, Bit, CheckpointId, ConstantId, CounterId, ErrorId, Frame, FunctionId, GlobalId, ItemId,
    JointsId, KeyframeId, Label, Level, LocalId, Path, Prefix, ReasonId, Setting, SlotId, SpeedId,
    ToolId, Type, op,
};

/// What generated modules may contain beside what every law holds for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Instructions of class never.
    pub never: bool,
    /// Blocks that are skipped or replaced in reverse.
    pub blocks: bool,
}

const P: Prefix = Prefix(0);
/// Locals by type: integers, reals, truth values, then one of each other kind.
const INTS: u8 = 5;
const REALS: u8 = 3;
const BOOLS: u8 = 2;
const JOINTS_LOCAL: LocalId = LocalId(INTS + REALS + BOOLS);
/// Written by nothing but the loops and branches that own them: a counter and a flag a depth.
const OWNED_FROM: u8 = JOINTS_LOCAL.0 + 1;
const MAX_DEPTH: u8 = 4;
/// How many branches a fork has at the most: each has variables and counters of its own.
const LANES: u8 = 3;
const FUNCTIONS: u16 = 4;
const GLOBAL_INTS: u16 = 2;

/// A random module that verifies.
///
/// # Errors
/// None in practice: exhausted randomness yields the simplest choice.
pub fn module(u: &mut Unstructured<'_>, options: Options) -> Result<Module> {
    let mut module = tables();
    let mut code = CodeBuilder::new();
    for index in 0..FUNCTIONS {
        let first = code.here();
        code.push(op::Enter {});
        let mut body = Body {
            u: &mut *u,
            code: &mut code,
            options,
            index,
            depth: 0,
            breaks: Vec::new(),
            in_block: false,
            lane: None,
        };
        let statements = body.u.int_in_range(1..=7)?;
        body.statements(statements)?;
        if index == 0 {
            code.push(op::Halt {});
        } else {
            code.push(op::Return {});
        }
        let end = code.here();
        module.functions.push(function(index, first, end));
    }
    module.code = code.finish();
    Ok(module)
}

fn function(index: u16, first: u32, end: u32) -> Function {
    let kind = if index == 0 { FunctionKind::Start } else { FunctionKind::Sequence };
    let of = |of_type, count: u8| (0..count).map(move |_| of_type);
    let types = of(Type::Int, INTS)
        .chain(of(Type::Real, REALS))
        .chain(of(Type::Bool, BOOLS))
        .chain([Type::Joints])
        .chain((0..MAX_DEPTH * LANES).flat_map(|_| [Type::Int, Type::Bool]));
    let locals = types
        .enumerate()
        .map(|(at, of_type)| Variable { name: format!("v{at}"), of_type, measures: None })
        .collect();
    let parameters = if has_parameters(index) { 2 } else { 0 };
    Function {
        name: format!("f{index}"),
        kind,
        parameters,
        locals,
        counters: MAX_DEPTH * LANES,
        slots: vec!["p0".to_owned(), "p1".to_owned()],
        first,
        end,
    }
}

/// The one function has them of its caller, and of the frame around a block that it replaces.
fn has_parameters(index: u16) -> bool {
    index == 2
}

fn tables() -> Module {
    let keyframe = Keyframe { name: 0, position_m: [0.1, 0.2, 0.3], rotation_rad: [0.0, 1.5, 0.0] };
    let error = |name: &str| ErrorDeclaration {
        name: name.to_owned(),
        severity: Severity::Recoverable,
        faults: Vec::new(),
        watches: Vec::new(),
        bounds: Bounds::default(),
        recovery: Recovery::None,
        otherwise: Otherwise::Stop,
        respond: Respond::AfterAction,
        continuation: Continuation::Stop,
    };
    let variable =
        |name: &str, of_type| Variable { name: name.to_owned(), of_type, measures: None };
    Module {
        constants: vec![
            Constant::Int(i64::MAX),
            Constant::Int(-7),
            Constant::Real(0.25),
            Constant::Real(-3.5e9),
        ],
        joints: vec![
            ("a".to_owned(), [0.0; 6]),
            ("b".to_owned(), [0.3, -1.0, 1.0, -0.5, 0.2, 3.0]),
            ("c".to_owned(), [-0.7, 0.1, -0.2, 0.9, 1.2, -2.0]),
        ],
        items: vec![Item { name: "part".to_owned(), keyframes: vec![keyframe] }],
        keyframes: vec!["grasp".to_owned()],
        tools: vec!["gripper".to_owned()],
        errors: vec![error("e0"), error("e1")],
        checkpoints: vec!["here".to_owned()],
        reasons: vec!["because".to_owned()],
        globals: vec![
            variable("g0", Type::Int),
            variable("g1", Type::Int),
            variable("g2", Type::Real),
        ],
        ..Module::default()
    }
}

struct Body<'b, 'u> {
    u: &'b mut Unstructured<'u>,
    code: &'b mut CodeBuilder,
    options: Options,
    index: u16,
    depth: u8,
    /// For each loop around: the jumps out of it.
    breaks: Vec<Vec<Mark>>,
    in_block: bool,
    /// The branch of a fork that this is in, and how deep the fork is.
    lane: Option<Lane>,
}

#[derive(Clone, Copy)]
struct Lane {
    number: u8,
    fork_depth: u8,
}

impl Body<'_, '_> {
    fn pick(&mut self, below: u8) -> Result<u8> {
        self.u.int_in_range(0..=below - 1)
    }

    fn flip(&mut self) -> Result<bool> {
        self.u.ratio(1_u8, 2)
    }

    fn int_local(&mut self) -> Result<LocalId> {
        self.pick(INTS).map(LocalId)
    }

    fn real_local(&mut self) -> Result<LocalId> {
        Ok(LocalId(INTS + self.pick(REALS)?))
    }

    fn bool_local(&mut self) -> Result<LocalId> {
        Ok(LocalId(INTS + REALS + self.pick(BOOLS)?))
    }

    /// What this depth of this branch has for itself, by number.
    fn own(&self) -> u8 {
        self.own_at(self.depth)
    }

    /// The same for a depth around this one.
    fn own_at(&self, depth: u8) -> u8 {
        let lane = self.lane.filter(|lane| depth >= lane.fork_depth);
        depth + MAX_DEPTH * lane.map_or(0, |lane| lane.number)
    }

    fn counter_around(&mut self) -> Result<CounterId> {
        let depth = self.pick(self.depth)?;
        Ok(CounterId(self.own_at(depth)))
    }

    /// Whether this is a branch beside one that moves and calls.
    fn is_beside(&self) -> bool {
        self.lane.is_some_and(|lane| lane.number > 0)
    }

    fn owned_counter(&self) -> LocalId {
        LocalId(OWNED_FROM + 2 * self.own())
    }

    fn owned_flag(&self) -> LocalId {
        LocalId(OWNED_FROM + 2 * self.own() + 1)
    }

    fn small(&mut self) -> Result<i32> {
        self.u.int_in_range(-20..=20)
    }

    fn statements(&mut self, count: u8) -> Result<()> {
        for _ in 0..count {
            self.statement()?;
        }
        Ok(())
    }

    fn statement(&mut self) -> Result<()> {
        let can_nest = self.depth < MAX_DEPTH;
        match self.pick(21)? {
            0 | 1 => self.store(),
            2 | 3 => self.update(),
            4..=7 => self.act(),
            8 => self.sense(),
            9 => self.setting(),
            10 => self.error(),
            11 if can_nest => self.branch(),
            12 if can_nest => self.asserted_branch(),
            13 if can_nest => self.while_loop(),
            14 if can_nest => self.counted_loop(),
            15 => self.call(),
            16 if can_nest && self.options.blocks => self.block(),
            17 if self.options.never => self.never(),
            18 => self.leave(),
            19 => {
                self.code.push(op::Checkpoint { checkpoint: CheckpointId(0) });
                Ok(())
            }
            20 if can_nest && self.lane.is_none() => self.fork(),
            _ => self.update(),
        }
    }

    /// Push an integer; never reads `but`.
    fn int(&mut self, depth: u8, but: Option<LocalId>) -> Result<()> {
        let leaf = depth == 0;
        match self.pick(if leaf { 5 } else { 16 })? {
            0 => drop(self.small().map(|value| self.code.push(op::PushInt { value }))?),
            1 => drop(self.code.push(op::PushConstant { constant: ConstantId(1) })),
            2 if self.depth > 0 => {
                let counter = self.counter_around()?;
                match self.pick(3)? {
                    0 => self.code.push(op::PushCounter { counter }),
                    1 => self.code.push(op::IntRemCounterImmediate { counter, value: 3 }),
                    _ => self.code.push(op::IntMulCounterImmediate { counter, value: -5 }),
                };
            }
            3 => drop(self.code.push(op::PushConstant { constant: ConstantId(0) })),
            2 | 4 => self.read_int(but)?,
            choice => {
                self.int(depth - 1, but)?;
                self.int_operator(choice, depth, but)?;
            }
        }
        Ok(())
    }

    fn read_int(&mut self, but: Option<LocalId>) -> Result<()> {
        let (local, right) = (self.int_local()?, self.int_local()?);
        let is_free = Some(local) != but && Some(right) != but;
        match self.pick(5)? {
            4 => drop(self.code.push(op::PushGlobal { global: GlobalId(1) })),
            0 if is_free => drop(self.code.push(op::IntAddLocals { left: local, right })),
            1 if is_free => drop(self.code.push(op::IntMulLocalImmediate { local, value: -3 })),
            2 if is_free => drop(self.code.push(op::IntRemLocalImmediate { local, value: 7 })),
            _ if is_free => drop(self.code.push(op::PushLocal { local })),
            _ => drop(self.code.push(op::PushInt { value: 2 })),
        }
        Ok(())
    }

    fn int_operator(&mut self, choice: u8, depth: u8, but: Option<LocalId>) -> Result<()> {
        match choice {
            5 => drop(self.code.push(op::IntAddImmediate { value: 5 })),
            6 => drop(self.code.push(op::IntMulImmediate { value: -3 })),
            7 => drop(self.code.push(op::IntRemImmediate { value: 9 })),
            8 => drop(self.code.push(op::IntNeg {})),
            9 => drop(self.code.push(op::IntAbs {})),
            10 => {
                let local = self.int_local()?;
                if Some(local) != but {
                    self.code.push(op::IntAddLocal { local });
                }
            }
            _ => {
                self.int(depth - 1, but)?;
                match choice {
                    11 => drop(self.code.push(op::IntAdd {})),
                    12 => drop(self.code.push(op::IntSub {})),
                    13 => drop(self.code.push(op::IntMul {})),
                    14 => drop(self.code.push(op::IntMin {})),
                    _ => drop(self.code.push(op::IntMax {})),
                }
            }
        }
        Ok(())
    }

    fn real(&mut self, depth: u8) -> Result<()> {
        match self.pick(if depth == 0 { 3 } else { 13 })? {
            0 => drop(self.code.push(op::PushConstant { constant: ConstantId(2) })),
            1 => drop(self.code.push(op::PushConstant { constant: ConstantId(3) })),
            2 => {
                let local = self.real_local()?;
                self.code.push(op::PushLocal { local });
            }
            3 => {
                self.int(depth - 1, None)?;
                self.code.push(op::IntToReal {});
            }
            choice @ 4..=6 => {
                self.real(depth - 1)?;
                match choice {
                    4 => drop(self.code.push(op::RealNeg {})),
                    5 => drop(self.code.push(op::RealAbs {})),
                    _ => {
                        self.code.push(op::RealAbs {});
                        self.code.push(op::RealSqrt {});
                    }
                }
            }
            choice => {
                self.real(depth - 1)?;
                self.real(depth - 1)?;
                match choice {
                    7 => drop(self.code.push(op::RealAdd {})),
                    8 => drop(self.code.push(op::RealSub {})),
                    9 => drop(self.code.push(op::RealMul {})),
                    10 => drop(self.code.push(op::RealMin {})),
                    11 => drop(self.code.push(op::RealDiv {})),
                    _ => drop(self.code.push(op::RealMax {})),
                }
            }
        }
        Ok(())
    }

    fn bool(&mut self, depth: u8) -> Result<()> {
        match self.pick(if depth == 0 { 3 } else { 15 })? {
            0 => drop(self.code.push(op::PushBool { value: Level::High })),
            1 => {
                let local = self.bool_local()?;
                self.code.push(op::PushLocal { local });
            }
            2 => drop(self.code.push(op::PushRaised { error: ErrorId(0) })),
            3 => {
                self.bool(depth - 1)?;
                self.code.push(op::BoolNot {});
            }
            choice @ 4..=6 => {
                self.bool(depth - 1)?;
                self.bool(depth - 1)?;
                match choice {
                    4 => drop(self.code.push(op::BoolAnd {})),
                    5 => drop(self.code.push(op::BoolOr {})),
                    _ => drop(self.code.push(op::BoolEq {})),
                }
            }
            choice @ 7..=10 => {
                self.int(depth - 1, None)?;
                self.int(depth - 1, None)?;
                match choice {
                    7 => drop(self.code.push(op::IntLt {})),
                    8 => drop(self.code.push(op::IntLe {})),
                    9 => drop(self.code.push(op::IntEq {})),
                    _ => drop(self.code.push(op::IntNe {})),
                }
            }
            choice => {
                self.real(depth - 1)?;
                self.real(depth - 1)?;
                match choice {
                    11 => drop(self.code.push(op::RealLt {})),
                    12 => drop(self.code.push(op::RealLe {})),
                    13 => drop(self.code.push(op::RealNe {})),
                    _ => drop(self.code.push(op::RealEq {})),
                }
            }
        }
        Ok(())
    }

    fn store(&mut self) -> Result<()> {
        match self.pick(7)? {
            0 => {
                self.real(2)?;
                let local = self.real_local()?;
                self.code.push(op::StoreLocal { prefix: P, local });
            }
            1 => {
                self.bool(2)?;
                let local = self.bool_local()?;
                self.code.push(op::StoreLocal { prefix: P, local });
            }
            2 => {
                self.joints()?;
                self.code.push(op::StoreLocal { prefix: P, local: JOINTS_LOCAL });
            }
            3 => {
                self.int(2, None)?;
                let global = GlobalId(u16::from(self.pick(GLOBAL_INTS as u8)?));
                self.code.push(op::StoreGlobal { prefix: P, global });
            }
            4 => {
                self.real(1)?;
                self.code.push(op::StoreGlobal { prefix: P, global: GlobalId(GLOBAL_INTS) });
            }
            5 => self.division()?,
            _ => {
                self.int(3, None)?;
                let local = self.int_local()?;
                self.code.push(op::StoreLocal { prefix: P, local });
            }
        }
        Ok(())
    }

    /// Divisions whose divisor is not zero, and a conversion that fits.
    fn division(&mut self) -> Result<()> {
        self.int(1, None)?;
        self.code.push(op::PushInt { value: 6 });
        match self.pick(3)? {
            0 => drop(self.code.push(op::IntDiv {})),
            1 => drop(self.code.push(op::IntRem {})),
            _ => {
                self.code.push(op::IntMin {});
                self.code.push(op::IntToReal {});
                self.code.push(op::PushConstant { constant: ConstantId(2) });
                self.code.push(op::RealMul {});
                self.code.push(op::RealToInt {});
            }
        }
        let local = self.int_local()?;
        self.code.push(op::StoreLocal { prefix: P, local });
        Ok(())
    }

    fn update(&mut self) -> Result<()> {
        let local = self.int_local()?;
        match self.pick(7)? {
            0 => {
                self.int(2, Some(local))?;
                self.code.push(op::AddLocal { prefix: P, local });
            }
            1 => {
                self.int(2, Some(local))?;
                self.code.push(op::SubLocal { prefix: P, local });
            }
            2 => {
                self.int(1, None)?;
                self.code.push(op::AddGlobal { prefix: P, global: GlobalId(0) });
            }
            3 => {
                self.int(1, None)?;
                self.code.push(op::SubGlobal { prefix: P, global: GlobalId(0) });
            }
            4 => {
                let value = self.int_local()?;
                if value == local {
                    self.code.push(op::AddLocalImmediate { local, value: 1 });
                } else if self.flip()? {
                    self.code.push(op::AddLocalLocal { local, value });
                } else {
                    self.code.push(op::SubLocalLocal { local, value });
                }
            }
            5 if self.depth > 0 => {
                let counter = self.counter_around()?;
                if self.flip()? {
                    self.code.push(op::AddLocalCounter { local, counter });
                } else {
                    self.code.push(op::SubLocalCounter { local, counter });
                }
            }
            _ => {
                let value = self.small()?;
                self.code.push(op::AddLocalImmediate { local, value });
            }
        }
        Ok(())
    }

    fn joints(&mut self) -> Result<()> {
        if self.flip()? {
            let joints = JointsId(u16::from(self.pick(3)?));
            self.code.push(op::PushJoints { joints });
        } else {
            self.code.push(op::PushLocal { local: JOINTS_LOCAL });
        }
        Ok(())
    }

    fn length(&mut self) {
        self.code.push(op::PushConstant { constant: ConstantId(2) });
    }

    fn path(&mut self) -> Result<Path> {
        Ok(if self.flip()? { Path::Joint } else { Path::Linear })
    }

    fn act(&mut self) -> Result<()> {
        let bit = Bit(u16::from(self.pick(8)?));
        // A move back to where the program was last asks that no other branch moves.
        let first = if self.is_beside() { 9 } else { 0 };
        match self.u.int_in_range(first..=12)? {
            0 => {
                self.joints()?;
                self.code.push(op::MoveJoint { prefix: P });
            }
            1 => {
                self.joints()?;
                self.code.push(op::MoveLinear { prefix: P });
            }
            2 => self.move_always()?,
            3 => {
                self.code.push(op::PushItem { item: ItemId(0) });
                let path = self.path()?;
                self.code.push(op::MoveItem { prefix: P, keyframe: KeyframeId(0), path });
            }
            4 => {
                self.length();
                self.code.push(op::MoveRelative {
                    prefix: P,
                    axis: Axis::MinusY,
                    frame: Frame::Base,
                });
            }
            5 => {
                self.length();
                self.length();
                self.length();
                self.code.push(op::MoveOffset { prefix: P, frame: Frame::ToolMount });
            }
            6 => {
                self.length();
                self.length();
                let (axis, frame) = (Axis::PlusZ, Frame::Tcp);
                if self.flip()? {
                    self.code.push(op::MoveGuarded { prefix: P, axis, frame });
                } else {
                    self.code.push(op::MoveGuardedOpposite { prefix: P, axis, frame });
                }
            }
            7 => {
                let slot = SlotId(self.pick(2)?);
                let path = self.path()?;
                self.code.push(op::MoveSlot { slot, path });
            }
            8 => self.turn()?,
            9 | 10 => {
                self.length();
                let level = if self.flip()? { Level::High } else { Level::Low };
                self.code.push(op::OutputSet { prefix: P, bit, level });
            }
            11 => {
                self.length();
                self.code.push(op::OutputToggle { prefix: P, bit });
            }
            _ => {
                self.length();
                self.code.push(op::Wait { prefix: P });
            }
        }
        Ok(())
    }

    fn turn(&mut self) -> Result<()> {
        self.length();
        self.length();
        let (axis, frame) = (Axis::PlusZ, Frame::Tcp);
        if self.flip()? {
            self.code.push(op::MoveTurn { prefix: P, axis, frame });
        } else {
            self.length();
            self.code.push(op::MoveTurnGuarded { prefix: P, axis, frame });
        }
        Ok(())
    }

    /// A move that goes back to where the program was last, which is where the arm stands.
    fn move_always(&mut self) -> Result<()> {
        let from = JointsId(u16::from(self.pick(3)?));
        let to = JointsId(u16::from(self.pick(3)?));
        self.code.push(op::PushJoints { joints: from });
        self.code.push(op::MoveJoint { prefix: P });
        self.code.push(op::PushJoints { joints: from });
        self.code.push(op::PushJoints { joints: to });
        let path = self.path()?;
        self.code.push(op::MoveAlways { prefix: P, path });
        Ok(())
    }

    fn sense(&mut self) -> Result<()> {
        let bit = Bit(u16::from(self.pick(8)?));
        let (real, bool) = (self.real_local()?, self.bool_local()?);
        let first = if self.is_beside() { 4 } else { 0 };
        match self.u.int_in_range(first..=7)? {
            0 => drop(self.code.push(op::SenseInput { local: bool, bit })),
            1 => drop(self.code.push(op::SenseForce { local: real })),
            choice @ 2..=3 => {
                // What came of the last motion, which after going back is another one.
                self.length();
                let (axis, frame) = (Axis::PlusX, Frame::Base);
                self.code.push(op::MoveRelative { prefix: P, axis, frame });
                if choice == 2 {
                    self.code.push(op::SenseDistance { local: real });
                } else {
                    self.code.push(op::SensePeakForce { local: real });
                }
            }
            4 => drop(self.code.push(op::SenseHolding { local: bool })),
            5 => drop(self.code.push(op::Draw { local: real })),
            6 => {
                self.length();
                let level = if self.flip()? { Level::High } else { Level::Low };
                self.code.push(op::WaitInput { prefix: P, local: bool, bit, level });
            }
            _ => {
                let slot = SlotId(self.pick(2)?);
                self.code.push(op::Remember { slot });
            }
        }
        Ok(())
    }

    fn setting(&mut self) -> Result<()> {
        match self.pick(6)? {
            0 => {
                let setting = Setting::ALL[usize::from(self.pick(5)?)];
                self.code.push(op::PushSetting { setting });
                self.code.push(op::SettingSet { prefix: P, setting });
            }
            2 => {
                self.length();
                self.code.push(op::SettingSet { prefix: P, setting: Setting::ReverseForceLimit });
            }
            3 => {
                self.bool(1)?;
                self.code.push(op::SettingSet { prefix: P, setting: Setting::ReverseStraight });
            }
            4 => {
                let speed = SpeedId::ALL[usize::from(self.pick(6)?)];
                self.code.push(op::PushSpeed { speed });
                self.code.push(op::SettingSet { prefix: P, setting: Setting::ReverseSpeed });
            }
            1 => {
                self.code.push(op::PushTool { tool: ToolId(0) });
                self.code.push(op::SettingSet { prefix: P, setting: Setting::Tool });
            }
            _ => {
                let speed = SpeedId::ALL[usize::from(self.pick(6)?)];
                self.code.push(op::PushSpeed { speed });
                self.code.push(op::SettingSet { prefix: P, setting: Setting::Speed });
            }
        }
        Ok(())
    }

    fn error(&mut self) -> Result<()> {
        let error = ErrorId(u16::from(self.pick(2)?));
        match self.pick(4)? {
            0 => drop(self.code.push(op::ErrorRaise { error })),
            1 => drop(self.code.push(op::ErrorClear { error })),
            2 => drop(self.code.push(op::ErrorDue { error })),
            _ => {
                self.code.push(op::PushBool { value: Level::High });
                self.code.push(op::Require { prefix: P, reason: ReasonId(0) });
            }
        }
        Ok(())
    }

    fn nested(&mut self) -> Result<()> {
        self.depth += 1;
        let statements = self.u.int_in_range(1..=3)?;
        let done = self.statements(statements);
        self.depth -= 1;
        done
    }

    /// A jump that is taken unless some condition holds.
    fn conditional(&mut self) -> Result<Mark> {
        let (local, right) = (self.int_local()?, self.int_local()?);
        Ok(match self.pick(9)? {
            0 => {
                self.bool(1)?;
                self.code.jump(|target| op::JumpIf { prefix: P, target })
            }
            1 => {
                self.bool(1)?;
                self.code.jump(|target| op::JumpUnless { prefix: P, target })
            }
            2 => {
                self.int(1, None)?;
                self.code.jump(|target| op::JumpUnlessEqImmediate { prefix: P, value: 3, target })
            }
            3 => {
                self.code.jump(|target| op::JumpUnlessLocalLtImmediate { local, value: 4, target })
            }
            4 => self.code.jump(|target| op::JumpUnlessLocalLtLocal { left: local, right, target }),
            choice => {
                self.int(1, None)?;
                self.int(1, None)?;
                self.code.jump(|target| match choice {
                    5 => obverse_isa::Instr::from(op::JumpUnlessLt { prefix: P, target }),
                    6 => op::JumpUnlessLe { prefix: P, target }.into(),
                    7 => op::JumpUnlessEq { prefix: P, target }.into(),
                    _ => op::JumpUnlessNe { prefix: P, target }.into(),
                })
            }
        })
    }

    fn branch(&mut self) -> Result<()> {
        let otherwise = self.conditional()?;
        self.nested()?;
        let end = self.code.jump(|target| op::Jump { target });
        self.code.join(otherwise, |from| op::Land { from });
        self.nested()?;
        self.code.join(end, |from| op::Join { from });
        Ok(())
    }

    fn asserted_branch(&mut self) -> Result<()> {
        let flag = self.owned_flag();
        let otherwise = self.conditional()?;
        self.nested()?;
        self.set_flag(flag, Level::High);
        let end = self.code.jump(|target| op::Jump { target });
        self.code.join(otherwise, |from| op::Land { from });
        self.nested()?;
        self.set_flag(flag, Level::Low);
        self.code.push(op::PushLocal { local: flag });
        self.code.join(end, |from| op::JoinAssert { prefix: P, from });
        Ok(())
    }

    fn set_flag(&mut self, flag: LocalId, value: Level) {
        self.code.push(op::PushBool { value });
        self.code.push(op::StoreLocal { prefix: P, local: flag });
    }

    fn while_loop(&mut self) -> Result<()> {
        let local = self.owned_counter();
        let rounds = self.u.int_in_range(0..=4)?;
        self.code.push(op::PushInt { value: 0 });
        self.code.push(op::StoreLocal { prefix: P, local });
        let top = if self.flip()? {
            // True if it came round again.
            self.code.push(op::PushLocal { local });
            self.code.push(op::PushInt { value: 0 });
            self.code.push(op::IntNe {});
            self.code.join_ahead(|from| op::JoinAssert { prefix: P, from })
        } else {
            self.code.join_ahead(|from| op::Join { from })
        };
        let exit = self.code.jump(|target| op::JumpUnlessLocalLtImmediate {
            local,
            value: rounds,
            target,
        });
        self.code.push(op::AddLocalImmediate { local, value: 1 });
        self.breaks.push(Vec::new());
        self.nested()?;
        self.code.jump_back(top, |target: Label| op::Jump { target });
        self.code.join(exit, |from| op::Land { from });
        self.end_breaks();
        Ok(())
    }

    fn counted_loop(&mut self) -> Result<()> {
        let counter = CounterId(self.own());
        let first = self.small()?;
        let value = first + self.u.int_in_range(-1..=3)?;
        self.code.push(op::PushInt { value: first });
        self.code.push(op::PushInt { value });
        let enter = self.code.jump(|exit| op::ForEnter { prefix: P, counter, exit });
        let top = self.code.join_ahead(|from| op::ForTop { counter, from });
        self.breaks.push(Vec::new());
        self.nested()?;
        self.code.jump_back(top, |target| op::ForNext { counter, target });
        self.code.join(enter, |from| op::ForExit { counter, from });
        self.end_breaks();
        Ok(())
    }

    fn end_breaks(&mut self) {
        for jump in self.breaks.pop().unwrap_or_default() {
            self.code.join(jump, |from| op::Join { from });
        }
    }

    fn leave(&mut self) -> Result<()> {
        if self.breaks.is_empty() || self.in_block {
            return self.update();
        }
        let jump = self.conditional()?;
        if let Some(breaks) = self.breaks.last_mut() {
            breaks.push(jump);
        }
        Ok(())
    }

    fn call(&mut self) -> Result<()> {
        // Later functions only, so that calls end; few, so that they end soon.
        let next = self.index + 1;
        if next >= FUNCTIONS || self.depth > 1 || self.is_beside() {
            return self.update();
        }
        let function = FunctionId(self.u.int_in_range(next..=FUNCTIONS - 1)?);
        if has_parameters(function.0) {
            self.int(1, None)?;
            self.int(1, None)?;
        }
        self.code.push(op::Call { prefix: P, function });
        Ok(())
    }

    fn fork(&mut self) -> Result<()> {
        let fork = self.code.jump(|join| op::Fork { join });
        let breaks = std::mem::take(&mut self.breaks);
        let mut leaves = Vec::new();
        for number in 0..self.u.int_in_range(1..=LANES)? {
            if number > 0 {
                self.code.push(op::ForkNext {});
            }
            self.lane = Some(Lane { number, fork_depth: self.depth });
            self.nested()?;
            if self.u.ratio(1_u8, 4)? {
                let goes_on = self.conditional()?;
                leaves.push(self.code.jump(|join| op::ForkLeave { join }));
                self.code.join(goes_on, |from| op::Land { from });
            }
        }
        self.lane = None;
        self.breaks = breaks;
        let join = self.code.join(fork, |from| op::ForkJoin { from });
        leaves.into_iter().for_each(|leave| self.code.lead(leave, join));
        Ok(())
    }

    fn block(&mut self) -> Result<()> {
        let from = Label(self.code.push(op::BlockBegin {}));
        let was_in_block = std::mem::replace(&mut self.in_block, true);
        self.nested()?;
        self.in_block = was_in_block;
        match self.pick(4)? {
            0 => drop(self.code.push(op::BlockSkip { from })),
            // A function that comes before this one, or after it; never itself, so that going back
            // ends.
            1 if self.index > 1 => {
                self.code.push(op::BlockReplace { function: FunctionId(1), from });
            }
            2 if self.index != 2 => {
                self.code.push(op::BlockReplace { function: FunctionId(2), from });
            }
            _ if self.index + 1 < FUNCTIONS => {
                self.code.push(op::BlockReplace { function: FunctionId(FUNCTIONS - 1), from });
            }
            _ => drop(self.code.push(op::BlockSkip { from })),
        }
        Ok(())
    }

    fn never(&mut self) -> Result<()> {
        let reason = ReasonId(0);
        if self.flip()? {
            self.code.push(op::Barrier { reason });
        } else {
            self.code.push(op::Irreversible { reason });
        }
        Ok(())
    }
}
