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
    Speed(usize),
    Current(usize),
    Odometry(usize),
    Gyro(usize),
    Acceleration(usize),
    ImuTemperature,
    Other,
}

/// Most of a duty in a log: roundings of a logger may pass 1 by a digit, no more.
pub(super) const MOST_DUTY: f64 = 1.001;
/// What to do about more.
pub(super) const AS_SHARE: &str =
    "log the duty as a share of the supply: percent divided by 100, 0 to 255 by 255, volts by those of the supply";

const COMMAND: [&str; 3] = ["cmd_vx", "cmd_vy", "cmd_w"];
const CAMERA: [&str; 3] = ["cam_x", "cam_y", "cam_theta"];
const ODOMETRY: [&str; 3] = ["odom_x", "odom_y", "odom_theta"];
const GYRO: [&str; 3] = ["gyro_x", "gyro_y", "gyro_z"];
const ACCELERATION: [&str; 3] = ["acc_x", "acc_y", "acc_z"];

/// A column of a group, by its number from 0.
type Member = fn(usize) -> Column;

/// Groups of three columns.
const TRIPLES: [([&str; 3], Member); 5] = [
    (COMMAND, Column::Command),
    (CAMERA, Column::Camera),
    (ODOMETRY, Column::Odometry),
    (GYRO, Column::Gyro),
    (ACCELERATION, Column::Acceleration),
];
/// Groups of one column a wheel.
const BY_WHEEL: [(&str, Member); 6] = [
    ("ref_", Column::Reference),
    ("enc_", Column::Counts),
    ("duty_", Column::Duty),
    ("meas_", Column::Measured),
    ("speed_", Column::Speed),
    ("current_", Column::Current),
];
/// Columns that stand alone.
const SINGLE: [(&str, Column); 3] =
    [("t", Column::Time), ("supply_v", Column::Supply), ("imu_temp", Column::ImuTemperature)];

impl Column {
    pub(super) fn from_name(name: &str) -> Self {
        if let Some((_, column)) = SINGLE.iter().find(|(n, _)| *n == name) {
            return *column;
        }
        for (names, column) in TRIPLES {
            if let Some(i) = names.iter().position(|n| *n == name) {
                return column(i);
            }
        }
        for (prefix, column) in BY_WHEEL {
            if let Some(wheel) = name.strip_prefix(prefix).and_then(wheel_index) {
                return column(wheel);
            }
        }
        Self::Other
    }

    /// The column that a name means which is written another way: `Enc_1`, `enc 1`, `enc1`, `Cam-X`; not one that
    /// only resembles.
    pub(super) fn from_variant(name: &str) -> Option<Self> {
        let joined: String =
            name.trim().to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        let digits = joined.len() - joined.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let (stem, number) = joined.split_at(joined.len() - digits);
        let split = format!("{}_{number}", stem.trim_end_matches('_'));
        let found = |name: &str| Some(Self::from_name(name)).filter(|c| *c != Self::Other);
        // A capital T is somebody's temperature or torque.
        found(&joined).or_else(|| found(&split)).filter(|c| *c != Self::Time)
    }

    /// The name of ours that a stranger's column resembles, by one slip of the keyboard.
    pub(super) fn resembling(name: &str) -> Option<String> {
        let name = name.trim().to_lowercase();
        let wheels = (0..9).flat_map(|i| BY_WHEEL.iter().map(move |(_, column)| column(i)));
        let triples = (0..3).flat_map(|i| TRIPLES.iter().map(move |(_, column)| column(i)));
        let known: Vec<String> = wheels.chain(triples).chain([Self::Supply]).map(Self::name).collect();
        let near = |k: &&String| k.len() >= 5 && strsim::damerau_levenshtein(&name, k) == 1;
        // `enc_1` and `enc_2` differ by one key, too.
        let stem = |s: &str| s.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        known.iter().filter(near).find(|k| name[..stem(&name)] != k[..stem(k)]).cloned()
    }

    /// Every column of a robot with so many wheels, but those nobody knows.
    pub(super) fn all(wheels: usize) -> Vec<Self> {
        let by_wheel = BY_WHEEL.iter().flat_map(|(_, column)| (0..wheels).map(column));
        let triples = TRIPLES.iter().flat_map(|(_, column)| (0..3).map(column));
        SINGLE.iter().map(|(_, column)| *column).chain(by_wheel).chain(triples).collect()
    }

    /// Unit, as the book's table of columns has it; empty where there is none.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Command(0 | 1) => "m/s",
            Self::Command(_) | Self::Gyro(_) | Self::Reference(_) | Self::Measured(_) | Self::Speed(_) => "rad/s",
            Self::Counts(_) => "counts",
            Self::Duty(_) => "share of the supply, -1 to 1",
            Self::Supply => "V",
            Self::Camera(0 | 1) | Self::Odometry(0 | 1) => "m",
            Self::Camera(_) | Self::Odometry(_) => "rad",
            Self::Current(_) => "A",
            Self::Acceleration(_) => "m/s2",
            Self::ImuTemperature => "degC",
            Self::Other => "",
        }
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
            Self::Speed(i) => format!("speed_{}", i + 1),
            Self::Current(i) => format!("current_{}", i + 1),
            Self::Odometry(i) => ODOMETRY[i].to_owned(),
            Self::Gyro(i) => GYRO[i].to_owned(),
            Self::Acceleration(i) => ACCELERATION[i].to_owned(),
            Self::ImuTemperature => "imu_temp".to_owned(),
            Self::Other => String::new(),
        }
    }
}

/// Groups that are logged whole or not at all, with the fewest members they may have.
pub(super) const GROUPS: [(Member, usize); 9] = [
    (Column::Reference, 0),
    (Column::Counts, 0),
    (Column::Duty, 0),
    (Column::Measured, 0),
    (Column::Speed, 0),
    (Column::Current, 0),
    (Column::Command, 3),
    // GPS, ultra-wideband and single markers have no heading.
    (Column::Camera, 2),
    (Column::Odometry, 3),
];
/// How many of them, from the first, have a member a wheel.
pub(super) const WHEEL_GROUPS: usize = 6;

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
        for name in [
            "t",
            "cmd_w",
            "ref_1",
            "enc_4",
            "duty_12",
            "meas_3",
            "supply_v",
            "cam_theta",
            "speed_2",
            "current_1",
            "odom_y",
            "gyro_z",
            "acc_x",
            "imu_temp",
        ] {
            assert_eq!(Column::from_name(name).name(), name);
        }
        for name in ["enc_0", "enc_01", "enc_", "enc_x", "enc_123", "duty", "T", "enc_+1"] {
            assert_eq!(Column::from_name(name), Column::Other, "{name}");
        }
    }

    #[test]
    fn other_ways_to_write_a_name_are_recognised() {
        for name in ["Enc_1", "ENC_1", "enc1", "enc 1", "Enc-1"] {
            assert_eq!(Column::from_variant(name), Some(Column::Counts(0)), "{name}");
        }
        assert_eq!(Column::from_variant("Cam-Theta"), Some(Column::Camera(2)));
        for name in ["T", "encoder", "current", "speed", "enc_0"] {
            assert_eq!(Column::from_variant(name), None, "{name}");
        }
        assert_eq!(Column::resembling("ecn_1").as_deref(), Some("enc_1"));
        assert_eq!(Column::resembling("cam_teta").as_deref(), Some("cam_theta"));
        for name in ["enc_12", "note", "temp", "refs"] {
            assert_eq!(Column::resembling(name), None, "{name}");
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
