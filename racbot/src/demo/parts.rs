//! What each part of the demo does.

use super::{Part, Picture, Report};
use crate::terminal::Failure;
use crate::terminal::progress::Progress;
use fixed_kin::speed::SpeedMode;
use hdl::design::{COMMITTED_VERILOG, NAME, content_hash, files};
use model::camera::CameraModel;
use model::trajectory::{FIG_7_SKEW_DEG, SetPoint};
use plot::Color;
use runs::Run;
use runs::error::InputError;
use runs::frames::Twist;
use runs::robot::{Layout, Robot};
use serde_json::json;
use simulator::closed_loop::picture::{Curve, speeds, trajectory};
use simulator::closed_loop::{Drive, Driven};
use simulator::cross_check::{CrossCheck, Trace, Traced, play};
use simulator::fpga::{BitTrue, QUIET_CLOCKS, RustHdl};
use simulator::replay::picture::duties;
use simulator::replay::{Part as RunPart, WheelAgreement, lsb, replay};
use std::panic::resume_unwind;
use std::path::Path;
use std::time::Instant;

/// A measured run and its robot, in the binary, so that the demo works anywhere.
const SHIPPED_RUN: &str = include_str!("../../../data/runs/wheel-skew/run_01.csv");
const SHIPPED_ROBOT: &str = include_str!("../../../data/runs/wheel-skew/robot.toml");

/// Control rate of the cross-check, Hz: short periods, so that many ticks fit into few clocks.
const CROSS_CHECK_RATE_HZ: f64 = 8_000.0;

/// How the robot moves as each drive of the cross-check begins, for the first set point: a bend, and backwards out of a turn.
const CROSS_CHECKED: [Twist; 2] = [Twist::new(0.6, 0.5, 0.5), Twist::new(-0.6, 0.3, -2.0)];

impl Report {
    /// Is `generated/` what the gateware emits today?
    pub(crate) fn check_generated(&mut self, folder: &Path) -> Result<(), Failure> {
        let progress = Progress::new("emitting Verilog", 1);
        let fresh = files().map_err(Failure::data)?;
        progress.at(1);
        let verilog = format!("{NAME}.v");
        let mut stale = Vec::new();
        let (place, count) = if folder.is_dir() {
            for file in &fresh {
                let path = folder.join(&file.name);
                let found = std::fs::read_to_string(&path).map_err(|error| InputError::io(&path, &error))?;
                if found != file.text {
                    stale.push(file.name.clone());
                }
            }
            (format!("{}/", folder.display()), fresh.len())
        } else {
            if fresh.iter().any(|file| file.name == verilog && file.text != COMMITTED_VERILOG) {
                stale.push(verilog);
            }
            ("the built-in Verilog".to_owned(), 1)
        };
        let good = stale.is_empty();
        let outcome = if good { "current".to_owned() } else { format!("{} stale", stale.join(", ")) };
        let plural = if count == 1 { "file" } else { "files" };
        let details =
            vec![format!("{place}: {count} {plural}, {outcome}"), format!("content hash {:#010x}", content_hash())];
        let figures = json!({ "files": count, "stale": stale, "content_hash": content_hash() });
        self.parts.push(Part { name: "gateware", details, good, outcome, figures });
        Ok(())
    }

