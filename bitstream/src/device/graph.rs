//! The routing graph: from a wire through switches to others.

use super::{ClassPip, Device, PipId, PipKind, Tile, TileClass, TileId, WireId};

/// A way from a wire to another. A pass gate has two, one each way, with the same switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arc {
    /// Where it leads.
    pub to: WireId,
    /// Through which switch.
    pub pip: PipId,
}

/// A switch of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pip {
    /// Where the switch stands.
    pub tile: TileId,
    /// Wire that drives the switch.
    pub from: WireId,
    /// To this one; a gate leads both ways.
    pub to: WireId,
    /// How it is set, with attributes of the tile's class.
    pub kind: PipKind,
}

/// Arcs, sorted by the wire they leave.
#[derive(Debug)]
pub(super) struct Graph {
    first: Vec<u32>,
    arcs: Vec<Arc>,
    pips: u32,
}

impl Graph {
    pub(super) fn build(classes: &[TileClass], tiles: &[Tile], tile_wires: &[u32], wires: usize, pips: u32) -> Self {
        let mut first = vec![0u32; wires + 1];
        for_every_arc(classes, tiles, tile_wires, |from, _, _| first[from as usize + 1] += 1);
        for n in 0..wires {
            first[n + 1] += first[n];
        }
        let mut next = first.clone();
        let mut arcs = vec![Arc { to: WireId(0), pip: PipId(0) }; first[wires] as usize];
        for_every_arc(classes, tiles, tile_wires, |from, to, pip| {
            let slot = &mut next[from as usize];
            arcs[*slot as usize] = Arc { to: WireId(to), pip: PipId(pip) };
            *slot += 1;
        });
        Self { first, arcs, pips }
    }
}

fn for_every_arc(classes: &[TileClass], tiles: &[Tile], tile_wires: &[u32], mut visit: impl FnMut(u32, u32, u32)) {
    for tile in tiles {
        let wires = &tile_wires[tile.first_wire as usize..];
        for (n, pip) in classes[usize::from(tile.class)].pips.iter().enumerate() {
            let (from, to) = (wires[usize::from(pip.from)], wires[usize::from(pip.to)]);
            if from == u32::MAX || to == u32::MAX || from == to {
                continue;
            }
            let id = tile.first_pip + n as u32;
            visit(from, to, id);
            if matches!(pip.kind, PipKind::Gate { .. }) {
                visit(to, from, id);
            }
        }
    }
}

impl Device {
    /// Switches there are, those that lead nowhere included.
    #[must_use]
    pub fn pip_count(&self) -> usize {
        self.graph.pips as usize
    }

    /// Ways there are.
    #[must_use]
    pub fn arc_count(&self) -> usize {
        self.graph.arcs.len()
    }

    /// Ways that leave a wire.
    #[must_use]
    pub fn arcs(&self, wire: WireId) -> &[Arc] {
        let first = &self.graph.first[wire.0 as usize..];
        &self.graph.arcs[first[0] as usize..first[1] as usize]
    }

    /// A switch; none where the device ends on one of its sides.
    #[must_use]
    pub fn pip(&self, pip: PipId) -> Option<Pip> {
        let tile = TileId((self.tiles.partition_point(|tile| tile.first_pip <= pip.0) - 1) as u16);
        self.tile_pip(tile, pip.0 - self.tile(tile).first_pip)
    }

    /// The switch number `n` of a tile's class, in this tile.
    #[must_use]
    pub fn tile_pip(&self, tile: TileId, n: u32) -> Option<Pip> {
        let ClassPip { from, to, kind } = *self.class(tile).pips.get(n as usize)?;
        Some(Pip { tile, from: self.tile_wire(tile, from)?, to: self.tile_wire(tile, to)?, kind })
    }

    /// The number of a switch of a tile among all.
    #[must_use]
    pub fn pip_id(&self, tile: TileId, n: u32) -> PipId {
        PipId(self.tile(tile).first_pip + n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// The figures of an independent count over the same table.
    #[test]
    fn the_graph_has_its_size() {
        let device = Device::xc2s200();
        let mut kinds: HashMap<&str, usize> = HashMap::new();
        for n in 0..device.pip_count() as u32 {
            let Some(pip) = device.pip(PipId(n)) else { continue };
            if pip.from != pip.to {
                let name = match pip.kind {
                    PipKind::Mux { .. } => "mux",
                    PipKind::Buffer { .. } => "buffer",
                    PipKind::Switch { .. } => "switch",
                    PipKind::Gate { .. } => "gate",
                    PipKind::Joined => "joined",
                };
                *kinds.entry(name).or_default() += 1;
            }
        }
        assert_eq!((kinds["mux"], kinds["switch"], kinds["gate"]), (1_210_196, 196_672, 169_344), "{kinds:?}");
        assert_eq!(device.arc_count(), kinds.values().sum::<usize>() + kinds["gate"]);
    }

    #[test]
    fn a_gate_leads_both_ways() {
        let device = Device::xc2s200();
        let wire = device.wire_at(5, 5, "SINGLE_E[0]").expect("a wire");
        let gates = device.arcs(wire).iter().filter_map(|arc| Some((arc, device.pip(arc.pip)?)));
        let mut seen = 0;
        for (arc, pip) in gates.filter(|(_, pip)| matches!(pip.kind, PipKind::Gate { .. })) {
            assert!(device.arcs(arc.to).iter().any(|back| back.pip == arc.pip && back.to == wire));
            assert!(pip.from == wire || pip.to == wire);
            seen += 1;
        }
        assert!(seen > 0);
    }
}
