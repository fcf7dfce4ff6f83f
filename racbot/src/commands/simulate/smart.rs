//! `racbot simulate --smart`: a robot fetches a ball with the overhead camera off.

use crate::terminal::progress::Progress;
use crate::terminal::{Answer, Failure, Table, Target, wrapped};
use clap::ValueEnum;
use serde_json::json;
use simulator::blackout::page::{html, picture_name, senses_name};
use simulator::blackout::{Blackout, Outcome, Senses, Story};
use simulator::eye::Fault;
use std::fmt::Write as _;
use std::path::Path;

/// Quality of the pictures' files, 1 to 100.
const QUALITY: u8 = 92;

/// What is wrong with the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum CameraFault {
    /// It sends its first frame for ever
    Frozen,
    /// Its lens is covered
    Black,
    /// Its exposure is far too long
    OverExposed,
    /// It sends another size than it was calibrated at
    Size,
    /// It was bent down after its calibration
    Calibration,
}

impl From<CameraFault> for Fault {
    fn from(fault: CameraFault) -> Self {
        match fault {
            CameraFault::Frozen => Self::Frozen,
            CameraFault::Black => Self::Black,
            CameraFault::OverExposed => Self::OverExposed,
            CameraFault::Size => Self::Size,
            CameraFault::Calibration => Self::Calibration,
        }
    }
}

/// One start, with all senses and with less.
pub(super) struct Smart<'a> {
    pub(super) seed: u64,
    pub(super) fault: Option<CameraFault>,
    pub(super) out: &'a Path,
    pub(super) target: Target,
}

impl Smart<'_> {
    pub(super) fn drive(&self) -> Result<Answer, Failure> {
        let page = self.out.join("report.html");
        self.target.check_free([&page])?;
        let start = Blackout::new(self.seed);
        let progress = Progress::new("driving without an overhead camera".to_owned(), 3);
        let others =
            [Senses::Wheels, Senses::Gyroscope].map(|senses| start.run(senses).map(|outcome| (senses, outcome)));
        let [wheels, gyroscope] = others;
        let others = [wheels.map_err(Failure::data)?, gyroscope.map_err(Failure::data)?];
        progress.at(2);
        let fault = self.fault.map(Fault::from);
        let story = start.story(Senses::Camera, fault, true).map_err(Failure::data)?;
        progress.at(3);
        self.save(&story)?;
        self.target.save(&page, &html(&start, &story, &others))?;
        Ok(self.answer(&story, &others))
    }

    fn save(&self, story: &Story) -> Result<(), Failure> {
        for (number, leg) in story.legs.iter().enumerate() {
            if number == 0 {
                self.target.save(&self.out.join("robot.toml"), &leg.robot.to_toml())?;
            }
            leg.run.save(self.out.join(format!("leg-{}.csv", number + 1)), self.target.existing())?;
        }
        for (number, shot) in story.shots.iter().enumerate() {
            self.target.save(&self.out.join(picture_name(number)), &shot.picture.to_jpeg(QUALITY, true))?;
        }
        Ok(())
    }

    fn answer(&self, story: &Story, others: &[(Senses, Outcome)]) -> Answer {
        let mut table = Table::new(1, &["on board", "front to the ball", "off the coordinates"]);
        let millimetres = |m: f64| if m.is_finite() { format!("{:.0} mm", 1e3 * m) } else { "-".to_owned() };
        let all = || others.iter().copied().chain([(Senses::Camera, story.outcome)]);
        for (senses, outcome) in all() {
            table.row([senses_name(senses).to_owned(), millimetres(outcome.ball_miss), millimetres(outcome.miss)]);
        }
        let mut text = format!("overhead camera off, start {}\n\n{}\n", self.seed, table.render());
        for (why, count) in &story.refused {
            text += &wrapped(&format!("{count} pictures without a pose: {why}"), 2);
        }
        let _ = writeln!(
            text,
            "written      {}: {} runs, {} pictures, report.html",
            self.out.display(),
            story.legs.len(),
            story.shots.len()
        );
        let finite = |m: f64| m.is_finite().then_some(m);
        let outcomes: Vec<_> = all()
            .map(|(senses, o)| json!({ "on_board": senses_name(senses), "ball_m": finite(o.ball_miss), "off_m": finite(o.miss) }))
            .collect();
        let json = json!({ "seed": self.seed, "outcomes": outcomes, "refused": story.refused, "runs": story.legs.len(),
            "pictures": story.shots.len(), "report": self.out.join("report.html").to_string_lossy() });
        Answer { text, json, wrong: None }
    }
}