    /// The paper's Fig. 6 and 7 over the bit-true FPGA.
    pub(crate) fn drive(&mut self) -> Result<(), Failure> {
        let fig_6 = Drive { camera: Some(CameraModel::of(&Robot::racbot())), ..Drive::fig_6() };
        let skew_rad = FIG_7_SKEW_DEG.map(f64::to_radians);
        let layout = Layout::Rac { body_radius_m: 0.085, skew_rad };
        let fig_7 = Drive { actual: Robot { layout, ..Robot::racbot() }, ..fig_6.clone() };
        let corrected = Drive { fused: true, ..fig_7.clone() };

        let begun = Instant::now();
        let mut simulated_s = 0.0;
        let mut drive = |drive: &Drive, what: &str| -> Result<Driven, Failure> {
            let progress = Progress::new(what, 20_000);
            let driven = drive.run(BitTrue::new(), |t| progress.at((t * 1e3) as u64)).map_err(Failure::data)?;
            simulated_s += driven.run.duration_s();
            Ok(driven)
        };
        let ideal = drive(&fig_6, "driving Fig. 6")?;
        let skewed = drive(&fig_7, "driving with unknown skew")?;
        let camera = drive(&corrected, "driving with the camera")?;
        let times_real_time = simulated_s / begun.elapsed().as_secs_f64();

        let reached = |driven: &Driven| driven.report.set_points.iter().filter(|p| p.why_not.is_none()).count();
        let points = fig_6.set_points.len();
        let error_mm = |driven: &Driven| 1e3 * driven.report.path_error_rms_m;
        let line = |what: &str, driven: &Driven| {
            format!("{what:<18}{} of {points} points, path {:6.1} mm RMS", reached(driven), error_mm(driven))
        };
        let time = ideal.report.time_s.unwrap_or(f64::NAN);
        let details = vec![
            line("as believed", &ideal),
            line("skew 4,-3,2°", &skewed),
            line("same with camera", &camera),
            format!("{time:.1} s for {:.1} m; {} times real time", ideal.report.path_m, ratio(times_real_time)),
        ];
        let good = reached(&ideal) == points && reached(&camera) == points;
        let outcome = format!("{} of {points} set points reached", reached(&ideal));
        let figures = json!({
            "set_points": points, "reached": reached(&ideal), "reached_with_skew": reached(&skewed),
            "reached_with_skew_and_camera": reached(&camera), "time_s": ideal.report.time_s,
            "path_error_rms_m": ideal.report.path_error_rms_m,
            "path_error_rms_m_with_skew": skewed.report.path_error_rms_m,
            "path_error_rms_m_with_skew_and_camera": camera.report.path_error_rms_m,
            "times_real_time": times_real_time,
        });
        self.parts.push(Part { name: "Fig. 6 and 7", details, good, outcome, figures });
        self.picture_drives(&fig_6.set_points, &ideal, &skewed, &camera);
        Ok(())
    }

    fn picture_drives(&mut self, set_points: &[SetPoint], ideal: &Driven, skewed: &Driven, camera: &Driven) {
        let curves = [
            Curve { label: "geometry as believed", driven: ideal, color: Color::Green, dashed: false },
            Curve { label: "skew 4°, −3°, 2°, unknown", driven: skewed, color: Color::Red, dashed: false },
            Curve { label: "the same, camera corrects", driven: camera, color: Color::Blue, dashed: true },
        ];
        self.pictures.push(Picture {
            name: "trajectory",
            caption: "The paper's four set points in closed loop: driver, registers, bit-true FPGA, motors, body, \
                      encoders. Arrows point along the robot's x axis, one every half second."
                .to_owned(),
            svg: trajectory("Trajectory over four set points", set_points, &curves),
        });
        self.pictures.push(Picture {
            name: "speeds",
            caption:
                "The green drive over time: wheel speeds with their set points, heading, duties (means of some ticks)."
                    .to_owned(),
            svg: speeds("Wheel speeds, heading and duties", ideal),
        });
    }

    /// Some ticks of two drives through the rust-hdl simulation, side by side, all of them compared.
    pub(crate) fn cross_check(&mut self, ticks: u32) -> Result<(), Failure> {
        let traces: Vec<Trace> = CROSS_CHECKED.iter().map(|&moving| traced(moving, ticks)).collect::<Result<_, _>>()?;
        let progress = Progress::new("rust-hdl, clock by clock", traces.iter().map(|t| t.periods.len() as u64).sum());
        let begun = Instant::now();
        let checks: Vec<CrossCheck> = std::thread::scope(|scope| {
            let progress = &progress;
            let threads: Vec<_> = traces
                .iter()
                .map(|trace| scope.spawn(move || play(trace, RustHdl::new(), |_| progress.step())))
                .collect();
            let ended = threads.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            ended.collect::<Result<_, _>>().map_err(Failure::data)
        })?;

        let sum = |of: fn(&CrossCheck) -> u64| checks.iter().map(of).sum::<u64>();
        let (ticks, clocks) = (sum(|check| check.ticks as u64), sum(|check| check.clocks));
        let (words, live_words) = (sum(|check| check.words as u64), sum(|check| check.live_words as u64));
        let clocks_per_s = clocks as f64 / begun.elapsed().as_secs_f64();
        let difference = checks.iter().find_map(|check| check.difference).map(|difference| difference.to_string());
        let good = difference.is_none();
        let outcome = difference.clone().unwrap_or_else(|| "0 words differ".to_owned());
        let details = vec![
            format!("{ticks} ticks, {clocks} clocks, {words} words: {outcome}"),
            format!("{live_words} words change from tick to tick"),
            format!("{} clocks/s simulated, two drives at once", ratio(clocks_per_s)),
        ];
        let figures = json!({
            "drives": checks.len(), "ticks": ticks, "clocks": clocks, "words": words, "live_words": live_words,
            "difference": difference, "clocks_per_s": clocks_per_s,
        });
        self.parts.push(Part { name: "against rust-hdl", details, good, outcome, figures });
        Ok(())
    }

