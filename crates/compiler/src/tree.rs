//! The checked tree: every name resolved, every value typed, what is never reached left out.
//!
//! Lowering it can fail at the limits of a module only. Operations are instructions of the table.
//! Read [`Program`], [`Function`], [`Statement`], [`Expression`], in this order.

use crate::types::ValueType;
use obverse_bytecode::{FunctionKind, Module, Variable};
use obverse_isa::{
    Axis, Bit, CheckpointId, CounterId, ErrorId, Frame, FunctionId, GlobalId, Instr, ItemId,
    JointsId, KeyframeId, Level, LocalId, Path, ReasonId, Setting, SlotId, SpeedId, ToolId, Type,
};
use obverse_syntax::span::Span;

/// A program. What has mistakes is not in it.
#[derive(Debug)]
pub(crate) struct Program {
    /// The tables, complete but for what lowering adds; without code.
    pub(crate) module: Module,
    /// The first values of the program's variables, in their order.
    pub(crate) first_values: Vec<Expression>,
    /// The functions but for the start, which is function 0: function n is at n - 1.
    pub(crate) functions: Vec<Function>,
    /// The sequence that the program begins with.
    pub(crate) main: FunctionId,
    /// What runs at its end.
    pub(crate) cleanup: Option<FunctionId>,
}

impl Program {
    /// A function other than the start.
    pub(crate) fn function(&self, id: FunctionId) -> &Function {
        &self.functions[id.index() - 1]
    }

    /// The functions with their indices.
    pub(crate) fn numbered(&self) -> impl Iterator<Item = (FunctionId, &Function)> {
        (1..).map(FunctionId).zip(&self.functions)
    }
}

/// A function.
#[derive(Debug)]
pub(crate) struct Function {
    /// Its name.
    pub(crate) name: String,
    /// What it was in the source.
    pub(crate) kind: FunctionKind,
    /// Where it is named.
    pub(crate) named: Span,
    /// What its frame holds.
    pub(crate) layout: Layout,
    /// The settings that hold to its end, and where what held before is kept meanwhile.
    pub(crate) modal: Vec<(Setting, LocalId)>,
    /// If it is a block that keeps its order in reverse: what it shares.
    pub(crate) kept: Option<Kept>,
    /// What it does.
    pub(crate) body: Body,
}

impl Function {
    /// One that has a mistake: it does nothing.
    pub(crate) fn absent() -> Self {
        Self {
            name: String::new(),
            kind: FunctionKind::Sequence,
            named: Span::default(),
            layout: Layout::default(),
            modal: Vec::new(),
            kept: None,
            body: Body::Block(Block::default()),
        }
    }
}

/// A block that is both a part of a function and a function of its own, with the same frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    /// The function that it is a part of.
    pub(crate) around: FunctionId,
    /// How many locals there were before it: those after them are its own.
    pub(crate) locals_before: usize,
}

/// How many words a frame has at the most.
pub(crate) const MAX_SLOTS: usize = 256;

/// What a frame holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    /// How many of the locals are parameters, from the first.
    pub(crate) parameters: u8,
    /// The locals.
    pub(crate) locals: Vec<Variable>,
    /// How many counters there are.
    pub(crate) counters: u8,
    /// The names of remembered positions.
    pub(crate) slots: Vec<String>,
}

impl Layout {
    /// How many words the frame has: one a local, three a counter.
    pub(crate) fn slots(&self) -> usize {
        self.locals.len() + 3 * usize::from(self.counters)
    }

    /// A further local; none if there is no room.
    pub(crate) fn add(&mut self, name: &str, of_type: Type) -> Option<LocalId> {
        let local = u8::try_from(self.locals.len()).ok().filter(|_| self.slots() < MAX_SLOTS)?;
        self.locals.push(Variable { name: name.to_owned(), of_type, measures: None });
        Some(LocalId(local))
    }

    /// The same, of a type of the language.
    pub(crate) fn add_typed(&mut self, name: &str, of_type: ValueType) -> Option<LocalId> {
        let added = self.add(name, of_type.machine())?;
        self.locals[added.index()].measures = of_type.measures();
        Some(added)
    }

    /// A further local whose name begins with `$`; where another has that name already, or it is
    /// empty, its index makes it different.
    pub(crate) fn add_hidden(&mut self, name: &str, of_type: Type) -> Option<LocalId> {
        let plain = format!("${name}");
        let is_taken = name.is_empty() || self.locals.iter().any(|local| local.name == plain);
        let index = if is_taken { self.locals.len().to_string() } else { String::new() };
        self.add(&format!("{plain}{index}"), of_type)
    }
}

