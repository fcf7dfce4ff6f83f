//! The whole way over the built-in card: load, drive, record, calibrate, find the gap, drive again.

use super::{Part, Picture, Report};
use crate::terminal::Failure;
use crate::terminal::progress::Progress;
use bitstream::device::Device;
use bitstream::report::Decoded;
use driver::drive::{Driven, Plan};
use driver::load::{Loaded, Options, load};
use driver::recording::{Recording, logged_robot};
use driver::{Board, PciCard, RegisterWindow};
use gap::Analysis;
use model::calibration::estimate_skew;
use model::camera::CameraModel;
use model::trajectory::{FIG_6, FIG_7_SKEW_DEG, SetPoint};
use plot::{Axis, Color, Figure, Panel, Series};
use runs::output::{Existing, write_whole};
use runs::robot::{Layout, Robot};
use runs::{DataSet, Layout as Columns, Run};
use serde_json::json;
use simulator::circuit::committed;
use simulator::virtual_card::{SharedCard, VirtualCard};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Seed of the camera's noise.
const SEED: u64 = 1;

/// Time for the robot to come to rest between two drives.
const REST: Duration = Duration::from_secs(30);

/// A loaded card with a robot whose skews nobody knows.
struct Bench {
    card: SharedCard,
    camera: CameraModel,
    loaded: Loaded,
}

impl Bench {
    fn new(actual: &Robot) -> Result<Self, Failure> {
        let mut card = SharedCard::new(VirtualCard::new(actual).map_err(Failure::data)?);
        let loaded = load(&mut card, &committed(), &Options::default(), |_| {}).map_err(Failure::data)?;
        Ok(Self { card, camera: CameraModel::of(actual), loaded })
    }

    /// Drives from where the robot stands and records; returns also the robot.toml for the recording.
    fn drive(
        &self,
        believed: &Robot,
        points: &[SetPoint],
        file: &Path,
        existing: Existing,
    ) -> Result<(Driven, Robot), Failure> {
        // Shorted motors brake slowly.
        self.card.clone().sleep(REST);
        let plan = Plan { start: self.card.pose(), ..Plan::new(believed, points) };
        let scale = plan.scale(self.loaded.clock_hz).map_err(Failure::data)?;
        let columns = Columns::of_robot(believed.wheel_count(), true);
        let mut recording = Recording::start(file, columns, existing).map_err(Failure::data)?;
        recording.wait_where_full();
        let board = Board::new(RegisterWindow::new(self.card.clone()));
        let mut camera = self.card.camera(self.camera, SEED);
        let (mut clock, never) = (self.card.clone(), AtomicBool::new(false));
        let driven = plan
            .drive(board, &mut clock, self.loaded.clock_hz, &mut camera, Some(&mut recording), &never)
            .map_err(Failure::data)?;
        recording.finish().map_err(Failure::data)?;
        Ok((driven, logged_robot(&plan.believed(), &scale, &plan.settings)))
    }
}

/// From wherever the robot stands, back and forth through the field.
fn others() -> [Vec<SetPoint>; 2] {
    let reversed = FIG_6.iter().rev().copied().collect();
    let turning = FIG_6.iter().map(|point| SetPoint { omega: -1.0, ..*point }).collect();
    [reversed, turning]
}

