//! A field from a file: its sizes as TOML, or the geometry message in a game log.

use super::Field;
use runs::error::{InputError, line_and_column};
use runs::vision::FieldSize;
use serde::Deserialize;
use std::path::Path;

/// Sizes that a field can have, m.
const SIDE: std::ops::RangeInclusive<f64> = 1.0..=100.0;
const HINT: &str = "give the sizes in metres: length, width, boundary, goal_width, defence_depth, defence_width ...";

/// The file's names; what it leaves out is division B's.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sizes {
    length: f64,
    width: f64,
    boundary: Option<f64>,
    goal_width: Option<f64>,
    goal_depth: Option<f64>,
    goal_height: Option<f64>,
    defence_depth: Option<f64>,
    defence_width: Option<f64>,
    circle_radius: Option<f64>,
    line_width: Option<f64>,
}

impl Field {
    /// The field of a name or a file: `A`, `B`, a TOML file with sizes in metres under the names of [`Field`]'s members
    /// (`length` and `width` at least, the rest is division B's), or a game log (`.log`, `.log.gz`) whose first geometry
    /// message counts.
    ///
    /// # Errors
    /// What is wrong, in which line or member.
    pub fn of(name: &Path) -> Result<Self, InputError> {
        match name.to_str() {
            Some("A") => return Ok(Self::DIVISION_A),
            Some("B") => return Ok(Self::DIVISION_B),
            _ => {}
        }
        let bytes = std::fs::read(name).map_err(|error| InputError::io(name, &error))?;
        if runs::import::is_game_log(&bytes) {
            let size = runs::import::field_size(&bytes, name)?;
            return Self::of_message(&size).map_err(|(member, what)| {
                InputError::new(name, what, "take another log, or a file of sizes").field(member)
            });
        }
        let text = String::from_utf8(bytes).map_err(|_| InputError::new(name, "neither text nor a game log", HINT))?;
        Self::of_toml(&text, name)
    }

    fn of_toml(text: &str, name: &Path) -> Result<Self, InputError> {
        let sizes: Sizes = toml::from_str(text).map_err(|error| {
            let (line, column) = line_and_column(text, error.span().map_or(0, |span| span.start));
            InputError::new(name, error.message().to_owned(), HINT).at(line, column)
        })?;
        let usual = Self::DIVISION_B;
        let field = Self {
            length: sizes.length,
            width: sizes.width,
            boundary: sizes.boundary.unwrap_or(usual.boundary),
            goal_width: sizes.goal_width.unwrap_or(usual.goal_width),
            goal_depth: sizes.goal_depth.unwrap_or(usual.goal_depth),
            goal_height: sizes.goal_height.unwrap_or(usual.goal_height),
            defence_depth: sizes.defence_depth.unwrap_or(usual.defence_depth),
            defence_width: sizes.defence_width.unwrap_or(usual.defence_width),
            circle_radius: sizes.circle_radius.unwrap_or(usual.circle_radius),
            line_width: sizes.line_width.unwrap_or(usual.line_width),
        };
        field.checked().map_err(|(member, what)| {
            let at = text.lines().position(|line| line.trim_start().starts_with(member));
            let error = InputError::new(name, what, HINT).field(member);
            at.map_or(error.clone(), |line| error.at(line + 1, 1))
        })
    }

    /// The field of the league's geometry message. What the message may leave out is division B's.
    ///
    /// # Errors
    /// The member that cannot be, and why.
    pub fn of_message(size: &FieldSize) -> Result<Self, (&'static str, String)> {
        let usual = Self::DIVISION_B;
        let metres = |mm: i32| 1e-3 * f64::from(mm);
        let circle = size.field_arcs.iter().find(|arc| arc.center.x == 0.0 && arc.center.y == 0.0);
        let field = Self {
            length: metres(size.field_length),
            width: metres(size.field_width),
            boundary: metres(size.boundary_width),
            goal_width: metres(size.goal_width),
            goal_depth: metres(size.goal_depth),
            defence_depth: size.penalty_area_depth.map_or(usual.defence_depth, metres),
            defence_width: size.penalty_area_width.map_or(usual.defence_width, metres),
            circle_radius: circle.map_or(usual.circle_radius, |arc| 1e-3 * f64::from(arc.radius)),
            line_width: size.field_lines.first().map_or(usual.line_width, |line| 1e-3 * f64::from(line.thickness)),
            ..usual
        };
        field.checked()
    }

    /// The same field, if its parts fit into it.
    fn checked(self) -> Result<Self, (&'static str, String)> {
        for (member, value) in [("length", self.length), ("width", self.width)] {
            if !SIDE.contains(&value) {
                return Err((member, format!("{value} m is not between {} and {} m", SIDE.start(), SIDE.end())));
            }
        }
        let within = [
            ("boundary", self.boundary, 0.0, 0.5 * self.width),
            ("goal_width", self.goal_width, 0.0, self.width),
            ("goal_depth", self.goal_depth, 0.0, 0.5 * self.length),
            ("goal_height", self.goal_height, 0.0, self.width),
            ("defence_depth", self.defence_depth, 0.0, 0.5 * self.length),
            ("defence_width", self.defence_width, 0.0, self.width),
            ("circle_radius", self.circle_radius, 0.0, 0.5 * self.width),
            ("line_width", self.line_width, 0.001, 0.1),
        ];
        for (member, value, least, most) in within {
            if !(least..=most).contains(&value) {
                return Err((member, format!("{value} m is not between {least} and {most} m on this field")));
            }
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn toml(text: &str) -> Result<Field, String> {
        Field::of_toml(text, Path::new("field.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn sizes_are_read_and_wrong_ones_are_named_with_their_line() {
        assert_eq!(Field::of(Path::new("A")), Ok(Field::DIVISION_A));
        assert_eq!(toml("length = 9.0\nwidth = 6"), Ok(Field::DIVISION_B));
        assert_eq!(toml("length = 4\nwidth = 3\ncircle_radius = 0.25").unwrap().circle_radius, 0.25);
        let said = |text: &str, what: &str| {
            let error = toml(text).unwrap_err();
            assert!(error.contains(what), "{error}");
        };
        said("length = 9000\nwidth = 6000", "field.toml:1:1: length: 9000 m is not between 1 and 100 m");
        said("length = 9\nwidth = 6\ndefence_width = 7", "field.toml:3:1: defence_width: 7 m");
        said("length = 9\nwidth = 6\ngoalwidth = 1", "field.toml:3:1: unknown field `goalwidth`");
        said("length = 9", "missing field `width`");
        said("length = nan\nwidth = 6", "length: NaN m");
    }

    #[test]
    fn the_message_of_the_league_makes_the_same_field() {
        use runs::vision::{CircularArc, Point};
        let centre = CircularArc { radius: 500.0, center: Point { x: 0.0, y: 0.0 }, ..CircularArc::default() };
        let mut size = FieldSize {
            field_length: 12_000,
            field_width: 9_000,
            goal_width: 1_800,
            goal_depth: 180,
            boundary_width: 300,
            field_arcs: vec![centre],
            penalty_area_depth: Some(1_800),
            penalty_area_width: Some(3_600),
            ..FieldSize::default()
        };
        assert_eq!(Field::of_message(&size), Ok(Field::DIVISION_A));
        size.field_length = -1;
        assert_eq!(Field::of_message(&size).unwrap_err().0, "length");
    }
}