/// What a function does.
#[derive(Debug)]
pub(crate) enum Body {
    /// Statements.
    Block(Block),
    /// An advanced move.
    Guarded(Box<GuardedMove>),
}

/// Statements in a row.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// The statements that are reached.
    pub(crate) statements: Vec<Statement>,
    /// Whether what follows the block is reached.
    pub(crate) falls_through: bool,
    /// Its closing brace.
    pub(crate) end: Span,
}

/// A statement.
#[derive(Debug)]
pub(crate) struct Statement {
    /// What is read before it.
    pub(crate) hoists: Vec<Hoist>,
    /// What it does.
    pub(crate) kind: StatementKind,
    /// Its place; of those with blocks, what comes before the first block.
    pub(crate) span: Span,
}

/// What comes before a statement so that its values are known.
#[derive(Clone, Debug)]
pub(crate) enum Hoist {
    /// An instruction that reads the outside into a local variable.
    Read(Instr),
    /// A value that is needed twice.
    Store {
        /// Where it is kept.
        local: LocalId,
        /// The value.
        value: Expression,
    },
}

/// A value and what is read for it each time it is computed.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    /// What is read before.
    pub(crate) hoists: Vec<Hoist>,
    /// The value.
    pub(crate) value: Expression,
}

/// Where a variable is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// In the frame.
    Local(LocalId),
    /// In the program.
    Global(GlobalId),
}

/// What a setting is set to.
#[derive(Clone, Debug)]
pub(crate) enum SettingValue {
    /// A speed.
    Speed(SpeedId),
    /// A tool.
    Tool(ToolId),
    /// The speed of motions that go back.
    ReverseSpeed(SpeedId),
    /// The force in newtons that stops a motion that goes back.
    ReverseForceLimit(Expression),
    /// That motions go back on a straight line.
    ReverseStraight,
}

impl SettingValue {
    /// Which setting it is.
    pub(crate) fn setting(&self) -> Setting {
        match self {
            Self::Speed(_) => Setting::Speed,
            Self::Tool(_) => Setting::Tool,
            Self::ReverseSpeed(_) => Setting::ReverseSpeed,
            Self::ReverseForceLimit(_) => Setting::ReverseForceLimit,
            Self::ReverseStraight => Setting::ReverseStraight,
        }
    }
}

/// What a statement does.
#[derive(Debug)]
pub(crate) enum StatementKind {
    /// Move the arm.
    Move(Motion),
    /// Call an advanced move, in whose place another one is run in reverse.
    Advance(FunctionId, Option<FunctionId>),
    /// Call a sequence or an action.
    Call(FunctionId, Vec<Expression>),
    /// Call an I/O operation, in whose place another one is run in reverse.
    Io(FunctionId, Option<FunctionId>),
    /// Let seconds pass.
    Wait(Expression),
    /// Wait for an input.
    WaitInput {
        /// Which input.
        bit: Bit,
        /// Its level.
        level: Level,
        /// The longest time, in seconds.
        timeout: Expression,
        /// Where it is kept whether the level came.
        came: LocalId,
        /// What to do if not.
        otherwise: Option<Block>,
    },
    /// Set an output, or change it where no level is given, and let it settle.
    Output {
        /// Which output.
        bit: Bit,
        /// To which level.
        level: Option<Level>,
        /// How long, in seconds.
        settle: Expression,
    },
    /// Store a value.
    Store(Place, Expression),
    /// Add to an integer variable that the value does not read, or subtract.
    Update {
        /// The variable.
        place: Place,
        /// Whether to subtract.
        subtracts: bool,
        /// How much.
        value: Expression,
    },
    /// Remember where the arm is.
    Remember(SlotId),
    /// Do one of two things.
    If {
        /// The condition.
        condition: Expression,
        /// When it holds.
        then: Block,
        /// When it does not.
        otherwise: Option<Block>,
        /// What holds after the first block alone, if the join is asserted.
        ending_when: Option<Expression>,
    },
    /// Repeat while a condition holds.
    While {
        /// The condition.
        condition: Prepared,
        /// What holds when first entered alone, if the join is asserted.
        entered_when: Option<Expression>,
        /// The body.
        body: Block,
    },
    /// Repeat for each number.
    For {
        /// The counter.
        counter: CounterId,
        /// What the program calls it, if it has a name, and whether it counts down.
        name: Option<(String, bool)>,
        /// The first number.
        first: Expression,
        /// The last number.
        last: Expression,
        /// The body.
        body: Block,
    },
    /// Repeat for ever.
    Loop(Block),
    /// Tasks that take turns, until all are done.
    Fork(Vec<Block>),
    /// Leave the innermost loop.
    Break,
    /// Leave the function.
    Return,
    /// Change a setting.
    Set(SettingValue),
    /// Change a setting for a block.
    SetFor {
        /// To what.
        value: SettingValue,
        /// Where the former value is kept meanwhile.
        former: LocalId,
        /// The block.
        block: Block,
    },
    /// Name this place.
    Checkpoint(CheckpointId),
    /// Nothing before this can be taken back.
    Barrier(ReasonId),
    /// A block that cannot be taken back.
    Irreversible(ReasonId, Block),
    /// A block that is passed over in reverse, or in whose place a function is run.
    Reversed(Block, Option<FunctionId>),
    /// A block that is the body of this function, and in whose place that is run in reverse.
    Kept(FunctionId),
    /// Raise an error.
    Throw(ErrorId),
    /// Trap unless a condition holds.
    Demand(Expression, ReasonId),
    /// Raise an error unless a condition holds.
    Requires(Expression, ErrorId),
}

