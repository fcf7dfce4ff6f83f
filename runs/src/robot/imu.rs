//! `[imu]`: the inertial sensor of a robot, where it has one.

use std::fmt;

use super::fields::Range;
use super::section::Section;
use crate::error::InputError;

/// Longest name of a sensor's type.
const NAME_BYTES: usize = 24;

/// The inertial sensor and how it is mounted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuMount {
    /// Type, such as `icm-42688-p`.
    pub sensor: SensorName,
    /// The sensor's axes that point along the body's x (right), y (forward) and z (up).
    pub axes: [Axis; 3],
    /// Place of the chip in the body frame: right, forward, up, m.
    pub place_m: [f64; 3],
    /// Whether the heading is controlled and believed by the gyroscope; else it is only recorded.
    pub heading: bool,
}

/// Name of a type of sensor: short text without a heap, so that a mount is plain data.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct SensorName {
    bytes: [u8; NAME_BYTES],
    length: usize,
}

impl SensorName {
    /// A name; `None` where it is empty or longer than any.
    #[must_use]
    pub fn new(name: &str) -> Option<Self> {
        let mut bytes = [0; NAME_BYTES];
        bytes.get_mut(..name.len()).filter(|_| !name.is_empty())?.copy_from_slice(name.as_bytes());
        Some(Self { bytes, length: name.len() })
    }
}

impl std::ops::Deref for SensorName {
    type Target = str;

    fn deref(&self) -> &str {
        std::str::from_utf8(&self.bytes[..self.length]).unwrap_or("")
    }
}

impl fmt::Display for SensorName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self)
    }
}

impl fmt::Debug for SensorName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", &**self)
    }
}

/// An axis of the sensor or the way against it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axis {
    index: usize,
    against: bool,
}

impl Axis {
    /// The sensor's own x, y and z.
    pub const XYZ: [Self; 3] = [Self::along(0), Self::along(1), Self::along(2)];

    const fn along(index: usize) -> Self {
        Self { index, against: false }
    }

    /// The component along it of a vector in the sensor's axes.
    #[must_use]
    pub fn of(self, vector: [f64; 3]) -> f64 {
        if self.against { -vector[self.index] } else { vector[self.index] }
    }

    /// Gives a vector in the sensor's axes this component along it.
    pub fn put(self, component: f64, vector: &mut [f64; 3]) {
        vector[self.index] = if self.against { -component } else { component };
    }

    /// The way against it.
    #[must_use]
    pub fn opposite(self) -> Self {
        Self { against: !self.against, ..self }
    }

    fn parse(text: &str) -> Option<Self> {
        let (against, name) = match text.as_bytes() {
            [b'-', name] => (true, name),
            [b'+', name] | [name] => (false, name),
            _ => return None,
        };
        let index = b"xyz".iter().position(|axis| axis == name)?;
        Some(Self { index, against })
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["x", "y", "z", "-x", "-y", "-z"][self.index + if self.against { 3 } else { 0 }])
    }
}

/// Keys of the section.
pub(super) const KEYS: [&str; 4] = ["sensor", "axes", "place_m", "heading"];

impl ImuMount {
    /// A sensor whose axes are the body's, in its centre, that the heading follows.
    #[must_use]
    pub fn upright(sensor: SensorName) -> Self {
        Self { sensor, axes: Axis::XYZ, place_m: [0.0; 3], heading: true }
    }

