//! Where the wheels are, as `robot.toml` says it: `[[wheel]]` tables, `body_radius_m` and skews, or both where they agree.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::Layout;
use super::fields::Range;
use super::section::{Section, Value, number};
use crate::error::InputError;
use crate::frames::wrap_angle;
use crate::geometry::Wheel;

const WHEEL_KEYS: &[&str] = &["x_m", "y_m", "drive_rad", "drive_deg", "roller_rad", "roller_deg"];
/// The league's fields are 12 m long; a body radius beyond this is a slip of units.
const LENGTH: Range = Range::Positive(10.0);
const COORDINATE: Range = Range::Within(10.0);
/// Any number of turns; what is kept is an angle.
const ANGLE: Range = Range::Within(1e6);
/// Share of the body radius, and m, that wheels may stand off it: drawings are rounded to millimetres.
const RADIUS_AGREES: (f64, f64) = (0.01, 0.001);
/// Angle that a drive direction may differ from mount and skew, rad: whole degrees are rounded by half of one.
const ANGLE_AGREES: f64 = 0.02;

/// The wheels; `None` where the file says nothing of them.
pub(super) fn layout(top: &Section) -> Result<Option<Layout>, InputError> {
    let body_radius = top.number("body_radius_m", LENGTH, "chassis centre to wheel contact")?;
    let skews = skews(top)?;
    let Some(list) = top.table.get("wheel") else {
        let Some(body_radius_m) = body_radius else { return Ok(None) };
        let Some((key, at, skews)) = skews else {
            return Ok(Some(Layout::Rac { body_radius_m, skew_rad: [0.0; 3] }));
        };
        let Ok(skew_rad) = <[f64; 3]>::try_from(skews.clone()) else {
            let hint = "give 3 numbers, or describe another robot by one [[wheel]] table a wheel";
            return Err(top.fault(key, at, format!("has {} entries", skews.len()), hint));
        };
        return Ok(Some(Layout::Rac { body_radius_m, skew_rad }));
    };
    let wheels = wheels(top, list)?;
    let hint = "keep one of the two; [[wheel]] describes any robot";
    if let (Some(radius), Some(at)) = (body_radius, top.table.get("body_radius_m")) {
        let distance = |w: &Wheel| w.x_m.hypot(w.y_m);
        let allowed = (RADIUS_AGREES.0 * radius).max(RADIUS_AGREES.1);
        if let Some(i) = wheels.iter().position(|w| (distance(w) - radius).abs() > allowed) {
            let what = format!(
                "contradicts the [[wheel]] tables: wheel {} stands {:.4} m from the centre",
                i + 1,
                distance(&wheels[i])
            );
            return Err(top.fault("body_radius_m", at, what, hint));
        }
    }
    if let Some((key, at, skews)) = skews {
        let none = skews.iter().all(|s| *s == 0.0);
        let off = |w: &Wheel, skew: f64| {
            let mount = w.y_m.atan2(w.x_m);
            // Motors may be mounted to turn either way round.
            (wrap_angle(2.0 * (w.drive_rad - (mount - FRAC_PI_2 - skew))) / 2.0).abs()
        };
        if !none && skews.len() != wheels.len() {
            let what = format!("has {} entries, but there are {} [[wheel]] tables", skews.len(), wheels.len());
            return Err(top.fault(key, at, what, hint));
        }
        let disagrees = |(i, w): (usize, &Wheel)| (off(w, skews[i]) > ANGLE_AGREES).then_some(i);
        if let Some(i) = wheels.iter().enumerate().filter(|_| !none).find_map(disagrees) {
            let what = format!("contradicts the [[wheel]] tables: wheel {} drives another way", i + 1);
            return Err(top.fault(key, at, what, hint));
        }
    }
    Ok(Some(Layout::Wheels(wheels)))
}

fn wheels(top: &Section, list: &Value) -> Result<Vec<Wheel>, InputError> {
    let Some(tables) = list.get_ref().as_array() else {
        return Err(top.fault("wheel", list, "is no array of tables", "write [[wheel]]"));
    };
    let mut wheels = Vec::new();
    for value in tables {
        let section = top.inner("wheel", value)?;
        section.known(WHEEL_KEYS, &mut Vec::new())?;
        let needed = |key: &str, range: Range| match section.number(key, range, "")? {
            Some(x) => Ok(x),
            None => Err(section.missing(key, "one per wheel")),
        };
        let angle = |stem: &str| -> Result<Option<f64>, InputError> {
            let rad = section.number(&format!("{stem}_rad"), ANGLE, "")?;
            let key = format!("{stem}_deg");
            let deg = section.number(&key, ANGLE, "")?.map(f64::to_radians);
            match (rad, deg, section.table.get(key.as_str())) {
                (Some(a), Some(b), Some(at)) if wrap_angle(a - b).abs() > 1e-6 => {
                    Err(section.fault(&key, at, format!("contradicts {stem}_rad"), "keep one of the two"))
                }
                (rad, deg, _) => Ok(rad.or(deg).map(within_a_turn)),
            }
        };
        wheels.push(Wheel {
            x_m: needed("x_m", COORDINATE)?,
            y_m: needed("y_m", COORDINATE)?,
            drive_rad: angle("drive")?.ok_or_else(|| section.missing("drive_rad", "one per wheel, or drive_deg"))?,
            roller_rad: angle("roller")?.unwrap_or(0.0),
        });
    }
    Ok(wheels)
}

/// The name of a list, the list as it stands in the file, and its angles, rad.
type Angles<'a> = (&'static str, &'a Value<'a>, Vec<f64>);

/// The list of skews under either of its names.
fn skews<'a>(top: &Section<'a>) -> Result<Option<Angles<'a>>, InputError> {
    for (key, unit) in [("skew_rad", 1.0), ("skew_deg", PI / 180.0)] {
        let Some(value) = top.table.get(key) else { continue };
        let hint = "give one angle a wheel, such as [0.0, 0.0, 0.0]";
        let Some(list) = value.get_ref().as_array() else { return Err(top.fault(key, value, "is no array", hint)) };
        let mut skews = Vec::new();
        for item in list {
            let Some(x) = number(item.get_ref()) else {
                return Err(top.fault(key, item, "holds something that is no number", hint));
            };
            let skew = within_a_turn(unit * x);
            if let Some(what) = Range::Within(TAU).fault(skew) {
                return Err(top.fault(key, item, what, hint));
            }
            if skew.abs() > FRAC_PI_2 {
                return Err(top.fault(key, item, format!("a wheel turned by {x} is none of this layout"), hint));
            }
            skews.push(skew);
        }
        return Ok(Some((key, value, skews)));
    }
    Ok(None)
}

/// The same direction; as it was written where that is within a turn.
fn within_a_turn(angle: f64) -> f64 {
    if angle.abs() > TAU { wrap_angle(angle) } else { angle }
}
