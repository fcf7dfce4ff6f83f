//! Bit-true twin of the safety block: watchdog, arm sequence, emergency stop, fault registers.
//!
//! One [`Safety::clock`] is one rising edge of the FPGA clock; the outputs are those that hold
//! until the next edge. The all-zero state is the safe one: stopped, bitten, disarmed.
//!
//! Clocks from a cause to `armed` low, counting the edge that first sees the cause as the first:
//!
//! | cause | edges |
//! |---|---|
//! | a write to the arm register | 1 |
//! | `encoder_fault`, `stall_fault`, `external_fault` | 1 |
//! | no pet: after the edge of the last one | timeout + 1 |
//! | emergency stop pin | [`EMERGENCY_STOP_CLOCKS`] |
//!
//! Set points time out before the watchdog bites: at the `set_point_timeout`-th control tick after a
//! pet `setpoints_valid` falls, the wheels are to stand, and the outputs stay armed.
//!
//! What keeps from arming is the cause itself, as long as it stands: [`Fault::disarms`]. A sticky bit whose
//! cause is gone does not, nor do the two faults that only report.

use crate::encoder::GlitchFilter;

/// First word of the arm sequence, `ARM1` in ASCII.
pub const ARM_FIRST: u32 = u32::from_be_bytes(*b"ARM1");
/// Second word of the arm sequence, `ARM2` in ASCII.
pub const ARM_SECOND: u32 = u32::from_be_bytes(*b"ARM2");

/// Filter setting of the emergency stop input: it must hold for 16 clocks, either way.
pub const EMERGENCY_STOP_FILTER: u8 = 15;
/// Edges from the first that samples the stop level to the one that switches off.
pub const EMERGENCY_STOP_CLOCKS: u32 = 2 + EMERGENCY_STOP_FILTER as u32 + 1 + 1;

/// Width mask of the watchdog time-out.
pub const TIMEOUT_MASK: u32 = 0x00FF_FFFF;

/// Bits of the fault registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// No valid set point for longer than the time-out. Disarms.
    Watchdog = 0,
    /// The emergency stop input is high or open. Disarms.
    EmergencyStop = 1,
    /// An encoder is broken. Disarms.
    Encoder = 2,
    /// A commit whose checksum was wrong; reported only, since nothing was taken over.
    CommitChecksum = 3,
    /// Link loss or another block's fault. Disarms.
    External = 4,
    /// A second arm word out of order or while a fault stood; reported only.
    ArmRefused = 5,
    /// A driven wheel does not move. Disarms.
    Stall = 6,
}

impl Fault {
    /// Every fault, in the order of its bit.
    pub const ALL: [Self; 7] = [
        Self::Watchdog,
        Self::EmergencyStop,
        Self::Encoder,
        Self::CommitChecksum,
        Self::External,
        Self::ArmRefused,
        Self::Stall,
    ];

    /// The fault's bit in the registers.
    #[must_use]
    pub const fn mask(self) -> u8 {
        1 << self as u8
    }

    const fn when(self, condition: bool) -> u8 {
        if condition { self.mask() } else { 0 }
    }

    /// Whether the fault switches the outputs off and keeps them from being armed.
    #[must_use]
    pub const fn disarms(self) -> bool {
        !matches!(self, Self::CommitChecksum | Self::ArmRefused)
    }
}

/// Pins, strobes and registers the block sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Raw pin: high or open = stop.
    pub emergency_stop: bool,
    /// Strobe: the arm register is written.
    pub arm_write: bool,
    /// What is written to it.
    pub arm_data: u32,
    /// Strobe: a valid set point was committed.
    pub pet: bool,
    /// Clocks a pet lasts, 24 bits; 0 = always bitten. A shorter one takes effect two clocks later.
    pub watchdog_timeout: u32,
    /// Level: an encoder is broken.
    pub encoder_fault: bool,
    /// Level: a driven wheel does not move.
    pub stall_fault: bool,
    /// Strobe: a commit with a wrong checksum.
    pub commit_fault: bool,
    /// Level: link loss or another block's fault.
    pub external_fault: bool,
    /// Strobe: bits to clear in both fault registers; what still stands appears again at the same clock.
    pub clear_faults: u8,
    /// Strobe: a control tick.
    pub tick: bool,
    /// Control ticks a set point lasts, 16 bits; 0 = none at all.
    pub set_point_timeout: u16,
}

