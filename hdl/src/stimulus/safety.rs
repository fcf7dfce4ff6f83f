//! Stimulus for the safety block: arming that succeeds, and everything that ends it.

use super::{columns, generator};
use crate::blocks::safety::Safety;
use crate::sim::cycle;
use fixed_kin::safety::{ARM_FIRST, ARM_SECOND, Inputs, Outputs, TIMEOUT_MASK};
use rand::RngExt;
use rust_hdl::prelude::*;

columns!(Inputs {
    emergency_stop,
    arm_write,
    arm_data,
    pet,
    watchdog_timeout,
    encoder_fault,
    stall_fault,
    commit_fault,
    external_fault,
    clear_faults,
    tick,
    set_point_timeout,
});
columns!(Outputs { armed, stops, off, setpoints_valid, faults, first_fault, stopped });

/// The rust-hdl block, fresh from configuration: one call is one clock.
pub fn hardware() -> impl FnMut(&Inputs) -> Outputs {
    let mut block = Safety::default();
    block.connect_all();
    move |inputs| {
        block.emergency_stop.next = inputs.emergency_stop;
        block.arm_write.next = inputs.arm_write;
        block.arm_data.next = inputs.arm_data.to_bits();
        block.pet.next = inputs.pet;
        block.watchdog_timeout.next = inputs.watchdog_timeout.to_bits();
        block.encoder_fault.next = inputs.encoder_fault;
        block.stall_fault.next = inputs.stall_fault;
        block.tick.next = inputs.tick;
        block.set_point_timeout.next = inputs.set_point_timeout.to_bits();
        block.commit_fault.next = inputs.commit_fault;
        block.external_fault.next = inputs.external_fault;
        block.clear_faults.next = inputs.clear_faults.to_bits();
        cycle(&mut block, |b, level| b.clock.next = level.into());
        Outputs {
            armed: block.armed.val(),
            stops: block.stops.val(),
            off: block.off.val(),
            setpoints_valid: block.setpoints_valid.val(),
            faults: block.faults.val().to_u8(),
            first_fault: block.first_fault.val().to_u8(),
            stopped: block.stopped.val(),
        }
    }
}

/// Segments of random length, each with its own time-out, petting, disturbances and arming.
#[must_use]
pub fn stimulus(seed: u64, clocks: usize) -> Vec<Inputs> {
    let mut random = generator(seed);
    let mut rows = Vec::with_capacity(clocks);
    let mut arm_step = 0;
    while rows.len() < clocks {
        let watchdog_timeout = match random.random_range(0..8) {
            0 => 0,
            1 => 1,
            2 => TIMEOUT_MASK,
            3 => random.random_range(0..=TIMEOUT_MASK),
            _ => random.random_range(2..300),
        };
        // Around the time-out, where a pet is just in time or just too late; at least one a clock.
        let pet_interval = match random.random_range(0..4) {
            0 => 1,
            1 => u32::MAX,
            _ => (watchdog_timeout + random.random_range(0..3)).clamp(1, 400),
        };
        let stop_of_256 = [0, 0, 0, 0, 40, 250, 256][random.random_range(0..7)];
        let fault_of_4096 = [0, 0, 0, 1, 10, 400][random.random_range(0..6)];
        let set_point_timeout = [0, 1, 2, 5, 30, u16::MAX][random.random_range(0..6)];
        let ticking = [1, 3, 20][random.random_range(0..3)];
        let arming = [2, 5, 40][random.random_range(0..3)];
        let wrong_of_16 = [0, 0, 1, 8][random.random_range(0..4)];
        let mut stop = 0;
        for clock in 0..random.random_range(1..800_u32) {
            // Runs of the stop level around the length of the filter.
            if stop == 0 && random.random_range(0..256) < stop_of_256 {
                stop = random.random_range(1..40);
            }
            let emergency_stop = stop > 0;
            stop = u32::saturating_sub(stop, 1);
            let arm_write = random.random_range(0..arming) == 0 && random.random_range(0..8) != 0;
            let mut arm_data = random.random();
            if random.random_range(0..16) >= wrong_of_16 {
                arm_data = if arm_step % 2 == 0 { ARM_FIRST } else { ARM_SECOND };
                arm_step += u32::from(arm_write);
            } else if random.random() {
                arm_data = ARM_SECOND ^ 1 << random.random_range(0..32);
            }
            // Once on, mostly left on.
            let arm_write = arm_write && (arm_step % 32 != 0 || random.random_range(0..400) == 0);
            let mut fault = || random.random_range(0..4_096) < fault_of_4096;
            rows.push(Inputs {
                emergency_stop,
                arm_write,
                arm_data,
                pet: clock % pet_interval == 0,
                watchdog_timeout,
                encoder_fault: fault(),
                stall_fault: fault(),
                commit_fault: fault(),
                external_fault: fault(),
                clear_faults: match random.random_range(0..200) {
                    0 => u8::MAX,
                    1 => random.random(),
                    _ => 0,
                },
                tick: clock % ticking == 0,
                set_point_timeout,
            });
        }
    }
    rows.truncate(clocks);
    rows
}
