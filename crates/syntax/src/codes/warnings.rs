//! The rows of the warnings. It knows no table: it hands its rows on, behind what makes one.

/// Calls a macro with what it was given, and behind it the rows of the warnings.
macro_rules! warnings {
    ($rows:ident $table:ident) => { $rows! { $table
    // W00xx: names, conditions and ways that may not be meant.
    Unused "W0001" "something that is never used"
        why "It may have been forgotten, or what should use it is misspelt. A variable that is \
             only assigned is not used. A name that begins with `_` is never warned about, nor is \
             what an imported file declares, since it may serve other programs as well."
        wrong "sequence main { var count = 0 count += 1 }"
        right "sequence main { var count = 0 count += 1 if count > 0 { wait 1 s } }"
    Unreachable "W0002" "statements that are never reached"
        why "After `return`, `break` and a loop without a way out nothing in the same block is \
             run, nor after a `throw` whose error is not continued from: it stops the program, or \
             leads back to something that is done again. Such statements are left out of the \
             module."
        wrong "sequence main { return wait 1 s }"
        right "sequence main { wait 1 s return }"
    IntegerDivision "W0003" "a division of integers that loses its remainder"
        why "Integers are divided towards zero: 1 / 2 is 0. Write one of them as a real, 1.0 / 2, \
             for 0.5."
        wrong "var half = 1 / 2\n\
               sequence main { if half > 0 { wait 1 s } }"
        right "var half = 1.0 / 2\n\
               sequence main { if half > 0 { wait 1 s } }"
    SilentStop "W0004" "a move whose stop is a failure that nothing follows"
        why "A move has succeeded if it came all the way, so that one that a force stops has \
             failed. Without `on failure` the program goes on as if it had not. Where the contact \
             is what the move is for, say so by `succeeds if`, for example `succeeds if force > \
             5 N`; where it is not, say in `on failure` what follows."
        wrong "advanced move probe { distance 20 mm down in base stop if force > 5 N }\n\
               sequence main { advance probe }"
        right "error no_contact { }\n\
               advanced move probe {\n  distance 20 mm down in base\n  stop if force > 5 N\n  \
               succeeds if force > 5 N\n  on failure { throw no_contact }\n}\n\
               sequence main { advance probe }"
    EndlessRecursion "W0005" "a sequence that always calls itself"
        why "Each call waits for the one within, so that a sequence that calls itself on every way \
             through it never ends: the machine refuses the call that is too deep. To do something \
             again write a loop."
        wrong "sequence blink { toggle 0 wait 1 s call blink }\n\
               sequence main { call blink }"
        right "sequence blink { loop { toggle 0 wait 1 s } }\n\
               sequence main { call blink }"
    UselessAllow "W0010" "an `allow` that allows nothing"
        why "What was warned of has gone, or stands elsewhere: an `allow` holds for the statement \
             or declaration that follows it, and with `in file` for the file that it stands in."
        wrong "allow W0001 \"it is read by the operator\"\n\
               var count = 0\n\
               sequence main { count += 1 if count > 3 { wait 1 s } }"
        right "var count = 0\n\
               sequence main { count += 1 if count > 3 { wait 1 s } }"
    NeverReached "W0011" "something that only what is never run uses"
        why "A program begins with its main sequence; sequences, moves and I/O operations that no \
             way from there leads to are never run, though something names them. What an imported \
             file declares is not warned about: it may serve other programs as well."
        wrong "io blink { toggle 0 }\n\
               sequence _spare { io blink }\n\
               sequence main { wait 1 s }"
        right "io blink { toggle 0 }\n\
               sequence main { io blink wait 1 s }"
    ConstantCondition "W0012" "a condition that is always the same"
        why "The condition reads nothing that could change, so that one of the ways is never \
             taken: a variable may be meant, or a reading. A loop for ever is written `loop { .. \
             }`. A loop that counts up does nothing where its last value is below its first, nor \
             does one that counts down where it is above."
        wrong "sequence main { while 1 > 2 { wait 1 s } }"
        right "sequence main { while input 3 { wait 1 s } }"

    // W04xx: reversal.
    ReversalStopped "W0401" "a recovery that cannot go back as far as it says"
        why "An error that is recovered from by reversing is raised at a place from which \
             something stops going back before that: a barrier, or an end of a block that is \
             irreversible, here or in what was called on the way. The recovery goes back as far as \
             that and no further. `obverse reach` draws how far each line can go back. Raise the \
             error before what stops it, or go back less far."
        wrong "error jam { recover by reversing to start of sequence then return to action }\n\
               sequence glue { barrier \"the glue is on\" }\n\
               sequence main { call glue throw jam }"
        right "error jam { recover by reversing to start of sequence then return to action }\n\
               sequence glue { barrier \"the glue is on\" }\n\
               sequence work { wait 1 s throw jam }\n\
               sequence main { call glue call work }"
    CheckpointNotOnEveryWay "W0402" "a recovery to a checkpoint that is not on every way"
        why "An error that is recovered from by reversing to a checkpoint can be raised on a way \
             that does not pass that checkpoint: then there is nothing to go back to but the start \
             of the program. Put the checkpoint where all ways pass it."
        wrong "error jam { recover by reversing to checkpoint ready then return to action }\n\
               sequence main { if input 1 { checkpoint ready } throw jam }"
        right "error jam { recover by reversing to checkpoint ready then return to action }\n\
               sequence main { checkpoint ready if input 1 { wait 1 s } throw jam }"
    CheckpointOnNoWay "W0403" "a recovery to a checkpoint that is on no way"
        why "An error that is recovered from by reversing to a checkpoint is raised where no run \
             has passed that checkpoint: it comes later, or lies in a block that is passed over in \
             reverse. Put the checkpoint on the way to where the error is raised."
        wrong "error jam { recover by reversing to checkpoint ready then return to action }\n\
               sequence main { if input 1 { throw jam } checkpoint ready }"
        right "error jam { recover by reversing to checkpoint ready then return to action }\n\
               sequence main { checkpoint ready if input 1 { throw jam } }"

    FaultNeverMet "W0404" "a fault that nothing in the program can meet"
        why "An error names a fault that only motions meet, and the program moves nothing; or \
             there is nothing at all that could fail. The error is raised by nothing. Leave the \
             fault out; or what moves the arm is missing."
        wrong "error jammed { on collision }\n\
               sequence main { wait 1 s }"
        right "error stopped { on emergency stop }\n\
               sequence main { wait 1 s }"
    ThrownAgain "W0405" "a throw that is done again after its recovery"
        why "An error says `then return to action` after a sequence, and the action is a `throw` \
             by itself: done again it throws again, and the condition before it is not looked at, \
             until the program has tried often enough and stops. `requires` is an action that \
             looks again, and so is an action, a sequence or an advanced move that throws."
        wrong "error no_part { recover using feed then return to action }\n\
               sequence feed { set 1 high wait 1 s }\n\
               sequence main { wait 1 s if not input 2 { throw no_part } }"
        right "error no_part { recover using feed then return to action }\n\
               sequence feed { set 1 high wait 1 s }\n\
               sequence main { wait 1 s requires input 2 else throw no_part }"

    // W05xx: files.
    TwoNames "W0501" "two names for one output or input"
        why "An I/O map says what each line of the workcell is for. Two names for one line are \
             mostly a number that was copied and not changed: the program would set a lamp where \
             it means the gripper."
        wrong "output gripper = 0\n\
               output lamp = 0\n\
               sequence main { set gripper high set lamp high }"
        right "output gripper = 0\n\
               output lamp = 1\n\
               sequence main { set gripper high set lamp high }"

    // W06xx: forks.
    ReadsOtherBranch "W0601" "a branch of a fork that reads what another assigns"
        why "Which value it reads depends on whose turn it is when. That follows from what the \
             branches do and from how long it takes: a statement more in either of them, or a \
             longer wait, changes it. Read it after the fork, or have one branch do both."
        wrong "sequence main { var n = 0 fork { n = 1 } and { if n > 0 { wait 1 s } } }"
        right "sequence main { var n = 0 fork { n = 1 } and { wait 1 s } if n > 0 { wait 1 s } }"
    }};
}

pub(super) use warnings;
