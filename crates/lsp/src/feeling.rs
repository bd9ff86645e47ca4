//! What the words of an advanced move say: of the clause that each is of, of ways, and of what is
//! felt, with units. It knows the tree, and no code.

use obverse_syntax::ast::{AdvancedMove, Item, MoveClause, Program};

/// What is said of a word of an advanced move that stands at a place, if it is within one.
pub(crate) fn said(program: &Program<'_>, offset: u32, word: &str) -> Option<String> {
    let advanced = program.items.iter().find_map(|item| match item {
        Item::AdvancedMove(advanced) => {
            let is_around = advanced.span.start <= offset && offset <= advanced.span.end;
            is_around.then_some(advanced)
        }
        _ => None,
    })?;
    let mut clauses = advanced.clauses.iter();
    let clause = clauses.find(|clause| clause.span.start <= offset && offset <= clause.span.end);
    let text = match clause {
        Some(clause) => own(word, &clause.value).unwrap_or_else(|| of_clause(&clause.value)),
        None => of_head(advanced, word),
    };
    Some(text.to_owned())
}

/// Outside of the clauses.
fn of_head(advanced: &AdvancedMove<'_>, word: &str) -> &'static str {
    match word {
        "reverse" if advanced.counterpart.is_some() => {
            "The advanced move that takes its place going back"
        }
        _ => {
            "A motion that feels: how far at the most, what stops it, what success is, and what \
             follows. `advance` does it"
        }
    }
}

/// What a word says that is no clause's own.
fn own(word: &str, clause: &MoveClause<'_>) -> Option<&'static str> {
    let is_way = matches!(clause, MoveClause::Distance { .. } | MoveClause::Turn(_));
    let is_judged = matches!(clause, MoveClause::SucceedsIf(_));
    Some(match word {
        "distance" if is_judged => {
            "How far the motion has come along its way: a length, in um, mm, cm or m"
        }
        "force" if is_judged => "The largest force that was felt on the way, in N",
        "force" if matches!(clause, MoveClause::StopIf(_)) => {
            "What is felt at the tool meanwhile: a force, in N"
        }
        "holding" => "Whether an item is held",
        "input" => "The level of an input of the workcell: high or low",
        "and" | "or" | "not" if !is_way => "Joins conditions",
        "forward" if is_way => "Along z of the tool, the way in which it looks; in `base` along x",
        "backward" | "backwards" if is_way => {
            "Against the way in which the tool looks, along -z; in `base` along -x"
        }
        "left" if is_way => "Along -x of the tool; in `base` along y",
        "right" if is_way => "Along x of the tool; in `base` along -y",
        "up" if is_way => "Along -y of the tool; in `base` along z",
        "down" if is_way => "Along y of the tool; in `base` along -z",
        "x" | "y" | "z" if is_way => "Along that axis of the frame",
        "tcp" if is_way => "The frame of the tool centre point: of the tool that is set",
        "toolmount" if is_way => "The frame of the tool mount, where the tool is screwed on",
        "base" if is_way => "The frame of the base of the arm",
        "advancing" => {
            "How far the tool moves along the axis while it is turned: a length, in um, mm, cm or m"
        }
        "return" | "initial" | "position" => {
            "Straight back to where the move began, whatever came of it"
        }
        "repeat" | "perturbation" | "times" => {
            "Further attempts, so many at the most, each from where the first began and aside by \
             up to so much: a length, in um, mm, cm or m; 1 mm where none is given"
        }
        "throw" => "Raises an error of the program",
        _ => return None,
    })
}

fn of_clause(clause: &MoveClause<'_>) -> &'static str {
    match clause {
        MoveClause::Requires { .. } => {
            "What must hold before the motion; else the error behind `else throw` is raised, or \
             the machine stops"
        }
        MoveClause::Distance { .. } => {
            "How far the motion goes at the most, and which way: a length above zero, in um, mm, \
             cm or m. `tcp` is the frame where none is named"
        }
        MoveClause::Turn(_) => {
            "How far the tool is turned at the most, by the right hand about the axis that the \
             direction names: an angle, in deg or rad"
        }
        MoveClause::StopIf(_) => {
            "The motion stops at the instant when more is felt: a force, in N. Nothing else can \
             stop it"
        }
        MoveClause::Speed(_) => {
            "How fast the motion is, and it alone: the workcell says what the word means, in mm/s \
             and deg/s"
        }
        MoveClause::SucceedsIf(_) => {
            "What success is, looked at when the motion is over. Where it is left out: that it \
             came all the way"
        }
        MoveClause::OnSuccess(_) => "What follows where it has succeeded",
        MoveClause::OnFailure(_) => {
            "What follows where it has not succeeded: first further attempts, then the return, \
             then an error"
        }
        MoveClause::OppositeForce => {
            "The way back is stopped by as much force as the way there, in N; else it has no limit"
        }
    }
}
