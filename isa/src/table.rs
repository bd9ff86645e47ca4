//! The table: a row an opcode. Rows only, no logic.
//!
//! A row is
//!
//! ```text
//! /// What it does; the first line is its summary.
//! CODE Ident "mnemonic" (operands: Types) [pops -- pushes] class family;
//! ```
//!
//! - `CODE` is explicit, ascending and never reused, since modules outlive an enum's order.
//! - The stack picture has types, or `local`, `global`, `constant`, `setting`, `parameters` where
//!   the type is that of what the instruction names.
//! - The class is `always`, `after_forward(Record)` or `never("why")`; the record names what is
//!   saved, the reason ends up in what people read.
//! - The family `value` is pure: it touches the operand stack alone. Every other family is an
//!   effect, which ends a statement; an effect that takes operands knows the length of the pure
//!   prefix that made them (`prefix`), and the assembler fills it in.
//!
//! `for_each_op!` hands all rows to the macro that it is given the name of.

/// Hand every row of the table to a macro.
#[macro_export]
macro_rules! for_each_op {
    ($consumer:ident) => {
        $consumer! {
/// Push a small integer.
0x01 PushInt "push.int" (value: i32) [-- int] always value;
/// Push a constant of the module.
0x02 PushConstant "push.const" (constant: ConstantId) [-- constant] always value;
/// Push a truth value.
0x03 PushBool "push.bool" (value: Level) [-- bool] always value;
/// Push a local variable.
0x04 PushLocal "push.local" (local: LocalId) [-- local] always value;
/// Push a variable of the program.
0x05 PushGlobal "push.global" (global: GlobalId) [-- global] always value;
/// Push the present value of a loop counter.
0x06 PushCounter "push.counter" (counter: CounterId) [-- int] always value;
/// Push a joint configuration of the module.
0x07 PushJoints "push.joints" (joints: JointsId) [-- joints] always value;
/// Push an item of the module.
0x08 PushItem "push.item" (item: ItemId) [-- item] always value;
/// Push a speed.
0x09 PushSpeed "push.speed" (speed: SpeedId) [-- speed] always value;
/// Push a tool of the module.
0x0a PushTool "push.tool" (tool: ToolId) [-- tool] always value;
/// Push what a setting is now, by identity.
0x0b PushSetting "push.setting" (setting: Setting) [-- setting] always value;
/// Push whether an error is pending.
0x0c PushRaised "push.raised" (error: ErrorId) [-- bool] always value;

/// Add integers, wrapping.
0x10 IntAdd "int.add" () [int int -- int] always value;
/// Subtract integers, wrapping.
0x11 IntSub "int.sub" () [int int -- int] always value;
/// Multiply integers, wrapping.
0x12 IntMul "int.mul" () [int int -- int] always value;
/// Divide integers towards zero; a divisor of zero is a trap, the least integer by -1 wraps.
0x13 IntDiv "int.div" () [int int -- int] always value;
/// The remainder with the sign of the dividend; a divisor of zero is a trap.
0x14 IntRem "int.rem" () [int int -- int] always value;
/// Negate an integer, wrapping.
0x15 IntNeg "int.neg" () [int -- int] always value;
/// The absolute value, wrapping.
0x16 IntAbs "int.abs" () [int -- int] always value;
/// The smaller of two integers.
0x17 IntMin "int.min" () [int int -- int] always value;
/// The larger of two integers.
0x18 IntMax "int.max" () [int int -- int] always value;
/// Whether the first is less than the second.
0x19 IntLt "int.lt" () [int int -- bool] always value;
/// Whether the first is at most the second.
0x1a IntLe "int.le" () [int int -- bool] always value;
/// Whether two integers are equal.
0x1b IntEq "int.eq" () [int int -- bool] always value;
/// Whether two integers differ.
0x1c IntNe "int.ne" () [int int -- bool] always value;
/// Add a small integer, wrapping: `push.int` and `int.add` in one.
0x1d IntAddImmediate "int.add.imm" (value: i32) [int -- int] always value;
/// Multiply by a small integer, wrapping: `push.int` and `int.mul` in one.
0x1e IntMulImmediate "int.mul.imm" (value: i32) [int -- int] always value;
/// The remainder by a small integer: `push.int` and `int.rem` in one; zero is a trap.
0x1f IntRemImmediate "int.rem.imm" (value: i32) [int -- int] always value;

/// Add reals.
0x20 RealAdd "real.add" () [real real -- real] always value;
/// Subtract reals.
0x21 RealSub "real.sub" () [real real -- real] always value;
/// Multiply reals.
0x22 RealMul "real.mul" () [real real -- real] always value;
/// Divide reals by IEEE rules; by zero gives an infinity or no number.
0x23 RealDiv "real.div" () [real real -- real] always value;
/// Negate a real.
0x24 RealNeg "real.neg" () [real -- real] always value;
/// The absolute value of a real.
0x25 RealAbs "real.abs" () [real -- real] always value;
/// The smaller of two reals; the other where one is no number.
0x26 RealMin "real.min" () [real real -- real] always value;
/// The larger of two reals; the other where one is no number.
0x27 RealMax "real.max" () [real real -- real] always value;
/// The square root; of a negative real, no number.
0x28 RealSqrt "real.sqrt" () [real -- real] always value;
/// Whether the first is less than the second.
0x29 RealLt "real.lt" () [real real -- bool] always value;
/// Whether the first is at most the second.
0x2a RealLe "real.le" () [real real -- bool] always value;
/// Whether two reals are equal.
0x2b RealEq "real.eq" () [real real -- bool] always value;
/// Whether two reals differ.
0x2c RealNe "real.ne" () [real real -- bool] always value;
/// An integer as the nearest real.
0x2d IntToReal "int.to_real" () [int -- real] always value;
/// A real as an integer, towards zero; out of range or no number is a trap.
0x2e RealToInt "real.to_int" () [real -- int] always value;

/// Not.
0x30 BoolNot "bool.not" () [bool -- bool] always value;
/// And, of two values that are both there.
0x31 BoolAnd "bool.and" () [bool bool -- bool] always value;
/// Or, of two values that are both there.
0x32 BoolOr "bool.or" () [bool bool -- bool] always value;
/// Whether two truth values are equal.
0x33 BoolEq "bool.eq" () [bool bool -- bool] always value;
/// Push one local integer plus another: two pushes and `int.add` in one.
0x34 IntAddLocals "int.add.locals" (left: LocalId, right: LocalId) [-- int] always value;
/// Add a local integer to the top: `push.local` and `int.add` in one.
0x35 IntAddLocal "int.add.local" (local: LocalId) [int -- int] always value;
/// Push a local integer times a small one.
0x36 IntMulLocalImmediate "int.mul.local.imm" (local: LocalId, value: i32) [-- int] always value;
/// Push the remainder of a local integer by a small one; zero is a trap.
0x37 IntRemLocalImmediate "int.rem.local.imm" (local: LocalId, value: i32) [-- int] always value;
/// Push the remainder of a loop counter by a small integer; zero is a trap.
0x38 IntRemCounterImmediate "int.rem.counter.imm" (counter: CounterId, value: i32) [-- int] always value;
/// Push a loop counter times a small integer.
0x39 IntMulCounterImmediate "int.mul.counter.imm" (counter: CounterId, value: i32) [-- int] always value;

/// Store into a local variable; its former value is saved.
0x40 StoreLocal "store.local" (prefix: Prefix, local: LocalId) [local --] after_forward(Word) variable;
/// Store into a variable of the program; its former value is saved.
0x41 StoreGlobal "store.global" (prefix: Prefix, global: GlobalId) [global --] after_forward(Word) variable;
/// Add to a local integer that the operand does not read; in reverse, subtract.
0x42 AddLocal "add.local" (prefix: Prefix, local: LocalId) [int --] always variable;
/// Subtract from a local integer that the operand does not read; in reverse, add.
0x43 SubLocal "sub.local" (prefix: Prefix, local: LocalId) [int --] always variable;
/// Add to an integer of the program that the operand does not read; in reverse, subtract.
0x44 AddGlobal "add.global" (prefix: Prefix, global: GlobalId) [int --] always variable;
/// Subtract from an integer of the program that the operand does not read; in reverse, add.
0x45 SubGlobal "sub.global" (prefix: Prefix, global: GlobalId) [int --] always variable;
/// Add a small integer to a local integer; in reverse, subtract it.
0x46 AddLocalImmediate "add.local.imm" (local: LocalId, value: i32) [--] always variable;
/// Add a local integer to another one; in reverse, subtract it.
0x47 AddLocalLocal "add.local.local" (local: LocalId, value: LocalId) [--] always variable;
/// Add a loop counter to a local integer; in reverse, subtract it.
0x48 AddLocalCounter "add.local.counter" (local: LocalId, counter: CounterId) [--] always variable;
/// Subtract a local integer from another one; in reverse, add it.
0x49 SubLocalLocal "sub.local.local" (local: LocalId, value: LocalId) [--] always variable;
/// Subtract a loop counter from a local integer; in reverse, add it.
0x4a SubLocalCounter "sub.local.counter" (local: LocalId, counter: CounterId) [--] always variable;

/// Go on at a join, which is landed on in the same step.
0x50 Jump "jump" (target: Label) [--] always flow;
/// Go on at a join if the operand is true.
0x51 JumpIf "jump.if" (prefix: Prefix, target: Label) [bool --] always flow;
/// Go on at a join unless the operand is true.
0x52 JumpUnless "jump.unless" (prefix: Prefix, target: Label) [bool --] always flow;
/// Go on at a join unless the first operand is less than the second.
0x53 JumpUnlessLt "jump.unless.lt" (prefix: Prefix, target: Label) [int int --] always flow;
/// Go on at a join unless the first operand is at most the second.
0x54 JumpUnlessLe "jump.unless.le" (prefix: Prefix, target: Label) [int int --] always flow;
/// Go on at a join unless the operands are equal.
0x55 JumpUnlessEq "jump.unless.eq" (prefix: Prefix, target: Label) [int int --] always flow;
/// Go on at a join unless the operands differ.
0x56 JumpUnlessNe "jump.unless.ne" (prefix: Prefix, target: Label) [int int --] always flow;
/// Go on at a join unless the operand equals a small integer.
0x57 JumpUnlessEqImmediate "jump.unless.eq.imm" (prefix: Prefix, value: i16, target: Label) [int --] always flow;
/// Go on at a join unless a local integer is less than a small one.
0x58 JumpUnlessLocalLtImmediate "jump.unless.local.lt.imm" (local: LocalId, value: i16, target: Label) [--] always flow;
/// Go on at a join unless one local integer is less than another.
0x59 JumpUnlessLocalLtLocal "jump.unless.local.lt.local" (left: LocalId, right: LocalId, target: Label) [--] always flow;
/// The join of a place that only its jump reaches; in reverse, back to the jump.
0x60 Land "land" (from: Label) [--] always flow;
/// A recorded join of the way from above and of a jump: one bit says which it was.
0x61 Join "join" (from: Label) [--] after_forward(Bit) flow;
/// An asserted join: the operand is true if and only if it was reached by the jump; a jump that
/// lands on it runs the prefix. In reverse the operand says where to go back to.
0x62 JoinAssert "join.assert" (prefix: Prefix, from: Label) [bool --] always flow;
/// Begin a counted loop over first to last, both included: save the counter's former first, last
/// and present value, set them, and go on at `for.exit` if there is nothing to count.
0x63 ForEnter "for.enter" (prefix: Prefix, counter: CounterId, exit: Label) [int int --] after_forward(Counter) flow;
/// The join at the top of a counted loop's body: came round again unless the counter is at first.
0x64 ForTop "for.top" (counter: CounterId, from: Label) [--] always flow;
/// Count up, and go on at `for.top` unless the counter has passed the last.
0x65 ForNext "for.next" (counter: CounterId, target: Label) [--] always flow;
/// The join after a counted loop: came from `for.enter` if there was nothing to count.
0x66 ForExit "for.exit" (counter: CounterId, from: Label) [--] always flow;
/// Call a function with the operands as its first locals. In reverse, enter the function at its
/// `return`, with the frame that `return` saved.
0x67 Call "call" (prefix: Prefix, function: FunctionId) [parameters --] always frame;
/// The first instruction of a function, landed on by `call`. In reverse, drop the frame and go
/// back to the call.
0x68 Enter "enter" () [--] always frame;
/// The last instruction of a function: save the frame and go back to the caller.
0x69 Return "return" () [--] after_forward(Frame) frame;
/// The end of the program: stay here.
0x6a Halt "halt" () [--] always frame;

/// Change a setting; the identity of the former one is saved.
0x70 SettingSet "setting.set" (prefix: Prefix, setting: Setting) [setting --] after_forward(Word) setting;

/// Move to a joint configuration, straight in joint space. In reverse, to the recorded start.
0x80 MoveJoint "move.joint" (prefix: Prefix) [joints --] after_forward(Joints) kinematic;
/// Move to a joint configuration with the tool on a straight line. In reverse, likewise to the
/// recorded start.
0x81 MoveLinear "move.linear" (prefix: Prefix) [joints --] after_forward(Joints) kinematic;
/// Move to the second configuration; in reverse, to the first, which the program named last.
/// Restores the start if the arm stood exactly there: the programmer's word.
0x82 MoveAlways "move.always" (prefix: Prefix, path: Path) [joints joints --] always kinematic;
/// Move the tool to a keyframe of an item, in the nearest configuration. In reverse, to the
/// recorded start.
0x83 MoveItem "move.item" (prefix: Prefix, keyframe: KeyframeId, path: Path) [item --] after_forward(Joints) kinematic;
/// Move the tool straight by a distance in metres along an axis. In reverse, to the recorded start.
0x84 MoveRelative "move.relative" (prefix: Prefix, axis: Axis, frame: Frame) [real --] after_forward(Joints) kinematic;
/// Move the tool straight by x, y and z metres. In reverse, to the recorded start.
0x85 MoveOffset "move.offset" (prefix: Prefix, frame: Frame) [real real real --] after_forward(Joints) kinematic;
/// Move the tool straight by a distance in metres until the force exceeds so many newtons; being
/// stopped so is a success. In reverse, straight back to the recorded start.
0x86 MoveGuarded "move.guarded" (prefix: Prefix, axis: Axis, frame: Frame) [real real --] after_forward(Joints) kinematic;
/// Move to a remembered position. In reverse, to the recorded start.
0x87 MoveSlot "move.slot" (slot: SlotId, path: Path) [--] after_forward(Joints) kinematic;
/// Move as `move.guarded` does. In reverse, straight back to the recorded start with the same force
/// limit: being stopped by more is a fault there, from which it may be tried again.
0x88 MoveGuardedOpposite "move.guarded.opposite" (prefix: Prefix, axis: Axis, frame: Frame) [real real --] after_forward(Joints) kinematic;
/// Turn the tool about an axis through its centre point by an angle in radians, by the right hand,
/// moving so many metres along the axis meanwhile. Whole turns count. In reverse, turned back to
/// the recorded start.
0x89 MoveTurn "move.turn" (prefix: Prefix, axis: Axis, frame: Frame) [real real --] after_forward(Joints) kinematic;
/// Turn as `move.turn` does until the force exceeds so many newtons; being stopped so is a success.
/// In reverse, turned back to the recorded start.
0x8a MoveTurnGuarded "move.turn.guarded" (prefix: Prefix, axis: Axis, frame: Frame) [real real real --] after_forward(Joints) kinematic;

/// Remember where the arm is; the position remembered before is saved.
0x90 Remember "remember" (slot: SlotId) [--] after_forward(Joints) sense;
/// Store whether an input is high.
0x91 SenseInput "sense.input" (local: LocalId, bit: Bit) [--] after_forward(Word) sense;
/// Store the filtered contact force, in newtons.
0x92 SenseForce "sense.force" (local: LocalId) [--] after_forward(Word) sense;
/// Store how far the last motion came, in metres; meant for right after a motion, since going back
/// moves too.
0x93 SenseDistance "sense.distance" (local: LocalId) [--] after_forward(Word) sense;
/// Store the largest force of the last motion, in newtons; meant for right after a motion.
0x94 SensePeakForce "sense.peak_force" (local: LocalId) [--] after_forward(Word) sense;
/// Store whether the gripper holds an item.
0x95 SenseHolding "sense.holding" (local: LocalId) [--] after_forward(Word) sense;
/// Store a random real of [0, 1) and count the draw; in reverse, count it back.
0x96 Draw "draw" (local: LocalId) [--] after_forward(Word) sense;
/// Wait until an input has a level, for so many seconds at the most; store whether it had.
0x97 WaitInput "wait.input" (prefix: Prefix, local: LocalId, bit: Bit, level: Level) [real --] after_forward(Word) sense;

/// Set an output and let it settle for so many seconds. In reverse, its former level, and the same
/// time to settle.
0xa0 OutputSet "output.set" (prefix: Prefix, bit: Bit, level: Level) [real --] after_forward(Bit) io;
/// Change the level of an output and let it settle for so many seconds. In reverse, the same.
0xa1 OutputToggle "output.toggle" (prefix: Prefix, bit: Bit) [real --] always io;
/// Let so many seconds pass. In reverse nothing needs to be waited for.
0xa2 Wait "wait" (prefix: Prefix) [real --] always io;

/// Nothing before this can be taken back, for the reason that the program gives.
0xb0 Barrier "barrier" (reason: ReasonId) [--] never("the program has a barrier here") reversal;
/// An end of a block that cannot be taken back, for the reason that the program gives.
0xb1 Irreversible "irreversible" (reason: ReasonId) [--] never("the program says that this block cannot be taken back") reversal;
/// A place that a recovery may go back to.
0xb2 Checkpoint "checkpoint" (checkpoint: CheckpointId) [--] always reversal;
/// Begin a block that has a reverse of its own.
0xb3 BlockBegin "block.begin" () [--] always reversal;
/// End a block that is passed over in reverse: the state of the program is restored as always, and
/// the workcell is commanded nothing.
0xb4 BlockSkip "block.skip" (from: Label) [--] always reversal;
/// End a block in whose place a function is run in reverse: the workcell is commanded what the
/// function says, and then the state of the program is restored as always. The function begins with
/// the frame around it as it is here: the locals that it has as parameters, the counters, the
/// positions.
0xb5 BlockReplace "block.replace" (function: FunctionId, from: Label) [--] always reversal;

/// Raise an error: it becomes pending, and whoever drives the machine is told.
0xc0 ErrorRaise "error.raise" (error: ErrorId) [--] always error;
/// An error is dealt with: take it from those that are pending.
0xc1 ErrorClear "error.clear" (error: ErrorId) [--] after_forward(Word) error;
/// Trap with a reason unless the operand is true.
0xc2 Require "require" (prefix: Prefix, reason: ReasonId) [bool --] always error;
/// An error is responded to here: whoever drives the machine is told, and may take it back. Going on
/// means that going back has been given up, or was not asked for.
0xc3 ErrorDue "error.due" (error: ErrorId) [--] always error;

/// Begin tasks, one a branch: the branches follow, set apart by `fork.next`, up to the `fork.join`. The
/// first that does not begin with a motion goes on; the others wait for their turns. In reverse all
/// stand at their starts again.
0xd0 Fork "fork" (join: Label) [--] always task;
/// The end of a branch, and before the start of the next. Its task is done, and another one goes on; if
/// it was the last, the program goes on behind the `fork.join`.
0xd1 ForkNext "fork.next" () [--] after_forward(Switch) task;
/// The end of the last branch, as `fork.next`, and where all come together. In reverse the turns of
/// the tasks are taken back in the order in which they were taken.
0xd2 ForkJoin "fork.join" (from: Label) [--] after_forward(Switch) task;
/// Leave all branches from within one, when what the others wait for has settled: the other tasks are
/// held where they are, what they hold is saved, and the program goes on behind the `fork.join`.
0xd3 ForkLeave "fork.leave" (join: Label) [--] after_forward(Tasks) task;
        }
    };
}
