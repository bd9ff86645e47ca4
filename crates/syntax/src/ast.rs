//! The syntax tree: what was written, checked for form alone.
//!
//! Names are slices of the source; numbers keep the unit they were written with. Nothing here says
//! whether a name exists or a unit fits: that is the compiler's. Read [`Program`], [`Item`],
//! [`Statement`], [`Expression`], in this order.

use crate::span::{Span, Spanned};

/// A name as written.
pub type Name<'s> = Spanned<&'s str>;

/// A source file: declarations in the order written.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Program<'s> {
    /// The declarations.
    pub items: Vec<Item<'s>>,
}

/// A declaration at the top of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Item<'s> {
    /// `cell "peg_in_hole.toml"`
    Cell(Spanned<&'s str>),
    /// `import "poses.obv"`: what is declared there, as if it stood here.
    Import(Import<'s>),
    /// `output gripper = 0`, `input part_present = 3`
    Signal(SignalDeclaration<'s>),
    /// `io gripper_open { set 0 low; sleep 0.5 s } reverse gripper_close`
    Io(IoOperation<'s>),
    /// `joints start = [3.425, -1.0, 1.2, -1.8, -1.57, 0.3] rad`
    Joints(JointsDeclaration<'s>),
    /// `item peg { keyframe grasp = [0, 0, 20] mm [0, 180, 0] deg }`
    ItemDeclaration(ItemDeclaration<'s>),
    /// `error peg_not_inserted { … }`
    Error(ErrorDeclaration<'s>),
    /// `advanced move insert_peg { … }`
    AdvancedMove(AdvancedMove<'s>),
    /// `var count = 0`: a variable of the whole program.
    Variable(VariableDeclaration<'s>),
    /// `sequence main { … }`, or `action pick(part: item) { … }`
    Sequence(Sequence<'s>),
    /// `cleanup { … }`
    Cleanup(Cleanup<'s>),
    /// `allow W0001 "why"`: for the declaration that follows.
    Allow(Allow<'s>),
}

impl<'s> Item<'s> {
    /// The name that it declares, if it declares one.
    #[must_use]
    pub fn name(&self) -> Option<Name<'s>> {
        match self {
            Self::Cell(_) | Self::Import(_) | Self::Cleanup(_) | Self::Allow(_) => None,
            Self::Signal(signal) => Some(signal.name),
            Self::Io(io) => Some(io.name),
            Self::Joints(joints) => Some(joints.name),
            Self::ItemDeclaration(item) => Some(item.name),
            Self::Error(error) => Some(error.name),
            Self::AdvancedMove(advanced) => Some(advanced.name),
            Self::Variable(variable) => Some(variable.name),
            Self::Sequence(sequence) => Some(sequence.name),
        }
    }
}

/// Another file whose declarations stand here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Import<'s> {
    /// `library`: one that comes with the language.
    pub is_library: bool,
    /// Its path, or its name in the library.
    pub path: Spanned<&'s str>,
}

/// What is done at the end of the program, whatever came before.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleanup<'s> {
    /// The word that begins it.
    pub word: Span,
    /// What is done.
    pub body: Block<'s>,
    /// The whole declaration.
    pub span: Span,
}

/// A warning that is meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Allow<'s> {
    /// The code of the warning, as written.
    pub code: Name<'s>,
    /// `in file`: wherever it stands in the file, not only in what follows.
    pub in_file: bool,
    /// Why it is meant.
    pub reason: Spanned<&'s str>,
    /// The whole of it.
    pub span: Span,
}

/// A name for a line of the workcell: an entry of an I/O map.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalDeclaration<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Whether it is an output or an input.
    pub kind: SignalKind,
    /// Its number in the workcell, from 0.
    pub number: Spanned<u64>,
    /// The whole declaration.
    pub span: Span,
}

/// Which way a line of the workcell goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SignalKind {
    /// The program sets it.
    Output,
    /// The program reads it.
    Input,
}

/// An output or an input where it is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal<'s> {
    /// `set 0 high`: its number in the workcell.
    Number(u64),
    /// `set gripper high`: its name in the program.
    Name(&'s str),
}

/// An I/O operation (the paper's rule IO).
#[derive(Clone, Debug, PartialEq)]
pub struct IoOperation<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// What it does, in order.
    pub primitives: Vec<Primitive<'s>>,
    /// The I/O operation that takes its place in reverse.
    pub counterpart: Option<Name<'s>>,
    /// The whole declaration.
    pub span: Span,
}

/// A primitive (the paper's rule Primitive).
#[derive(Clone, Debug, PartialEq)]
pub enum Primitive<'s> {
    /// `set 0 low`
    Set {
        /// Which output.
        bit: Spanned<Signal<'s>>,
        /// High or low.
        high: bool,
        /// The primitive.
        span: Span,
    },
    /// `toggle 3`
    Toggle {
        /// Which output.
        bit: Spanned<Signal<'s>>,
        /// The primitive.
        span: Span,
    },
    /// `sleep 0.5 s`: the settling time of the outputs before it.
    Sleep {
        /// How long.
        duration: Expression<'s>,
        /// The primitive.
        span: Span,
    },
}

/// A joint configuration (the paper's rule JointConf).
#[derive(Clone, Debug, PartialEq)]
pub struct JointsDeclaration<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// The values as written: any number of them, checked later.
    pub values: Vector<'s>,
    /// The whole declaration.
    pub span: Span,
}

/// Numbers in brackets with a unit for all, or each with its own: `[1, 2, 3] mm`.
#[derive(Clone, Debug, PartialEq)]
pub struct Vector<'s> {
    /// The elements, constant expressions.
    pub elements: Vec<Expression<'s>>,
    /// The unit after the bracket.
    pub unit: Option<Name<'s>>,
    /// The vector.
    pub span: Span,
}

/// An item with its keyframes (the paper's rule Item).
#[derive(Clone, Debug, PartialEq)]
pub struct ItemDeclaration<'s> {
    /// Its name, also in the workcell.
    pub name: Name<'s>,
    /// Its keyframes.
    pub keyframes: Vec<Keyframe<'s>>,
    /// The whole declaration.
    pub span: Span,
}

