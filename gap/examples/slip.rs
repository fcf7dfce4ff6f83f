//! Scratch.
use gap::{effect::*, effects, motion::*, problem::*, segment, state::*};
use std::sync::Arc;
fn main() {
    let set = model::run::DataSet::open(std::env::args().nth(1).unwrap()).unwrap();
    let g = set.robot.geometry().unwrap();
    let segments = segment::segments(&set.robot, &g, &set.runs);
    let noise = model::fit::camera_noise(&set.runs);
    let ml = MotionLink::new(&segments, noise, 1.0);
    let p = Problem::Motion(&ml);
    let e: Arc<dyn Effect> = Arc::from(effects::find("wheel-slip").unwrap());
    let base = State { robot: set.robot.clone(), active: vec![] };
    println!("off {:.1} noise {noise:?}", p.loss(&base));
    for mu in [0.1, 0.15, 0.2, 0.23, 0.25, 0.3, 0.4, 0.6, 0.9] {
        let mut a = Active::new(e.clone(), e.forms(&set.robot)[0].clone());
        a.values.set("friction_coefficient", mu);
        let s = State { robot: set.robot.clone(), active: vec![a] };
        println!("mu {mu} {:.1}", p.loss(&s));
    }
    let r = ml.residuals(&base.motion(None));
    for w in &r {
        let q: f64 = w.residuals.iter().flatten().map(|x| x * x).sum::<f64>() / w.residuals.len() as f64;
        if q > 20.0 {
            println!(
                "run {} t {:.2} rr {:.1} first {:?} last {:?}",
                w.run,
                w.t[0],
                q,
                w.residuals[0],
                w.residuals.last().unwrap()
            );
        }
    }
}
