//! The placed design as a picture: slices and memories coloured by block, pads, the path with the least slack.

use super::build::Built;
use super::nets::{Part, Routed};
use super::pack::Slice;
use super::place::MEMORY_SITES;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Size of a tile in the picture, in px.
const TILE: u32 = 18;
/// Tiles of the device, across and up.
const GRID: (u32, u32) = (46, 30);
/// Room for the legend, in px.
const LEGEND: u32 = 220;
/// Blocks that get a colour of their own; the others share grey.
const COLOURED: usize = 14;
/// Colours that people with colour blindness tell apart as far as fourteen can be.
const COLOURS: [&str; COLOURED] = [
    "#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#ee7733", "#009988", "#882255", "#999933",
    "#332288", "#ddaa33", "#88ccee", "#cc6677",
];

/// The picture as SVG.
#[must_use]
pub fn svg(built: &Built) -> String {
    let mut blocks: BTreeMap<String, usize> = BTreeMap::new();
    let mut tenants = Vec::new();
    for (column, slices) in built.packed.columns.iter().enumerate() {
        for (row, slice) in slices.slices.iter().enumerate() {
            let block = block_of(built, slice);
            *blocks.entry(block.clone()).or_default() += 1;
            tenants.push((column, row, block));
        }
    }
    let mut ranked: Vec<(usize, String)> = blocks.into_iter().map(|(name, slices)| (slices, name)).collect();
    ranked.sort_by(|one, other| other.0.cmp(&one.0).then_with(|| one.1.cmp(&other.1)));
    let colour = |name: &str| {
        let rank = ranked.iter().position(|(_, other)| other == name).unwrap_or(COLOURED);
        COLOURS.get(rank).copied().unwrap_or("#bbbbbb")
    };
    let (width, height) = (GRID.0 * TILE + LEGEND, GRID.1 * TILE);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n\
         <rect width=\"{}\" height=\"{height}\" fill=\"#f2f2f2\"/>\n",
        GRID.0 * TILE
    );
    for (column, row, block) in &tenants {
        let site = built.placement.columns[*column];
        let (x, y) = corner(site.column, site.row + *row as u8);
        let x = x + u32::from(site.slice) * TILE / 2;
        rectangle(&mut svg, (x, y), (TILE / 2 - 1, TILE - 1), colour(block));
    }
    for site in &built.placement.memories {
        let (column, row) = MEMORY_SITES[*site];
        let (x, y) = corner(column, row + 3);
        rectangle(&mut svg, (x, y), (TILE - 1, 4 * TILE - 1), "#777777");
    }
    for (column, row) in &built.placement.pads {
        let (x, y) = corner(*column, *row);
        rectangle(&mut svg, (x + 4, y + 4), (TILE - 9, TILE - 9), "#222222");
    }
    path(&mut svg, built);
    legend(&mut svg, &ranked, colour);
    svg.push_str("</svg>\n");
    svg
}

/// Upper left corner of a tile.
fn corner(column: u8, row: u8) -> (u32, u32) {
    (u32::from(column) * TILE, (GRID.1 - 1 - u32::from(row)) * TILE)
}

fn rectangle(svg: &mut String, at: (u32, u32), size: (u32, u32), fill: &str) {
    let ((x, y), (width, height)) = (at, size);
    let _ = writeln!(svg, "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>");
}

/// The block that most of a slice's nets are named after: two levels of the hierarchy.
fn block_of(built: &Built, slice: &Slice) -> String {
    let mut votes: BTreeMap<String, usize> = BTreeMap::new();
    let outputs = slice.sources().into_iter().map(|(_, net)| net);
    for net in outputs.chain(slice.sinks().into_iter().map(|(_, net)| net)) {
        if let Some(name) = block(&built.logic.nets[net.index()]) {
            *votes.entry(name).or_default() += 1;
        }
    }
    let best = votes.iter().max_by_key(|(name, votes)| (**votes, std::cmp::Reverse((*name).clone())));
    best.map_or_else(|| "other".to_owned(), |(name, _)| name.clone())
}

fn block(net: &str) -> Option<String> {
    let mut levels = net.split('.');
    let (top, block) = (levels.next()?, levels.next()?);
    (!top.starts_with('$') && levels.next().is_some()).then(|| format!("{top}.{block}"))
}

/// The path with the least slack, by its share of the period, as a line through the parts that it visits.
fn path(svg: &mut String, built: &Built) {
    let worst = built.timing.domains.iter().filter_map(|domain| Some((domain.worst.first()?, domain.period)));
    let worst = worst.max_by_key(|(path, period)| u64::from(path.delay) * 1_000 / u64::from(*period));
    let Some((worst, _)) = worst else { return };
    let by_net: BTreeMap<_, &Routed> = built.nets.general.iter().map(|routed| (routed.net, routed)).collect();
    let mut firsts = Vec::new();
    let mut first = 0;
    for routed in &built.nets.general {
        firsts.push(first);
        first += routed.sinks.len();
    }
    let mut points = Vec::new();
    let mut add = |part: Part| {
        let (column, row) = built.placement.at(part);
        let (x, y) = corner(column, row);
        points.push(format!("{},{}", x + TILE / 2, y + TILE / 2));
    };
    for step in &worst.steps {
        step.net.and_then(|net| by_net.get(&net)).into_iter().for_each(|routed| add(routed.source.part));
        if let Some(connection) = step.connection.map(|connection| connection as usize) {
            let net = firsts.partition_point(|first| *first <= connection) - 1;
            add(built.nets.general[net].sinks[connection - firsts[net]].part);
        }
    }
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#000000\" stroke-width=\"2\" stroke-linejoin=\"round\"/>",
        points.join(" ")
    );
}

fn legend(svg: &mut String, ranked: &[(usize, String)], colour: impl Fn(&str) -> &'static str) {
    let x = GRID.0 * TILE + 12;
    let mut line = |row: u32, fill: &str, text: &str| {
        rectangle(svg, (x, 10 + row * 20), (12, 12), fill);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\">{text}</text>", x + 20, 20 + row * 20);
    };
    let mut row = 0;
    for (slices, name) in ranked.iter().take(COLOURED) {
        line(row, colour(name), &format!("{name}: {slices} slices"));
        row += 1;
    }
    let rest: usize = ranked.iter().skip(COLOURED).map(|(slices, _)| slices).sum();
    if rest > 0 {
        line(row, "#bbbbbb", &format!("other blocks: {rest} slices"));
    }
    line(row + 1, "#777777", "block memories");
    line(row + 2, "#222222", "pads");
    line(row + 3, "#000000", "the path with the least slack: the line");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_two_levels_of_a_name() {
        assert_eq!(block("core.bus.offer.q"), Some("core.bus".into()));
        assert_eq!(block("core.tick"), None);
        assert_eq!(block("$abc$1.genblk1.f0"), None);
    }
}