/// A named pose of the tool centre point in an item's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframe<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// x, y, z.
    pub position: Vector<'s>,
    /// Rotation vector (axis times angle); none means none.
    pub rotation: Option<Vector<'s>>,
    /// The keyframe.
    pub span: Span,
}

/// An error (the paper's rules Error, Etime, Eoption), with how it is recovered from. Clauses in
/// any order; each at most once, checked later.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorDeclaration<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Its clauses in the order written.
    pub clauses: Vec<Spanned<ErrorClause<'s>>>,
    /// The whole declaration.
    pub span: Span,
}

/// A clause of an error.
#[derive(Clone, Debug, PartialEq)]
pub enum ErrorClause<'s> {
    /// `severity recoverable`
    Severity(Severity),
    /// `recover …`
    Recover(Recovery<'s>),
    /// `otherwise …`: when recovering has been given up.
    Otherwise(Otherwise<'s>),
    /// `respond …`
    Respond(Respond),
    /// `then …`: how to go on after recovery.
    Then(Continuation),
    /// `on protective stop, collision, force > 30 N`: what of the workcell raises it.
    On(Vec<Cause<'s>>),
    /// `give up after 6 times, 90 s, 3 m`: what recovering from one incident may cost.
    GiveUp(Vec<Bound<'s>>),
}

/// What of the workcell raises an error.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause<'s> {
    /// `protective stop`: a fault.
    Fault(Spanned<FaultWord>),
    /// `input door_closed low`: an input that comes to a level while something is done.
    Input {
        /// Which.
        input: Spanned<Signal<'s>>,
        /// The level.
        high: bool,
        /// All of it.
        span: Span,
    },
    /// `force > 30 N`: more force than this while something is done.
    Force(Expression<'s>),
}

/// A fault of the workcell in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaultWord {
    /// `joint limit`
    JointLimit,
    /// `out of reach`
    OutOfReach,
    /// `singularity`
    Singularity,
    /// `collision`
    Collision,
    /// `force limit`
    ForceLimit,
    /// `protective stop`
    ProtectiveStop,
    /// `emergency stop`
    EmergencyStop,
    /// `stopped short`
    StoppedShort,
    /// `missing`: the workcell has no such output, input, item or tool.
    Missing,
}

impl FaultWord {
    /// Every one.
    pub const ALL: [Self; 9] = [
        Self::JointLimit,
        Self::OutOfReach,
        Self::Singularity,
        Self::Collision,
        Self::ForceLimit,
        Self::ProtectiveStop,
        Self::EmergencyStop,
        Self::StoppedShort,
        Self::Missing,
    ];

    /// As it is written.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::JointLimit => "joint limit",
            Self::OutOfReach => "out of reach",
            Self::Singularity => "singularity",
            Self::Collision => "collision",
            Self::ForceLimit => "force limit",
            Self::ProtectiveStop => "protective stop",
            Self::EmergencyStop => "emergency stop",
            Self::StoppedShort => "stopped short",
            Self::Missing => "missing",
        }
    }
}

