//! Stimulus for the radio block: frames, most of them whole, on a line that is not always kind.

use super::{columns, generator};
use crate::blocks::radio::RadioAt;
use crate::sim::cycle;
use fixed_kin::radio::{Frame, GAP_BYTES, HEAD, Inputs, LONGEST_FRAME, Outputs, offset_of};
use rand::{Rng, RngExt};
use rust_hdl::prelude::*;

columns!(Inputs { rx, host_select, robot, armed, taken, select_write, select });
columns!(Outputs { offer, address, data, selected, accepted, dropped });

/// Clocks a bit here: fewer than on the real line, so that many frames fit a simulation.
pub const CLOCKS_PER_BIT: u16 = 6;

/// The block at that rate.
pub type Radio = RadioAt<2, 5>;

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Radio::default();
    block.connect_all();
    move |inputs| {
        block.rx.next = inputs.rx;
        block.host_select.next = inputs.host_select;
        block.robot.next = inputs.robot.to_bits();
        block.armed.next = inputs.armed;
        block.taken.next = inputs.taken;
        block.select_write.next = inputs.select_write;
        block.select.next = inputs.select;
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs {
            offer: block.offer.val(),
            address: block.address.val().to_u16(),
            data: block.data.val().to_u32(),
            selected: block.selected.val(),
            accepted: block.accepted.val().to_u8(),
            dropped: block.dropped.val().to_u8(),
        }
    }
}

/// One frame, damaged in one of many ways or not at all.
fn frame(random: &mut impl Rng, robot: u8, sequence: &mut u8) -> Vec<u8> {
    let to = if random.random_range(0..16) == 0 { random.random_range(0..16) } else { robot };
    *sequence = match random.random_range(0..16) {
        0 => *sequence,
        1 => random.random(),
        _ => sequence.wrapping_add(1),
    };
    let mut frame = Frame::new(to, *sequence).expect("a robot below 16");
    let writes = if random.random_range(0..60) == 0 { 95 } else { random.random_range(1..9) };
    for _ in 0..writes {
        let offset = offset_of(random.random_range(0..192));
        frame.write(offset, random.next_u32()).expect("at most 95 writes");
    }
    let mut bytes = frame.bytes().to_vec();
    let at = random.random_range(0..bytes.len());
    match random.random_range(0..20) {
        0 => bytes[at] ^= 1 << random.random_range(0..8),
        1 => bytes.truncate(at),
        2 => drop(bytes.remove(at)),
        3 => bytes.insert(at, bytes[at]),
        4 => bytes.push(random.random()),
        5 => bytes[0] = [HEAD ^ 3, random.random()][random.random_range(0..2)],
        6 => bytes[2] = [0, 96, 95, random.random()][random.random_range(0..4)],
        7 => bytes = (0..random.random_range(1..LONGEST_FRAME / 8)).map(|_| random.random()).collect(),
        _ => {}
    }
    bytes
}

/// Frames with gaps around the least one, in runs with their own noise, strap and arming.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    const BIT: usize = CLOCKS_PER_BIT as usize;
    let mut random = generator(seed);
    let robot = random.random_range(0..16);
    let mut rows: Vec<Inputs> = Vec::with_capacity(clocks);
    let mut sequence = 0;
    let (mut armed, mut selecting) = (false, true);
    while rows.len() < clocks {
        let bytes = frame(&mut random, robot, &mut sequence);
        let mut levels = Vec::with_capacity(bytes.len() * 10 * BIT);
        for byte in bytes {
            let bits = u32::from(byte) << 1 | 1 << 9;
            levels.extend((0..10).flat_map(|bit| [bits >> bit & 1 == 1; BIT]));
            if random.random_range(0..30) == 0 {
                // A pause inside the frame, now and then long enough to end it.
                let pause = random.random_range(0..GAP_BYTES as usize * 10 * BIT + 8);
                levels.extend(std::iter::repeat_n(true, pause));
            }
        }
        match random.random_range(0..12) {
            // A line that bounces, one that is cut, one that was never driven.
            0 => (0..4).for_each(|_| {
                let at = random.random_range(0..levels.len().max(1));
                levels.iter_mut().skip(at).take(random.random_range(1..2 * BIT)).for_each(|level| *level = !*level);
            }),
            1 => levels.truncate(random.random_range(0..=levels.len())),
            2 => levels.iter_mut().for_each(|level| *level = false),
            _ => {}
        }
        let gap = GAP_BYTES as usize * 10 * BIT;
        let gap =
            if random.random_range(0..8) == 0 { random.random_range(0..gap) } else { gap + random.random_range(0..20) };
        levels.extend(std::iter::repeat_n(true, gap));
        armed = if random.random_range(0..6) == 0 { !armed } else { armed };
        let taking = [1, 1, 3, 40][random.random_range(0..4)];
        for rx in levels {
            let select_write = random.random_range(0..4_000) == 0;
            selecting = if select_write { random.random_range(0..4) != 0 } else { selecting };
            rows.push(Inputs {
                rx,
                host_select: seed.is_multiple_of(2),
                robot,
                armed,
                taken: random.random_range(0..taking) == 0,
                select_write,
                select: selecting,
            });
        }
    }
    rows.truncate(clocks);
    rows
}
