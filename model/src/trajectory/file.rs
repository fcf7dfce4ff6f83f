//! Files of set points, CSV or TOML.

use std::path::Path;
use toml::de::{DeTable, DeValue};

use super::SetPoint;
use runs::error::{InputError, line_and_column, nearest};

const NAMES: [&str; 4] = ["x", "y", "v", "omega"];
const HINT: &str = "give x, y (m), v (m/s), omega (rad/s), and stop if the robot shall halt there";

impl SetPoint {
    /// Reads a file of set points.
    ///
    /// CSV: one point a line, `x, y, v, omega` and optionally `stop` or `pass`; a header line with
    /// these names and lines that start with `#` are allowed. TOML (by the file's extension):
    /// `[[set_point]]` tables with `x`, `y`, `v`, `omega` and optionally `stop = true`.
    ///
    /// # Errors
    /// [`InputError`] with line and column for a wrong number of values, text in a number, numbers
    /// that are not finite, speeds that are not positive, and files without points.
    pub fn read_file(path: impl AsRef<Path>) -> Result<Vec<Self>, InputError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|e| InputError::io(path, &e))?;
        let toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
        if toml { Self::parse_toml(&text, path) } else { Self::parse_csv(&text, path) }
    }

    /// Reads set points in CSV; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`SetPoint::read_file`].
    pub fn parse_csv(text: &str, path: &Path) -> Result<Vec<Self>, InputError> {
        let mut points = Vec::new();
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        for (i, line) in text.lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default();
            if content.trim().is_empty() {
                continue;
            }
            let fields: Vec<&str> = content.split(',').collect();
            let is_header = points.is_empty() && fields[0].trim() == NAMES[0];
            if is_header {
                continue;
            }
            if fields.len() != 4 && fields.len() != 5 {
                let what = format!("{} values instead of 4", fields.len());
                return Err(InputError::new(path, what, HINT).at(i + 1, 1));
            }
            let mut column = 1;
            let mut numbers = [0.0; 4];
            for ((number, name), field) in numbers.iter_mut().zip(NAMES).zip(&fields) {
                *number = field.trim().parse().map_err(|_| {
                    let what = format!("{:?} is no number", field.trim());
                    InputError::new(path, what, HINT).at(i + 1, column).field(name)
                })?;
                column += field.chars().count() + 1;
            }
            let stop = match fields.get(4).map(|f| f.trim()) {
                None | Some("" | "pass") => false,
                Some("stop") => true,
                Some(other) => {
                    let what = format!("{other:?} is neither stop nor pass");
                    return Err(InputError::new(path, what, HINT).at(i + 1, column).field("stop"));
                }
            };
            points.push(point(numbers, stop, path).map_err(|e| e.at(i + 1, 1))?);
        }
        not_empty(points, path)
    }

    /// Reads set points in TOML; `path` is for the error messages.
    ///
    /// # Errors
    /// As [`SetPoint::read_file`].
    pub fn parse_toml(text: &str, path: &Path) -> Result<Vec<Self>, InputError> {
        let place = |offset: usize| line_and_column(text, offset);
        let root = DeTable::parse(text).map_err(|e| {
            let (line, column) = place(e.span().map_or(0, |s| s.start));
            InputError::new(path, e.message().replace('\n', " "), "correct the TOML").at(line, column)
        })?;
        let mut points = Vec::new();
        for (key, value) in root.get_ref() {
            let (line, column) = place(key.span().start);
            let list = value.get_ref().as_array().filter(|_| key.get_ref() == "set_point");
            let Some(list) = list else {
                let what = "is no array of [[set_point]] tables";
                return Err(InputError::new(path, what, HINT).at(line, column).field(key.get_ref().as_ref()));
            };
            for item in list {
                let (line, column) = place(item.span().start);
                let fail = |name: &str, what: &str| {
                    Err(InputError::new(path, what, HINT).at(line, column).field(name.to_owned()))
                };
                let Some(table) = item.get_ref().as_table() else { return fail("set_point", "is no table") };
                let mut numbers = [0.0; 4];
                for (number, name) in numbers.iter_mut().zip(NAMES) {
                    let Some(value) = table.get(name) else { return fail(name, "is missing") };
                    let text = value.get_ref();
                    let text = match text {
                        DeValue::Float(x) => Some(x.as_str()),
                        DeValue::Integer(x) => Some(x.as_str()),
                        _ => None,
                    };
                    match text.and_then(|t| t.parse().ok()) {
                        Some(x) => *number = x,
                        None => return fail(name, "is no number"),
                    }
                }
                let stop = match table.get("stop").map(|v| v.get_ref().as_bool()) {
                    None => false,
                    Some(Some(stop)) => stop,
                    Some(None) => return fail("stop", "is neither true nor false"),
                };
                for key in table.keys() {
                    let name: &str = key.get_ref();
                    if !NAMES.contains(&name) && name != "stop" {
                        let (line, column) = place(key.span().start);
                        let hint = nearest(name, &["x", "y", "v", "omega", "stop"])
                            .map_or_else(|| HINT.to_owned(), |k| format!("did you mean {k}?"));
                        return Err(InputError::new(path, "is not a known field", hint).at(line, column).field(name));
                    }
                }
                points.push(point(numbers, stop, path).map_err(|e| e.at(line, column))?);
            }
        }
        not_empty(points, path)
    }
}

