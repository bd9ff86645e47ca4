//! The codes of what is wrong with assembly text or a module: a row a code, with the page that
//! explains it.
//!
//! A code is stable: it is never given another meaning nor used again. `A01xx` is the text, `A02xx`
//! a rule of the verifier, `A03xx` the bytes of a module. Knows nothing of how any of it is found.

obverse_codes::table! {
    ModuleCode "A kind of mistake in assembly text or in a module."

    Header "A0101" "assembly text of another kind"
        why "Assembly text begins with the line `obvasm 1`, which says what it is and of which \
             version."
        wrong ".function \"main\" start\n    enter\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\n    halt"
    Form "A0102" "a line that is not written as it should be"
        why "A line has a directive, a label or an instruction with its operands, commas between \
             them, and nothing behind. `obverse explain` and the name of an instruction show what \
             it takes."
        wrong "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    \
               add.local.imm n 1\n    halt"
        right "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    \
               add.local.imm n, 1\n    halt"
    UnknownWord "A0103" "a name or word that nothing has"
        why "An instruction, a directive, or one of a few words is not there, or a name is \
               declared \
             by no line of the text. A label is seen in its function alone."
        wrong "obvasm 1\n.function \"main\" start\n    enter\n    checkpoint ready\n    halt"
        right "obvasm 1\n.checkpoint \"ready\"\n.function \"main\" start\n    enter\n    \
               checkpoint ready\n    halt"
    Number "A0104" "a number that is none, or does not fit"
        why "A number stands here, within the range of what it is for. An integer is a whole \
               number \
             of 64 bits; a real is decimal, or `0x` and the bits of one."
        wrong "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    \
               add.local.imm n, 9999999999\n    halt"
        right "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    \
               add.local.imm n, 9\n    halt"
    Ambiguous "A0105" "a name that is there twice"
        why "A label is in its function once, and a name that several entries of a table have is \
             not enough to tell them apart: `#` and the index is."
        wrong "obvasm 1\n.function \"main\" start\n    enter\na:\na:\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\na:\n    halt"
    Tables "A0201" "a table that breaks the first rule of modules"
        why "Every table fits the type of its indices, joint configurations and keyframes are \
             finite, keyframes name keyframes, errors name functions, and a variable whose type is \
             an index into a table has a table to index."
        wrong "obvasm 1\n.error \"jam\" recoverable\n    .recover using #3\n.function \"main\" \
               start\n    enter\n    halt"
        right "obvasm 1\n.error \"jam\" recoverable\n.function \"main\" start\n    enter\n    halt"
    Functions "A0202" "a function that is not whole"
        why "Functions cover the code without gaps, in order; the first is the start; each begins \
             with `enter` and ends with `return`, the start with `halt`, and has neither \
               elsewhere; \
             locals and three words a counter fit 256 slots."
        wrong "obvasm 1\n.function \"main\" start\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\n    halt"
    Operands "A0203" "an operand that is out of range"
        why "Every index is in the range of its table; a function that is called has the \
               parameters \
             that are passed, and is not the start."
        wrong "obvasm 1\n.function \"main\" start\n    enter\n    call #0\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\n    call #1\n    halt\n.function \
               \"rest\" sequence\n    enter\n    return"
    Statements "A0204" "a statement that does not come out even"
        why "Code is a row of statements: pure instructions that touch the operand stack alone, \
               and \
             one effect that takes what they leave and knows how many they are. Between statements \
             the stack is empty, and types fit."
        wrong "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    push.bool \
               true\n    store.local n\n    halt"
        right "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    push.int \
               1\n    store.local n\n    halt"
    Joins "A0205" "a jump and a join that do not name each other"
        why "The machine going backwards meets the join first, so that each jump names a join of \
             its function that names it, and each join a jump. `land` follows what never falls \
             through, and nothing else does."
        wrong "obvasm 1\n.checkpoint \"ready\"\n.function \"main\" start\n    enter\nfrom:\n    \
               jump there\n    checkpoint ready\nthere:\n    join from\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\nfrom:\n    jump there\nthere:\n    \
               land from\n    halt"
    Loops "A0206" "a counted loop that is not whole"
        why "`for.enter`, `for.top`, `for.next` and `for.exit` come in this order, the pairs side \
             by side; nothing jumps in from outside; loops that overlap have different counters."
        wrong "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    .counters 1\n    \
               enter\n    push.int 1\n    push.int 2\n    for.enter 0, d\nt:\n    for.top 0\n    \
               for.next 0, t\n    add.local.imm n, 1\nd:\n    for.exit 0\n    halt"
        right "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    .counters 1\n    \
               enter\n    push.int 1\n    push.int 2\n    for.enter 0, d\nt:\n    for.top 0\n    \
               add.local.imm n, 1\n    for.next 0, t\nd:\n    for.exit 0\n    halt"
    Updates "A0207" "an update that reads what it changes"
        why "An update such as `x += e` is undone by `x -= e`, which is its inverse only where `e` \
             does not read `x`."
        wrong "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    push.local \
               n\n    add.local n\n    halt"
        right "obvasm 1\n.function \"main\" start\n    .local \"n\" int\n    enter\n    push.int \
               1\n    add.local n\n    halt"
    Blocks "A0208" "a block with a reverse of its own that is not whole"
        why "`block.begin` and its end nest, and nothing jumps in or out; a function that takes a \
             block's place has for parameters the first locals of the function around the block."
        wrong "obvasm 1\n.function \"main\" start\n    enter\n    block.begin\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\na:\n    block.begin\n    block.skip \
               a\n    halt"
    SourceMap "A0209" "a source map that is out of order"
        why "The entries of a source map ascend, and lie within the source files that the module \
             carries, as do the places where it speaks of its workcell."
        wrong "obvasm 1\n.function \"main\" start\n    enter\n  @ 0 3 9\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\n    halt"
    Tasks "A0210" "a fork that is not whole"
        why "`fork`, `fork.next` and `fork.join` nest; a fork has at most 16 branches; nothing \
             jumps into or out of one; `fork.leave` names the join of the innermost fork that \
               holds \
             it; counted loops of different branches have different counters."
        wrong "obvasm 1\n.function \"main\" start\n    enter\n    fork.next\n    halt"
        right "obvasm 1\n.function \"main\" start\n    enter\nf:\n    fork j\n    fork.next\n\
               j:\n    fork.join f\n    halt"
    Bytes "A0301" "bytes that are no module"
        why "The file ends in `.obc`, or begins as a module does, and is none: it was cut off or \
             changed, or made by another version. Compile the program again."
        wrong "" right ""
}
