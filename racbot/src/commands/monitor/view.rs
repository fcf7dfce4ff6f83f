//! The picture: at most 24 lines of 80 columns.

use driver::{Observation, Scale, fault_names};
use fixed_kin::registers as map;
use std::time::Duration;

/// Half of a duty's bar.
const HALF_BAR: usize = 10;

/// What does not change from picture to picture.
pub(super) struct View<'a> {
    pub(super) name: &'a str,
    pub(super) clock_hz: f64,
    pub(super) scale: &'a Scale,
}

impl View<'_> {
    pub(super) fn lines(&self, seen: &Observation, since: Duration, interactive: bool) -> Vec<String> {
        let status = seen.status;
        let quit = if interactive { "   q quits" } else { "" };
        let mut lines = vec![
            format!(
                "racbot monitor   {}   {:.4} MHz   {:.1} s{quit}",
                self.name,
                self.clock_hz / 1e6,
                since.as_secs_f64()
            ),
            String::new(),
        ];
        let mut state = vec![if status.armed { "ARMED" } else { "disarmed" }];
        state.extend(status.set_points_valid.then_some("set points valid"));
        state.extend(status.emergency_stop.then_some("EMERGENCY STOP"));
        state.extend(status.ball.then_some("ball"));
        lines.push(format!("state    {}", state.join(", ")));
        lines.push(format!("faults   {:#04x}: {}", seen.faults, fault_names(seen.faults)));
        lines.push(format!("first    {:#04x}: {}", seen.first_fault, fault_names(seen.first_fault)));
        lines.push(format!("commits  {} accepted, {} rejected", seen.commits[0], seen.commits[1]));
        lines.push(format!("kicker   {}", kicker(seen.kicker)));
        lines.push(String::new());
        lines.extend(self.wheels(seen));
        lines.push(String::new());
        lines.push(match seen.snapshot {
            Some(snapshot) => format!("tick     {}", snapshot.sequence),
            None => "tick     somebody drives: counts, speeds and duties are theirs to read".to_owned(),
        });
        // What is wider than a terminal is cut, not wrapped: a wrapped line would move all others.
        lines.into_iter().map(|line| line.chars().take(80).collect()).collect()
    }

    fn wheels(&self, seen: &Observation) -> Vec<String> {
        let mut lines = vec![format!(
            "{:<6}{:>12}{:>10}{:>10}{:>9}  {:^21}  {:<9}",
            "wheel", "counts", "rad/s", "wanted", "duty", "-1        0        +1", "A B I"
        )];
        for wheel in 0..self.scale.wheels() {
            let [a, b, index] = seen.lines[wheel].map(u8::from);
            let error = if seen.encoder_errors >> wheel & 1 == 1 { " ERROR" } else { "" };
            let pins = format!("{a} {b} {index}{error}");
            lines.push(match &seen.snapshot {
                Some(s) => {
                    let (speed, wanted) = (self.scale.speed(s.speeds[wheel]), self.scale.speed(s.references[wheel]));
                    let duty = f64::from(s.duties[wheel]);
                    format!(
                        "{:<6}{:>12}{speed:>10.2}{wanted:>10.2}{duty:>9.4}  {}  {pins}",
                        wheel + 1,
                        s.counts[wheel],
                        bar(duty)
                    )
                }
                None => {
                    let integral = seen.integrals[wheel];
                    format!(
                        "{:<6}{:>12}{:>10}{:>10}{integral:>9.4}  {}  {pins}",
                        wheel + 1,
                        "",
                        "",
                        "I:",
                        bar(integral)
                    )
                }
            });
        }
        lines
    }
}

/// A duty from −1 to 1 as a bar about its middle.
fn bar(duty: f64) -> String {
    let length = (duty.clamp(-1.0, 1.0) * HALF_BAR as f64).round() as i32;
    let cell = |position: i32| match position {
        0 => '|',
        p if p > 0 && p <= length || p < 0 && p >= length => '=',
        _ => '.',
    };
    (-(HALF_BAR as i32)..=HALF_BAR as i32).map(cell).collect()
}

fn kicker(status: u32) -> String {
    let state = match map::KICKER_STATE.of(status) {
        0 => "off",
        1 => "idle",
        2 => "fires soon",
        3 => "FIRES",
        4 => "commutation",
        _ => "locked out",
    };
    let flag = |field: &map::Field, text: &str| if field.of(status) == 1 { format!(", {text}") } else { String::new() };
    format!(
        "{state}{}{}{}",
        flag(&map::KICKER_READY, "ready"),
        flag(&map::KICKER_TIMED_OUT, "charging timed out"),
        flag(&map::KICKER_DROPPED, "a request was dropped")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use driver::{Snapshot, Status};
    use fixed_kin::AXES;
    use fixed_kin::format::Duty;
    use runs::robot::Robot;

    fn seen() -> Observation {
        Observation {
            status: Status { armed: true, set_points_valid: true, emergency_stop: true, ball: true },
            faults: 0x3F,
            first_fault: 0x3F,
            commits: [65_535, 65_535],
            time: 0,
            lines: [[true; 3]; AXES],
            encoder_errors: 0xF,
            set_points: [0; 4],
            integrals: [-1.0; AXES],
            kicker: 0x7F,
            snapshot: Some(Snapshot {
                counts: [i32::MIN; AXES],
                duties: [Duty::ONE, -Duty::ONE, Duty::ZERO, Duty::from_num(0.26)],
                ..Snapshot::default()
            }),
        }
    }

    #[test]
    fn the_picture_fits_a_terminal_whatever_is_in_it() {
        let scale = Scale::new(&Robot::racbot(), 33_333_333.0).unwrap();
        let view = View { name: "0000:00:05.0", clock_hz: 33_333_333.0, scale: &scale };
        for snapshot in [seen().snapshot, None] {
            let lines = view.lines(&Observation { snapshot, ..seen() }, Duration::from_secs(100_000), true);
            assert!(lines.len() <= 24);
            assert!(lines.iter().all(|line| line.chars().count() <= 80), "{lines:#?}");
        }
    }

    #[test]
    fn bars_show_sign_and_size() {
        assert_eq!(bar(0.0), "..........|..........");
        assert_eq!(bar(1.0), "..........|==========");
        assert_eq!(bar(-0.34), ".......===|..........");
        assert_eq!(bar(7.0).len(), 21);
    }
}
