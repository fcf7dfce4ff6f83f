//! `racbot info`

use super::load::design;
use crate::card::CardOptions;
use crate::terminal::{Answer, Failure, entry};
use clap::Args;
use driver::fault_names;
use driver::load::{inspect, measure_clock};
use driver::pci::{Ids, SYSFS_DEVICES, Use, devices};
use serde_json::json;
use std::path::Path;
use std::time::Duration;

/// Options of `info`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    card: CardOptions,

    /// List every Mesa 4I65 and what looks like one; touch none
    #[arg(long)]
    list: bool,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        if self.list {
            return list();
        }
        let mut open = self.card.open(Use::Look)?;
        let about = |error: &dyn std::fmt::Display| Failure::data(format!("{}: {error}", open.name));
        let state = inspect(&mut open.card).map_err(|error| about(&error))?;
        let level = |high| if high { "high" } else { "low" };
        let mut text = format!(
            "card     {}, Mesa 4I65 ({})\nlines    DONE {}, INIT {}, PROGRAM {}\n",
            open.name,
            Ids::MESA_4I65,
            level(state.done),
            level(state.init),
            level(state.program)
        );
        let mut json = json!({
            "card": open.name, "done": state.done, "init": state.init, "program": state.program,
            "ready_enabled": state.ready_enabled, "other": state.other,
        });
        if let Some(identity) = &state.identity {
            let clock_hz = measure_clock(&mut open.card, Duration::from_millis(50)).map_err(|error| about(&error))?;
            text += &design(identity, clock_hz);
            let (status, faults) = (state.status.unwrap_or_default(), state.faults.unwrap_or_default());
            let armed = if status.armed { "armed" } else { "disarmed" };
            let stop = if status.emergency_stop { ", emergency stop" } else { "" };
            text += &entry("state", &format!("{armed}{stop}; faults {faults:#04x}: {}", fault_names(faults)));
            json["content_hash"] = format!("{:08x}", identity.content_hash).into();
            json["map_version"] = identity.version.into();
            json["axes"] = identity.axes.into();
            json["clock_hz"] = clock_hz.into();
            json["armed"] = status.armed.into();
            json["emergency_stop"] = status.emergency_stop.into();
            json["faults"] = faults.into();
        } else if let Some(other) = &state.other {
            text += &entry("design", &format!("none of ours: {other}"));
        } else {
            text += "design   none: the FPGA is not configured; racbot load FILE\n";
        }
        Ok(Answer { text, json, wrong: None })
    }
}

fn list() -> Result<Answer, Failure> {
    let devices = devices(Path::new(SYSFS_DEVICES)).map_err(Failure::data)?;
    let of = |ids: Ids| devices.iter().filter(move |slot| slot.ids == ids).map(|slot| slot.name.clone());
    let cards: Vec<String> = of(Ids::MESA_4I65).collect();
    let other: Vec<String> = of(Ids::MESA_5I20).collect();
    let mut text: String = cards.iter().map(|name| format!("{name}  Mesa 4I65\n")).collect();
    text.extend(other.iter().map(|name| format!("{name}  Mesa 5I20, not supported: same FPGA on other pins\n")));
    if text.is_empty() {
        text = format!("no Mesa card among {} PCI devices\n", devices.len());
    }
    Ok(Answer { text, json: json!({ "mesa_4i65": cards, "mesa_5i20": other, "devices": devices.len() }), wrong: None })
}
