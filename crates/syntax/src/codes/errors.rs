//! The rows of the errors. It knows no table: it hands its rows to the macro that makes one.

/// Calls a macro with the rows of the errors, and behind them those that it was given.
macro_rules! errors {
    ($table:ident $($more:tt)*) => { $table! {
    // E00xx: text and grammar.
    UnexpectedCharacter "E0001" "a character that means nothing"
        why "Outside comments and strings a program is written in ASCII: names of letters, digits \
             and `_`, numbers, and the signs of the language. Letters of other alphabets, \
             typographic quotes and invisible characters, as they come with text copied from a \
             document, are refused rather than guessed at."
        wrong "var größe = 3 mm"
        right "var size = 3 mm"
    UnterminatedString "E0002" "a text without its closing quote"
        why "A text begins with `\"` and ends with `\"` on the same line; there is no way to write \
             a `\"` in one."
        wrong "cell \"peg.toml"
        right "cell \"peg.toml\""
    NumberOutOfRange "E0003" "a number that is too large"
        why "Integers have 64 bits: the largest is 9223372036854775807. Reals are double \
             precision: the largest is about 1.8e308. A larger number is refused, never rounded \
             or wrapped."
        wrong "var count = 9223372036854775808"
        right "var count = 9223372036854775807"
    MalformedNumber "E0004" "a number that is not written as one"
        why "A real has digits on both sides of its point, and an exponent has digits. Digits are \
             not grouped."
        wrong "var part = .5"
        right "var part = 0.5"
    UnknownUnit "E0005" "a word after a number that is not a unit"
        why "A name right after a number on the same line is its unit: um, mm, cm, m for lengths, \
             deg, rad for angles, ms, s, min for times, N for forces, mm/s, m/s, deg/s, rad/s for \
             speeds."
        wrong "var gap = 3 mmm"
        right "var gap = 3 mm"
    SourceTooLarge "E0006" "a source text that is too large"
        why "A source text has at most 256 MiB. What is larger was hardly written by people; name \
             what repeats, and call it."
        wrong ""
        right ""
    NotText "E0007" "a file that is not text"
        why "A program is UTF-8 text without NUL bytes. A module, a tape or an archive was given \
             where a source text was asked for."
        wrong ""
        right ""
    UnexpectedToken "E0010" "something that cannot stand here"
        why "The grammar allows something else at this place. What was expected is named; \
             GRAMMAR.md of the syntax crate has the whole grammar on a page."
        wrong "joints start [1, 2, 3, 4, 5, 6] rad"
        right "joints start = [1, 2, 3, 4, 5, 6] rad"
    UnclosedBracket "E0011" "a bracket that is not closed"
        why "Every `{`, `(` and `[` has its `}`, `)` or `]`. The place marked is the one that was \
             opened; the closing one is missing before the second place, or earlier."
        wrong "sequence main { return"
        right "sequence main { return }"
    UnmatchedBracket "E0012" "a closing bracket that closes nothing"
        why "Every `}`, `)` and `]` closes the bracket of its kind that was opened last."
        wrong "sequence main { return } }"
        right "sequence main { return }"
    NestingTooDeep "E0013" "brackets or blocks too deep in one another"
        why "Blocks, brackets and the links of an `else if` chain are at most 64 deep in one \
             another. Name a sequence for the inner part and call it."
        wrong "var a = ((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((\
               1))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))"
        right "var a = 1"
    ExpressionTooLong "E0014" "an expression with too many operators"
        why "An expression has at most 256 operators. Name a part of it with `var`."
        wrong "var a = ----------------------------------------------------------------------\
               ----------------------------------------------------------------------\
               ----------------------------------------------------------------------\
               ----------------------------------------------------------------------\
               1"
        right "var a = 1"
    AssignmentAsComparison "E0015" "`=` where two values are compared"
        why "`=` gives a variable a value; `==` asks whether two values are equal."
        wrong "sequence main { if 1 = 2 { return } }"
        right "sequence main { if 1 == 2 { return } }"
    ForeignOperator "E0016" "an operator of another language"
        why "The language writes `and`, `or`, `not` and `mod` in words, and has the assignments \
             `=`, `+=` and `-=`."
        wrong "var ready = true && false"
        right "var ready = true and false"
    MissingBlock "E0017" "a block without braces"
        why "What a condition or a loop governs stands in braces, also when it is one statement."
        wrong "sequence main { if true return }"
        right "sequence main { if true { return } }"
    ForeignLoop "E0018" "a loop of another language"
        why "A loop that counts names its counter, the first value and the last, both included. A \
             loop that only repeats is `repeat 3 times { .. }`."
        wrong "sequence main { for (i = 0; i < 10; i++) { sleep 1 s } }"
        right "sequence main { for i from 0 to 9 { sleep 1 s } }"
    ReservedWord "E0019" "a word of the language where a name was expected"
        why "Words that begin a statement or an expression cannot be names. GRAMMAR.md lists \
             them; most words of the language are free."
        wrong "var wait = 3 s"
        right "var pause = 3 s"
    StatementOutside "E0020" "a statement outside of a sequence"
        why "At the top of a file stand declarations; what the robot does stands in a sequence or \
             an action. The program begins with the sequence `main`, or with its last sequence."
        wrong "move 5 mm up"
        right "sequence main { move 5 mm up }"
    DeclarationInside "E0021" "a declaration inside of a block"
        why "Sequences, actions, items, errors and the like are declared at the top of a file, \
             where every sequence sees them; only variables are declared in blocks."
        wrong "sequence main { sequence inner { return } }"
        right "sequence inner { return } sequence main { call inner() }"
    ChainedComparison "E0022" "a comparison of a comparison"
        why "`a < b < c` would compare a truth value with `c`. Compare twice."
        wrong "var inside = 1 < 2 < 3"
        right "var inside = 1 < 2 and 2 < 3"
    ForeignWord "E0030" "a word of another language"
        why "Other robot languages have other words for the same thing. What is written here in \
             place of one is said where it was found; the rest of its line is not read."
        wrong "joints start = [0, -90, 90, -90, -90, 0] deg\n\
               sequence main {\n  move to start\n  MoveL start, v100, fine, tool0;\n}"
        right "joints start = [0, -90, 90, -90, -90, 0] deg\n\
               sequence main {\n  move to start\n  move to start linearly\n}"

    // E01xx: names.
    UnknownName "E0101" "a name that nothing has"
        why "Every name is declared once in the file: joint configurations, items, I/O operations, \
             errors, advanced moves and sequences at its top, in any order; variables before they \
             are used. A declaration with a mistake of its own still counts."
        wrong "sequence main { move to start }"
        right "joints start = [0, -90, 90, -90, -90, 0] deg\n\
               sequence main { move to start }"
    DuplicateName "E0102" "a name that is given twice"
        why "All declarations share one set of names, and a name means one thing wherever it is \
             seen: a variable cannot have the name of a sequence, nor of a variable around it. \
             Blocks beside one another may use the same name."
        wrong "var count = 0\n\
               sequence main { var count = 1 if count > 0 { wait 1 s } }"
        right "sequence main { var count = 1 if count > 0 { wait 1 s } }"
    WrongKind "E0103" "a name of another kind of thing"
        why "`move to` takes a joint configuration, a keyframe or a position; `io` an I/O \
             operation; `advance` an advanced move; `call` a sequence or an action; `throw` an \
             error."
        wrong "io open { set 0 low }\n\
               sequence main { call open }"
        right "io open { set 0 low }\n\
               sequence main { io open }"
    UnknownKeyframe "E0104" "an item without this keyframe"
        why "`move to part.grasp` needs a keyframe `grasp` of that item. Where `part` is a \
             parameter, every item that is passed needs each keyframe that the sequence moves to, \
             itself or through the sequences it passes the item on to."
        wrong "item peg { keyframe above = [0, 0, 50] mm }\n\
               sequence main { move to peg.grasp }"
        right "item peg { keyframe grasp = [0, 0, 20] mm }\n\
               sequence main { move to peg.grasp }"
    UnknownFunction "E0105" "a function that there is not"
        why "The functions of expressions are abs, min, max, sqrt, int, real and random. A \
             sequence has no value; it is called by a statement of its own, `call NAME(..)`."
        wrong "var gap = square(2)\n\
               sequence main { if gap > 3 { wait 1 s } }"
        right "var gap = 2 * 2\n\
               sequence main { if gap > 3 { wait 1 s } }"
    UnknownType "E0106" "a type that there is not"
        why "The types are int, number, length, angle, time, force, speed, bool, joints and item. \
             A number is a real without a unit."
        wrong "action lift(height: metres) { move height up in base }\n\
               sequence main { call lift(5 mm) }"
        right "action lift(height: length) { move height up in base }\n\
               sequence main { call lift(5 mm) }"
    UnknownCheckpoint "E0107" "a checkpoint that is nowhere set"
        why "A recovery that reverses to a checkpoint needs a statement `checkpoint NAME` \
             somewhere in the program; otherwise it could only give up."
        wrong "error jam { recover by reversing to checkpoint ready }\n\
               sequence main { throw jam }"
        right "error jam { recover by reversing to checkpoint ready }\n\
               sequence main { checkpoint ready throw jam }"
    UnknownCode "E0110" "a code that is no warning's"
        why "`allow` takes the code of a warning, `W0001` for example. Errors cannot be allowed. \
             It holds for the statement or declaration that follows; with `in file`, for the file. \
             docs/codes.md lists the codes."
        wrong "allow E0001 \"it is read by the operator\"\n\
               sequence main { wait 1 s }"
        right "allow W0001 \"it is read by the operator\"\n\
               var count = 0\n\
               sequence main { count += 1 }"

    // E02xx: types and units.
    TypeMismatch "E0201" "a value of another type"
        why "Integers, reals, truth values, joint configurations and items do not stand for one \
             another. An integer that is written out stands for a number where one is needed; any \
             other is turned into one by `real(n)`, and a number into an integer by `int(x)`."
        wrong "sequence main { if 1 { wait 1 s } }"
        right "sequence main { if holding { wait 1 s } }"
    UnitMismatch "E0202" "a value of another unit"
        why "Values are added, compared and assigned only where they measure the same: a length is \
             never compared with a time. Units of one kind convert: mm and m, deg and rad. \
             Products and quotients combine: 10 mm / 2 s is a speed."
        wrong "sequence main { wait 3 mm }"
        right "sequence main { wait 3 s }"
    MissingUnit "E0203" "a number without a unit"
        why "A length, angle, time, force or speed is written with its unit, also when it is zero; \
             there is no default, so that 0.3 m and 0.3 mm cannot be confused."
        wrong "sequence main { wait 3 }"
        right "sequence main { wait 3 s }"
    DoubleUnit "E0204" "a unit within and after the bracket"
        why "The unit after a bracket is that of each number in it, so that the numbers have none \
             of their own. Without a unit after the bracket each has its own."
        wrong "joints home = [0 deg, -90, 90, -90, -90, 0] deg\n\
               sequence main { move to home }"
        right "joints home = [0, -90, 90, -90, -90, 0] deg\n\
               sequence main { move to home }"
    VectorLength "E0205" "a vector with too many or too few numbers"
        why "A joint configuration has six numbers, from the base to the wrist; the position of a \
             keyframe has three, and so has its rotation (the axis times the angle)."
        wrong "joints home = [0, -90, 90] deg\n\
               sequence main { move to home }"
        right "joints home = [0, -90, 90, -90, -90, 0] deg\n\
               sequence main { move to home }"
    NotConstant "E0206" "a value that is not known before the program runs"
        why "The first values of the program's variables, joint configurations, keyframes and the \
             policies of errors are fixed when the program is compiled: numbers, units and \
             arithmetic, but no variables and no readings."
        wrong "var first = force\n\
               sequence main { if first > 1 N { wait 1 s } }"
        right "sequence main { var first = force if first > 1 N { wait 1 s } }"
    DivisionByZero "E0207" "a division by zero"
        why "An integer cannot be divided by zero, nor is there a remainder by zero. Where the \
             divisor is a variable, the machine traps before the statement has changed anything."
        wrong "var part = 1 / 0\n\
               sequence main { if part > 0 { wait 1 s } }"
        right "var part = 1 / 2.0\n\
               sequence main { if part > 0 { wait 1 s } }"
    ArgumentCount "E0208" "too many or too few arguments"
        why "A call gives each parameter its value, in the order of their declaration or by name. \
             One that has a default may be left out."
        wrong "action lift(height: length) { move height up }\n\
               sequence main { call lift }"
        right "action lift(height: length) { move height up }\n\
               sequence main { call lift(5 mm) }"
    NoSquareRoot "E0209" "a unit without a square root"
        why "The square root halves each unit: that of an area is a length, but that of a length \
             has no unit."
        wrong "var side = sqrt(4 mm)\n\
               sequence main { move side up }"
        right "var side = sqrt(4 mm * 4 mm)\n\
               sequence main { move side up }"
    OutOfRange "E0210" "a value that cannot be meant"
        why "A time to wait is not negative, a move is tried a limited number of times, values and \
             units are finite, and a workcell has no more than 65536 lines."
        wrong "sequence main { wait -1 s }"
        right "sequence main { wait 1 s }"
    ItemVariable "E0211" "a variable that would hold an item"
        why "Which keyframes an item has is checked before the program runs. Therefore only a \
             parameter stands for an item, and it is never assigned."
        wrong "item peg { keyframe grasp = [0, 0, 20] mm }\n\
               sequence main { var part = peg move to part.grasp }"
        right "item peg { keyframe grasp = [0, 0, 20] mm }\n\
               sequence main { call pick(peg) }\n\
               action pick(part: item) { move to part.grasp }"
    OutsideRange "E0212" "a value outside the range of its parameter"
        why "A parameter may say between which values it lies, both included. Its default and \
             every value that is known before the program runs are held to that here; a value \
             that is computed is looked at when the action begins, and traps if it is outside."
        wrong "action lift(height: length in 5 mm to 60 mm = 20 mm) { move height up }\n\
               sequence main { call lift(height: 80 mm) }"
        right "action lift(height: length in 5 mm to 60 mm = 20 mm) { move height up }\n\
               sequence main { call lift(height: 50 mm) }"
    WrongArgument "E0213" "an argument that belongs to no parameter"
        why "An argument with a name goes to the parameter of that name, one without a name to the \
             next in the order of their declaration. Those with a name come last, and each \
             parameter is given once."
        wrong "action lift(height: length = 20 mm) { move height up }\n\
               sequence main { call lift(depth: 5 mm) }"
        right "action lift(height: length = 20 mm) { move height up }\n\
               sequence main { call lift(height: 5 mm) }"

    // E03xx: statements, structure and errors.
    NoMain "E0301" "a program without a main sequence"
        why "A program begins with its sequence `main`, or, where none has that name, with the \
             last sequence that has no parameters. Actions are only called."
        wrong "joints home = [0, -90, 90, -90, -90, 0] deg\n\
               action go { move to home }"
        right "joints home = [0, -90, 90, -90, -90, 0] deg\n\
               sequence go { move to home }"
    MainParameters "E0302" "a main sequence that needs arguments"
        why "Nobody calls the sequence `main`, so that nobody could give it arguments; and it is a \
             sequence, not an action."
        wrong "sequence main(height: length) { move height up }"
        right "sequence main { move 5 mm up }"
    DuplicateClause "E0303" "a clause that is written twice"
        why "Each clause of an error or an advanced move, and `cell` in a file, is written at most \
             once: which of two should hold would be a guess."
        wrong "error jam { severity fatal severity warning }\n\
               sequence main { throw jam }"
        right "error jam { severity fatal }\n\
               sequence main { throw jam }"
    MissingClause "E0304" "a clause that is needed"
        why "An advanced move says how far it goes and which way: `distance 300 mm forward in \
             tcp`."
        wrong "advanced move insert { stop if force > 5 N }\n\
               sequence main { advance insert }"
        right "advanced move insert {\n  distance 20 mm forward\n  stop if force > 5 N\n  \
               succeeds if force > 5 N\n}\n\
               sequence main { advance insert }"
    StopCondition "E0305" "a motion cannot be stopped by this"
        why "A guarded motion is stopped by the workcell itself, at the instant when the contact \
             force exceeds a limit: `stop if force > 5 N`. How far it goes is its distance."
        wrong "advanced move insert { distance 20 mm forward stop if holding }\n\
               sequence main { advance insert }"
        right "advanced move insert {\n  distance 20 mm forward\n  stop if force > 5 N\n  \
               succeeds if force > 5 N\n}\n\
               sequence main { advance insert }"
    BreakOutsideLoop "E0306" "a `break` without a loop"
        why "`break` leaves the innermost loop of the same sequence. `return` leaves the sequence."
        wrong "sequence main { break }"
        right "sequence main { return }"
    NotAssignable "E0307" "something that cannot be assigned"
        why "Variables and parameters can be assigned; the counter of a loop, an item and a \
             declaration cannot. A counted loop knows its counter in both directions, since \
             nothing else changes it."
        wrong "sequence main { for i from 0 to 9 { i = 3 } }"
        right "sequence main { var i = 0 while i < 10 { i += 3 } }"
    RecoveryParameters "E0308" "a recovery that needs arguments"
        why "A recovery is called where an error is responded to, and nothing there could be its \
             arguments."
        wrong "error jam { recover using free }\n\
               sequence free(by: length) { move by up }\n\
               sequence main { throw jam }"
        right "error jam { recover using free }\n\
               sequence free { move 5 mm up }\n\
               sequence main { throw jam }"
    ContradictoryError "E0309" "clauses of an error that exclude one another"
        why "A fatal error stops the program and a warning lets it go on, so that neither is \
             recovered from. `otherwise using` names what is run when reversing has been given up; \
             an error that is recovered from by a sequence has no use for a second one."
        wrong "error jam { severity fatal then continue }\n\
               sequence main { throw jam }"
        right "error jam { severity warning }\n\
               sequence main { throw jam }"
    TooMany "E0310" "more than a module can hold"
        why "A module has at most 65535 of each kind of thing and four million instructions; a \
             sequence has room for 256 variables (hidden ones among them, and three for each loop \
             counter), 255 parameters and 256 positions. Name a sequence for a part of it and call \
             it."
        wrong ""
        right ""
    ExpressionTooLarge "E0311" "an expression that is too large"
        why "A statement computes at most 200 values and holds at most 120 of them at a time; the \
             arguments of a call count together. Name a part of it with `var`."
        wrong ""
        right ""
    MisplacedBehaviour "E0312" "a behaviour that cannot stand here"
        why "`repeat with perturbation` tries a failed move again, so that it stands once, in `on \
             failure`."
        wrong "advanced move insert { distance 20 mm forward on success { repeat with \
               perturbation 3 times } }\n\
               sequence main { advance insert }"
        right "advanced move insert { distance 20 mm forward on failure { repeat with \
               perturbation 3 times } }\n\
               sequence main { advance insert }"

    FaultTwice "E0313" "a fault that raises two errors"
        why "When the workcell does not do as commanded, the error is raised that names the fault. \
             Which of two would hold is a guess, so that each fault is named once in a program, \
             with the files that it imports."
        wrong "error slipped { on protective stop }\n\
               error jammed { on collision, protective stop }\n\
               sequence main { move 5 mm down }"
        right "error slipped { on protective stop }\n\
               error jammed { on collision }\n\
               sequence main { move 5 mm down }"

    // E04xx: reversal.
    NoNamedPosition "E0401" "the position named last is not known"
        why "`reversible always` takes a move back to the configuration that the program named \
             last, without a record. That is known only where on every way that leads here the \
             same `move to` a joint configuration comes last, with nothing between that may move \
             the arm: another motion, a call or an error that leads to one, a loop that comes \
             round to one. Without `reversible always` a move goes back to where it was recorded \
             to begin."
        wrong "joints a = [0, -90, 90, -90, -90, 0] deg\n\
               sequence main { move to a reversible always }"
        right "joints a = [0, -90, 90, -90, -90, 0] deg\n\
               joints b = [9, -90, 90, -90, -90, 0] deg\n\
               sequence main { move to a move to b reversible always }"
    LeavesReversedBlock "E0402" "a way out of a block that is reversed as one"
        why "A block that is skipped or replaced in reverse is passed over from its end to its \
             beginning; a way out of its middle would have no such end."
        wrong "sequence main { skip in reverse { return } }"
        right "sequence main { skip in reverse { wait 1 s } return }"
    ReadingInAssertion "E0403" "an assertion that reads the outside"
        why "What follows `ending when` and `entered when` is evaluated in both directions and \
             must say the same in both. A reading of the workcell or a random draw need not. Store \
             it in a variable and assert that."
        wrong "sequence main { if holding { wait 1 s } ending when input 3 }"
        right "sequence main { var part = input 3 if part { wait 1 s } ending when part }"
    UselessAssertion "E0404" "an assertion where no ways join"
        why "`ending when` and `entered when` tell two ways apart that come together. Where one of \
             them leaves for good there is nothing to tell apart, and no record would be made \
             either."
        wrong "sequence main { var n = 1 if n > 0 { return } ending when n > 0 }"
        right "sequence main { var n = 1 if n > 0 { return } }"
    OuterVariableInReverse "E0405" "a variable of the sequence, changed in reverse"
        why "The block after `in reverse` is run while the program goes backwards, and then all \
             that the program knew is what it was before. The block may read the variables and \
             the positions of the sequence around it, as they are at the end of what it replaces; \
             what it changes is its own. For the same reason a block that keeps its order in \
             reverse does not remember a position anew that was remembered before it."
        wrong "sequence main { var n = 1 s do { wait n } in reverse { n = 2 s wait n } }"
        right "sequence main { var n = 1 s do { wait n } in reverse { var m = 2 s wait m } }"
    ErrorInReverse "E0406" "a block that replaces another and can fail"
        why "The block after `in reverse` is run while the program goes backwards, where no error \
             is responded to. Neither it nor what it calls may throw."
        wrong "error jam { then stop }\n\
               sequence main { do { wait 2 s } in reverse { throw jam } }"
        right "error jam { then stop }\n\
               sequence main { do { throw jam } in reverse { wait 1 s } }"
    BarrierInReversedBlock "E0407" "a barrier in a block that has a reverse of its own"
        why "A barrier, and a block that is irreversible, cannot be passed backwards; a block that \
             is skipped or replaced in reverse is passed. Neither it nor what it calls may contain \
             one."
        wrong "sequence main { skip in reverse { barrier \"glued\" } }"
        right "sequence main { skip in reverse { wait 1 s } barrier \"glued\" }"

    // E05xx: files.
    CannotImport "E0501" "a file that cannot be imported"
        why "The file is not there, cannot be read, is too large, or is no text; which of these is \
             said. A path begins at the folder of the file that it is written in. Each file is \
             read once, however often it is imported."
        wrong "import \"poses.obv\"\n\
               sequence main { wait 1 s }"
        right "sequence main { wait 1 s }"
    ImportPath "E0502" "a path that no import can have"
        why "A program is what is in its folder and below: the folder of the file that is checked \
             or run. So it is the same wherever it is copied to, and a program from elsewhere \
             reads nothing of yours. A path begins at the folder of the file that it is written \
             in and has `/` between folders on every system; `..` may lead up, but not out of the \
             program's folder. Nor may a link of the file system."
        wrong "import \"/cell/poses.obv\"\n\
               sequence main { wait 1 s }"
        right "sequence main { wait 1 s }"
    ImportCycle "E0503" "files that import one another"
        why "An import stands for the declarations of the file that it names; a file that imports \
             itself, by way of others or not, would stand for more than any file holds. \
             Declarations see one another whichever file they are in, so that a file need not \
             import what it uses if the one that imports it does."
        wrong ""
        right ""
    TooManyImports "E0504" "too many files, or too large together"
        why "A program imports at most 1000 files, of which 64 import one another in a row; all \
             its files have at most 256 MiB together."
        wrong ""
        right ""

    // E06xx: forks.
    ForkBranches "E0601" "a fork that has not two to sixteen branches with something in each"
        why "`fork { .. } and { .. }` runs its branches in turns until all are done. One branch \
             alone, or an empty one, has nobody to take turns with."
        wrong "sequence main { fork { set 1 high wait 1 s } }"
        right "sequence main { fork { set 1 high wait 1 s } and { set 2 high wait 2 s } }"
    LeavesFork "E0602" "a way out of a fork from one of its branches"
        why "A fork is done when all its branches are. `break` leaves a loop within its branch, \
             and `return` a sequence that the branch calls, but not the branch: the others would \
             stand half-way. Only an error leaves a fork, since then the others are held."
        wrong "sequence main { fork { toggle 1 return } and { toggle 2 } }"
        right "sequence main { fork { toggle 1 } and { toggle 2 } return }"
    SharedDevice "E0603" "two branches of a fork that use the same device"
        why "Branches run in turns, one command at a time, so that two that command the same \
             device would be mixed. The arm is one device, with its speed, its tool and its \
             readings `force`, `distance` and `holding`; so is each output, and so are the random \
             numbers. What a branch calls counts as its own, and so do the recoveries of its \
             errors and what is run in its place in reverse."
        wrong "sequence main { fork { set 1 high } and { wait 1 s set 1 low } }"
        right "sequence main { fork { set 1 high } and { wait 1 s set 2 low } }"
    SharedVariable "E0604" "two branches of a fork that assign the same variable"
        why "Which of them comes last depends on whose turn it is when. Give each branch a \
             variable of its own, and put them together after the fork."
        wrong "sequence main { var n = 0 fork { n = 1 } and { n = 2 } if n > 0 { wait 1 s } }"
        right "sequence main { var a = 0 var b = 0 fork { a = 1 } and { b = 2 } \
               if a + b > 0 { wait 1 s } }"

    // E07xx: inversion. The examples are inverted: their sequence `main`.
    NotInvertible "E0701" "something that has no inverse"
        why "The inverse of a sequence is a program of its own, which knows nothing of the run \
             that it takes back: it has no tape. So each statement must say by itself, or with \
             those before it, what takes it back. A move goes back to the place that was named \
             before it; an output to the level that it was set to before, or to the counterpart \
             of its I/O operation; `n += e` of an integer is taken back by `n -= e`; a branch \
             or a loop by its assertion (`ending when`, `entered when`) or by what it leaves \
             alone. Readings, sums of reals, errors, barriers and ways out of the middle leave \
             no such trace. A sequence begins where its first move leads, with the outputs that \
             are set before it."
        wrong "joints a = [0, 0, 0, 0, 0, 0] deg\n\
               joints b = [9, 0, 0, 0, 0, 0] deg\n\
               sequence main { move to a move 20 mm up in base move to b }"
        right "joints a = [0, 0, 0, 0, 0, 0] deg\n\
               joints b = [9, 0, 0, 0, 0, 0] deg\n\
               joints above_a = [0, 9, 0, 0, 0, 0] deg\n\
               sequence main { move to a move to above_a move to b }"
    $($more)*
    }};
}

pub(super) use errors;
