//! Probes for structure that no effect of the catalogue has. They compete with the effects, and
//! where one wins, the verdict says what it saw instead of the nearest name.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};
use crate::motion::MotionModel;

/// One kind of structure.
struct Probe {
    name: &'static str,
    link: Link,
    forms: fn(&Robot, &Sizes) -> Vec<Form>,
    motion: fn(&Values, &mut MotionModel),
    drive: fn(&Values, &mut DriveModel),
    describe: fn(&Values) -> String,
}

impl Effect for Probe {
    fn name(&self) -> &str {
        self.name
    }

    fn equation(&self) -> &str {
        "structure outside the catalogue"
    }

    fn link(&self) -> Link {
        self.link
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        (self.forms)(robot, sizes)
    }

    fn motion(&self, values: &Values, model: &mut MotionModel) {
        (self.motion)(values, model);
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        (self.drive)(values, model);
    }

    fn probe(&self) -> bool {
        true
    }

    fn is_load(&self) -> bool {
        self.link == Link::Drive
    }

    fn describe(&self, values: &Values) -> String {
        (self.describe)(values)
    }
}

/// The wheel a per-wheel parameter of this stem names, from 1, and its value.
fn wheel_of(values: &Values, stem: &str) -> (usize, f64) {
    let largest = values.0.iter().filter(|(n, _)| n.starts_with(stem)).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    largest.map_or((0, 0.0), |(n, v)| (n.split('_').nth(1).and_then(|d| d.parse().ok()).unwrap_or(0), *v))
}