/// A bound of what recovering from one incident may cost.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound<'s> {
    /// `6 times`
    Attempts(Spanned<u64>),
    /// `90 s`, `3 m`: a time or a length, which its unit says.
    Cost(Expression<'s>),
}

/// How bad an error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// `warning`: noted, the program goes on.
    Warning,
    /// `recoverable`: its recovery is tried.
    Recoverable,
    /// `fatal`: the program stops.
    Fatal,
}

/// How an error is recovered from.
#[derive(Clone, Debug, PartialEq)]
pub enum Recovery<'s> {
    /// `recover using NAME`: the explicit sequence, as in the paper.
    Using(Name<'s>),
    /// `recover by reversing …`
    Reversing {
        /// How the depth changes from one attempt to the next.
        depth: Depth,
        /// How far.
        extent: Extent<'s>,
        /// What changes on the way forward again.
        changes: Vec<Spanned<Change<'s>>>,
    },
}

/// How far reversal goes from attempt to attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// `by reversing 3 actions`
    Fixed,
    /// `by reversing escalating up to 4 actions`
    Escalating,
    /// `by reversing escalating doubling up to 8 actions`
    Doubling,
    /// `by reversing learned up to 4 actions`
    Learned,
}

/// The bound of a reversal.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent<'s> {
    /// `(up to) 4 actions`
    Actions(Spanned<u64>),
    /// `to checkpoint NAME`
    Checkpoint(Name<'s>),
    /// `to start of sequence`
    Sequence,
}

/// What a recovery changes on the way forward again.
#[derive(Clone, Debug, PartialEq)]
pub enum Change<'s> {
    /// `perturbed 1 mm`, `perturbed at random 1 mm`
    Perturbed {
        /// The largest sideways offset.
        within: Expression<'s>,
        /// Whether at random, instead of on a spiral.
        at_random: bool,
    },
    /// `slower`
    Slower,
    /// `lighter`
    Lighter,
}

/// What follows when recovering has been given up.
#[derive(Clone, Debug, PartialEq)]
pub enum Otherwise<'s> {
    /// `otherwise using NAME`
    Using(Name<'s>),
    /// `otherwise operator`
    Operator,
    /// `otherwise stop`
    Stop,
}

/// When an error is responded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Respond {
    /// `respond at once`
    AtOnce,
    /// `respond after current action`
    AfterAction,
    /// `respond after current sequence`
    AfterSequence,
}

/// How a program goes on after a recovery.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuation {
    /// `then return to action`: the action again.
    Action,
    /// `then continue`: the next action.
    NextAction,
    /// `then return to sequence`: the sequence again.
    Sequence,
    /// `then restart program`
    Program,
    /// `then stop`
    Stop,
}

/// An advanced move (the paper's rules Amove and those below it). Clauses in any order; each at
/// most once, checked later.
#[derive(Clone, Debug, PartialEq)]
pub struct AdvancedMove<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Its clauses in the order written.
    pub clauses: Vec<Spanned<MoveClause<'s>>>,
    /// `reverse NAME`: the advanced move that takes its place in reverse.
    pub counterpart: Option<Name<'s>>,
    /// The whole declaration.
    pub span: Span,
}