/// Where a motion goes.
#[derive(Debug)]
pub(crate) enum Motion {
    /// To a joint configuration.
    Joints(Expression, Path),
    /// From a joint configuration to another: the first is where its reverse goes.
    Always(JointsId, JointsId, Path),
    /// To a keyframe of an item.
    Keyframe(Expression, KeyframeId, Path),
    /// By a distance in metres.
    Relative(Expression, Axis, Frame),
    /// Turned by an angle in radians, and on by a distance in metres.
    Turned(Expression, Expression, Axis, Frame),
    /// To a remembered position.
    Position(SlotId, Path),
}

/// An advanced move.
#[derive(Debug)]
pub(crate) struct GuardedMove {
    /// What must hold before, and what follows if it does not.
    pub(crate) requires: Option<(Prepared, Unmet)>,
    /// How far it is turned, in radians, if it is.
    pub(crate) angle: Option<Prepared>,
    /// How far, in metres.
    pub(crate) distance: Prepared,
    /// Which way.
    pub(crate) axis: Axis,
    /// In which frame.
    pub(crate) frame: Frame,
    /// The force that stops it, in newtons; without one, contact is a collision.
    pub(crate) limit: Option<Prepared>,
    /// Whether the way back has the same limit.
    pub(crate) is_opposed: bool,
    /// Its speed, and where the former one is kept meanwhile.
    pub(crate) speed: Option<(SpeedId, LocalId)>,
    /// What it comes to: metres and newtons.
    pub(crate) results: MoveResults,
    /// Whether it has succeeded.
    pub(crate) succeeds: Prepared,
    /// What follows success.
    pub(crate) on_success: Aftermath,
    /// What follows failure.
    pub(crate) on_failure: Aftermath,
    /// How it is tried again.
    pub(crate) repeat: Option<Retry>,
    /// Where it began, if it goes back there.
    pub(crate) initial: Option<SlotId>,
    /// The places of distance, success and failure for the source map.
    pub(crate) spans: MoveSpans,
}

/// What follows if what an advanced move requires does not hold.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Unmet {
    /// The clause names an error.
    Throws(ErrorId),
    /// What failure throws is thrown; if it throws nothing, a trap with these words.
    Fails(ReasonId),
}

impl GuardedMove {
    /// The errors that it throws.
    pub(crate) fn throws(&self) -> impl Iterator<Item = (ErrorId, Span)> {
        let unmet = match &self.requires {
            Some((condition, Unmet::Throws(error))) => Some((*error, condition.value.span)),
            _ => None,
        };
        [self.on_success.throws, self.on_failure.throws, unmet].into_iter().flatten()
    }
}

/// Where what an advanced move came to is kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MoveResults {
    /// How far it came, in metres.
    pub(crate) distance: LocalId,
    /// The largest force, in newtons.
    pub(crate) force: LocalId,
}

/// Where the parts of an advanced move stand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MoveSpans {
    /// The motion.
    pub(crate) motion: Span,
    /// What success is.
    pub(crate) succeeds: Span,
    /// The closing brace.
    pub(crate) end: Span,
}

/// What an advanced move does afterwards.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Aftermath {
    /// Whether it goes back to where it began.
    pub(crate) returns: Option<Span>,
    /// What it throws.
    pub(crate) throws: Option<(ErrorId, Span)>,
}

