//! Links of a run that was recorded over the project's own card: replayed in the card's arithmetic, word
//! for word, without a tolerance.

mod command;
mod controller;

use fixed_kin::format::{Duty, Format, Speed};
use fixed_kin::kinematics::TWIST;
use fixed_kin::recording::RecordedWords;
use runs::Run;
use runs::robot::Robot;

use crate::exact::ExactLink;

pub(crate) use command::command;
pub(crate) use controller::controller;

/// What `robot.toml` calls the card's arithmetic.
const NAME: &str = "fixed-kin";
/// How far a logged number may lie beside a word, in LSB: decimals of the log, and no more.
const BESIDE: f64 = 0.2;

/// Whether a link can be compared word for word.
pub(crate) enum Compared {
    /// The words were compared; what came of it.
    Link(Box<ExactLink>),
    /// It is to be replayed in floating point; because of what, if that is news.
    InFloatingPoint(Option<String>),
    /// It cannot be replayed at all, and why.
    Impossible(String),
}

impl Compared {
    /// What becomes of the link: the words where no more than this share differs, else what a law in floating point
    /// finds, if it finds anything. Says why where the words were not compared.
    pub(crate) fn or_law(
        self,
        wrong_share: f64,
        remarks: &mut Vec<String>,
        law: impl FnOnce() -> Option<ExactLink>,
    ) -> Option<ExactLink> {
        match self {
            // To the last bit, but for a few words: no law of another kind.
            Self::Link(words) if words.wrong_share <= wrong_share => Some(*words),
            Self::Link(words) => law().filter(|link| link.finding.is_some()).or(Some(*words)),
            Self::InFloatingPoint(why) => {
                remarks.extend(why);
                law()
            }
            Self::Impossible(why) => {
                remarks.push(why);
                None
            }
        }
    }
}

/// The card's words and how the numbers of a log are made of them.
struct Card {
    words: RecordedWords,
    /// Speed words per rad/s at the wheel.
    per_rad_s: f64,
    /// Control period, s.
    tick_s: f64,
}

/// A number of a log that is no word, and where it stands.
struct NoWord {
    signal: String,
    t: f64,
    value: f64,
}

impl NoWord {
    fn remark(&self, link: &str) -> String {
        let Self { signal, t, value } = self;
        format!(
            "{link}: {signal} = {value} at {t} s is no word of the card's registers (was the log rounded?); replayed in floating point."
        )
    }
}

impl Card {
    /// The card of a robot that ran on one.
    fn of(robot: &Robot) -> Result<Self, Option<String>> {
        match robot.pi.arithmetic.as_deref() {
            None => return Err(None),
            Some(NAME) => {}
            Some(other) => {
                return Err(Some(format!(
                    "pi.arithmetic = \"{other}\" is not known here; the speed loops are replayed in floating point."
                )));
            }
        }
        let word = |name: &str| robot.pi.registers.iter().find(|(n, _)| n == name).map(|(_, word)| *word);
        let words = RecordedWords::find(word).map_err(|e| {
            format!("pi.registers: {e}; the speed loops are replayed in floating point. Use the robot.toml of the recording.")
        })?;
        let clock_hz = robot.control_rate_hz * f64::from(words.tick_period);
        let per_rad_s = fixed_kin::format::speed_words(robot.counts_per_wheel_rad(), clock_hz);
        Ok(Self { words, per_rad_s, tick_s: robot.tick_s() })
    }

    /// The word of a logged speed (rad/s); nothing where there is no sample.
    fn speed(
        &self,
        run: &Run,
        column: &str,
        columns: &[Vec<f64>],
        wheel: usize,
        row: usize,
    ) -> Result<Option<Speed>, NoWord> {
        let word = word_of(columns[wheel][row], self.per_rad_s, run, row, || format!("{column}_{}", wheel + 1))?;
        Ok(word.map(Speed::from_bits))
    }

    /// Ticks of the card from the row before to this one; 0 for the first row.
    fn since(&self, run: &Run, row: usize) -> u64 {
        let Some(before) = row.checked_sub(1) else { return 0 };
        ((run.t[row] - run.t[before]) / self.tick_s).round().max(1.0) as u64
    }
}

/// The word of a logged duty.
fn duty(run: &Run, wheel: usize, row: usize) -> Result<Option<Duty>, NoWord> {
    let word = word_of(run.duty[wheel][row], 1.0 / Format::DUTY.lsb(), run, row, || format!("duty_{}", wheel + 1))?;
    Ok(word.map(Duty::from_bits))
}

/// The words of a logged body velocity.
fn twist(
    run: &Run,
    command: &[Vec<f64>; TWIST],
    exponents: &[i32; TWIST],
    row: usize,
) -> Result<Option<[i32; TWIST]>, NoWord> {
    const NAMES: [&str; TWIST] = ["cmd_vx", "cmd_vy", "cmd_w"];
    let mut words = [0; TWIST];
    for (k, word) in words.iter_mut().enumerate() {
        let scale = f64::from(exponents[k]).exp2();
        let Some(found) = word_of(command[k][row], scale, run, row, || NAMES[k].to_owned())? else { return Ok(None) };
        *word = found;
    }
    Ok(Some(words))
}

fn word_of(value: f64, scale: f64, run: &Run, row: usize, signal: impl Fn() -> String) -> Result<Option<i32>, NoWord> {
    let scaled = value * scale;
    if scaled.is_nan() {
        return Ok(None);
    }
    let word = scaled.round();
    let limit = f64::from(fixed_kin::word::WORD_MAX) + 1.0;
    if (scaled - word).abs() < BESIDE && word.abs() <= limit {
        Ok(Some(word as i32))
    } else {
        Err(NoWord { signal: signal(), t: run.t[row], value })
    }
}

/// A word that differs from what the card computes.
struct Wrong {
    run: String,
    t: f64,
    logged: i32,
    computed: i32,
}

/// Words of one signal that were compared.
#[derive(Default)]
struct Signal {
    compared: usize,
    /// Words that differ; the first ones in full.
    different: usize,
    first: Vec<Wrong>,
    square: f64,
}

/// Words that are told one by one.
const TOLD: usize = 3;

impl Signal {
    fn same(&mut self) {
        self.compared += 1;
    }

    fn wrong(&mut self, run: &Run, row: usize, logged: i32, computed: i32) {
        self.compared += 1;
        self.different += 1;
        self.square += (f64::from(logged) - f64::from(computed)).powi(2);
        if self.first.len() < TOLD {
            self.first.push(Wrong { run: run.name.clone(), t: run.t[row], logged, computed });
        }
    }

    /// RMS of the words that differ, LSB.
    fn rms(&self) -> f64 {
        (self.square / self.different.max(1) as f64).sqrt()
    }

    /// Which words differ; nothing where none does.
    fn place(&self, name: &str) -> Option<String> {
        let told = self
            .first
            .iter()
            .map(|w| format!("{:.4} s in {} ({} logged, {} computed)", w.t, w.run, w.logged, w.computed));
        let told: Vec<String> = told.collect();
        let more = if self.different > TOLD { ", ..." } else { "" };
        let list = format!("{}{more}", told.join(", "));
        (self.different > 0).then(|| {
            format!(
                "{name}: {} of {} words differ from what the card computes: at {list}",
                self.different, self.compared
            )
        })
    }
}
