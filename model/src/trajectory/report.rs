//! How well a trajectory was driven.

use super::{Arrival, SetPoint, length_of};
use runs::frames::Pose;

/// What became of one set point.
#[derive(Debug, Clone, PartialEq)]
pub struct SetPointReport {
    /// Time at which the controller took it as reached, s.
    pub reached_at: Option<f64>,
    /// Smallest distance of the robot to it, m.
    pub miss_m: f64,
    /// Why it counts as not reached; `None` if it was.
    pub why_not: Option<String>,
}

/// How well a trajectory was driven, by where the robot really was.
#[derive(Debug, Clone, PartialEq)]
pub struct TrajectoryReport {
    /// Time to reach the last set point, s; `None` if one was not reached.
    pub time_s: Option<f64>,
    /// Length of the path of straight lines, m.
    pub path_m: f64,
    /// Root mean square of the distance to that path, m.
    pub path_error_rms_m: f64,
    /// Largest distance to that path, m.
    pub path_error_max_m: f64,
    /// Furthest the robot went beyond a set point, along the leg that led there, m.
    pub overshoot_m: f64,
    /// One entry a set point.
    pub set_points: Vec<SetPointReport>,
}

impl TrajectoryReport {
    /// From where the robot was (time in s, pose), what the controller says of its set points, and
    /// the distance (m) within which a robot counts as having been there.
    pub fn new(
        start: Pose,
        set_points: &[SetPoint],
        arrivals: &[Arrival],
        track: &[(f64, Pose)],
        tolerance_m: f64,
    ) -> Self {
        let corners: Vec<[f64; 2]> =
            std::iter::once([start.x, start.y]).chain(set_points.iter().map(|p| [p.x, p.y])).collect();
        let legs = || corners.windows(2).map(|leg| (leg[0], leg[1]));
        let reports: Vec<SetPointReport> = set_points
            .iter()
            .enumerate()
            .map(|(i, p)| {
                let arrival = arrivals.get(i).copied().unwrap_or(Arrival::Pending);
                // On the way to it or just after; a path may pass the same place at other times, too.
                let from = i.checked_sub(1).and_then(|i| time_of(arrivals.get(i))).unwrap_or(0.0);
                let to = time_of(arrivals.get(i + 1)).unwrap_or(f64::INFINITY);
                let there = track.iter().filter(|(t, _)| *t >= from && *t <= to);
                let miss_m = there.map(|(_, at)| length_of([at.x - p.x, at.y - p.y])).fold(f64::INFINITY, f64::min);
                set_point_report(arrival, miss_m, tolerance_m, track)
            })
            .collect();
        let all_reached = reports.iter().all(|r| r.why_not.is_none());
        let end = reports.last().and_then(|r| r.reached_at);
        let until = end.unwrap_or(f64::INFINITY);
        let errors: Vec<f64> = track
            .iter()
            .filter(|(t, _)| *t <= until)
            .map(|(_, p)| legs().map(|(a, b)| off_segment(*p, a, b)).fold(f64::INFINITY, f64::min).sqrt())
            .collect();
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let mut overshoot_m = 0.0_f64;
        for (i, (a, b)) in legs().enumerate() {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let Some(from) = reports[i].reached_at.filter(|_| length > 0.0) else { continue };
            let to = reports.get(i + 1).and_then(|r| r.reached_at).unwrap_or(f64::INFINITY);
            // The next leg may lead on in the same direction; only what goes against it is too far.
            let onward = corners
                .get(i + 2)
                .map_or(0.0, |c| (((c[0] - b[0]) * (b[0] - a[0]) + (c[1] - b[1]) * (b[1] - a[1])) / length).max(0.0));
            for (_, p) in track.iter().filter(|(t, _)| *t >= from && *t < to) {
                let beyond = ((p.x - b[0]) * (b[0] - a[0]) + (p.y - b[1]) * (b[1] - a[1])) / length;
                overshoot_m = overshoot_m.max(beyond - onward);
            }
        }
        Self {
            time_s: end.filter(|_| all_reached),
            path_m: legs().map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).sum(),
            path_error_rms_m: (squares / errors.len().max(1) as f64).sqrt(),
            path_error_max_m: errors.iter().copied().fold(0.0, f64::max),
            overshoot_m,
            set_points: reports,
        }
    }
}