/// How a failed motion is tried again.
#[derive(Debug)]
pub(crate) struct Retry {
    /// How often.
    pub(crate) times: i32,
    /// The largest sideways offset, in metres.
    pub(crate) within: Prepared,
    /// Where the two draws are kept.
    pub(crate) draws: [LocalId; 2],
    /// Where it is asked for.
    pub(crate) span: Span,
}

/// An expression.
#[derive(Clone, Debug)]
pub(crate) struct Expression {
    /// What it is.
    pub(crate) kind: ExpressionKind,
    /// Its type.
    pub(crate) of_type: ValueType,
    /// Its place.
    pub(crate) span: Span,
}

/// What an expression is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ExpressionKind {
    /// An integer.
    Int(i64),
    /// A real in SI units.
    Real(f64),
    /// A truth value.
    Bool(bool),
    /// A joint configuration.
    Joints(JointsId),
    /// An item.
    Item(ItemId),
    /// A local variable.
    Local(LocalId),
    /// A variable of the program.
    Global(GlobalId),
    /// A loop counter.
    Counter(CounterId),
    /// A pure instruction of one operand.
    Unary(Instr, Box<Expression>),
    /// A pure instruction of two.
    Binary(Instr, Box<(Expression, Expression)>),
    /// An expression with a mistake.
    Missing,
}

impl PartialEq for Expression {
    /// The same value, wherever it stands.
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
    }
}

impl Expression {
    /// An expression with a mistake.
    pub(crate) fn missing(span: Span) -> Self {
        Self { kind: ExpressionKind::Missing, of_type: ValueType::Unknown, span }
    }

    /// An integer.
    pub(crate) fn int(value: i64, span: Span) -> Self {
        Self { kind: ExpressionKind::Int(value), of_type: ValueType::Int, span }
    }

    /// A real.
    pub(crate) fn real(value: f64, of_type: ValueType, span: Span) -> Self {
        Self { kind: ExpressionKind::Real(value), of_type, span }
    }

    /// A local variable.
    pub(crate) fn local(local: LocalId, of_type: ValueType, span: Span) -> Self {
        Self { kind: ExpressionKind::Local(local), of_type, span }
    }

    /// Whether it is a value and not computed.
    pub(crate) fn is_constant(&self) -> bool {
        use ExpressionKind::{Bool, Int, Joints, Real};
        matches!(self.kind, Int(_) | Real(_) | Bool(_) | Joints(_))
    }

    /// Whether it reads a variable.
    pub(crate) fn reads(&self, place: Place) -> bool {
        match &self.kind {
            ExpressionKind::Local(local) => place == Place::Local(*local),
            ExpressionKind::Global(global) => place == Place::Global(*global),
            ExpressionKind::Unary(_, operand) => operand.reads(place),
            ExpressionKind::Binary(_, operands) => {
                operands.0.reads(place) || operands.1.reads(place)
            }
            _ => false,
        }
    }

    /// How many values are computed for it, and how many are held at a time, at the most.
    pub(crate) fn size(&self) -> (usize, usize) {
        match &self.kind {
            ExpressionKind::Unary(_, operand) => {
                let (count, depth) = operand.size();
                (count + 1, depth)
            }
            ExpressionKind::Binary(_, operands) => {
                let (left, right) = (operands.0.size(), operands.1.size());
                (left.0 + right.0 + 1, left.1.max(right.1 + 1))
            }
            _ => (1, 1),
        }
    }
}

impl Block {
    /// Call `visit` with each statement, those in blocks within included.
    pub(crate) fn each_statement<'t>(&'t self, visit: &mut impl FnMut(&'t Statement)) {
        self.statements.iter().for_each(|statement| statement.each(visit));
    }
}

impl Statement {
    /// Call `visit` with this statement and with each one within it.
    pub(crate) fn each<'t>(&'t self, visit: &mut impl FnMut(&'t Self)) {
        visit(self);
        self.each_block(&mut |block| block.each_statement(visit));
    }

    fn each_block<'t>(&'t self, visit: &mut dyn FnMut(&'t Block)) {
        match &self.kind {
            StatementKind::If { then, otherwise, .. } => {
                visit(then);
                otherwise.iter().for_each(visit);
            }
            StatementKind::WaitInput { otherwise, .. } => otherwise.iter().for_each(visit),
            StatementKind::While { body, .. }
            | StatementKind::For { body, .. }
            | StatementKind::Loop(body) => visit(body),
            StatementKind::SetFor { block, .. }
            | StatementKind::Irreversible(_, block)
            | StatementKind::Reversed(block, _) => visit(block),
            StatementKind::Fork(branches) => branches.iter().for_each(visit),
            _ => {}
        }
    }
}
