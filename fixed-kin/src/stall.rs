//! Bit-true twin of the stall detector of one axis: driven, but the wheel does not move.
//!
//! In every window of control ticks a driven wheel must move [`STALL_COUNTS`] counts **net** from where the
//! window began, either way. One cut encoder line makes the other toggle by one count for ever, and two
//! cut lines make none: both are found, and so is a blocked wheel. An axis whose drive was off, or
//! below the threshold, at any tick of a window is not judged in it.
//!
//! A stall is therefore reported after one to two windows of being driven. Formats: threshold and compare
//! are PWM clocks, 13 bits; the net count saturates, nothing wraps.

/// Net counts that a driven wheel moves at least in a window.
pub const STALL_COUNTS: i8 = 4;

/// What the detector sees at one clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Outputs may be on.
    pub enable: bool,
    /// Strobe: an edge of the encoder is counted.
    pub step: bool,
    /// Its direction, true = up.
    pub up: bool,
    /// Strobe: a new compare value goes to the PWM generator.
    pub load: bool,
    /// That value, 13 bits.
    pub compare: u16,
    /// Compare values above this drive the wheel, 13 bits.
    pub threshold: u16,
    /// Strobe: a window ends and the next begins.
    pub window: bool,
    /// Clears the sticky stall, unless a new one comes at the same clock.
    pub clear: bool,
}

/// Output of the detector after a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Sticky: the wheel was driven through a window and did not move.
    pub stalled: bool,
}

/// State of one detector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stall {
    net: i8,
    moved: bool,
    driven: bool,
    outputs: Outputs,
}

impl Stall {
    /// A rising edge of the clock, with what the block sees before it.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        let start = if inputs.window { 0 } else { before.net };
        self.net = match (inputs.step, inputs.up) {
            (true, true) => (start + 1).min(STALL_COUNTS - 1),
            (true, false) => (start - 1).max(1 - STALL_COUNTS),
            _ => start,
        };
        let leaves = inputs.step && before.net == if inputs.up { STALL_COUNTS - 1 } else { 1 - STALL_COUNTS };
        self.moved = !inputs.window && (before.moved || leaves);
        let drives = inputs.compare & 0x1FFF > inputs.threshold & 0x1FFF;
        self.driven = inputs.enable && (inputs.window || before.driven) && (drives || !inputs.load);
        let stalls = inputs.window && inputs.enable && before.driven && !before.moved;
        self.outputs.stalled = stalls || (before.outputs.stalled && !inputs.clear);
        self.outputs
    }

    /// Clocks with one step each, so many up (or, negative, down) and no other strobe; equal to as many calls of
    /// [`Self::clock`].
    #[expect(clippy::cast_possible_truncation, reason = "the net count is clamped to a few counts")]
    pub fn step(&mut self, enable: bool, counts: i32) {
        if counts != 0 {
            let end = i32::from(self.net).saturating_add(counts);
            let most = i32::from(STALL_COUNTS - 1);
            self.moved |= end.unsigned_abs() > most.unsigned_abs();
            self.net = end.clamp(-most, most) as i8;
            self.driven &= enable;
        }
    }

    /// The output after the last clock.
    #[must_use]
    pub fn outputs(&self) -> Outputs {
        self.outputs
    }
}

/// Counts control ticks to the end of a window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    ticks: u16,
}

