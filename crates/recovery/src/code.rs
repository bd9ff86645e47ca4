//! The codes of what is wrong with a memory: a row a code, with the page that explains it.
//!
//! A code is stable: it is never given another meaning nor used again. `M01xx` is the file. Knows
//! nothing of how any of it is found.

obverse_codes::table! {
    MemoryCode "A kind of mistake in a file of what was learned of recoveries."

    Malformed "M0101" "a memory that is torn, or no memory"
        why "A memory is a text in TOML with a version, the program and the workcell that it is \
             of, places, and `[end]` as its last line, without which it was cut off. What is left \
             of a torn one is not gone by; the file stays as it is. Move it away to begin anew, or \
             mend it: people may read and change it."
        wrong "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\n[[place]]\nerror = \"jam"
        right "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\n[[place]]\nerror = \"jam\"\n\
               at = \"main: advance insert\"\n\n[[place.incident]]\ndepths = [1]\nenough = \
               true\ntimes = 1\n\n[end]"
    Version "M0102" "a memory of another version"
        why "What a memory says is counted otherwise from one version to the next, and is not \
             guessed at. The file stays as it is; move it away to begin anew."
        wrong "version = 1"
        right "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\n[end]"
    Foreign "M0103" "a memory of another program or workcell"
        why "A memory goes by the names of errors and of places, and those of another program, or \
             of the same one in another workcell, say nothing of this one. Each has a file of its \
             own. Where a file was only given another name, the memory may be told so."
        wrong "version = 3\nprogram = \"another.obv\"\ncell = \"c.toml\"\n\n[end]"
        right "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\n[end]"
    Impossible "M0104" "a memory that says what no run can have come to"
        why "An attempt goes back by one action at least and sixteen at most, an incident has an \
             attempt, sixteen at most, and happened once at least; a place is there once, and has \
             an incident."
        wrong "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\n[[place]]\nerror = \"jam\"\n\
               at = \"main: advance insert\"\n\n[[place.incident]]\ndepths = [0]\nenough = \
               true\ntimes = 1\n\n[end]"
        right "version = 3\nprogram = \"p.obv\"\ncell = \"c.toml\"\n\n[[place]]\nerror = \"jam\"\n\
               at = \"main: advance insert\"\n\n[[place.incident]]\ndepths = [1]\nenough = \
               true\ntimes = 1\n\n[end]"
}