/// A clause of an advanced move.
#[derive(Clone, Debug, PartialEq)]
pub enum MoveClause<'s> {
    /// `requires CONDITION else throw NAME`: must hold before the move (the paper's rule
    /// Acondition).
    Requires {
        /// What must hold.
        condition: Expression<'s>,
        /// The error that is thrown if it does not.
        otherwise: Option<Name<'s>>,
    },
    /// `distance 300 mm forward in tcp` (rules Aspeci and Amove).
    Distance {
        /// How far.
        distance: Expression<'s>,
        /// Which way.
        heading: Spanned<Heading>,
        /// In which frame; the TCP's where none is named.
        frame: Option<Spanned<FrameWord>>,
    },
    /// `turn 720 deg advancing 2 mm forward in tcp`, in place of a distance.
    Turn(Turn<'s>),
    /// `stop if force > 5 N` (rule Aquery).
    StopIf(Expression<'s>),
    /// `speed slow` (rule Asetting).
    Speed(SpeedWord),
    /// `succeeds if distance > 200 mm` (rule Aeval).
    SucceedsIf(Expression<'s>),
    /// `on success { … }` (rule Abehave)
    OnSuccess(Vec<Spanned<Behaviour<'s>>>),
    /// `on failure { … }` (rule Abehave)
    OnFailure(Vec<Spanned<Behaviour<'s>>>),
    /// `opposite force in reverse`: the way back has the force limit of the way there.
    OppositeForce,
}

/// What an advanced move does afterwards (the paper's rule Abehave).
#[derive(Clone, Debug, PartialEq)]
pub enum Behaviour<'s> {
    /// `return to initial position`
    ReturnToInitialPosition,
    /// `repeat with perturbation [1 mm] 3 times`
    RepeatWithPerturbation {
        /// The largest sideways offset; 1 mm where none is given.
        within: Option<Expression<'s>>,
        /// How often.
        times: Spanned<u64>,
    },
    /// `throw NAME`
    Throw(Name<'s>),
}

/// A direction in words (the paper's rule direction). What a word means depends on the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// `forward`
    Forward,
    /// `backward` or `backwards`
    Backward,
    /// `left`
    Left,
    /// `right`
    Right,
    /// `up`
    Up,
    /// `down`
    Down,
    /// `x`
    X,
    /// `y`
    Y,
    /// `z`
    Z,
    /// `-x`
    MinusX,
    /// `-y`
    MinusY,
    /// `-z`
    MinusZ,
}

/// A frame in words (the paper's rule frame).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameWord {
    /// `tcp`
    Tcp,
    /// `toolmount`
    ToolMount,
    /// `base`
    Base,
}

/// A speed in words (the paper's rule speed).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedWord {
    /// `very slow`
    VerySlow,
    /// `slow`
    Slow,
    /// `normal`
    Normal,
    /// `fast`
    Fast,
    /// `very fast`
    VeryFast,
}

/// A declared variable; its type is that of its value where none is written.
#[derive(Clone, Debug, PartialEq)]
pub struct VariableDeclaration<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Its type as written.
    pub type_name: Option<Name<'s>>,
    /// Its first value.
    pub value: Expression<'s>,
    /// The whole declaration.
    pub span: Span,
}

/// A sequence, or an action with parameters: both are called the same way.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Whether it was declared with `action`: one step of a story and of a recovery.
    pub is_action: bool,
    /// Its parameters.
    pub parameters: Vec<Parameter<'s>>,
    /// What it does.
    pub body: Block<'s>,
    /// The whole declaration.
    pub span: Span,
}

/// A parameter of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Its type: int, number, length, angle, time, force, speed, bool, joints, item.
    pub type_name: Name<'s>,
    /// `in 5 mm to 60 mm`: the least and the most that it may be.
    pub range: Option<ValueRange<'s>>,
    /// `= 20 mm`: what it is where a call does not say.
    pub default: Option<Expression<'s>>,
}

