//! Bit-true twin of the interrupt block: two causes, their enables, one line to the bridge.
//!
//! A cause is set by its event and stays until cleared, enabled or not; a new event at the clock of
//! the clearing wins, so none is lost. The line is low while an enabled cause is set; it is a level,
//! so that an interrupt that comes while another is being served is not lost either.

/// What the block sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Strobe: a control tick has ended.
    pub done: bool,
    /// Level: the outputs may be on.
    pub armed: bool,
    /// Enabled causes, bits of `interrupt_status`.
    pub enable: u8,
    /// Causes to clear.
    pub clear: u8,
}

/// Outputs of the block after a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The line to the bridge, low = interrupt.
    pub int_n: bool,
    /// Causes, whether enabled or not: bit 0 tick, bit 1 disarmed.
    pub status: u8,
}

/// State of the block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Interrupt {
    was_armed: bool,
    status: u8,
    low: bool,
}

impl Interrupt {
    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let events = u8::from(inputs.done) | u8::from(before.was_armed && !inputs.armed) << 1;
        self.was_armed = inputs.armed;
        self.status = (before.status & !inputs.clear) | events;
        self.low = before.status & inputs.enable & 3 != 0;
        self.outputs()
    }

    /// The outputs after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        Outputs { int_n: !self.low, status: self.status }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_is_low_while_an_enabled_cause_is_set() {
        let mut block = Interrupt::default();
        let quiet = Inputs::default();
        assert_eq!(block.clock(&Inputs { done: true, ..quiet }), Outputs { int_n: true, status: 1 });
        assert!(block.clock(&quiet).int_n, "off at reset");
        let enabled = Inputs { enable: 1, ..quiet };
        assert!(!block.clock(&enabled).int_n);
        assert!(!block.clock(&Inputs { clear: 2, ..enabled }).int_n);
        block.clock(&Inputs { clear: 1, ..enabled });
        assert_eq!(block.clock(&enabled), Outputs { int_n: true, status: 0 });
    }

    #[test]
    fn disarming_is_a_cause_once() {
        let mut block = Interrupt::default();
        let armed = Inputs { armed: true, enable: 2, ..Inputs::default() };
        block.clock(&armed);
        let off = Inputs { armed: false, ..armed };
        assert_eq!(block.clock(&off).status, 2);
        block.clock(&Inputs { clear: 3, ..off });
        assert_eq!(block.clock(&off).status, 0);
    }

    #[test]
    fn an_event_at_the_clearing_is_not_lost() {
        let mut block = Interrupt::default();
        let both = Inputs { done: true, clear: 3, ..Inputs::default() };
        assert_eq!(block.clock(&both).status, 1);
        assert_eq!(block.clock(&both).status, 1);
    }
}
