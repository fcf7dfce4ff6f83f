use gap::{drive::*, effect::*, effects, motion::*, problem::*, segment, state::*};
use std::sync::Arc;
fn main() {
    for folder in std::env::args().skip(1) {
        let t0 = std::time::Instant::now();
        let set = model::run::DataSet::open(&folder).unwrap();
        let g = set.robot.geometry().unwrap();
        let t1 = std::time::Instant::now();
        let segments = segment::segments(&set.robot, &g, &set.runs);
        println!("=== {folder}  read {:?} segments {:?}", t1 - t0, t1.elapsed());
        let noise = model::fit::camera_noise(&set.runs);
        let state = State { robot: set.robot.clone(), active: vec![] };
        let ml = MotionLink::new(&segments, noise, 1.0);
        let mut dl = DriveLink::new(&segments, &state.drive(None)).unwrap();
        let r = dl.residuals(&state.drive(None)).unwrap();
        dl.estimate_noise(&r);
        let n = dl.noise.len();
        for i in 0..n {
            let v: Vec<f64> = r.torque.iter().zip(&r.weights).filter(|(_, w)| w[i] > 0.0).map(|(t, _)| t[i]).collect();
            print!(
                " wheel {}: n {} rms {:.3} mNm noise {:.3} |",
                i + 1,
                v.len(),
                1e3 * gap::statistics::rms(v.iter().copied()),
                1e3 * dl.noise[i]
            );
        }
        println!("\n camera noise {noise:?} windows {} bumps {}", ml.len(), dl.len());
        for problem in [Problem::Motion(&ml), Problem::Drive(&dl)] {
            let t = std::time::Instant::now();
            let mut cands = vec![];
            for e in effects::catalogue() {
                if e.link() != problem.link() {
                    continue;
                }
                let e: Arc<dyn Effect> = Arc::from(e);
                for f in e.forms(&state.robot) {
                    cands.push(Active::new(e.clone(), f));
                }
            }
            let lin = problem.linearise(&state, &cands);
            let l0 = lin.gram.loss();
            println!(
                "-- {:?} loss/n {:.4} n {} ({} columns, {:?})",
                problem.link(),
                l0 / lin.gram.n(),
                lin.gram.n(),
                lin.owners.len(),
                t.elapsed()
            );
            let mut rows = vec![];
            for (c, cand) in cands.iter().enumerate() {
                let cols = lin.of_candidate(c);
                let sol = lin.gram.solve(&cols);
                let held: f64 = lin.gram.held_out(&cols).iter().sum();
                let cov = lin.gram.covariance(&sol);
                let text: Vec<String> = (0..cols.len())
                    .map(|j| format!("{}={:.5}±{:.5}", cand.form.free[j].name, sol.step[j], cov[(j, j)].sqrt()))
                    .collect();
                rows.push((
                    l0 - held,
                    format!(
                        "{:22} {:?} gain {:9.1} held {:9.1} ({:5.1}%)  {}",
                        cand.effect.name(),
                        cand.form.fixed,
                        l0 - sol.loss,
                        l0 - held,
                        100.0 * (l0 - held) / l0,
                        text.join(" ")
                    ),
                ));
            }
            rows.sort_by(|a, b| b.0.total_cmp(&a.0));
            for r in rows.iter().take(16) {
                println!("{}", r.1);
            }
        }
    }
}
