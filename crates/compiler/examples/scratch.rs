//! x
use obverse_syntax::source::LineIndex;
fn main() {
    let source = std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
    let t = std::time::Instant::now();
    let compiled = obverse_compiler::compile("x.obv", &source);
    let el = t.elapsed();
    let index = LineIndex::new(&source);
    let text =
        |s: obverse_syntax::span::Span| source.get(s.start as usize..s.end as usize).unwrap();
    for d in &compiled.diagnostics {
        let p = index.position(d.primary.span.start);
        println!(
            "{} {}:{} {:?}: {}\n    at {:?}",
            d.code,
            p.line,
            p.column,
            text(d.primary.span),
            d.message,
            d.primary.text
        );
        for l in &d.labels {
            println!("    label {:?} {}", text(l.span), l.text);
        }
        for n in &d.notes {
            println!("    note {n}");
        }
        if let Some(h) = &d.help {
            println!("    help {h}");
        }
    }
    println!(
        "{} diagnostics, {:?}, {el:?}",
        compiled.diagnostics.len(),
        compiled.module.as_ref().map(|m| m.code.len())
    );
    if let Some(m) = compiled.module {
        let t = std::time::Instant::now();
        if let Err(e) = obverse_bytecode::verify(m.clone()) {
            println!("{e:#?}");
        }
        println!("verify {:?}", t.elapsed());
        if std::env::var("DIS").is_ok() {
            println!("{}", obverse_bytecode::text::disassemble(&m));
        }
    }
}
