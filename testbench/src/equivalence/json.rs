//! A module as yosys writes it (`write_json`): nets are numbers, and every name of a net leads to its number.

use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};

/// What stands at a pin: the number of a net, or a constant `0`, `1`, `x`.
#[derive(Clone, Debug, Deserialize, Eq, Hash, Ord, PartialEq, PartialOrd)]
#[serde(untagged)]
pub(super) enum Bit {
    Net(u64),
    Constant(String),
}

#[derive(Debug, Deserialize)]
pub(super) struct Port {
    pub(super) direction: String,
    pub(super) bits: Vec<Bit>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Cell {
    #[serde(rename = "type")]
    pub(super) kind: String,
    #[serde(default)]
    pub(super) parameters: BTreeMap<String, String>,
    pub(super) connections: BTreeMap<String, Vec<Bit>>,
}

#[derive(Debug, Deserialize)]
struct NetName {
    bits: Vec<Bit>,
    #[serde(default)]
    attributes: BTreeMap<String, String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Module {
    pub(super) ports: BTreeMap<String, Port>,
    pub(super) cells: BTreeMap<String, Cell>,
    netnames: BTreeMap<String, NetName>,
}

#[derive(Debug, Deserialize)]
struct File {
    modules: BTreeMap<String, Module>,
}

/// `name`, or `name[index]` where there are more bits than one.
pub(super) fn indexed(name: &str, index: usize, width: usize) -> String {
    if width == 1 { name.to_owned() } else { format!("{name}[{index}]") }
}

impl Module {
    /// The module of this name.
    pub(super) fn parse(text: &str, top: &str) -> Result<Self, String> {
        let mut file: File = serde_json::from_str(text).map_err(|error| format!("not the JSON of yosys: {error}"))?;
        file.modules.remove(top).ok_or_else(|| format!("no module {top} in the JSON of yosys"))
    }

    /// Every name of every net, with what it stands for.
    pub(super) fn names(&self) -> impl Iterator<Item = (String, &Bit)> {
        self.netnames.iter().flat_map(|(name, net)| {
            net.bits.iter().enumerate().map(|(index, bit)| (indexed(name, index, net.bits.len()), bit))
        })
    }

    /// Start values that the source gives, by net.
    pub(super) fn starts(&self) -> HashMap<&Bit, bool> {
        let said = |net: &'_ NetName| net.attributes.get("init").cloned().unwrap_or_default();
        let bits = self.netnames.values().flat_map(|net| net.bits.iter().zip(said(net).into_bytes().into_iter().rev()));
        bits.filter(|(_, value)| *value != b'x').map(|(bit, value)| (bit, value == b'1')).collect()
    }
}
