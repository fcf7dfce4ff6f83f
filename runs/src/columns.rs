//! The header of a log: which column is what.

/// What a column carries; wheels from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Column {
    Time,
    Command(usize),
    Reference(usize),
    Counts(usize),
    Duty(usize),
    Measured(usize),
    Supply,
    Camera(usize),
    Other,
}

const COMMAND: [&str; 3] = ["cmd_vx", "cmd_vy", "cmd_w"];
const CAMERA: [&str; 3] = ["cam_x", "cam_y", "cam_theta"];

impl Column {
    pub(super) fn from_name(name: &str) -> Self {
        let position = |names: [&str; 3]| names.iter().position(|n| *n == name);
        if let Some(i) = position(COMMAND) {
            return Self::Command(i);
        }
        if let Some(i) = position(CAMERA) {
            return Self::Camera(i);
        }
        match name {
            "t" => return Self::Time,
            "supply_v" => return Self::Supply,
            _ => {}
        }
        for (prefix, column) in [
            ("ref_", Self::Reference as fn(usize) -> Self),
            ("enc_", Self::Counts),
            ("duty_", Self::Duty),
            ("meas_", Self::Measured),
        ] {
            if let Some(wheel) = name.strip_prefix(prefix).and_then(wheel_index) {
                return column(wheel);
            }
        }
        Self::Other
    }

    /// The name in the header; [`Column::Other`] has none of its own.
    pub(super) fn name(self) -> String {
        match self {
            Self::Time => "t".to_owned(),
            Self::Command(i) => COMMAND[i].to_owned(),
            Self::Reference(i) => format!("ref_{}", i + 1),
            Self::Counts(i) => format!("enc_{}", i + 1),
            Self::Duty(i) => format!("duty_{}", i + 1),
            Self::Measured(i) => format!("meas_{}", i + 1),
            Self::Supply => "supply_v".to_owned(),
            Self::Camera(i) => CAMERA[i].to_owned(),
            Self::Other => String::new(),
        }
    }
}

/// `1` to `99` without leading zeros, from 0; a "wheel 0" or "wheel 1000000" is somebody else's column.
fn wheel_index(text: &str) -> Option<usize> {
    let canonical = !text.starts_with('0') && text.len() <= 2 && text.bytes().all(|b| b.is_ascii_digit());
    text.parse::<usize>().ok().filter(|_| canonical).map(|wheel| wheel - 1)
}

/// The first gap in a group of numbered columns: 0..n must all be there.
pub(super) fn missing_member(columns: &[Column], group: fn(usize) -> Column, at_least: usize) -> Option<Column> {
    let present: Vec<usize> = (0..100).filter(|i| columns.contains(&group(*i))).collect();
    let n = present.last()? + 1;
    (0..n.max(at_least)).find(|i| !present.contains(i)).map(group)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_columns_agree() {
        for name in ["t", "cmd_w", "ref_1", "enc_4", "duty_12", "meas_3", "supply_v", "cam_theta"] {
            assert_eq!(Column::from_name(name).name(), name);
        }
        for name in ["enc_0", "enc_01", "enc_", "enc_x", "enc_123", "duty", "T", "enc_+1"] {
            assert_eq!(Column::from_name(name), Column::Other, "{name}");
        }
    }

    #[test]
    fn gaps_in_a_group_are_found() {
        let columns = [Column::Counts(0), Column::Counts(2), Column::Camera(0)];
        assert_eq!(missing_member(&columns, Column::Counts, 0), Some(Column::Counts(1)));
        assert_eq!(missing_member(&columns, Column::Camera, 3), Some(Column::Camera(1)));
        assert_eq!(missing_member(&columns, Column::Duty, 0), None);
    }
}
