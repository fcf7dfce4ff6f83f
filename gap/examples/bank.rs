//! Analyses every set a truth file lists and prints truth and result side by side: `bank TRUTH.json [FILTER]`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let truth: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&args[1])?)?;
    let base = std::path::Path::new(&args[1]).parent().ok_or("no folder")?;
    for entry in truth["sets"].as_array().ok_or("no sets")? {
        let name = entry["set"].as_str().unwrap_or_default();
        let list = |v: &serde_json::Value| -> Vec<String> {
            v.as_array()
                .into_iter()
                .flatten()
                .map(|e| format!("{}{}{}", e["name"].as_str().unwrap_or(""), e["wheels"], e["parameters"]))
                .collect()
        };
        let hidden = [list(&entry["effects"]), list(&entry["outside"])].concat().join(" + ");
        if args.get(2).is_some_and(|o| !name.contains(o.as_str()) && !hidden.contains(o.as_str())) {
            continue;
        }
        let set = runs::DataSet::open(base.join(name))?;
        let start = std::time::Instant::now();
        let a = match gap::analyse(&set, &gap::Options::default()) {
            Ok(a) => a,
            Err(e) => {
                println!("{name} TRUE {hidden}\n   ERROR {e}");
                continue;
            }
        };
        let named: Vec<String> = a
            .effects
            .iter()
            .map(|e| {
                let p: Vec<String> =
                    e.parameters.iter().map(|(n, v, known)| format!("{n}={v:.4}{:?}", known.ends())).collect();
                format!("{}{:?}({}) g{:.2} {}", e.name, e.wheels, p.join(","), e.gain, e.evidence.words())
            })
            .collect();
        let j = a.to_json();
        println!(
            "{name} TRUE {hidden}\n   {} {} | alt {:?} | left {:?} | gap {:.2}->{:.2} closed {} {:.1}s",
            a.verdict.name(),
            named.join("; "),
            a.alternatives,
            a.unexplained.iter().map(|u| u.structure.clone()).collect::<Vec<_>>(),
            j["gap"]["before"].as_f64().unwrap_or(0.0),
            j["gap"]["after"].as_f64().unwrap_or(0.0),
            j["gap"]["closed"],
            start.elapsed().as_secs_f64()
        );
    }
    Ok(())
}