fn time_of(arrival: Option<&Arrival>) -> Option<f64> {
    match arrival {
        Some(Arrival::Reached { t, .. } | Arrival::Stuck { t, .. }) => Some(*t),
        Some(Arrival::Pending) | None => None,
    }
}

fn set_point_report(arrival: Arrival, miss_m: f64, tolerance_m: f64, track: &[(f64, Pose)]) -> SetPointReport {
    let (reached_at, why_not) = match arrival {
        Arrival::Reached { t, .. } if miss_m <= tolerance_m => (Some(t), None),
        Arrival::Reached { t, .. } => {
            let why = format!(
                "the controller believed to be there at {t:.2} s, but the robot never came nearer than {miss_m:.3} m"
            );
            (Some(t), Some(why))
        }
        Arrival::Stuck { t, distance_m } => {
            (None, Some(format!("the robot no longer came nearer; given up at {t:.2} s, {distance_m:.3} m away")))
        }
        Arrival::Pending => {
            let end = track.last().map_or(0.0, |(t, _)| *t);
            (None, Some(format!("the run ended at {end:.2} s before it")))
        }
    };
    SetPointReport { reached_at, miss_m, why_not }
}

/// Square of the distance of a position to a line segment, m².
fn off_segment(p: Pose, a: [f64; 2], b: [f64; 2]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let squared = d[0] * d[0] + d[1] * d[1];
    let along = if squared > 0.0 { ((p.x - a[0]) * d[0] + (p.y - a[1]) * d[1]) / squared } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    let off = [p.x - a[0] - along * d[0], p.y - a[1] - along * d[1]];
    off[0] * off[0] + off[1] * off[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_drive_drawn_by_hand() {
        let points = [SetPoint::pass(1.0, 0.0, 1.0, 0.0), SetPoint::stop(1.0, 1.0, 1.0, 0.0)];
        let at = |t: f64, x: f64, y: f64| (t, Pose::new(x, y, 0.0));
        let track = [at(0.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(1.1, 1.05, 0.02), at(2.0, 1.0, 1.0), at(2.1, 1.0, 1.03)];
        let reached = |t: f64| Arrival::Reached { t, miss_m: 0.0 };
        let report = TrajectoryReport::new(Pose::default(), &points, &[reached(1.0), reached(2.0)], &track, 0.01);
        assert_eq!(report.time_s, Some(2.0));
        assert!((report.path_m - 2.0).abs() < 1e-12 && (report.overshoot_m - 0.05).abs() < 1e-12);
        assert!((report.path_error_max_m - 0.05).abs() < 1e-12);
        assert!((report.path_error_rms_m - 0.025).abs() < 1e-12);
    }

    #[test]
    fn a_place_passed_earlier_does_not_count_for_a_later_set_point() {
        let points = [SetPoint::stop(1.0, 0.0, 1.0, 0.0), SetPoint::stop(0.0, 0.0, 1.0, 0.0)];
        let track = [(0.0, Pose::default()), (1.0, Pose::new(1.0, 0.0, 0.0)), (2.0, Pose::new(0.3, 0.0, 0.0))];
        let arrivals = [1.0, 2.0].map(|t| Arrival::Reached { t, miss_m: 0.0 });
        let report = TrajectoryReport::new(Pose::default(), &points, &arrivals, &track, 0.1);
        assert!(report.set_points[0].why_not.is_none());
        assert!((report.set_points[1].miss_m - 0.3).abs() < 1e-12 && report.time_s.is_none());
    }

    #[test]
    fn every_set_point_is_reached_or_the_report_says_why_not() {
        let points = [SetPoint::pass(1.0, 0.0, 1.0, 0.0); 4];
        let arrivals =
            [Arrival::Reached { t: 1.0, miss_m: 0.0 }, Arrival::Stuck { t: 2.0, distance_m: 0.7 }, Arrival::Pending];
        let track = [(0.0, Pose::default()), (1.5, Pose::new(0.5, 0.0, 0.0)), (3.0, Pose::default())];
        let report = TrajectoryReport::new(Pose::default(), &points, &arrivals, &track, 0.1);
        assert_eq!(report.time_s, None);
        let why: Vec<&str> = report.set_points.iter().map(|s| s.why_not.as_deref().unwrap()).collect();
        assert!(why[0].contains("never came nearer than 0.500 m"), "{why:?}");
        assert!(why[1].contains("given up at 2.00 s, 0.700 m away"));
        assert!(why[2].contains("ended at 3.00 s") && why[3].contains("ended at 3.00 s"));
    }
}