/// `in 5 mm to 60 mm`
#[derive(Clone, Debug, PartialEq)]
pub struct ValueRange<'s> {
    /// The least value.
    pub least: Expression<'s>,
    /// The most.
    pub most: Expression<'s>,
}

/// What a call gives to a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument<'s> {
    /// `depth:`: which parameter; without it, the next in the order of their declaration.
    pub name: Option<Name<'s>>,
    /// The value.
    pub value: Expression<'s>,
}

/// Statements in braces.
#[derive(Clone, Debug, PartialEq)]
pub struct Block<'s> {
    /// The statements.
    pub statements: Vec<Statement<'s>>,
    /// From brace to brace.
    pub span: Span,
}

/// A statement and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement<'s> {
    /// What it does.
    pub kind: StatementKind<'s>,
    /// The whole statement.
    pub span: Span,
}

/// What a statement does. Those up to `Primitive` are actions of the robot.
#[derive(Clone, Debug, PartialEq)]
pub enum StatementKind<'s> {
    /// `move to start linearly reversible always`
    Move {
        /// Where to.
        target: Target<'s>,
        /// `linearly`: the TCP on a straight line.
        linear: bool,
        /// `reversible always`: its reverse goes to the position the program last named.
        always: Option<Span>,
    },
    /// `advance insert_peg`
    Advance(Name<'s>),
    /// `call pick(peg)`
    Call {
        /// The sequence or action.
        name: Name<'s>,
        /// Its arguments.
        arguments: Vec<Argument<'s>>,
    },
    /// `io gripper_open`
    Io(Name<'s>),
    /// `wait 0.5 s`
    Wait(Expression<'s>),
    /// `wait until input 3 high for up to 2 s else { … }`
    WaitUntil {
        /// Which input.
        input: Spanned<Signal<'s>>,
        /// High or low.
        high: bool,
        /// The longest time.
        timeout: Expression<'s>,
        /// What to do when the time is up; without it, the program goes on.
        otherwise: Option<Block<'s>>,
    },
    /// `set 0 high`, `toggle 0`, `sleep 1 s` outside an I/O operation.
    Primitive(Primitive<'s>),
    /// `var x = 3 mm`
    Variable(VariableDeclaration<'s>),
    /// `position p`: remember where the arm is, for `move to p`.
    Remember(Name<'s>),
    /// `x = e`, `x += e`, `x -= e`
    Assign {
        /// The variable.
        name: Name<'s>,
        /// How.
        operator: AssignOperator,
        /// The value.
        value: Expression<'s>,
    },
    /// `if c { … } else { … } ending when p`: with `ending when` the join is asserted, without it
    /// recorded. An `else if` is a block of one statement.
    If {
        /// The condition.
        condition: Expression<'s>,
        /// When it holds.
        then: Block<'s>,
        /// When it does not.
        otherwise: Option<Block<'s>>,
        /// Holds after the first block and not after the second.
        ending_when: Option<Expression<'s>>,
    },
    /// `while c entered when p { … }`: with `entered when` the join is asserted.
    While {
        /// The condition.
        condition: Expression<'s>,
        /// Holds when the loop is first entered and not when it comes round again.
        entered_when: Option<Expression<'s>>,
        /// The body.
        body: Block<'s>,
    },
    /// `repeat 3 times { … }`
    Repeat {
        /// How often.
        times: Expression<'s>,
        /// The body.
        body: Block<'s>,
    },
    /// `for i from 0 to 9 { … }`, `for i from 9 down to 0 { … }`, both ends included.
    For {
        /// The counter, which the body cannot assign.
        name: Name<'s>,
        /// The first value.
        first: Expression<'s>,
        /// Whether it counts down.
        down: bool,
        /// The last value.
        last: Expression<'s>,
        /// The body.
        body: Block<'s>,
    },
    /// `loop { … }`: for ever, until `break` or an error.
    Loop(Block<'s>),
    /// `fork { … } and { … }`: the branches in turns, until all are done.
    Fork(Vec<Block<'s>>),
    /// `break`: out of the innermost loop.
    Break,
    /// `return`: out of the sequence.
    Return,
    /// `speed slow`, until the end of the sequence; `speed slow { … }`, for the block.
    Speed {
        /// The speed.
        speed: Spanned<SpeedWord>,
        /// Its scope.
        block: Option<Block<'s>>,
    },
    /// `tool gripper`, `tool gripper { … }`
    Tool {
        /// The tool's name in the workcell.
        name: Name<'s>,
        /// Its scope.
        block: Option<Block<'s>>,
    },
    /// `checkpoint NAME`
    Checkpoint(Name<'s>),
    /// `barrier "why"`: nothing before it can be taken back.
    Barrier(Spanned<&'s str>),
    /// `irreversible "why" { … }`: what is in it cannot be taken back.
    Irreversible {
        /// Why.
        reason: Spanned<&'s str>,
        /// The block.
        block: Block<'s>,
    },
    /// `skip in reverse { … }`: in reverse it is passed over.
    SkipInReverse(Block<'s>),
    /// `do { … } in reverse { … }`: in reverse the second block is run in place of the first.
    ReplaceInReverse {
        /// Forward.
        block: Block<'s>,
        /// In reverse.
        replacement: Block<'s>,
    },
    /// `keep in reverse { … }`: in reverse it is run in its forward order again.
    KeepInReverse(Block<'s>),
    /// `with speed slow, force limit 20 N in reverse { … }`: going back over what is in it, the
    /// arm moves otherwise than it came.
    WithInReverse {
        /// What is otherwise; each at most once, checked later.
        parameters: Vec<Spanned<ReverseParameter<'s>>>,
        /// The block.
        block: Block<'s>,
    },
    /// `throw NAME`
    Throw(Name<'s>),
    /// `requires CONDITION else throw NAME`
    Requires {
        /// What must hold here.
        condition: Expression<'s>,
        /// The error that is thrown if it does not.
        error: Name<'s>,
    },
    /// `allow W0001 "why"`: for the statement that follows.
    Allow(Allow<'s>),
}

/// The blocks of a kind of statement, to be read or to be changed.
macro_rules! blocks_of {
    ($kind:expr, $iter:ident) => {
        match $kind {
            StatementKind::If { then, otherwise, .. } => {
                std::iter::once(then).chain(otherwise.$iter()).collect()
            }
            StatementKind::WaitUntil { otherwise, .. } => otherwise.$iter().collect(),
            StatementKind::While { body, .. }
            | StatementKind::Repeat { body, .. }
            | StatementKind::For { body, .. }
            | StatementKind::Loop(body) => vec![body],
            StatementKind::Speed { block, .. } | StatementKind::Tool { block, .. } => {
                block.$iter().collect()
            }
            StatementKind::Fork(branches) => branches.$iter().collect(),
            StatementKind::Irreversible { block, .. }
            | StatementKind::SkipInReverse(block)
            | StatementKind::KeepInReverse(block)
            | StatementKind::WithInReverse { block, .. } => vec![block],
            StatementKind::ReplaceInReverse { block, replacement } => {
                vec![block, replacement]
            }
            StatementKind::Move { .. }
            | StatementKind::Advance(_)
            | StatementKind::Call { .. }
            | StatementKind::Io(_)
            | StatementKind::Wait(_)
            | StatementKind::Primitive(_)
            | StatementKind::Variable(_)
            | StatementKind::Remember(_)
            | StatementKind::Assign { .. }
            | StatementKind::Break
            | StatementKind::Return
            | StatementKind::Checkpoint(_)
            | StatementKind::Barrier(_)
            | StatementKind::Throw(_)
            | StatementKind::Requires { .. }
            | StatementKind::Allow(_) => Vec::new(),
        }
    };
}

impl<'s> Statement<'s> {
    /// What it allows, if that is all that it does.
    #[must_use]
    pub fn allow(&self) -> Option<&Allow<'s>> {
        match &self.kind {
            StatementKind::Allow(allow) => Some(allow),
            _ => None,
        }
    }

    /// The blocks in it, in the order of the text.
    #[must_use]
    pub fn blocks(&self) -> Vec<&Block<'s>> {
        blocks_of!(&self.kind, iter)
    }

    /// The same, to be changed.
    #[must_use]
    pub fn blocks_mut(&mut self) -> Vec<&mut Block<'s>> {
        blocks_of!(&mut self.kind, iter_mut)
    }
}

/// What may be otherwise going back.
#[derive(Clone, Debug, PartialEq)]
pub enum ReverseParameter<'s> {
    /// `speed slow`
    Speed(SpeedWord),
    /// `force limit 20 N`: more force than that stops the motion back.
    ForceLimit(Expression<'s>),
    /// `straight moves`: with the TCP on a straight line.
    StraightMoves,
}

/// Where a move goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Target<'s> {
    /// A joint configuration, a remembered position, or a parameter.
    Named(Name<'s>),
    /// `peg.grasp`: a keyframe of an item or of a parameter that is one.
    Keyframe {
        /// The item.
        item: Name<'s>,
        /// Its keyframe.
        keyframe: Name<'s>,
    },
    /// `move 20 mm up in base`: a straight way from here.
    Relative {
        /// How far.
        distance: Expression<'s>,
        /// Which way.
        heading: Spanned<Heading>,
        /// In which frame; the TCP's where none is named.
        frame: Option<Spanned<FrameWord>>,
    },
    /// `turn 720 deg forward`, a statement without the word `move`.
    Turned(Turn<'s>),
}

/// `turn 720 deg advancing 2 mm forward in tcp`: about an axis through the TCP, by the right hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn<'s> {
    /// By what angle; whole turns count.
    pub angle: Expression<'s>,
    /// How far along the axis meanwhile; nowhere where nothing is said.
    pub advance: Option<Expression<'s>>,
    /// About which axis.
    pub heading: Spanned<Heading>,
    /// In which frame; the TCP's where none is named.
    pub frame: Option<Spanned<FrameWord>>,
}

impl<'s> Turn<'s> {
    /// Its angle, and how far it advances if that is said.
    pub fn amounts(&self) -> impl Iterator<Item = &Expression<'s>> {
        std::iter::once(&self.angle).chain(&self.advance)
    }
}

/// How an assignment changes its variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssignOperator {
    /// `=`
    Set,
    /// `+=`
    Add,
    /// `-=`
    Subtract,
}

/// An expression and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression<'s> {
    /// What it is.
    pub kind: ExpressionKind<'s>,
    /// Where it is.
    pub span: Span,
}

/// An expression. Readings and draws are taken before the statement they stand in.
#[derive(Clone, Debug, PartialEq)]
pub enum ExpressionKind<'s> {
    /// `3`
    Integer(i64),
    /// `0.5`
    Real(f64),
    /// `0.5 s`, `3 mm`: a number and its unit as written.
    Quantity {
        /// The number.
        value: f64,
        /// The unit.
        unit: Name<'s>,
    },
    /// `true`, `false`
    Boolean(bool),
    /// A variable, a parameter, a joint configuration, an item.
    Name(&'s str),
    /// `-e`, `not e`
    Unary {
        /// The operator.
        operator: UnaryOperator,
        /// Its operand.
        operand: Box<Expression<'s>>,
    },
    /// `a + b`
    Binary {
        /// The operator.
        operator: BinaryOperator,
        /// Left.
        left: Box<Expression<'s>>,
        /// Right.
        right: Box<Expression<'s>>,
    },
    /// `abs(e)`, `min(a, b)`, `random(a, b)`
    Function {
        /// The function's name.
        name: Name<'s>,
        /// Its arguments.
        arguments: Vec<Expression<'s>>,
    },
    /// `input 3`: whether it is high.
    Input(Spanned<Signal<'s>>),
    /// `force`: the filtered contact force now; in an advanced move's queries, the peak of it.
    Force,
    /// `distance`: how far the last move came.
    Distance,
    /// `holding`: whether the gripper holds an item.
    Holding,
    /// What the parser put where an expression was wrong, so that it could go on.
    Missing,
}

/// An operator before its operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOperator {
    /// `-`
    Negate,
    /// `not`
    Not,
}

/// An operator between its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOperator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `mod`
    Remainder,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `and`: both sides are evaluated.
    And,
    /// `or`: both sides are evaluated.
    Or,
}
