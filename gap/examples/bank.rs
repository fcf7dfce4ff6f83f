//! Scratch.
use gap::{drive::*, effect::*, effects, motion::*, options::*, problem::*, segment, select::*, state::*};
use std::sync::Arc;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&text).unwrap();
    let base = std::path::Path::new(&args[1]).parent().unwrap();
    let only = args.get(2);
    for entry in truth["sets"].as_array().unwrap() {
        let name = entry["set"].as_str().unwrap();
        let hidden: Vec<String> = entry["effects"]
            .as_array()
            .unwrap()
            .iter()
            .map(|e| format!("{}{}{}", e["name"].as_str().unwrap(), e["wheels"], e["parameters"]))
            .collect();
        let hidden = format!("{}{}", hidden.join(" + "), entry["outside"]);
        if only.is_some_and(|o| !name.contains(o.as_str()) && !hidden.contains(o.as_str())) {
            continue;
        }
        let set = model::run::DataSet::open(base.join(name)).unwrap();
        let g = set.robot.geometry().unwrap();
        let t = std::time::Instant::now();
        let segments = segment::segments(&set.robot, &g, &set.runs);
        let noise = set.robot.camera_noise.unwrap_or_else(|| model::fit::camera_noise(&set.runs));
        let mut state = State { robot: set.robot.clone(), active: vec![] };
        let catalogue: Vec<Arc<dyn Effect>> = effects::catalogue().into_iter().map(Arc::from).collect();
        let mut th = Thresholds::default();
        let mut line = String::new();
        let mut seen = 0;
        let mut report = |s: &Selection, seen: usize| {
            let mut out = String::new();
            for a in &s.state.active[seen..] {
                let mat = if a.immaterial || !is_material(a, &a.parameters()) { "~" } else { "" };
                let v: Vec<String> = a.values.0.iter().map(|(n, v)| format!("{n}={v:.4}")).collect();
                out += &format!(" {mat}{}({})", a.effect.name(), v.join(","));
            }
            let next = s.bench.trials(&Thresholds::default());
            let n = next
                .first()
                .map(|t| {
                    format!(
                        "{} {:.0}{}",
                        s.bench.candidates[t.candidate].effect.name(),
                        t.gain,
                        if t.material { "!" } else { "" }
                    )
                })
                .unwrap_or_default();
            format!("{out} [{:.2}/{:.2} c{:.0} next {n}]", s.loss / s.bench.linear.gram.n(), s.bench.variance, s.costs)
        };
        let ml = MotionLink::new(&segments, noise, 1.0);
        if !ml.is_empty() {
            let m = select(&Problem::Motion(&ml), &state, &catalogue, &th);
            line += "M:";
            line += &report(&m, 0);
            state = m.state;
            seen = state.active.len();
        }
        if let Some(mut dl) = DriveLink::new(&segments, &state.drive(None)) {
            let r = dl.residuals(&state.drive(None)).unwrap();
            let (f, corr) = floor(&dl, &r, Sizes::of(&set.robot).stall_nm);
            dl.noise = f;
            th.drive_correlation = corr;
            let d = select(&Problem::Drive(&dl), &state, &catalogue, &th);
            line += " D:";
            line += &report(&d, seen);
        }
        println!("{name} TRUE {hidden}\n      {line} {:.1}s", t.elapsed().as_secs_f64());
    }
}
