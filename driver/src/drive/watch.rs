//! What must hold from tick to tick, whatever the controller wants.
//!
//! The gateware watches what it can see within a clock; here is what takes the robot's data or longer.

use super::Fault;
use crate::{Scale, Snapshot};
use fixed_kin::AXES;
use fixed_kin::registers::FAULT_COMMIT;
use runs::robot::Robot;
use std::time::Duration;

/// How much faster than without load a wheel may seem: pushed from outside, a supply above nominal.
const SPEED_MARGIN: f64 = 1.5;
/// Counts beside: edges that bounce around a tick.
const COUNT_MARGIN: f64 = 16.0;
/// Duty that counts as full drive.
const FULL_DUTY: f64 = 0.9;
/// Duty at which the motors overcome any friction and speed the robot up: 0.9 m/s² ...
const STILL_DUTY: f64 = 0.4;
/// ... so that no count for so long is a cut line or a blocked wheel, s.
const STILL_S: f64 = 0.25;
/// Counts that a single cut line still makes: it toggles by one.
const STILL_COUNTS: i64 = 2;
/// Full drive against the motion for so long is no braking, s: it would have brought the robot to rest.
const BACKWARDS_S: f64 = 0.3;
/// Share of the no-load speed below which a wheel counts as at rest.
const REST_SHARE: f64 = 0.02;
/// A speed this far from its set point, as a share of the no-load speed ...
const FOLLOW_SHARE: f64 = 0.1;
/// ... for so long does not follow, s; nor does one at full drive that is off by more than rest for ...
const FOLLOW_S: f64 = 0.5;
/// ... so long, s.
const SATURATED_S: f64 = 1.0;
/// Speeds that are believed, as a multiple of the no-load speed: a disturbed count is a large one for a tick.
const BELIEVED: f64 = 8.0;
/// Time over which clocks are compared, and the least ticks in it.
const CLOCK_WINDOW: Duration = Duration::from_millis(250);
const CLOCK_TICKS: u32 = 50;
/// A crystal is right to 1e-4; the rest is for the host's own delays.
const CLOCK_TOLERANCE: f64 = 0.05;
/// Wrong checksums in a row that are more than a disturbance.
const REFUSED: u32 = 10;

/// The supervisor of one drive.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    wheels: usize,
    tick_s: f64,
    counts_per_s: f64,
    no_load: f64,
    /// Since when each wheel has been in doubt, s; negative is not.
    still: [f64; AXES],
    still_at: [i64; AXES],
    backwards: [f64; AXES],
    lost: [f64; AXES],
    saturated: [f64; AXES],
    clock: Option<(Duration, u32)>,
    /// Time over which clocks are compared.
    clock_window: Duration,
    refused: u32,
}

impl Watch {
    pub(super) fn new(robot: &Robot, scale: &Scale) -> Self {
        let no_load = robot.no_load_wheel_speed(robot.supply_v);
        Self {
            wheels: scale.wheels(),
            tick_s: scale.tick_s(),
            counts_per_s: SPEED_MARGIN * no_load * robot.counts_per_wheel_rad(),
            no_load,
            still: [0.0; AXES],
            still_at: [0; AXES],
            backwards: [0.0; AXES],
            lost: [0.0; AXES],
            saturated: [0.0; AXES],
            clock: None,
            clock_window: CLOCK_WINDOW.max(Duration::from_secs_f64(f64::from(CLOCK_TICKS) * scale.tick_s())),
            refused: 0,
        }
    }

    /// The same with no doubts: after a rest.
    pub(super) fn anew(&self) -> Self {
        let doubtless = [0.0; AXES];
        Self {
            still: doubtless,
            backwards: doubtless,
            lost: doubtless,
            saturated: doubtless,
            clock: None,
            refused: 0,
            ..self.clone()
        }
    }

