//! What a calibration leaves behind: robot.toml, words for the FPGA, a picture.

use crate::terminal::{Failure, save};
use driver::Scale;
use fixed_kin::registers::{CONFIGURATION, NOMINAL_CLOCK_HZ};
use model::robot::Robot;
use serde_json::{Value, json};
use std::path::Path;

/// A robot before and after.
pub(super) struct Calibrated<'a> {
    /// As its designers describe it.
    pub(super) nominal: &'a Robot,
    /// As it is, or as it is best known; for the picture.
    #[cfg_attr(not(feature = "simulation"), expect(dead_code))]
    pub(super) actual: &'a Robot,
    /// As it was found to be.
    pub(super) calibrated: &'a Robot,
}

impl Calibrated<'_> {
    /// The FPGA's configuration bank at the nominal clock: matrices with the skew, and gains.
    pub(super) fn words(&self) -> Result<Vec<Value>, Failure> {
        Ok(self.configuration()?.into_iter().map(|(offset, word)| json!({ "offset": offset, "word": word })).collect())
    }

    fn configuration(&self) -> Result<Vec<(u16, i32)>, Failure> {
        let scale = Scale::new(self.calibrated, f64::from(NOMINAL_CLOCK_HZ)).map_err(Failure::data)?;
        let words = scale.configuration().to_words().into_iter().enumerate();
        Ok(words.map(|(index, word)| (CONFIGURATION.at(index), word)).collect())
    }

    /// Writes the files; gives their names.
    pub(super) fn save(&self, folder: &Path) -> Result<Vec<String>, Failure> {
        let rows = self.configuration()?.into_iter().map(|(offset, word)| format!("{offset:#05x},{word}\n"));
        let words = format!("offset,word\n{}", rows.collect::<String>());
        let mut files = vec![("robot.toml", self.calibrated.to_toml()), ("configuration.csv", words)];
        #[cfg(feature = "simulation")]
        files.push(("trajectory.svg", self.picture()?));
        for (name, content) in &files {
            save(&folder.join(name), content)?;
        }
        Ok(files.iter().map(|(name, _)| (*name).to_owned()).collect())
    }

    /// Fig. 6 with ideal geometry, before and after.
    #[cfg(feature = "simulation")]
    fn picture(&self) -> Result<String, Failure> {
        use model::plot::Color;
        use model::trajectory::FIG_6;
        use testbench::closed_loop::Drive;
        use testbench::closed_loop::picture::{Curve, trajectory};
        use testbench::fpga::BitTrue;

        let drive = |believed: &Robot, actual: &Robot| {
            let drive = Drive { actual: actual.clone(), ..Drive::new(believed, &FIG_6) };
            drive.run(BitTrue::new(), |_| {}).map_err(Failure::data)
        };
        let (ideal, before, after) = (
            drive(self.nominal, self.nominal)?,
            drive(self.nominal, self.actual)?,
            drive(self.calibrated, self.actual)?,
        );
        let curves = [
            Curve { label: "before calibration", driven: &before, color: Color::Red, dashed: false },
            Curve { label: "after", driven: &after, color: Color::Green, dashed: false },
            Curve { label: "ideal geometry", driven: &ideal, color: Color::Grey, dashed: true },
        ];
        Ok(trajectory("Before and after calibration", &FIG_6, &curves))
    }
}
