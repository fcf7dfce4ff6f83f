//! Scratch.
use gap::{drive::*, effect::*, effects, motion::*, options::*, problem::*, segment, select::*, state::*};
use std::sync::Arc;
fn main() {
    for folder in std::env::args().skip(1) {
        let set = model::run::DataSet::open(&folder).unwrap();
        let g = set.robot.geometry().unwrap();
        let t = std::time::Instant::now();
        let segments = segment::segments(&set.robot, &g, &set.runs);
        println!("=== {folder}");
        let noise = set.robot.camera_noise.unwrap_or_else(|| model::fit::camera_noise(&set.runs));
        let state = State { robot: set.robot.clone(), active: vec![] };
        let catalogue: Vec<Arc<dyn Effect>> = effects::catalogue().into_iter().map(Arc::from).collect();
        let mut th = Thresholds::default();
        let ml = MotionLink::new(&segments, noise, 1.0);
        let show = |s: &Selection| {
            for a in &s.state.active {
                println!(
                    "   ** {} {:?} {:?} immaterial {}",
                    a.effect.name(),
                    a.form.wheels,
                    a.values.0,
                    a.immaterial || !is_material(a, &a.parameters())
                );
            }
            println!(
                "   loss/n {:.3} costs {:.1} variance {:.3}",
                s.loss / s.bench.linear.gram.n(),
                s.costs,
                s.bench.variance
            );
            let b = s.bench.base();
            for (j, o) in s.bench.linear.owners.iter().enumerate() {
                if let Owner::Candidate(c, q) = o {
                    let c = &s.bench.candidates[*c];
                    let m = if c.switched() { 0.15 } else { 0.25 * c.form.free[*q].material };
                    if (b.step[j] / m).abs() > 1.0 {
                        print!(
                            "   [{} {} {:.5} = {:.1} sd]",
                            c.effect.name(),
                            c.form.free[*q].name,
                            b.step[j],
                            b.step[j] / m
                        );
                    }
                }
            }
            println!();
            for t in s.bench.trials(&Thresholds::default()).iter().take(5) {
                let c = &s.bench.candidates[t.candidate];
                println!(
                    "     next {:9.1} {} {:?} {:?} {:.5?} {}",
                    t.gain,
                    c.effect.name(),
                    c.form.wheels,
                    c.form.fixed,
                    t.values,
                    t.material
                );
            }
        };
        let m = select(&Problem::Motion(&ml), &state, &catalogue, &th);
        println!(" motion {:?}", t.elapsed());
        show(&m);
        let mut dl = DriveLink::new(&segments, &m.state.drive(None)).unwrap();
        let r = dl.residuals(&m.state.drive(None)).unwrap();
        let (f, corr) = floor(&dl, &r, Sizes::of(&set.robot).stall_nm);
        println!(" floor {f:.5?} correlation {corr:.2}");
        dl.noise = f;
        th.drive_correlation = corr;
        let d = select(&Problem::Drive(&dl), &m.state, &catalogue, &th);
        println!(" drive {:?}", t.elapsed());
        show(&d);
    }
}