    /// Whether a snapshot can follow another, `ticks` later; if not, one of the two was misread.
    pub(super) fn plausible(&self, before: &Snapshot, now: &Snapshot, scale: &Scale, ticks: u32) -> Result<(), Fault> {
        let limit = self.counts_per_s * self.tick_s * f64::from(ticks) + COUNT_MARGIN;
        for wheel in 0..self.wheels {
            let counts = i64::from(now.counts[wheel].wrapping_sub(before.counts[wheel]));
            if counts.abs() as f64 > limit {
                return Err(Fault::CountJump { wheel: wheel + 1, counts, limit });
            }
            let believed = |speed: f64| speed.abs() <= BELIEVED * self.no_load;
            let what = match () {
                () if f64::from(now.duties[wheel]).abs() > 1.0 => "duty",
                () if !believed(scale.speed(now.speeds[wheel])) => "speed",
                () if !believed(scale.speed(now.references[wheel])) => "set point",
                () => continue,
            };
            return Err(Fault::Misread { wheel: wheel + 1, what });
        }
        Ok(())
    }

    /// Looks at a new tick. `total` are the cumulative counts, `host` the host's time at the snapshot.
    pub(super) fn look(
        &mut self,
        now: &Snapshot,
        total: &[i64; AXES],
        scale: &Scale,
        ticks: u32,
        host: Duration,
    ) -> Result<(), Fault> {
        self.clocks(now.sequence, host)?;
        let refused = FAULT_COMMIT.is_set(now.faults);
        self.refused = if refused { self.refused + 1 } else { 0 };
        if self.refused >= REFUSED {
            return Err(Fault::Refused { commits: self.refused });
        }
        let elapsed = self.tick_s * f64::from(ticks);
        for (wheel, &count) in total.iter().enumerate().take(self.wheels) {
            let duty = f64::from(now.duties[wheel]);
            let (speed, reference) = (scale.speed(now.speeds[wheel]), scale.speed(now.references[wheel]));
            let full = duty.abs() >= FULL_DUTY;
            let moved = (count - self.still_at[wheel]).abs() > STILL_COUNTS;
            let drives = duty.abs() >= STILL_DUTY;
            if !drives || moved {
                self.still_at[wheel] = count;
            }
            if lasts(&mut self.still[wheel], drives && !moved, elapsed, STILL_S) {
                return Err(Fault::StandsStill { wheel: wheel + 1 });
            }
            let against = full && speed * duty < 0.0 && speed.abs() > REST_SHARE * self.no_load;
            if lasts(&mut self.backwards[wheel], against, elapsed, BACKWARDS_S) {
                return Err(Fault::Backwards { wheel: wheel + 1 });
            }
            let off = (speed - reference).abs() / self.no_load;
            let lost = lasts(&mut self.lost[wheel], off > FOLLOW_SHARE, elapsed, FOLLOW_S);
            let weak = full && off > REST_SHARE;
            if lost | lasts(&mut self.saturated[wheel], weak, elapsed, SATURATED_S) {
                return Err(Fault::DoesNotFollow { wheel: wheel + 1, speed, reference });
            }
        }
        Ok(())
    }

    /// Card ticks against the host's clock.
    fn clocks(&mut self, sequence: u32, host: Duration) -> Result<(), Fault> {
        let (since, first) = *self.clock.get_or_insert((host, sequence));
        let (elapsed, ticks) = (host.saturating_sub(since), sequence.wrapping_sub(first));
        if elapsed < self.clock_window {
            return Ok(());
        }
        self.clock = Some((host, sequence));
        let ratio = f64::from(ticks) * self.tick_s / elapsed.as_secs_f64();
        if (ratio - 1.0).abs() > CLOCK_TOLERANCE { Err(Fault::Clock { ratio }) } else { Ok(()) }
    }
}