impl Window {
    /// A control tick; returns whether it ends a window of so many ticks. 0 and 1 are every tick.
    pub fn tick(&mut self, length: u16) -> bool {
        let next = self.ticks.wrapping_add(1);
        let ends = next >= length;
        self.ticks = if ends { 0 } else { next };
        ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DRIVEN: Inputs = Inputs {
        enable: true,
        step: false,
        up: false,
        load: false,
        compare: 500,
        threshold: 100,
        window: false,
        clear: false,
    };

    /// A window of ticks with these steps in it; every tick loads the same compare value.
    fn window(stall: &mut Stall, inputs: &Inputs, steps: &[i32]) -> bool {
        for &step in steps {
            stall.clock(&Inputs { load: true, ..*inputs });
            stall.clock(&Inputs { step: step != 0, up: step > 0, ..*inputs });
        }
        stall.clock(&Inputs { window: true, ..*inputs }).stalled
    }

    fn began() -> Stall {
        let mut stall = Stall::default();
        assert!(!window(&mut stall, &DRIVEN, &[]), "not driven through the whole of the first window");
        stall
    }

    #[test]
    fn a_wheel_that_stands_or_toggles_is_stalled() {
        for steps in [&[0, 0, 0][..], &[1, -1, 1, -1, 1, -1, 1, -1], &[1, 1, 1], &[-1, -1, -1, 1, 1, 1, 1, 1, 1]] {
            assert!(window(&mut began(), &DRIVEN, steps), "{steps:?}");
        }
    }

    #[test]
    fn four_counts_net_either_way_are_motion() {
        for steps in [&[1; 4][..], &[-1; 4], &[1, -1, -1, -1, -1, -1, 1], &[1, 1, 1, 1, -1, -1, -1, -1]] {
            assert!(!window(&mut began(), &DRIVEN, steps), "{steps:?}");
        }
    }

    #[test]
    fn what_was_not_driven_throughout_is_not_judged() {
        let mut stall = began();
        stall.clock(&Inputs { load: true, compare: 100, ..DRIVEN });
        assert!(!window(&mut stall, &DRIVEN, &[0, 0]), "the threshold itself is no drive");
        stall.clock(&Inputs { enable: false, ..DRIVEN });
        assert!(!window(&mut stall, &DRIVEN, &[0, 0]), "disarmed for a clock");
        assert!(window(&mut stall, &DRIVEN, &[0, 0]));
    }

    #[test]
    fn a_stall_is_sticky_until_cleared() {
        let mut stall = began();
        assert!(window(&mut stall, &DRIVEN, &[0]));
        assert!(window(&mut stall, &DRIVEN, &[1; 8]));
        assert!(!stall.clock(&Inputs { clear: true, ..DRIVEN }).stalled);
        assert!(stall.clock(&Inputs { window: true, clear: true, ..DRIVEN }).stalled, "a new one wins");
    }

    #[test]
    fn windows_are_as_long_as_asked() {
        for (length, ends) in [(0, 1), (1, 1), (2, 2), (200, 200), (u16::MAX, 65_535)] {
            let mut window = Window::default();
            for round in 0..3 {
                let found = (1..=70_000).find(|_| window.tick(length));
                assert_eq!(found, Some(ends), "{length}, round {round}");
            }
        }
    }

    proptest! {
        /// Steps at once are as many clocks, whatever came before.
        #[test]
        fn steps_at_once_equal_clocks(
            net in -3..=3_i8, bits in 0..16_u8, counts in prop_oneof![-12..=12_i32, Just(i32::MIN), Just(i32::MAX)]
        ) {
            let bit = |n: u8| bits >> n & 1 == 1;
            let (mut at_once, enable) = (Stall { net, moved: bit(0), driven: bit(1), outputs: Outputs { stalled: bit(2) } }, bit(3));
            let mut clocked = at_once;
            at_once.step(enable, counts);
            // Twelve clocks are more than from one end of the net count to the other: the rest change nothing.
            for _ in 0..counts.unsigned_abs().min(12) {
                clocked.clock(&Inputs { step: true, up: counts > 0, enable, ..Inputs::default() });
            }
            prop_assert_eq!(at_once, clocked);
        }

        /// Against plain counting: moved is |net| having reached four.
        #[test]
        fn equals_plain_counting(steps in prop::collection::vec(-1..=1_i32, 0..200)) {
            let mut net = 0_i32;
            let moved = steps.iter().any(|step| { net += step; net.abs() >= i32::from(STALL_COUNTS) });
            prop_assert_eq!(window(&mut began(), &DRIVEN, &steps), !moved);
        }
    }
}