fn point([x, y, v, omega]: [f64; 4], stop: bool, path: &Path) -> Result<SetPoint, InputError> {
    for (name, number) in NAMES.iter().zip([x, y, v, omega]) {
        if !number.is_finite() {
            return Err(InputError::new(path, format!("{number} is not finite"), HINT).field(*name));
        }
    }
    if v <= 0.0 {
        let hint = "give the speed on the way there; to stand still, write stop after the point";
        return Err(InputError::new(path, format!("speed {v} is not positive"), hint).field("v"));
    }
    Ok(SetPoint { x, y, v, omega, stop, heading: None })
}

fn not_empty(points: Vec<SetPoint>, path: &Path) -> Result<Vec<SetPoint>, InputError> {
    if points.is_empty() { Err(InputError::new(path, "holds no set points", HINT)) } else { Ok(points) }
}

#[cfg(test)]
mod tests {
    use super::super::FIG_6;
    use super::*;
    use proptest::prelude::*;

    fn csv(text: &str) -> Result<Vec<SetPoint>, InputError> {
        SetPoint::parse_csv(text, Path::new("points.csv"))
    }

    fn toml(text: &str) -> Result<Vec<SetPoint>, InputError> {
        SetPoint::parse_toml(text, Path::new("points.toml"))
    }

    #[test]
    fn fig_6_in_both_formats() {
        let text = "\u{feff}x,y,v,omega\r\n# Fig. 6\n3,3,1,0.5\n 3, 0, 1, 0,\n6,0,1.0,-0.15 # turn\n\n6,3,1,0,pass";
        assert_eq!(csv(text).unwrap(), FIG_6);
        let points: Vec<String> = FIG_6
            .iter()
            .map(|p| format!("[[set_point]]\nx = {}\ny = {:?}\nv = {:?}\nomega = {:?}\n", p.x, p.y, p.v, p.omega))
            .collect();
        assert_eq!(toml(&points.concat()).unwrap(), FIG_6);
        assert!(toml("[[set_point]]\nx=1\ny=1\nv=1\nomega=0\nstop=true").unwrap()[0].stop);
        assert!(csv("1,1,1,0,stop").unwrap()[0].stop);
    }

    #[test]
    fn the_shipped_files_are_what_they_say() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/set-points");
        assert_eq!(SetPoint::read_file(folder.join("fig-6.csv")).unwrap(), FIG_6);
        let square = SetPoint::read_file(folder.join("square.toml")).unwrap();
        assert_eq!(square.len(), 4);
        assert!(square.iter().all(|p| p.stop));
        assert_eq!(SetPoint::read_file(folder.join("none.csv")).unwrap_err().hint, "check the path");
    }

    #[test]
    fn errors_say_where_and_what() {
        let table = [
            ("", "points.csv: holds no set points"),
            ("3,3,1,0.5\n3,0,1\n", "points.csv:2:1: 3 values instead of 4; give x, y (m)"),
            ("1,2,3,4,5,6", "points.csv:1:1: 6 values"),
            ("1, 2, fast, 0", "points.csv:1:6: v: \"fast\" is no number"),
            ("1,2,0,0", "points.csv:1:1: v: speed 0 is not positive"),
            ("1,nan,1,0", "points.csv:1:1: y: NaN is not finite"),
            ("1,2,1,0,halt", "points.csv:1:9: stop: \"halt\" is neither"),
        ];
        for (text, message) in table {
            let shown = csv(text).unwrap_err().to_string();
            assert!(shown.starts_with(message), "{text:?} gave {shown}");
        }
        let table = [
            ("", "points.toml: holds no set points"),
            ("[[set_point]]\nx=1\ny=1\nv=1\n", "points.toml:1:1: omega: is missing"),
            (
                "[[set_point]]\nx=1\ny=1\nv=1\nomega=0\nomga=2",
                "points.toml:6:1: omga: is not a known field; did you mean omega?",
            ),
            ("[[set_point]]\nx=1\ny=\"b\"\nv=1\nomega=0", "points.toml:1:1: y: is no number"),
            ("[[point]]\nx=1", "points.toml:1:3: point: is no array of [[set_point]]"),
            ("x = = 1", "points.toml:1:5: "),
        ];
        for (text, message) in table {
            let shown = toml(text).unwrap_err().to_string();
            assert!(shown.starts_with(message), "{text:?} gave {shown}");
        }
    }

    proptest! {
        #[test]
        fn no_text_panics_the_readers(text in "[\\[\\]xyv=,.0-9#a-z\\n \"-]{0,80}") {
            let _ = csv(&text);
            let _ = toml(&text);
        }
    }
}
