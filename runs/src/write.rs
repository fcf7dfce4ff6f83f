//! Writing a log.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use super::columns::Column;
use super::{Run, RunError};

impl Run {
    /// Writes the run so that [`Run::read`] reads it back unchanged: as CSV, or as MCAP where the
    /// name ends in `.mcap`, which has no place for [`Run::other`].
    ///
    /// # Errors
    /// [`RunError`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), RunError> {
        let path = path.as_ref();
        if super::stream::is_mcap(path) {
            let mut stream = super::create(path, self.layout(), 0).map_err(|e| RunError::io(path, &e))?;
            return self.stream_to(&mut *stream).map_err(|e| RunError::io(path, &e));
        }
        let io = |e: std::io::Error| RunError::io(path, &e);
        let mut file = BufWriter::new(File::create(path).map_err(io)?);
        self.write_to(&mut file).and_then(|()| file.flush()).map_err(io)
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
                    Column::Time => self.t[tick],
                    Column::Command(i) => self.command.as_ref().map_or(f64::NAN, |c| c[i][tick]),
                    Column::Reference(wheel) => self.reference[wheel][tick],
                    Column::Counts(wheel) => {
                        let gap = gaps.get_mut(wheel).and_then(|g| g.next_if(|t| **t == tick)).is_some();
                        let text = if gap { String::new() } else { self.counts[wheel][tick].to_string() };
                        csv.write_field(text)?;
                        continue;
                    }
                    Column::Duty(wheel) => self.duty[wheel][tick],
                    Column::Measured(wheel) => self.measured[wheel][tick],
                    Column::Supply => self.supply_v.as_ref().map_or(f64::NAN, |s| s[tick]),
                    Column::Camera(i) => pose.map_or(f64::NAN, |p| p[i]),
                    Column::Other => continue,
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
