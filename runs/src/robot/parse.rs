//! `robot.toml` into [`Robot`], with positions for every complaint.

use std::path::Path;
use toml::de::DeTable;

use super::fields::{BODY, FIELDS, Range, SYNONYMS};
use super::layout::layout;
use super::section::{Section, Source, number, whole};
use super::{Effect, EffectParameter, Layout, PiParameters, Robot, Support, WHEELS, imu};
use crate::error::{InputError, line_and_column};

/// Keys beside [`FIELDS`].
const OTHER_KEYS: &[(&str, &str)] = &[
    ("", "body_radius_m"),
    ("", "skew_rad"),
    ("", "skew_deg"),
    ("", "camera_noise"),
    ("", "support"),
    ("", "motor"),
    ("", "pi"),
    ("", "wheel"),
    ("", "effect"),
    ("", "imu"),
    ("pi", "arithmetic"),
    ("pi", "registers"),
];

/// A robot of which everything is said if that is asked for.
pub(super) fn robot(text: &str, path: &Path, whole: bool) -> Result<Robot, InputError> {
    // Editors on Windows put a byte order mark in front.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source { text, path };
    let root = DeTable::parse(text).map_err(|e| source.syntax(&e))?;
    let top = Section { source, name: "", start: 0, table: root.get_ref() };
    let motor = if top.table.contains_key("motor") { Some(top.section("motor")?) } else { None };
    // A robot whose speed loop nobody knows has none to compare.
    let pi = if top.table.contains_key("pi") { Some(top.section("pi")?) } else { None };
    // What the file leaves out has its default here, or stands in `missing`.
    let no_loop = PiParameters { kp: 0.0, ki: 0.0, arithmetic: None, registers: Vec::new() };
    let mut robot =
        Robot { gear_ratio: 1.0, gear_efficiency: 1.0, camera_rate_hz: 0.0, pi: no_loop, ..Robot::racbot() };
    for section in [Some(&top), motor.as_ref(), pi.as_ref()].into_iter().flatten() {
        section.known(&keys_of(section.name), &mut robot.other)?;
    }
    robot.support = support(&top)?;
    let mut missing: Vec<(String, usize, &str)> = Vec::new();
    for field in FIELDS {
        let section = match field.table {
            "motor" => motor.as_ref(),
            "pi" => match &pi {
                Some(pi) => Some(pi),
                None => continue,
            },
            _ => Some(&top),
        };
        let read = section.map_or(Ok(None), |section| section.number(field.name, field.range, field.meaning))?;
        match read {
            Some(x) => (field.set)(&mut robot, x),
            None if field.optional => {}
            None if robot.support == Support::Blocks && BODY.contains(&field.name) => {}
            None => missing.push((field.path(), section.map_or(0, |s| s.start), field.meaning)),
        }
    }
    for synonym in SYNONYMS {
        let Some(field) = FIELDS.iter().find(|f| f.name == synonym.of) else { continue };
        let Some(x) = top.number(synonym.name, field.range, synonym.meaning)? else { continue };
        let x = (synonym.value)(&robot, x);
        let said = missing.iter().all(|(name, ..)| name != synonym.of);
        if let (Some(value), Some(given)) = (top.table.get(synonym.name), (field.get)(&robot))
            && said
            && (given / x - 1.0).abs() > 1e-6
        {
            let what = format!("contradicts {}: it would be {x}", synonym.of);
            return Err(top.fault(synonym.name, value, what, "keep one of the two"));
        }
        (field.set)(&mut robot, x);
        // An encoder on the output shaft needs no gear ratio: it is then 1, unless the file says it.
        let counts = synonym.of == "encoder_counts_per_motor_rev";
        missing.retain(|(name, ..)| name != synonym.of && !(counts && name == "gear_ratio"));
    }
    let turns = robot.motor.rotor_inertia + robot.wheel_inertia_kg_m2 > 0.0;
    if robot.support == Support::Blocks && !turns && missing.iter().all(|(name, ..)| name != "motor.rotor_inertia") {
        let hint = "on blocks nothing else turns: give rotor_inertia or wheel_inertia_kg_m2";
        return Err(InputError {
            hint: hint.to_owned(),
            ..motor.as_ref().unwrap_or(&top).missing("rotor_inertia", "")
        });
    }
    match layout(&top)? {
        Some(layout) => robot.layout = layout,
        None => {
            missing.push((WHEELS.to_owned(), 0, "one a wheel, which `racbot init --wheels` writes, or body_radius_m"));
            robot.layout = Layout::Wheels(Vec::new());
        }
    }
    if whole && !missing.is_empty() {
        return Err(top.all_missing(&missing));
    }
    robot.missing = missing.into_iter().map(|(name, ..)| name).collect();
    robot.camera_noise = top.numbers("camera_noise", Range::NotNegative(1e2))?;
    if let Some(pi) = &pi {
        read_pi_extras(pi, &mut robot)?;
    }
    if top.table.contains_key("imu") {
        let imu = top.section("imu")?;
        imu.known(&imu::KEYS, &mut robot.other)?;
        robot.imu = Some(imu::ImuMount::read(&imu)?);
    }
    robot.effects = effects(&top)?;
    if robot.missing.iter().any(|m| m == WHEELS) {
        return Ok(robot);
    }
    let wheel_at = top.table.get("wheel").or_else(|| top.table.get("body_radius_m"));
    robot.geometry().map_err(|e| match wheel_at {
        Some(value) => top.fault("wheel", value, e.to_string(), ""),
        None => InputError::new(path, e.to_string(), ""),
    })?;
    Ok(robot)
}