    pub(super) fn read(section: &Section) -> Result<Self, InputError> {
        let Some(value) = section.table.get("sensor") else {
            return Err(section.missing("sensor", "the type, such as \"icm-42688-p\""));
        };
        let Some(sensor) = value.get_ref().as_str().and_then(SensorName::new) else {
            return Err(section.fault("sensor", value, "is no name of a sensor", "such as \"icm-42688-p\""));
        };
        let mut mount = Self::upright(sensor);
        if let Some(value) = section.table.get("axes") {
            let list = value
                .get_ref()
                .as_array()
                .map(|list| list.iter().map(|axis| axis.get_ref().as_str().and_then(Axis::parse)).collect::<Vec<_>>());
            let axes = match list.as_deref() {
                Some([Some(x), Some(y), Some(z)]) if right_handed([*x, *y, *z]) => [*x, *y, *z],
                _ => {
                    let hint = "name the sensor's axes along the body's x, y and z, right-handed, such as [\"y\", \"-x\", \"z\"]";
                    return Err(section.fault("axes", value, "is no turn of the sensor's axes", hint));
                }
            };
            mount.axes = axes;
        }
        if let Some(place) = section.numbers("place_m", Range::Within(10.0))? {
            mount.place_m = place;
        }
        if let Some(value) = section.table.get("heading") {
            mount.heading = match value.get_ref().as_str() {
                Some("gyro") => true,
                Some("wheels") => false,
                _ => return Err(section.fault("heading", value, "is neither", "write \"gyro\" or \"wheels\"")),
            };
        }
        Ok(mount)
    }

    /// Keys and values, as the file has them.
    pub(super) fn lines(&self) -> [(&'static str, String); 4] {
        let quoted = |text: &dyn fmt::Display| format!("\"{text}\"");
        let axes = self.axes.map(|axis| quoted(&axis)).join(", ");
        let place = self.place_m.map(|x| format!("{x:?}")).join(", ");
        let heading = if self.heading { "gyro" } else { "wheels" };
        [
            ("sensor", quoted(&self.sensor)),
            ("axes", format!("[{axes}]")),
            ("place_m", format!("[{place}]")),
            ("heading", quoted(&heading)),
        ]
    }
}

/// Whether three axes are a turn of x, y, z: no two alike, no mirror.
fn right_handed(axes: [Axis; 3]) -> bool {
    let rows = axes
        .map(|axis| [0, 1, 2].map(|i| f64::from(u8::from(i == axis.index)) * if axis.against { -1.0 } else { 1.0 }));
    let [a, b, c] = rows;
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    (0..3).map(|i| cross[i] * c[i]).sum::<f64>() > 0.5
}

#[cfg(test)]
mod tests {
    use super::super::Robot;
    use super::*;
    use std::path::Path;

    fn parsed(section: &str) -> Result<Robot, InputError> {
        let text = format!("{}\n[imu]\n{section}\n", Robot::racbot().to_toml());
        Robot::parse(&text, Path::new("robot.toml"))
    }

    #[test]
    fn a_section_is_read_and_written() {
        let robot =
            parsed("sensor = \"icm-42688-p\"\naxes = [\"y\", \"-x\", \"z\"]\nplace_m = [0.01, 0, 0.05]").unwrap();
        let mount = robot.imu.unwrap();
        assert_eq!(&*mount.sensor, "icm-42688-p");
        assert_eq!(mount.axes.map(|axis| axis.of([1.0, 2.0, 3.0])), [2.0, -1.0, 3.0]);
        assert_eq!(Robot::parse(&robot.to_toml(), Path::new("again")).unwrap(), robot);
        assert!(mount.heading && Robot::racbot().imu.is_none());
    }

    #[test]
    fn what_is_no_mount_is_said_with_its_place() {
        for (section, field) in [
            ("axes = [\"x\", \"y\", \"z\"]", "imu.sensor"),
            ("sensor = 7", "imu.sensor"),
            ("sensor = \"a\"\naxes = [\"x\", \"y\", \"-z\"]", "imu.axes"),
            ("sensor = \"a\"\naxes = [\"x\", \"x\", \"z\"]", "imu.axes"),
            ("sensor = \"a\"\naxes = [\"x\", \"y\"]", "imu.axes"),
            ("sensor = \"a\"\nplace_m = [1, 2]", "imu.place_m"),
            ("sensor = \"a\"\nheading = \"north\"", "imu.heading"),
            ("sensr = \"a\"", "imu.sensr"),
        ] {
            let error = parsed(section).unwrap_err().to_string();
            assert!(error.contains(field), "{section}: {error}");
        }
    }
}