impl Report {
    /// Load, drive, record, calibrate, gap, drive again.
    pub(crate) fn board(&mut self, folder: &Path, existing: Existing) -> Result<(), Failure> {
        let progress = Progress::new("over the built-in card", 6);
        let believed = Robot::racbot();
        let skew_rad = FIG_7_SKEW_DEG.map(f64::to_radians);
        let actual = Robot { layout: Layout::Rac { body_radius_m: 0.085, skew_rad }, ..believed.clone() };
        let bench = Bench::new(&actual)?;
        let runs = folder.join("runs");
        std::fs::create_dir_all(&runs).map_err(|error| Failure::about(&runs, error))?;
        let file = |number: usize| runs.join(format!("run_{number:02}.csv"));
        let (first, logged) = bench.drive(&believed, &FIG_6, &file(1), existing)?;
        let mut seconds = first.t;
        write_whole(&runs.join("robot.toml"), logged.to_toml().as_bytes(), existing)?;
        for (number, points) in others().into_iter().enumerate() {
            progress.at(number as u64 + 1);
            seconds += bench.drive(&believed, &points, &file(number + 2), existing)?.0.t;
        }
        let set = DataSet::open(&runs)?;
        progress.at(3);
        let estimate = estimate_skew(&set.robot, &set.runs).map_err(Failure::data)?;
        progress.at(4);
        let analysis = gap::analyse(&set, &gap::Options::default()).map_err(Failure::data)?;
        analysis.save(folder.join("gap"), existing).map_err(Failure::data)?;
        progress.at(5);
        let again = Bench::new(&actual)?;
        let last = folder.join("again.csv");
        again.drive(&analysis.robot, &FIG_6, &last, existing)?;
        let again = Run::read(&last)?;
        let (before, after) = (farthest(&set.runs[0]), farthest(&again));

        let named: Vec<&str> = analysis.effects.iter().map(|effect| effect.name.as_str()).collect();
        let good = named == ["wheel-skew"] && after < 0.1 * before;
        let outcome = if named.is_empty() { "nothing named".to_owned() } else { format!("{} named", named.join(", ")) };
        let clock_mhz = bench.loaded.clock_hz / 1e6;
        let file = Decoded::new(Device::xc2s200(), &committed()).map_err(Failure::data)?.report;
        let share = |part: &str| {
            let used = file.used.iter().find(|(name, ..)| *name == part);
            used.map_or(0, |(_, used, of)| (100 * used + of / 2) / (*of).max(1))
        };
        let (slices, registers, memories) = (share("slices"), share("flip-flops"), share("block RAMs"));
        let details = vec![
            format!("bitstream  {} bytes, {} CRC words right", file.bytes, file.crc_checks),
            format!("           slices {slices} %, flip-flops {registers} %, RAM {memories} %"),
            format!("loaded, {clock_mhz:.4} MHz; 3 drives, {seconds:.1} s recorded"),
            format!("calibrate  skew {}", degrees(&estimate.skew_rad)),
            format!("gap        {outcome}"),
            format!("           skew {}", degrees(&parameters(&analysis))),
            format!("Fig. 6     {:.0} mm off, with that {:.0} mm", 1e3 * before, 1e3 * after),
        ];
        let figures = json!({
            "bitstream": {
                "bytes": file.bytes, "crc_checks": file.crc_checks, "slices_percent": slices,
                "flip_flops_percent": registers, "block_rams_percent": memories,
            },
            "clock_hz": bench.loaded.clock_hz, "recorded_s": seconds, "calibrated_skew_rad": estimate.skew_rad,
            "named": named, "named_skew_rad": parameters(&analysis), "off_m": before, "off_m_with_effect": after,
        });
        self.parts.push(Part { name: "over the card", details, good, outcome, figures });
        self.pictures.push(Picture {
            name: "card",
            caption: "Over the built-in card: Fig. 6 with skews that nobody knows, and again with the effect that gap \
                      named in robot.toml, whose skews went into the card's coefficients. As the camera saw it."
                .to_owned(),
            svg: picture(&set.runs[0], &again),
        });
        Ok(())
    }
}

/// How far from the set point that it missed most the camera saw the robot at its nearest, m.
fn farthest(run: &Run) -> f64 {
    let nearest = |point: &SetPoint| {
        let off = run.camera.iter().map(|sample| (sample.pose.x - point.x).hypot(sample.pose.y - point.y));
        off.fold(f64::INFINITY, f64::min)
    };
    FIG_6.iter().map(nearest).fold(0.0, f64::max)
}

fn parameters(analysis: &Analysis) -> Vec<f64> {
    analysis
        .effects
        .first()
        .map_or_else(Vec::new, |effect| effect.parameters.iter().map(|(_, value, _)| *value).collect())
}

fn degrees(angles: &[f64]) -> String {
    let texts: Vec<String> = angles.iter().map(|angle| format!("{:.2}", angle.to_degrees())).collect();
    format!("{} deg", texts.join(", "))
}

fn picture(before: &Run, after: &Run) -> String {
    let track = |run: &Run| run.camera.iter().map(|sample| [sample.pose.x, sample.pose.y]).collect();
    let panel = Panel::new(Axis::new("x", "m"), Axis::new("y", "m"))
        .equal_aspect()
        .with(Series::line("skews unknown", track(before)).color(Color::Red))
        .with(Series::line("with the effect that gap named", track(after)).color(Color::Green))
        .with(Series::crosses("set points", FIG_6.iter().map(|p| [p.x, p.y]).collect()).color(Color::Black));
    Figure::new("Fig. 6 over the built-in card").with(panel).to_svg()
}
