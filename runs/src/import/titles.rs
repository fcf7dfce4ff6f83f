//! Tables whose names of columns stand below lines of another width, as motion capture writes them: its settings, then the
//! bodies, each above its columns, then the columns, then their units.

use super::line::{REMARKS, fields, is_number, with_units};
use super::units;
use crate::read::separator;

/// Lines above the numbers at most.
const MOST: usize = 16;

/// The names of such a table, titles before them, and the lines above its numbers.
pub(super) fn table(bytes: &[u8]) -> Option<(Vec<String>, usize)> {
    let text: Vec<&[u8]> = bytes.split(|b| *b == b'\n').take(MOST + 2).map(<[u8]>::trim_ascii).collect();
    let separator = text.iter().map(|line| separator(line)).find(|s| text.iter().any(|line| line.contains(s)))?;
    let lines: Vec<Vec<String>> = text.iter().map(|line| fields(line, false, separator)).collect();
    let numbers = |line: &Vec<String>| {
        let filled = line.iter().filter(|field| !field.is_empty()).count();
        filled > 1 && line.iter().all(|field| is_number(field, separator))
    };
    let begin = |i: &usize| numbers(&lines[*i]) && numbers(&lines[i + 1]) && lines[*i].len() == lines[i + 1].len();
    let first = (1..lines.len().saturating_sub(1)).find(begin)?;
    let width = lines[first].len();
    let filled = |line: &Vec<String>| line.iter().filter(|field| !field.is_empty()).count();
    let mixed =
        |line: &Vec<String>| line.len() != width && line.iter().any(|f| !f.is_empty() && is_number(f, separator));
    let top = lines.iter().find(|line| filled(line) > 0)?;
    if REMARKS.iter().any(|mark| top[0].starts_with(mark)) {
        return None;
    }
    let is_unit = |field: &String| field.is_empty() || units::in_name(&format!("x [{field}]")).is_some();
    let is_names = |line: &Vec<String>| {
        filled(line) > 1 && !line.iter().all(is_unit) && line.iter().all(|f| f.is_empty() || !is_number(f, separator))
    };
    let named = (0..first).rev().find(|i| is_names(&lines[*i]))?;
    // Names of every column below a line of another width, or a table as any other.
    let below = top.len() != width && lines[named].len() == width;
    if 2 * filled(top) >= width && !mixed(top) && !below {
        return None;
    }
    let mut names = lines[named].clone();
    names.resize(width, String::new());
    // An oscilloscope of a drive writes the unit of its time among the signals, below generic names.
    if let Some(above) = named.checked_sub(1).map(|i| &lines[i]).filter(|above| above.len() == width) {
        for (name, generic) in names.iter_mut().zip(above).filter(|(name, _)| !name.is_empty() && is_unit(name)) {
            *name = with_units(vec![generic.clone()], std::slice::from_ref(name)).remove(0);
        }
    }
    for units in &lines[named + 1..first] {
        // A recorder of a drive gives its time no name, but a unit.
        if names[0].is_empty() && units.first().is_some_and(|unit| units::is_like(unit, "s")) {
            names[0] = "time".to_owned();
        }
        names = with_units(names, units);
    }
    // A title goes for the columns below it, up to the next.
    for titles in lines[..named].iter().rev().filter(|line| line[0].is_empty() && filled(line) > 0) {
        let mut title = "";
        for (i, name) in names.iter_mut().enumerate() {
            title = titles.get(i).filter(|own| !own.is_empty()).map_or(title, String::as_str);
            if !title.is_empty() && !name.is_empty() {
                *name = format!("{title}/{name}");
            }
        }
    }
    for (i, name) in names.iter_mut().enumerate().filter(|(_, name)| name.is_empty()) {
        *name = format!("column_{}", i + 1);
    }
    Some((names, first))
}

