//! What a calibration leaves behind: robot.toml, words for the FPGA, pictures.

use crate::terminal::{Failure, Target};
use driver::Scale;
use fixed_kin::registers::{CONFIGURATION, NOMINAL_CLOCK_HZ};
use model::firmware::Firmware;
#[cfg(feature = "simulation")]
use plot::page::Page;
use runs::robot::Robot;
use serde_json::{Value, json};
use std::path::Path;

/// A robot after its calibration.
pub(super) struct Calibrated {
    robot: Robot,
    /// The FPGA's configuration bank, offsets and words.
    words: Vec<(u16, i32)>,
    /// Whether there is something to type into a firmware.
    found: bool,
    pictures: Vec<(&'static str, String)>,
    #[cfg(feature = "simulation")]
    path_errors_m: [f64; 3],
}

impl Calibrated {
    /// A robot that was believed to be `nominal`, is `actual`, and was found to be `calibrated`.
    pub(super) fn new(nominal: &Robot, actual: &Robot, calibrated: &Robot) -> Result<Self, Failure> {
        let scale = Scale::new(calibrated, f64::from(NOMINAL_CLOCK_HZ)).map_err(Failure::data)?;
        let words = scale.configuration().to_words().into_iter().enumerate();
        let words = words.map(|(index, word)| (CONFIGURATION.at(index), word)).collect();
        Self::drive(nominal, actual, calibrated, words)
    }

    /// A robot that no card of ours drives: its file alone.
    pub(super) fn without_card(calibrated: &Robot) -> Self {
        Self {
            robot: calibrated.clone(),
            words: Vec::new(),
            found: true,
            pictures: Vec::new(),
            #[cfg(feature = "simulation")]
            path_errors_m: [f64::NAN; 3],
        }
    }

    /// A robot of which nothing was found out: its file as it was.
    pub(super) fn not_at_all(nominal: &Robot) -> Self {
        Self { found: false, ..Self::without_card(nominal) }
    }

    /// Fig. 6 with ideal geometry, before and after, on odometry alone.
    #[cfg(feature = "simulation")]
    fn drive(nominal: &Robot, actual: &Robot, calibrated: &Robot, words: Vec<(u16, i32)>) -> Result<Self, Failure> {
        use model::trajectory::FIG_6;
        use plot::Color;
        use simulator::closed_loop::Drive;
        use simulator::closed_loop::picture::{Curve, trajectory};
        use simulator::fpga::BitTrue;

        let drive = |believed: &Robot, actual: &Robot| {
            let drive = Drive { actual: actual.clone(), ..Drive::new(believed, &FIG_6) };
            drive.run(BitTrue::new(), |_| {}).map_err(Failure::data)
        };
        let (ideal, before, after) = (drive(nominal, nominal)?, drive(nominal, actual)?, drive(calibrated, actual)?);
        let curves = [
            Curve { label: "before calibration", driven: &before, color: Color::Red, dashed: false },
            Curve { label: "after", driven: &after, color: Color::Green, dashed: false },
            Curve { label: "ideal geometry", driven: &ideal, color: Color::Grey, dashed: true },
        ];
        let pictures = vec![("trajectory.svg", trajectory("Before and after calibration", &FIG_6, &curves))];
        let path_errors_m = [&ideal, &before, &after].map(|driven| driven.report.path_error_rms_m);
        Ok(Self { robot: calibrated.clone(), words, found: true, pictures, path_errors_m })
    }

    /// Drives need the simulation.
    #[cfg(not(feature = "simulation"))]
    fn drive(_: &Robot, _: &Robot, calibrated: &Robot, words: Vec<(u16, i32)>) -> Result<Self, Failure> {
        Ok(Self { robot: calibrated.clone(), words, found: true, pictures: Vec::new() })
    }

    /// Path errors (RMS, m) of those drives.
    #[cfg(feature = "simulation")]
    pub(super) fn path_errors_m(&self) -> [f64; 3] {
        self.path_errors_m
    }

    /// One more picture, if there is one.
    #[cfg(feature = "simulation")]
    pub(super) fn with_picture(mut self, name: &'static str, svg: Option<String>) -> Self {
        self.pictures.extend(svg.map(|svg| (name, svg)));
        self
    }

    /// The FPGA's configuration bank at the nominal clock: matrices with the skew, and gains.
    pub(super) fn words(&self) -> Value {
        self.words.iter().map(|(offset, word)| json!({ "offset": offset, "word": word })).collect()
    }

    /// What its owner types into a program of his own.
    pub(super) fn firmware(&self) -> Option<Firmware> {
        self.found.then(|| Firmware::of(&self.robot).ok()).flatten()
    }

    /// What stands in `index.html`: the answer as the terminal shows it, what to type in, the pictures.
    #[cfg(feature = "simulation")]
    fn page(&self, text: &str) -> String {
        let mut page = Page::new("Calibration");
        let words = ("configuration.csv", "words for the FPGA: configuration.csv");
        let words = (!self.words.is_empty()).then_some(words);
        page.links(std::iter::once(("robot.toml", "the calibrated robot.toml")).chain(words));
        page.verbatim(text);
        if let Some(found) = self.firmware() {
            page.heading("Into your firmware");
            page.verbatim(&found.c_arrays());
        }
        for (_, svg) in &self.pictures {
            page.figure(svg, "");
        }
        page.note(
            "Next: `racbot gap DATASET` names what skews alone do not explain, such as the radius of a wheel. Your own logs: \
             `racbot convert --draft LOG map.toml`.",
        );
        page.finish()
    }

    #[cfg(not(feature = "simulation"))]
    fn page(&self, text: &str) -> String {
        text.to_owned()
    }

    /// Writes the files, and a page with the answer `text`; gives their names.
    pub(super) fn save(&self, folder: &Path, target: Target, text: &str) -> Result<Vec<&'static str>, Failure> {
        let rows = self.words.iter().map(|(offset, word)| format!("{offset:#05x},{word}\n"));
        let words = format!("offset,word\n{}", rows.collect::<String>());
        let mut files = vec![("robot.toml", self.robot.to_toml())];
        files.extend((!self.words.is_empty()).then_some(("configuration.csv", words)));
        files.extend(self.pictures.iter().cloned());
        let name = if cfg!(feature = "simulation") { "index.html" } else { "calibration.txt" };
        files.push((name, self.page(text)));
        target.check_free(files.iter().map(|(name, _)| folder.join(name)))?;
        for (name, content) in &files {
            target.save(&folder.join(name), content)?;
        }
        Ok(files.into_iter().map(|(name, _)| name).collect())
    }
}