fn support(top: &Section) -> Result<Support, InputError> {
    let Some(value) = top.table.get("support") else { return Ok(Support::Floor) };
    match value.get_ref().as_str() {
        Some("floor") => Ok(Support::Floor),
        Some("blocks") => Ok(Support::Blocks),
        _ => {
            let what = "is neither \"floor\" nor \"blocks\"";
            Err(top.fault("support", value, what, "say what carries the robot"))
        }
    }
}

fn keys_of(table: &str) -> Vec<&'static str> {
    let others = OTHER_KEYS.iter().filter(|(t, _)| *t == table).map(|(_, name)| *name);
    let synonyms = SYNONYMS.iter().filter(|_| table.is_empty()).map(|s| s.name);
    FIELDS.iter().filter(|f| f.table == table).map(|f| f.name).chain(synonyms).chain(others).collect()
}

fn read_pi_extras(pi: &Section, robot: &mut Robot) -> Result<(), InputError> {
    if let Some(value) = pi.table.get("arithmetic") {
        let Some(name) = value.get_ref().as_str() else {
            return Err(pi.fault("arithmetic", value, "is no text", "such as \"fixed-kin\""));
        };
        robot.pi.arithmetic = Some(name.to_owned());
    }
    if let Some(value) = pi.table.get("registers") {
        let section = pi.inner("registers", value)?;
        for (name, word) in section.in_file_order() {
            let Some(word_value) = whole(word.get_ref()) else {
                let hint = "register words are whole numbers";
                return Err(section.fault(name.get_ref(), word, "is no whole number", hint));
            };
            robot.pi.registers.push((name.get_ref().to_string(), word_value));
        }
    }
    Ok(())
}

fn effects(top: &Section) -> Result<Vec<Effect>, InputError> {
    let Some(value) = top.table.get("effect") else { return Ok(Vec::new()) };
    let Some(list) = value.get_ref().as_array() else {
        return Err(top.fault("effect", value, "is no array of tables", "write [[effect]]"));
    };
    // The same text once more as plain values, which is what is kept.
    let plain: toml::Table = toml::from_str(top.source.text).map_err(|e| top.source.syntax(&e))?;
    let plain = plain.get("effect").and_then(toml::Value::as_array).cloned().unwrap_or_default();
    list.iter()
        .zip(plain)
        .map(|(value, plain)| {
            let section = top.inner("effect", value)?;
            effect(&section, plain.as_table().cloned().unwrap_or_default())
        })
        .collect()
}

