//! rust-hdl's Verilog made readable, in one step.
//!
//! rust-hdl writes one module an instance, all under `top`, with `$` in most names. Here:
//!
//! | rust-hdl | emitted |
//! |---|---|
//! | `top$core$pwm$0`, `top$core$pwm$1`, … with equal text | one module `rac4i65_core_pwm` |
//! | the same with different constants | `rac4i65_core_pwm_0`, `rac4i65_core_pwm_1` |
//! | a module for every flip-flop | `rac4i65_dff_16`: one for every width and start value |
//! | `pwm$0$clock` | `pwm_0_clock` |
//! | port list, then declarations | one header with the declarations |
//! | constants of enums nobody uses here | gone |
//! | a pin that only repeats a signal | that signal |
//! | one `always @(*)` for a whole `update` | one for each group of signals that need each other |
//!
//! Parents come before their parts, flip-flops last. The text is Verilog-2001 and the same on every
//! run. Names are replaced token by token; two names that would fall together are kept apart by a
//! number.

use super::module::{Module, split};
use rust_hdl::prelude::{Block, generate_verilog};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The whole file for one block: head, modules, tail.
///
/// # Panics
/// If rust-hdl finds the block badly connected: an open input, a latch or a loop.
#[must_use]
pub fn emit<B: Block>(block: &B, name: &str) -> String {
    file(name, &[&modules(block, name)])
}

/// The modules of a block, whose own is called `name`, without head and tail.
///
/// # Panics
/// If rust-hdl finds the block badly connected: an open input, a latch or a loop.
#[must_use]
pub fn modules<B: Block>(block: &B, name: &str) -> String {
    rename(&generate_verilog(block), name)
}

/// A file from parts: says what it is, and forbids undeclared nets inside.
#[must_use]
pub fn file(name: &str, parts: &[&str]) -> String {
    let map = fixed_kin::registers::VERSION;
    let (major, minor) = (map >> 16, map & 0xffff);
    format!(
        "// {name}\n\
         // Written from the rust-hdl sources in hdl/src; register map {major}.{minor}.\n\
         // Do not edit: change the sources and run `racbot generate`.\n\n\
         `default_nettype none\n\n{}\n`default_nettype wire\n",
        parts.join("\n")
    )
}

/// Renames and merges what `generate_verilog` wrote.
#[must_use]
pub fn rename(text: &str, top: &str) -> String {
    let modules = split(text);
    let names = plain_names(&modules);
    let order = parts_first(&modules);
    let merged = merge(&modules, &order, &names);
    let titles = titles(&modules, &merged, top);
    let mut written = HashSet::new();
    let (mut blocks, mut flip_flops) = (Vec::new(), Vec::new());
    for index in order.iter().rev() {
        let representative = merged[index];
        if written.insert(representative) {
            let module = &modules[representative];
            let child = |raw: &str| titles[&merged[&position(&modules, raw)]].clone();
            let text = module.render(&titles[&representative], &names, &child);
            match module.flip_flop() {
                Some((width, kind)) => flip_flops.push((width, kind, text)),
                None => blocks.push(text),
            }
        }
    }
    flip_flops.sort();
    blocks.extend(flip_flops.into_iter().map(|(_, _, text)| text));
    blocks.join("\n")
}

fn position(modules: &[Module], raw: &str) -> usize {
    modules
        .iter()
        .position(|m| m.name == raw)
        .unwrap_or_else(|| panic!("rust-hdl instantiates `{raw}` without defining it"))
}

/// New names without `$`, no two the same, for every identifier of the text.
fn plain_names<'a>(modules: &[Module<'a>]) -> BTreeMap<&'a str, String> {
    let all: BTreeSet<&str> = modules.iter().flat_map(Module::identifiers).collect();
    let mut taken: BTreeSet<String> = all.iter().filter(|n| !n.contains('$')).map(|n| (*n).to_owned()).collect();
    let mut names = BTreeMap::new();
    for raw in all.iter().filter(|n| n.contains('$')) {
        let name = unique(&raw.replace('$', "_"), &mut taken);
        names.insert(*raw, name);
    }
    names
}

/// `wish`, or `wish_2`, `wish_3`, …: the first that is free.
fn unique(wish: &str, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|n| format!("{wish}_{n}"));
    let free = std::iter::once(wish.to_owned()).chain(numbered).find(|n| !taken.contains(n));
    let name = free.unwrap_or_default();
    taken.insert(name.clone());
    name
}

/// Every module after the modules it is made of; read backwards, parents before parts in the order
/// in which they are instantiated.
fn parts_first(modules: &[Module]) -> Vec<usize> {
    fn visit(modules: &[Module], index: usize, seen: &mut HashSet<usize>, order: &mut Vec<usize>) {
        if seen.insert(index) {
            for child in modules[index].children().iter().rev() {
                visit(modules, position(modules, child), seen, order);
            }
            order.push(index);
        }
    }
    let (mut seen, mut order) = (HashSet::new(), Vec::new());
    if !modules.is_empty() {
        visit(modules, position(modules, "top"), &mut seen, &mut order);
    }
    order
}

/// For every module the one that stands for it: the first with the same text.
fn merge(modules: &[Module], order: &[usize], names: &BTreeMap<&str, String>) -> HashMap<usize, usize> {
    let mut by_text: HashMap<String, usize> = HashMap::new();
    let mut merged: HashMap<usize, usize> = HashMap::new();
    for index in order {
        let child = |raw: &str| format!("part {}", merged[&position(modules, raw)]);
        let text = modules[*index].render("", names, &child);
        let first = *by_text.entry(text).or_insert(*index);
        merged.insert(*index, first);
    }
    merged
}

/// A name for every module that stands for one or more.
fn titles(modules: &[Module], merged: &HashMap<usize, usize>, top: &str) -> BTreeMap<usize, String> {
    let mut groups: BTreeMap<usize, Vec<Vec<&str>>> = BTreeMap::new();
    let mut members: Vec<_> = merged.iter().collect();
    members.sort();
    for (member, representative) in members {
        let path = modules[*member].name.split('$').skip(1).collect();
        groups.entry(*representative).or_default().push(path);
    }
    let mut taken = BTreeSet::from([top.to_owned()]);
    // Singles have a claim to their own path, so they choose first.
    let mut order: Vec<_> = groups.iter().collect();
    order.sort_by_key(|(representative, paths)| (paths.len() > 1, **representative));
    let mut titles = BTreeMap::new();
    for (representative, paths) in order {
        let title = if paths[0].is_empty() {
            top.to_owned()
        } else if let Some((_, kind)) = modules[*representative].flip_flop() {
            unique(&format!("{top}_{kind}"), &mut taken)
        } else {
            unique(&format!("{top}_{}", common(paths)), &mut taken)
        };
        titles.insert(*representative, title);
    }
    titles
}

/// What instances with these paths have in common: their path without array indices, else their
/// last name, else the first one's path without indices.
fn common(paths: &[Vec<&str>]) -> String {
    if paths.len() == 1 {
        return paths[0].join("_");
    }
    let is_name = |part: &&&str| part.parse::<u32>().is_err();
    let bare = |path: &Vec<&str>| path.iter().filter(is_name).copied().collect::<Vec<_>>().join("_");
    let last = |path: &Vec<&str>| path.iter().rfind(is_name).map_or_else(String::new, |n| (*n).to_owned());
    let same = |of: &dyn Fn(&Vec<&str>) -> String| {
        let first = of(&paths[0]);
        paths.iter().all(|path| of(path) == first).then_some(first)
    };
    same(&bare).or_else(|| same(&last)).unwrap_or_else(|| bare(&paths[0]))
}
