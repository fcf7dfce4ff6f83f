//! [`Robot`] into the text of a `robot.toml`.

use std::fmt::{Display, Write as _};

use super::fields::{FIELDS, Field};
use super::{Effect, Layout, Robot, Support};

pub(super) fn robot(robot: &Robot) -> String {
    let mut out = String::from("# Robot parameters, SI units.\n");
    let said = |f: &&Field| !robot.missing.contains(&f.path());
    for field in FIELDS.iter().filter(|f| f.table.is_empty()).filter(said) {
        if let Some(x) = (field.get)(robot) {
            line(&mut out, field.name, number(x));
        }
        if field.name == "wheel_radius_m"
            && let Layout::Rac { body_radius_m, skew_rad } = &robot.layout
        {
            line(&mut out, "body_radius_m", number(*body_radius_m));
            line(&mut out, "skew_rad", floats(skew_rad));
        }
    }
    if let Some(noise) = &robot.camera_noise {
        line(&mut out, "camera_noise", floats(noise));
    }
    if robot.support == Support::Blocks {
        out.push_str("support = \"blocks\"\n");
    }
    others(&mut out, robot, "");
    let silent = |table: &str| FIELDS.iter().filter(|f| f.table == table && !f.optional).all(|f| !said(&f));
    let has_loop = robot.pi.kp != 0.0 || robot.pi.ki != 0.0 || robot.pi.arithmetic.is_some();
    for table in ["motor", "pi"].into_iter().filter(|table| *table != "pi" || has_loop) {
        if silent(table) {
            continue;
        }
        let _ = writeln!(out, "\n[{table}]");
        for field in FIELDS.iter().filter(|f| f.table == table).filter(said) {
            if let Some(x) = (field.get)(robot) {
                let _ = writeln!(out, "{} = {}  # {}", field.name, number(x), field.meaning);
            }
        }
        others(&mut out, robot, table);
    }
    if let Some(arithmetic) = &robot.pi.arithmetic {
        line(&mut out, "arithmetic", toml::Value::String(arithmetic.clone()));
    }
    if !robot.pi.registers.is_empty() {
        let words = robot.pi.registers.iter();
        line(&mut out, "registers", inline(words.map(|(name, word)| (name.clone(), word.to_string()))));
    }
    if let Some(imu) = &robot.imu {
        out.push_str("\n[imu]\n");
        imu.lines().into_iter().for_each(|(key, value)| line(&mut out, key, value));
        others(&mut out, robot, "imu");
    }
    if let Layout::Wheels(wheels) = &robot.layout {
        for w in wheels {
            out.push_str("\n[[wheel]]\n");
            let keys = ["x_m", "y_m", "drive_rad", "roller_rad"];
            for (key, x) in keys.iter().zip([w.x_m, w.y_m, w.drive_rad, w.roller_rad]) {
                line(&mut out, key, number(x));
            }
        }
    }
    for e in &robot.effects {
        effect(&mut out, e);
    }
    out
}

/// What the file said beside; tables inline, so that they stay where they are.
fn others(out: &mut String, robot: &Robot, table: &str) {
    for (_, key, value) in robot.other.iter().filter(|(t, ..)| t == table) {
        line(out, key, text(value));
    }
}

pub(super) fn effect(out: &mut String, effect: &Effect) {
    out.push_str("\n[[effect]]\n");
    line(out, "name", toml::Value::String(effect.name.clone()));
    let wheels = effect.wheels.iter().map(|w| toml::Value::Integer(*w as i64)).collect();
    line(out, "wheels", toml::Value::Array(wheels));
    for (key, value) in &effect.other {
        line(out, key, text(value));
    }
    if effect.parameters.is_empty() {
        return;
    }
    out.push_str("[effect.parameters]\n");
    for (name, p) in &effect.parameters {
        let ci95 = p.ci95.map(|ci| ("ci95".to_owned(), floats(&ci)));
        let rest = p.other.iter().map(|(key, value)| (key.clone(), text(value)));
        let entries = [("value".to_owned(), number(p.value))].into_iter().chain(ci95).chain(rest);
        line(out, name, inline(entries));
    }
}

/// One `key = value`, everything nested inline, so that no later key falls into a sub-table.
fn line(out: &mut String, name: &str, value: impl Display) {
    let _ = writeln!(out, "{} = {value}", key(name));
}

/// A value inline. Its numbers have exponents where `toml` would write hundreds of zeros.
fn text(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(x) => float(*x),
        toml::Value::Array(values) => format!("[{}]", values.iter().map(text).collect::<Vec<_>>().join(", ")),
        toml::Value::Table(table) => inline(table.iter().map(|(key, value)| (key.clone(), text(value)))),
        other => other.to_string(),
    }
}

/// An inline table of entries in this order.
fn inline(entries: impl IntoIterator<Item = (String, String)>) -> String {
    let entries: Vec<String> = entries.into_iter().map(|(name, value)| format!("{} = {value}", key(&name))).collect();
    format!("{{ {} }}", entries.join(", "))
}

fn key(name: &str) -> String {
    let bare = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare && !name.is_empty() { name.to_owned() } else { toml::Value::String(name.to_owned()).to_string() }
}

/// The shortest text that reads back as the same number; whole numbers without a fraction.
fn number(x: f64) -> String {
    if x.fract() == 0.0 && x.abs() < 1e15 {
        return format!("{x}");
    }
    float(x)
}

/// Rust writes NaN and TOML nan, so that what is not valid stays readable for the error message.
fn float(x: f64) -> String {
    format!("{x:?}").to_lowercase()
}

fn floats(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().copied().map(float).collect();
    format!("[{}]", numbers.join(", "))
}