/// A complaint about an effect of a file, by its index from 0, at its name or at one of its parameters.
pub(super) fn fault_of_effect(
    text: &str,
    path: &Path,
    (effect, parameter): (usize, Option<&str>),
    what: &str,
    hint: &str,
) -> InputError {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let nowhere = || InputError::new(path, what, hint);
    let Ok(root) = DeTable::parse(text) else { return nowhere() };
    let list = root.get_ref().get("effect").and_then(|list| list.get_ref().as_array());
    let Some(table) = list.and_then(|list| list.get(effect)).and_then(|value| value.get_ref().as_table()) else {
        return nowhere();
    };
    let keys = match parameter {
        None => Some(table),
        Some(_) => table.get("parameters").and_then(|value| value.get_ref().as_table()),
    };
    let key = parameter.unwrap_or("name");
    let Some((found, _)) = keys.and_then(|keys| keys.iter().find(|(name, _)| name.get_ref() == key)) else {
        return nowhere();
    };
    let (line, column) = line_and_column(text, found.span().start);
    nowhere().at(line, column).field(parameter.map_or("effect.name".to_owned(), |p| format!("effect.parameters.{p}")))
}

fn effect(section: &Section, mut other: toml::Table) -> Result<Effect, InputError> {
    let Some(name) = section.table.get("name") else {
        return Err(section.missing("name", "such as \"wheel-skew\""));
    };
    let Some(text) = name.get_ref().as_str() else {
        return Err(section.fault("name", name, "is no text", "such as \"wheel-skew\""));
    };
    let mut effect = Effect { name: text.to_owned(), ..Effect::default() };
    if let Some(value) = section.table.get("wheels") {
        let wheels = value
            .get_ref()
            .as_array()
            .and_then(|list| list.iter().map(|w| whole(w.get_ref()).and_then(|w| usize::try_from(w).ok())).collect());
        let Some(wheels) = wheels else {
            return Err(section.fault("wheels", value, "is no list of wheels", "such as [1, 3]"));
        };
        effect.wheels = wheels;
    }
    if let Some(value) = section.table.get("parameters") {
        let parameters = section.inner("parameters", value)?;
        let plain = other.remove("parameters");
        for (name, value) in parameters.in_file_order() {
            let key: &str = name.get_ref();
            if number(value.get_ref()).is_some() {
                let value = parameters.number(key, Range::Within(f64::MAX), "the estimate")?.unwrap_or(0.0);
                effect.parameters.push((key.to_owned(), EffectParameter { value, ..EffectParameter::default() }));
                continue;
            }
            let entry = parameters.inner(key, value)?;
            let Some(number) = entry.number("value", Range::Within(f64::MAX), "the estimate")? else {
                return Err(entry.missing("value", "the estimate"));
            };
            let ci95 = entry.numbers("ci95", Range::Within(f64::MAX))?;
            let mut rest =
                plain.as_ref().and_then(|p| p.get(key)).and_then(toml::Value::as_table).cloned().unwrap_or_default();
            rest.remove("value");
            rest.remove("ci95");
            let parameter = EffectParameter { value: number, ci95, other: rest };
            effect.parameters.push((key.to_owned(), parameter));
        }
    }
    other.remove("name");
    other.remove("wheels");
    let stray = section.in_file_order().into_iter().find(|(_, value)| number(value.get_ref()).is_some());
    if let (true, Some((key, value))) = (effect.parameters.is_empty(), stray) {
        let hint = "parameters of an effect stand in a table of their own: put [effect.parameters] above it";
        return Err(section.fault(key.get_ref(), value, "is no key of an effect", hint));
    }
    effect.other = other;
    Ok(effect)
}