    /// The shipped log through the bit-true FPGA.
    pub(crate) fn replay(&mut self) -> Result<(), Failure> {
        let robot = Robot::parse(SHIPPED_ROBOT, Path::new("wheel-skew/robot.toml"))?;
        let mut run = Run::from_reader(SHIPPED_RUN.as_bytes(), Path::new("wheel-skew/run_01.csv"))?;
        run.name = "wheel-skew/run_01".to_owned();
        let progress = Progress::new("replaying a measured log", run.len() as u64);
        let begun = Instant::now();
        let at = |done: usize| progress.at(done as u64);
        let replayed = replay(BitTrue::new(), &robot, &run, RunPart::default(), at).map_err(Failure::data)?;
        let times_real_time = run.duration_s() / begun.elapsed().as_secs_f64();

        let all = replayed.wheels.iter().fold(WheelAgreement::default(), |all, wheel| all.with(*wheel));
        // The arithmetic may tip what the log rounded near a tie, and no more than that.
        let good = all.fpga.ticks > 0 && all.fpga.max <= 0.5 * replayed.quantum + all.arithmetic.max + 1e-9;
        let outcome = format!("{:.6} at most from the log", all.fpga.max);
        let details = vec![
            format!("{} measured duties, rounded to {}", all.fpga.ticks, replayed.quantum),
            format!("FPGA - log at most {:.6}, RMS {:.6}", all.fpga.max, all.fpga.rms()),
            format!("f64 law - log at most {:.6}", all.law.max),
            format!("FPGA - f64 law at most {:.0} LSB of 2^-24", lsb(all.arithmetic.max)),
            format!("{} times real time", ratio(times_real_time)),
        ];
        let figures = json!({
            "duties": all.fpga.ticks, "quantum": replayed.quantum, "max": all.fpga.max, "rms": all.fpga.rms(),
            "beyond": all.fpga.beyond, "law_max": all.law.max, "arithmetic_max_lsb": lsb(all.arithmetic.max),
            "times_real_time": times_real_time,
        });
        self.parts.push(Part { name: "measured log", details, good, outcome, figures });
        self.pictures.push(Picture {
            name: "replay",
            caption:
                "A measured log through the bit-true FPGA: logged duties are rounded to 0.001, the FPGA's are not; \
                      the difference stays within the rounding."
                    .to_owned(),
            svg: duties(&run, &replayed, 0),
        });
        Ok(())
    }
}

/// A drive of so many ticks, and what the bit-true FPGA made of it.
fn traced(moving: Twist, ticks: u32) -> Result<Trace, Failure> {
    let mut drive = Drive {
        speed_mode: SpeedMode::CountAndTime,
        limit_s: f64::from(ticks) / CROSS_CHECK_RATE_HZ,
        moving,
        ..Drive::fig_6()
    };
    drive.believed.control_rate_hz = CROSS_CHECK_RATE_HZ;
    let mut fpga = Traced::new(BitTrue::new().with_quiet_clocks(QUIET_CLOCKS));
    drive.run(&mut fpga, |_| {}).map_err(Failure::data)?;
    Ok(fpga.into_trace())
}

/// Two significant figures, with thousands apart.
fn ratio(value: f64) -> String {
    let step = 10_f64.powf((value.max(1.0).log10().floor() - 1.0).max(0.0));
    let digits = format!("{:.0}", (value / step).round() * step);
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}
