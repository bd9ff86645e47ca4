//! The tokens, and which words are reserved. A token carries no text: that is read from the source
//! at its span. It does not know how tokens make a program.

use logos::Logos;

macro_rules! tokens {
    (reserved { $($reserved:ident $reserved_text:tt)* }
     free { $($free:ident $free_text:tt)* }
     signs { $($sign:ident $sign_text:tt)* }) => {
        /// A kind of token.
        #[derive(Logos, Clone, Copy, Debug, PartialEq, Eq)]
        #[logos(skip r"[ \t\r\n\x0C]+", skip(r"//[^\r\n]*", allow_greedy = true))]
        pub(crate) enum Token {
            $(#[token($reserved_text)] $reserved,)*
            $(#[token($free_text)] $free,)*
            $(#[token($sign_text)] $sign,)*
            #[regex("[A-Za-z_][A-Za-z0-9_]*", priority = 1)]
            Name,
            #[regex("[0-9]+")]
            Integer,
            #[regex(r"[0-9]+\.[0-9]+([eE][+-]?[0-9]+)?|[0-9]+[eE][+-]?[0-9]+")]
            Real,
            #[regex(r#""[^"\r\n]*""#)]
            Text,

            // What the lexer makes of the ones above.
            /// A word before `=`, `+=` or `-=` that can begin an assignment.
            Assigned,
            /// A number and its unit.
            Quantity,
            /// A number and a word that is no unit.
            BadQuantity,
            /// A unit after `]`.
            Unit,
            /// A value of another language, which has been reported.
            Absent,

            // What the lexer reports and replaces or leaves out.
            #[regex(r"[0-9]+\.|\.[0-9]+([eE][+-]?[0-9]+)?")]
            MalformedNumber,
            #[regex(r#""[^"\r\n{]*"#)]
            UnclosedText,
            #[regex(r"'[^'\r\n]*'")]
            ForeignText,
            #[token("/*")]
            ForeignComment,
            #[token("&&")]
            ForeignAnd,
            #[token("||")]
            ForeignOr,
            #[token("!")]
            ForeignNot,
            #[token("%")]
            ForeignRemainder,
            #[token(":=")]
            ForeignAssign,
            #[token("<>")]
            ForeignNotEqual,
        }

        impl Token {
            /// How a word or sign is written; none for names, numbers, texts.
            pub(crate) fn text(self) -> Option<&'static str> {
                match self {
                    $(Self::$reserved => Some($reserved_text),)*
                    $(Self::$free => Some($free_text),)*
                    $(Self::$sign => Some($sign_text),)*
                    _ => None,
                }
            }

            /// Whether it is a word that cannot be a name.
            pub(crate) fn is_reserved(self) -> bool {
                matches!(self, $(Self::$reserved)|*)
            }

            /// Whether it is a word of the language that can be a name.
            pub(crate) fn is_free(self) -> bool {
                matches!(self, $(Self::$free)|*)
            }
        }

        /// The words that cannot be names, in alphabetical order.
        pub const RESERVED_WORDS: &[&str] = &[$($reserved_text),*];

        /// The other words of the language: they can be names.
        pub const FREE_WORDS: &[&str] = &[$($free_text),*];
    };
}

tokens! {
    reserved {
        Advance "advance" And "and" Barrier "barrier" Break "break" Call "call"
        Checkpoint "checkpoint" Distance "distance" Do "do" Else "else" False "false" For "for"
        Force "force" Fork "fork" Holding "holding" If "if" Input "input" Io "io"
        Irreversible "irreversible" Keep "keep" Loop "loop" Mod "mod" Move "move" Not "not" Or "or"
        Repeat "repeat" Return "return"
        Sequence "sequence" Set "set" Skip "skip" Sleep "sleep" Throw "throw" To "to"
        Toggle "toggle" True "true" Until "until" Var "var" Wait "wait" While "while"
    }
    free {
        Action "action" Actions "actions" Advanced "advanced" Advancing "advancing"
        After "after" Allow "allow" Always "always" At "at"
        Backward "backward" Backwards "backwards" Base "base" By "by"
        Cell "cell" Cleanup "cleanup" Collision "collision" Continue "continue" Current "current"
        Doubling "doubling" Down "down" Emergency "emergency" Ending "ending" Entered "entered"
        Error "error" Escalating "escalating" Failure "failure" Fast "fast" Fatal "fatal"
        File "file" Forward "forward" From "from" Give "give" High "high" Import "import" In "in"
        Initial "initial" Item "item" Joint "joint" Joints "joints" Keyframe "keyframe"
        Learned "learned" Left "left" Library "library" Lighter "lighter" Limit "limit"
        Linearly "linearly" Low "low"
        Missing "missing" Moves "moves" Normal "normal" Of "of" On "on" Once "once"
        Operator "operator" Opposite "opposite" Otherwise "otherwise" Out "out" Output "output"
        Perturbation "perturbation" Perturbed "perturbed" Position "position" Program "program"
        Protective "protective" Random "random" Reach "reach" Recover "recover"
        Recoverable "recoverable" Requires "requires" Respond "respond" Restart "restart"
        Reverse "reverse" Reversible "reversible" Reversing "reversing" Right "right"
        Severity "severity" Short "short" Singularity "singularity" Slow "slow" Slower "slower"
        Speed "speed" Start "start" Stop "stop" Stopped "stopped" Straight "straight"
        Succeeds "succeeds" Success "success" Tcp "tcp" Then "then" Times "times" Tool "tool"
        ToolMount "toolmount" Turn "turn" Up "up" Using "using" Very "very"
        Warning "warning" When "when" With "with" X "x" Y "y" Z "z"
    }
    signs {
        OpenBrace "{" CloseBrace "}" OpenParenthesis "(" CloseParenthesis ")" OpenBracket "["
        CloseBracket "]" Semicolon ";" Comma "," Colon ":" Dot "." Assign "=" AddAssign "+="
        SubtractAssign "-=" Plus "+" Minus "-" Star "*" Slash "/" Equal "==" NotEqual "!="
        Less "<" LessOrEqual "<=" Greater ">" GreaterOrEqual ">="
    }
}

impl Token {
    /// The end of a text that is being written. The grammar has no such token, so that it says what
    /// it allows there; the lexer gives it nowhere else.
    pub(crate) const END: Self = Self::UnclosedText;

    /// Whether it is a word: a name, or a word of the language.
    pub(crate) fn is_word(self) -> bool {
        matches!(self, Self::Name | Self::Assigned) || self.is_reserved() || self.is_free()
    }

    /// Whether it can be a name: one, or a word of the language that is not reserved.
    pub(crate) fn can_be_name(self) -> bool {
        self.is_word() && !self.is_reserved()
    }

    /// Whether it begins a statement, whatever stands before it.
    pub(crate) fn begins_statement(self) -> bool {
        use Token::*;
        matches!(
            self,
            Advance
                | Barrier
                | Break
                | Call
                | Checkpoint
                | Do
                | For
                | Fork
                | If
                | Io
                | Irreversible
                | Keep
                | Loop
                | Move
                | Repeat
                | Return
                | Set
                | Skip
                | Sleep
                | Throw
                | Toggle
                | Var
                | Wait
                | While
        )
    }

    /// Whether a statement or declaration can end with it, and no name can follow it in one.
    pub(crate) fn ends_statement(self) -> bool {
        use Token::*;
        matches!(
            self,
            Name | Assigned
                | Integer
                | Real
                | Quantity
                | Unit
                | Text
                | CloseParenthesis
                | CloseBracket
                | True
                | False
                | Holding
                | Force
                | Break
                | Forward
                | Backward
                | Backwards
                | Left
                | Right
                | Up
                | Down
                | X
                | Y
                | Z
                | Base
                | Tcp
                | ToolMount
                | Slow
                | Normal
                | Fast
                | High
                | Low
                | Linearly
                | Always
        )
    }

    /// Whether a name follows it that ends the statement. Reserved words alone are among them.
    pub(crate) fn wants_name(self) -> bool {
        use Token::*;
        matches!(self, To | Io | Call | Advance | Throw | Checkpoint)
    }

    /// Whether what follows on the line is an operand: the `x` of `if x = 3` is none that is
    /// assigned, nor the `lamp` of `set lamp = high`. The token before tells whether a word such as
    /// `when` is a name.
    pub(crate) fn wants_operand(self, before: Self) -> bool {
        use Token::*;
        match self {
            Assign | AddAssign | SubtractAssign | If | While | Wait | Sleep | Input | Set
            | Toggle => true,
            When => matches!(before, Ending | Entered),
            _ => self.is_operator(),
        }
    }

    /// Whether it adds a node to the tree of an expression.
    pub(crate) fn is_operator(self) -> bool {
        use Token::*;
        matches!(
            self,
            And | Or
                | Not
                | Mod
                | Plus
                | Minus
                | Star
                | Slash
                | Equal
                | NotEqual
                | Less
                | LessOrEqual
                | Greater
                | GreaterOrEqual
        )
    }
}

/// The units a number may have, by what they measure.
pub const UNITS: &[&str] =
    &["um", "mm", "cm", "m", "deg", "rad", "ms", "s", "min", "N", "mm/s", "m/s", "deg/s", "rad/s"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_sorted_and_of_one_kind() {
        for words in [RESERVED_WORDS, FREE_WORDS] {
            assert!(words.is_sorted(), "{words:?}");
        }
        assert!(!RESERVED_WORDS.iter().any(|word| FREE_WORDS.contains(word)));
    }

    #[test]
    fn the_longest_token_wins() {
        let tokens: Vec<_> = Token::lexer("iffy if x1 1e5 1.5e-3 <= < =").map(Result::ok).collect();
        use Token::*;
        let expected = [Name, If, Name, Real, Real, LessOrEqual, Less, Assign].map(Some);
        assert_eq!(tokens, expected);
    }
}