/// Whether a doubt has lasted for so long.
fn lasts(since: &mut f64, doubt: bool, elapsed: f64, limit: f64) -> bool {
    *since = if doubt { *since + elapsed } else { 0.0 };
    *since > limit
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed_kin::format::Duty;

    struct Bench {
        watch: Watch,
        scale: Scale,
        seen: Snapshot,
        total: [i64; AXES],
    }

    impl Bench {
        fn new() -> Self {
            let robot = Robot::racbot();
            let scale = Scale::new(&robot, 33_333_000.0).unwrap();
            Self { watch: Watch::new(&robot, &scale), scale, seen: Snapshot::default(), total: [0; AXES] }
        }

        /// Seconds until the watch cries, with so many counts a tick.
        fn cries(&mut self, counts: i64) -> Option<(f64, Fault)> {
            for tick in 0..2_000 {
                self.seen.sequence += 1;
                self.total[1] += counts;
                let host = Duration::from_secs_f64(f64::from(tick) * 1e-3);
                if let Err(fault) = self.watch.look(&self.seen, &self.total, &self.scale, 1, host) {
                    return Some((f64::from(tick) * 1e-3, fault));
                }
            }
            None
        }
    }

    #[test]
    fn doubts_become_faults_in_their_time_and_ordinary_driving_does_not() {
        let mut bench = Bench::new();
        assert!(bench.cries(30).is_none());
        bench.seen.duties[1] = Duty::ONE;
        assert!(bench.cries(1).is_none());
        let (after, fault) = bench.cries(0).unwrap();
        assert!((0.24..0.27).contains(&after), "{after}");
        assert!(matches!(fault, Fault::StandsStill { wheel: 2 }) && fault.to_string().contains("cut encoder line"));
        let mut bench = Bench::new();
        bench.seen.duties[1] = Duty::ONE;
        bench.seen.speeds[1] = bench.scale.speed_word(-100.0);
        bench.seen.references[1] = bench.scale.speed_word(-90.0);
        assert!(matches!(bench.cries(-100), Some((_, Fault::Backwards { wheel: 2 }))));
        let mut bench = Bench::new();
        bench.seen.references[1] = bench.scale.speed_word(200.0);
        let (after, fault) = bench.cries(3).unwrap();
        assert!((0.49..0.52).contains(&after) && matches!(fault, Fault::DoesNotFollow { wheel: 2, .. }), "{after}");
    }

    #[test]
    fn a_clock_that_changes_is_noticed_within_half_a_second() {
        for (rate, cries) in [(1.0, false), (1.02, false), (0.75, true), (1.25, true)] {
            let mut bench = Bench::new();
            let mut found = None;
            for tick in 0..500 {
                bench.seen.sequence = (f64::from(tick) * rate) as u32;
                let host = Duration::from_secs_f64(f64::from(tick) * 1e-3);
                found = found.or(bench.watch.look(&bench.seen, &[0; AXES], &bench.scale, 1, host).err());
            }
            assert_eq!(found.is_some(), cries, "{rate}");
            if let Some(Fault::Clock { ratio }) = found {
                assert!((ratio - rate).abs() < 0.01);
            }
        }
    }

    #[test]
    fn counts_that_no_motor_makes_are_not_believed() {
        let bench = Bench::new();
        let mut jumped = bench.seen;
        jumped.counts[2] = 1 << 12;
        assert!(matches!(
            bench.watch.plausible(&bench.seen, &jumped, &bench.scale, 1),
            Err(Fault::CountJump { wheel: 3, .. })
        ));
        jumped.counts[2] = 200;
        assert!(bench.watch.plausible(&bench.seen, &jumped, &bench.scale, 1).is_ok());
        assert!(
            bench
                .watch
                .plausible(
                    &Snapshot { counts: [i32::MAX; AXES], ..jumped },
                    &Snapshot { counts: [i32::MIN; AXES], ..jumped },
                    &bench.scale,
                    1
                )
                .is_ok(),
            "counters wrap"
        );
    }
}
