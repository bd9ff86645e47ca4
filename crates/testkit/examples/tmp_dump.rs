//! x
fn main() {
    let source = std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
    let c = obverse_compiler::compile("x", &source);
    for d in &c.diagnostics {
        eprintln!("{:?} {} {:?}", d.severity, d.message, d.primary);
    }
    let m = c.module.unwrap();
    for f in &m.functions {
        println!(
            "{} {}..{} {:?}",
            f.name,
            f.first,
            f.end,
            f.locals.iter().map(|l| &l.name).collect::<Vec<_>>()
        );
    }
    for (i, x) in m.code.iter().enumerate() {
        let e = m.source_map.iter().find(|e| e.first as usize == i);
        println!(
            "{i}: {x:?} {}",
            e.map_or(String::new(), |e| format!(
                "   <- {}..{} {:?}",
                e.start,
                e.end,
                &source[e.start as usize..e.end as usize]
            ))
        );
    }
}
