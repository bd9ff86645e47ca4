//! What going back over a statement does, in words. It knows the tree, and no code.

use obverse_syntax::ast::{
    Item, MoveClause, Name, Primitive, Program, ReverseParameter, Statement, StatementKind, Target,
};
use obverse_syntax::span::Span;

/// The declarations of all files of a program.
pub(crate) struct Declarations<'t, 's>(pub(crate) &'t [Program<'s>]);

impl<'s> Declarations<'_, 's> {
    fn items(&self) -> impl Iterator<Item = &Item<'s>> {
        self.0.iter().flat_map(|program| &program.items)
    }

    /// What takes the place of an I/O operation or an advanced move in reverse.
    pub(crate) fn counterpart(&self, name: &str) -> Option<Name<'s>> {
        self.items().find_map(|item| match item {
            Item::Io(io) if io.name.value == name => io.counterpart,
            Item::AdvancedMove(advanced) if advanced.name.value == name => advanced.counterpart,
            _ => None,
        })
    }

    fn has_opposite_force(&self, name: &str) -> bool {
        self.items().any(|item| match item {
            Item::AdvancedMove(advanced) if advanced.name.value == name => {
                let mut clauses = advanced.clauses.iter();
                clauses.any(|clause| clause.value == MoveClause::OppositeForce)
            }
            _ => false,
        })
    }

    /// What going back over an advanced move does.
    pub(crate) fn of_advanced(&self, name: &str) -> String {
        match self.counterpart(name) {
            Some(other) => format!("`advance {}`", other.value),
            None if self.has_opposite_force(name) => {
                "straight back to where it began, stopped by as much force".to_owned()
            }
            None => "straight back to where it began".to_owned(),
        }
    }

    /// What going back over an I/O operation does.
    pub(crate) fn of_io(&self, name: &str) -> String {
        match self.counterpart(name) {
            Some(other) => format!("`io {}`", other.value),
            None => "its outputs take their former levels, the last first".to_owned(),
        }
    }

    /// What going back over a statement does, in words that follow "in reverse: ".
    pub(crate) fn of_statement(&self, statement: &Statement<'s>) -> String {
        use StatementKind as Kind;
        let words = match &statement.kind {
            Kind::Move { always: Some(_), .. } => "to the position that was named before",
            Kind::Move { target: Target::Turned(_), .. } => "turned as often the other way round",
            Kind::Move { .. } => "back to where it began, as recorded",
            Kind::Advance(name) => return self.of_advanced(name.value),
            Kind::Io(name) => return self.of_io(name.value),
            Kind::Primitive(Primitive::Set { .. } | Primitive::Toggle { .. }) => {
                "the output takes its former level"
            }
            Kind::Primitive(Primitive::Sleep { .. }) => "waited for again, as the output settles",
            Kind::Wait(_) | Kind::WaitUntil { .. } => "not waited for again",
            Kind::Call { .. } => "what it did is taken back, the last first",
            Kind::Variable(_) | Kind::Assign { .. } => "the variable has its former value again",
            Kind::Remember(_) => "the position that was remembered before is known again",
            Kind::If { ending_when: Some(_), .. } => {
                "the way that was taken, as `ending when` says"
            }
            Kind::If { .. } => "the way that was taken, as recorded",
            Kind::While { entered_when: Some(_), .. } => "round by round, as `entered when` says",
            Kind::While { .. } | Kind::Loop(_) => "round by round, as recorded",
            Kind::Repeat { .. } | Kind::For { .. } => "round by round, counting back",
            Kind::Fork(_) => "turn by turn, as the branches took them",
            Kind::Speed { .. } | Kind::Tool { .. } => "the former setting holds again",
            Kind::Checkpoint(_) => "passed; a recovery can end here",
            Kind::Barrier(_) | Kind::Irreversible { .. } => "going back ends here",
            Kind::SkipInReverse(_) => "nothing is commanded",
            Kind::ReplaceInReverse { .. } => "the second block is run in place of the first",
            Kind::KeepInReverse(_) => "the same again, in the same order",
            Kind::WithInReverse { parameters, .. } => return with_words(parameters),
            Kind::Break | Kind::Return | Kind::Throw(_) | Kind::Requires { .. } => {
                "the way that was taken"
            }
            Kind::Allow(_) => return String::new(),
        };
        words.to_owned()
    }
}

fn with_words(parameters: &[obverse_syntax::span::Spanned<ReverseParameter<'_>>]) -> String {
    let words = parameters.iter().map(|parameter| match &parameter.value {
        ReverseParameter::Speed(_) => "at another speed",
        ReverseParameter::ForceLimit(_) => "stopped by a force",
        ReverseParameter::StraightMoves => "in straight lines",
    });
    format!("what was done, mirrored, {}", words.collect::<Vec<_>>().join(", "))
}

/// The innermost statement around a position.
pub(crate) fn statement_at<'t, 's>(
    program: &'t Program<'s>,
    offset: u32,
) -> Option<&'t Statement<'s>> {
    let is_around = |span: Span| span.start <= offset && offset <= span.end;
    let bodies = program.items.iter().filter_map(|item| match item {
        Item::Sequence(sequence) => Some(&sequence.body),
        Item::Cleanup(cleanup) => Some(&cleanup.body),
        _ => None,
    });
    let mut blocks: Vec<_> = bodies.filter(|body| is_around(body.span)).collect();
    let mut innermost = None;
    while let Some(block) = blocks.pop() {
        let found = block.statements.iter().find(|statement| is_around(statement.span));
        let Some(found) = found else { continue };
        innermost = Some(found);
        blocks = found.blocks();
        blocks.retain(|block| is_around(block.span));
    }
    innermost
}