/// All probes.
pub(super) fn all() -> Vec<Box<dyn Effect>> {
    vec![
        Box::new(Probe {
            name: "probe-camera-drift",
            link: Link::Motion,
            forms: |robot, sizes| {
                let v = sizes.speed * robot.wheel_radius_m;
                let p = |n: &str| Parameter::new(n, 0.005 * v, [-v, v], 0.005 * v);
                vec![Form::whole(vec![p("x_m_per_s"), p("y_m_per_s")])]
            },
            motion: |v, m| m.drift = [v.get("x_m_per_s"), v.get("y_m_per_s")],
            drive: |_, _| {},
            describe: |v| {
                format!(
                    "the camera pose drifts in the world by ({:+.1}, {:+.1}) mm/s, whatever the robot does",
                    1e3 * v.get("x_m_per_s"),
                    1e3 * v.get("y_m_per_s")
                )
            },
        }),
        Box::new(Probe {
            name: "probe-camera-speed-delay",
            link: Link::Motion,
            forms: |robot, sizes| {
                // Seconds at the speed that wheels roll at.
                let unit = 0.0025 / (sizes.speed * robot.wheel_radius_m);
                vec![Form::whole(vec![Parameter::new("delay_s2_per_m", unit, [-160.0 * unit, 160.0 * unit], unit)])]
            },
            motion: |v, m| m.speed_delay = v.get("delay_s2_per_m"),
            drive: |_, _| {},
            describe: |v| {
                format!(
                    "the camera pose is late in proportion to speed: {:.1} ms per m/s",
                    1e3 * v.get("delay_s2_per_m")
                )
            },
        }),
        Box::new(Probe {
            name: "probe-late-friction",
            link: Link::Drive,
            forms: |robot, sizes| {
                let drive = sizes.drive_nm;
                let mut forms = Vec::new();
                for share in [0.3, 0.5, 0.7] {
                    let p =
                        |i| Parameter::new(wheel_name("torque", i, "nm"), 0.01 * drive, [-drive, drive], 0.045 * drive);
                    forms.extend(Form::alone(robot, p).into_iter().map(|f| f.fixing("share", share)));
                }
                forms
            },
            motion: |_, _| {},
            drive: |v, m| {
                let torque: Vec<f64> = (0..m.wheels.len()).map(|i| v.wheel("torque", i, "nm")).collect();
                let share = v.get("share");
                m.loads.push(Box::new(move |now, loads| {
                    let [first, last] = now.segment.stretch;
                    if now.time_s > share * (last - first) {
                        for (i, x) in torque.iter().enumerate() {
                            loads.wheel[i] -= x * now.sign[i];
                        }
                    }
                }));
            },
            describe: |v| {
                let (wheel, t) = wheel_of(v, "torque");
                format!(
                    "wheel {wheel} has {:+.1} mNm of friction from about {:.0} % of each run on, none before",
                    1e3 * t,
                    100.0 * v.get("share")
                )
            },
        }),
        Box::new(Probe {
            name: "probe-heading-friction",
            link: Link::Drive,
            forms: |robot, sizes| {
                let drive = sizes.drive_nm;
                let mut forms = Vec::new();
                for n in [1.0, 2.0, 3.0, 4.0] {
                    for i in 0..robot.wheel_count() {
                        let p = |stem: &str, m: f64| {
                            Parameter::new(wheel_name(stem, i, "nm"), 0.01 * drive, [-drive, drive], m)
                        };
                        let free = vec![p("cos", 0.03 * drive), p("sin", 0.03 * drive), p("mean", f64::INFINITY)];
                        forms.push(Form { wheels: vec![i], free, fixed: vec![("harmonic".to_owned(), n)] });
                    }
                }
                forms
            },
            motion: |_, _| {},
            drive: |v, m| {
                let n = v.get("harmonic");
                let t: Vec<[f64; 3]> =
                    (0..m.wheels.len()).map(|i| ["cos", "sin", "mean"].map(|s| v.wheel(s, i, "nm"))).collect();
                m.loads.push(Box::new(move |now, loads| {
                    let [c, s] = now.facing_times(n);
                    for (i, [a, b, mean]) in t.iter().enumerate() {
                        loads.wheel[i] -= (a * c + b * s + mean) * now.sign[i];
                    }
                }));
            },
            describe: |v| {
                let (wheel, a) = wheel_of(v, "cos");
                let (_, b) = wheel_of(v, "sin");
                format!(
                    "friction of wheel {wheel} follows the heading in the world, harmonic {:.0}, amplitude {:.1} mNm",
                    v.get("harmonic"),
                    1e3 * a.hypot(b)
                )
            },
        }),
        Box::new(Probe {
            name: "probe-position-force",
            link: Link::Drive,
            forms: |_, sizes| {
                let w = sizes.weight_n;
                let p = |n: &str, m: f64| Parameter::new(n, 0.01 * w, [-10.0 * w, 10.0 * w], m);
                vec![Form::whole(vec![
                    p("stiffness_n_per_m", 0.02 * w),
                    p("x_n", f64::INFINITY),
                    p("y_n", f64::INFINITY),
                ])]
            },
            motion: |_, _| {},
            drive: |v, m| {
                let (k, x, y) = (v.get("stiffness_n_per_m"), v.get("x_n"), v.get("y_n"));
                m.loads.push(Box::new(move |now, loads| {
                    let [px, py] = now.position;
                    loads.push_world(now.facing, [x - k * px, y - k * py]);
                }));
            },
            describe: |v| {
                let k = v.get("stiffness_n_per_m");
                format!(
                    "a force pulls towards ({:.2}, {:.2}) m in the field, {k:.2} N/m, as a cable or a slope of the floor would",
                    v.get("x_n") / k,
                    v.get("y_n") / k
                )
            },
        }),
        Box::new(Probe {
            name: "probe-position-drag",
            link: Link::Drive,
            forms: |_, sizes| {
                let w = sizes.weight_n;
                [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]
                    .into_iter()
                    .map(|[x, y]| {
                        let p = Parameter::new("force_n", 0.01 * w, [-w, w], 0.025 * w);
                        Form::whole(vec![p]).fixing("x", x).fixing("y", y)
                    })
                    .collect()
            },
            motion: |_, _| {},
            drive: |v, m| {
                let (f, x, y) = (v.get("force_n"), v.get("x"), v.get("y"));
                m.loads.push(Box::new(move |now, loads| {
                    if now.position[0] * x + now.position[1] * y > 0.0 {
                        let [vx, vy] = now.world_velocity();
                        let speed = vx.hypot(vy).max(0.02);
                        loads.push_world(now.facing, [-f * vx / speed, -f * vy / speed]);
                    }
                }));
            },
            describe: |v| {
                let side = match (v.get("x") as i32, v.get("y") as i32) {
                    (1, _) => "x > 0",
                    (-1, _) => "x < 0",
                    (_, 1) => "y > 0",
                    _ => "y < 0",
                };
                format!("the floor drags by {:.2} N where {side} in the field and not elsewhere", v.get("force_n"))
            },
        }),
    ]
}