/// Frames a second, which motion capture that numbers its frames writes alone below the kind of its export: `Objects`, `100`.
pub(super) fn frames_per_s(bytes: &[u8]) -> Option<f64> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = |line| std::str::from_utf8(line).ok().map(|line: &str| line.trim().trim_end_matches([',', ';']));
    let mut lines = bytes.split(|b| *b == b'\n');
    let [kind, rate] = [text(lines.next()?)?, text(lines.next()?)?];
    let worded = kind.starts_with(char::is_alphabetic) && !kind.contains([',', ';']);
    let rate = rate.parse().ok().filter(|rate: &f64| worded && rate.is_finite() && *rate > 0.0)?;
    table(bytes).is_some_and(|(names, _)| names[0] == "Frame").then_some(rate)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Clock, Table};

    fn read(text: &str, rate_hz: Option<f64>) -> Table {
        Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock { rate_hz, ..Clock::default() }).unwrap()
    }

    #[test]
    fn exports_of_motion_capture_have_their_names_below() {
        let text = "Objects\r\n100\r\n,,Global Angle car:car,,,,,,\r\nFrame,Sub Frame,RX,RY,RZ,TX,TY,TZ\r\n,,rad,rad,rad,mm,mm,mm\r\n\
                    1,0,0,0,1.5,10,20,30\r\n2,0,0,0,1.6,11,21,30\r\n3,0,,,,,,\r\n4,0,0,0,1.7,12,22,30\r\n";
        let table = read(text, Some(100.0));
        let x = table.find("Global Angle car:car/TX [mm]").unwrap();
        assert_eq!((x.values.clone(), x.t.clone()), (vec![10.0, 11.0, 12.0], vec![0.0, 0.01, 0.03]));
        // Its rate stands above, unless the map says another.
        let own = read(&format!("\u{feff}{text}"), None);
        assert_eq!(own.find("Global Angle car:car/TX [mm]").unwrap().t, x.t);
        let other = read(text, Some(50.0));
        assert_eq!(other.find("Global Angle car:car/TX [mm]").unwrap().t, [0.0, 0.02, 0.06]);
        let text = "Format Version,1.23,Take Name,a,Capture Frame Rate,120.0,Length Units,Meters,Rotation Type,XYZ\n\n\
                    ,,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n,,car,car,car,car\n,,Rotation,Position,Position,Position\n\
                    Frame,Time (Seconds),Z,X,Y,Z\n0,0.0,0.5,1,2,0\n1,0.01,0.6,1.5,2,0\n";
        let table = read(text, None);
        assert_eq!(table.find("Rigid Body/car/Position/X").unwrap().values, [1.0, 1.5]);
        assert_eq!(table.find("Rigid Body/car/Rotation/Z").unwrap().t, [0.0, 0.01]);
    }
    #[test]
    fn a_unit_among_the_names_belongs_to_the_generic_name_above_it() {
        let text = "Axis1\nNumber of sampling data,3\nSampling time interval(ms),0.5\nTime,Analog 1,Analog 2,Digital 1\n\
                    ms,Servo motor speed,Torque,INP\n0.0,0,-1.0,2.5\n0.5,-14,-7.6,2.5\n1.0,-30,-9.1,0\n";
        let table = read(text, None);
        assert_eq!(table.find("Servo motor speed").unwrap().t, [0.0, 5e-4, 1e-3]);
        assert_eq!(table.find("Torque").unwrap().values, [-1.0, -7.6, -9.1]);
    }

    #[test]
    fn a_recorder_of_a_drive_has_settings_above_its_names_and_a_time_without_one() {
        let text = "\u{feff}Date:;2020-07-08 21:09:37\r\nIndex:;0x30D3;0x30D2;0x0000\r\nMax. samples:;500\r\nSampling period:;6.4\r\n\
                    Scale:;0;True;5.0;197.5\r\n;Velocity actual value averaged;Torque actual value averaged\r\nms;rpm;%\r\n\
                    0.0;-199;-31.9\r\n6.4;-201;-30.2\r\n12.8;-201;-29.9\r\n";
        let table = read(text, None);
        let speed = table.find("Velocity actual value averaged [rpm]").unwrap();
        assert_eq!((speed.t.clone(), speed.values.clone()), (vec![0.0, 0.0064, 0.0128], vec![-199.0, -201.0, -201.0]));
        assert_eq!(table.find("Torque actual value averaged [%]").unwrap().values, [-31.9, -30.2, -29.9]);
    }
}
