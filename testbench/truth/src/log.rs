//! A run's log and its CSV form.

use std::fmt::Write as _;

use crate::camera::Frame;

/// Which groups of columns a log has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// `cmd_vx, cmd_vy, cmd_w`.
    pub commands: bool,
    /// `duty_i`.
    pub duty: bool,
    /// `cam_x, cam_y, cam_theta`.
    pub camera: bool,
    /// `supply_v`.
    pub supply: bool,
    /// `gyro_z, acc_x, acc_y`.
    pub inertial: bool,
}

impl Columns {
    /// A log with nothing left out.
    pub const ALL: Self = Self { commands: true, duty: true, camera: true, supply: true, inertial: true };
}

/// One tick of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Body-frame command: m/s, m/s, rad/s.
    pub command: [f64; 3],
    /// Set points, rad/s at the wheel.
    pub refs: Vec<f64>,
    /// Cumulative counts at the motor shaft.
    pub counts: Vec<i64>,
    /// Duties applied from this tick to the next.
    pub duties: Vec<f64>,
    /// Supply at the moment of the row, V.
    pub supply_v: f64,
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// Ticks per second.
    pub rate_hz: f64,
    /// One row a tick, the first at time 0.
    pub rows: Vec<Row>,
    /// Camera samples in order of their rows.
    pub frames: Vec<Frame>,
    /// Rate of turn (rad/s) and specific force to the right and forward (m/s²) by the inertial sensor, one a row; empty off
    /// the floor.
    pub inertial: Vec<[f64; 3]>,
}

impl Log {
    /// The log as CSV with the given groups of columns.
    #[must_use]
    pub fn to_csv(&self, columns: Columns) -> String {
        let axes = self.rows.first().map_or(0, |row| row.refs.len());
        let mut out = String::with_capacity(self.rows.len() * 90);
        out.push('t');
        if columns.commands {
            out.push_str(",cmd_vx,cmd_vy,cmd_w");
        }
        let groups: &[&str] = if columns.duty { &["ref", "enc", "duty"] } else { &["ref", "enc"] };
        for group in groups {
            for axis in 1..=axes {
                let _ = write!(out, ",{group}_{axis}");
            }
        }
        if columns.supply {
            out.push_str(",supply_v");
        }
        let inertial = columns.inertial && !self.inertial.is_empty();
        if inertial {
            out.push_str(",gyro_z,acc_x,acc_y");
        }
        if columns.camera {
            out.push_str(",cam_x,cam_y,cam_theta");
        }
        out.push('\n');
        let mut frames = self.frames.iter().peekable();
        for (tick, row) in self.rows.iter().enumerate() {
            number(&mut out, tick as f64 / self.rate_hz, 6);
            let mut field = |value: f64, decimals: i32| {
                out.push(',');
                number(&mut out, value, decimals);
            };
            if columns.commands {
                row.command.iter().for_each(|&v| field(v, 3));
            }
            row.refs.iter().for_each(|&v| field(v, 3));
            row.counts.iter().for_each(|&v| field(v as f64, 0));
            if columns.duty {
                row.duties.iter().for_each(|&v| field(v, 5));
            }
            if columns.supply {
                field(row.supply_v, 2);
            }
            if inertial {
                self.inertial[tick].iter().for_each(|&v| field(v, 4));
            }
            if columns.camera {
                match frames.next_if(|frame| frame.tick == tick) {
                    Some(frame) => frame.pose.iter().for_each(|&v| field(v, 4)),
                    None => out.push_str(",,,"),
                }
            }
            out.push('\n');
        }
        out
    }
}

/// Writes a number with at most `decimals` decimals, no trailing zeros and no negative zero.
fn number(out: &mut String, value: f64, decimals: i32) {
    let scale = 10_f64.powi(decimals);
    let rounded = (value * scale).round() / scale;
    let _ = write!(out, "{}", if rounded == 0.0 { 0.0 } else { rounded });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_has_the_groups_asked_for_and_empty_fields_between_frames() {
        let row =
            Row { command: [0.1, -0.0, 0.0], refs: vec![1.25], counts: vec![-3], duties: vec![0.125], supply_v: 7.204 };
        let frames = vec![Frame { tick: 1, pose: [0.123_46, -1.0, 3.0] }];
        let inertial = vec![[0.5, -1.25, 0.0]; 2];
        let log = Log { rate_hz: 1000.0, rows: vec![row.clone(), row], frames, inertial };
        assert_eq!(
            log.to_csv(Columns::ALL),
            "t,cmd_vx,cmd_vy,cmd_w,ref_1,enc_1,duty_1,supply_v,gyro_z,acc_x,acc_y,cam_x,cam_y,cam_theta\n\
             0,0.1,0,0,1.25,-3,0.125,7.2,0.5,-1.25,0,,,\n\
             0.001,0.1,0,0,1.25,-3,0.125,7.2,0.5,-1.25,0,0.1235,-1,3\n"
        );
        let bare = Columns { commands: false, duty: false, camera: false, supply: false, inertial: false };
        assert_eq!(log.to_csv(bare), "t,ref_1,enc_1\n0,1.25,-3\n0.001,1.25,-3\n");
    }
}