/// Outputs of the block after a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The outputs of the card may be on.
    pub armed: bool,
    /// `armed` is low after the next clock, if the inputs stay as they are.
    pub stops: bool,
    /// Not `armed`.
    pub off: bool,
    /// A set point has come since arming and has not timed out.
    pub setpoints_valid: bool,
    /// Sticky faults, bits as in [`Fault`].
    pub faults: u8,
    /// Those that came first and have not been cleared since.
    pub first_fault: u8,
    /// The emergency stop stands, synchronised and filtered.
    pub stopped: bool,
}

impl Default for Outputs {
    /// Those from configuration to the first clock.
    fn default() -> Self {
        Self { armed: false, stops: true, off: true, setpoints_valid: false, faults: 0, first_fault: 0, stopped: true }
    }
}

/// State of the safety block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Safety {
    /// Filters the inverted pin, so that the power-up state is "stopped".
    released: GlitchFilter,
    remaining: u32,
    /// The time-out was below `remaining` a clock ago.
    shortened: bool,
    /// Control ticks since the last pet; stops at the time-out.
    age: u16,
    first_word: bool,
    outputs: Outputs,
}

impl Safety {
    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let timeout = inputs.watchdog_timeout & TIMEOUT_MASK;
        self.released.clock(!inputs.emergency_stop, true, EMERGENCY_STOP_FILTER, false);
        self.shortened = before.remaining > timeout;
        self.remaining = if inputs.pet || before.shortened { timeout } else { before.remaining.saturating_sub(1) };

        let stale = before.age >= inputs.set_point_timeout;
        if inputs.pet {
            self.age = 0;
        } else if inputs.tick && !stale {
            self.age = before.age + 1;
        }

        let armed = before.stays_armed(inputs);
        let refused = inputs.arm_write && inputs.arm_data == ARM_SECOND && !armed;
        let word = if inputs.arm_write { inputs.arm_data == ARM_FIRST } else { before.first_word };
        self.first_word = word && !before.standing(inputs);
        self.outputs.armed = armed;
        self.outputs.off = !armed;
        self.outputs.stops = !self.stays_armed(inputs);
        let kept = before.outputs.setpoints_valid && !stale;
        self.outputs.setpoints_valid = self.outputs.armed && (kept || (before.outputs.armed && inputs.pet));
        self.outputs.stopped = !self.released.value;

        let events = Fault::Watchdog.when(before.remaining == 0)
            | Fault::EmergencyStop.when(!before.released.value)
            | Fault::Encoder.when(inputs.encoder_fault)
            | Fault::CommitChecksum.when(inputs.commit_fault)
            | Fault::External.when(inputs.external_fault)
            | Fault::ArmRefused.when(refused)
            | Fault::Stall.when(inputs.stall_fault);
        self.outputs.faults = (before.outputs.faults & !inputs.clear_faults) | events;
        self.outputs.first_fault = match before.outputs.first_fault & !inputs.clear_faults {
            0 => events,
            first => first,
        };
        self.outputs
    }

    /// Whether something keeps the outputs off at the next clock.
    fn standing(&self, inputs: &Inputs) -> bool {
        let broken = inputs.encoder_fault || inputs.stall_fault || inputs.external_fault;
        self.remaining == 0 || !self.released.value || broken || self.shortened
    }

    /// Whether the outputs are armed after the next clock.
    fn stays_armed(&self, inputs: &Inputs) -> bool {
        let asked =
            if inputs.arm_write { inputs.arm_data == ARM_SECOND && self.first_word } else { self.outputs.armed };
        asked && !self.standing(inputs)
    }

    /// The outputs after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }

    /// `clocks` clocks with the same inputs, strobes low; equal to as many calls of [`Self::clock`].
    pub fn advance(&mut self, inputs: &Inputs, clocks: u32) {
        let mut left = clocks;
        while left > 0 {
            let before = *self;
            self.clock(inputs);
            left -= 1;
            if *self == before {
                return;
            }
            // Where a clock has moved nothing but the watchdog, so will those until it bites.
            let counted = Self { remaining: before.remaining.saturating_sub(1), ..before };
            if *self == counted {
                let skipped = left.min(self.remaining.saturating_sub(1));
                self.remaining -= skipped;
                left -= skipped;
            }
        }
    }
}

#[cfg(test)]
mod tests;
