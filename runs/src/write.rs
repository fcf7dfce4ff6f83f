//! Writing a log.

use crate::error::InputError;
use crate::output::{Existing, write_with};
use std::io::{BufWriter, Write};
use std::path::Path;

use super::Run;
use super::columns::Column;

impl Run {
    /// Writes the run so that [`Run::read`] reads it back unchanged: as CSV, or as MCAP where the
    /// name ends in `.mcap`, which has no place for [`Run::other`]. A file that is there is replaced.
    ///
    /// # Errors
    /// [`InputError`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), InputError> {
        self.save(path, Existing::Replace)
    }

    /// The same, where a file that is there may have to stay.
    ///
    /// # Errors
    /// [`InputError`] if it has to, or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>, existing: Existing) -> Result<(), InputError> {
        let path = path.as_ref();
        write_with(path, existing, |file| {
            let mut file = BufWriter::new(file);
            if super::stream::is_mcap(path) {
                self.stream_to(&mut super::McapStream::new(&mut file, self.layout(), 0)?)?;
            } else {
                self.write_to(&mut file)?;
            }
            file.flush()
        })
    }

    /// Writes the run as CSV to anywhere.
    ///
    /// # Errors
    /// What the writer reports.
    pub fn write_to(&self, writer: impl Write) -> std::io::Result<()> {
        let mut csv = csv::Writer::from_writer(writer);
        let columns = self.layout().columns();
        let others = self.other.iter().map(|(name, _)| name.clone());
        csv.write_record(columns.iter().map(|c| c.name()).chain(others))?;
        let mut camera = self.camera.iter().peekable();
        let mut gaps: Vec<_> = self.count_gaps.iter().map(|g| g.iter().peekable()).collect();
        for tick in 0..self.len() {
            let pose = camera.next_if(|sample| sample.tick == tick).map(|s| [s.pose.x, s.pose.y, s.pose.theta]);
            for column in &columns {
                let number = match *column {
                    Column::Counts(wheel) => {
                        let gap = gaps.get_mut(wheel).and_then(|g| g.next_if(|t| **t == tick)).is_some();
                        let text = if gap { String::new() } else { self.counts[wheel][tick].to_string() };
                        csv.write_field(text)?;
                        continue;
                    }
                    Column::Camera(i) => pose.map_or(f64::NAN, |p| p[i]),
                    column => self.real(column).map_or(f64::NAN, |numbers| numbers[tick]),
                };
                csv.write_field(if number.is_nan() { String::new() } else { number.to_string() })?;
            }
            for (_, values) in &self.other {
                csv.write_field(&values[tick])?;
            }
            csv.write_record(None::<&[u8]>)?;
        }
        csv.flush()
    }
}
