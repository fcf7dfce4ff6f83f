//! Writing a log.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use super::columns::Column;
use super::{Run, RunError};

impl Run {
    /// Writes the run as a CSV that [`Run::read`] reads back unchanged.
    ///
    /// # Errors
    /// [`RunError`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), RunError> {
        let path = path.as_ref();
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
        let columns = self.columns();
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

    fn columns(&self) -> Vec<Column> {
        let mut columns = vec![Column::Time];
        if self.command.is_some() {
            columns.extend((0..3).map(Column::Command));
        }
        columns.extend((0..self.reference.len()).map(Column::Reference));
        columns.extend((0..self.counts.len()).map(Column::Counts));
        columns.extend((0..self.duty.len()).map(Column::Duty));
        if self.supply_v.is_some() {
            columns.push(Column::Supply);
        }
        if self.has_camera {
            columns.extend((0..3).map(Column::Camera));
        }
        columns
    }
}
