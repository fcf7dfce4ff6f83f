//! Bit-true twin of the clock monitor: is the bus clock alive, judged by the crystal.
//!
//! The block has two clocks; one [`ClockMonitor::clock`] is one moment at which either or both
//! rise. Counts are unsigned and stop at their limits.

/// Crystal clocks without a change after which the bus clock counts as dead.
pub const SILENT_CLOCKS: u32 = 32;
/// Changes without such a gap after which it counts as alive again.
pub const RECOVERY_TOGGLES: u32 = 256;
/// Most crystal edges from the last edge of the bus clock to `lclk_dead`: synchroniser, then silence.
pub const DEAD_CLOCKS: u32 = 3 + SILENT_CLOCKS;

/// Which clocks rise; if both, the crystal domain samples what was before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Rising edge of the bus clock.
    pub lclk: bool,
    /// Rising edge of the 50 MHz crystal clock.
    pub synclk: bool,
}

/// Output of the monitor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The bus clock has stopped, or has not yet run for long enough.
    pub lclk_dead: bool,
}

/// State of the monitor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClockMonitor {
    toggle: bool,
    /// Synchroniser and the level before.
    levels: [bool; 3],
    silent: u32,
    good: u32,
    alive: bool,
}

impl ClockMonitor {
    /// One moment.
    pub fn clock(&mut self, inputs: &Inputs) -> Outputs {
        let before = *self;
        if inputs.lclk {
            self.toggle = !before.toggle;
        }
        if inputs.synclk {
            let [first, second, last] = before.levels;
            self.levels = [before.toggle, first, second];
            if second != last {
                self.silent = 0;
                if before.good == RECOVERY_TOGGLES - 1 {
                    self.alive = true;
                } else {
                    self.good = before.good + 1;
                }
            } else if before.silent == SILENT_CLOCKS - 1 {
                self.good = 0;
                self.alive = false;
            } else {
                self.silent = before.silent + 1;
            }
        }
        Outputs { lclk_dead: !self.alive }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Crystal clocks until `lclk_dead` is `level`, with a bus edge every `ratio` half crystal
    /// clocks; 0 = stopped.
    fn crystal_clocks_until(monitor: &mut ClockMonitor, level: bool, ratio: u32, limit: u32) -> Option<u32> {
        let mut since = 0;
        (0..2 * limit).find_map(|half| {
            since += 1;
            let lclk = since == ratio;
            if lclk {
                since = 0;
            }
            let synclk = half % 2 == 1;
            let out = monitor.clock(&Inputs { lclk, synclk });
            (synclk && out.lclk_dead == level).then_some(half.div_ceil(2))
        })
    }

    fn alive() -> ClockMonitor {
        let mut monitor = ClockMonitor::default();
        assert!(crystal_clocks_until(&mut monitor, false, 3, 10_000).is_some());
        monitor
    }

    #[test]
    fn dead_at_power_up_until_the_clock_has_run() {
        let mut monitor = ClockMonitor::default();
        assert_eq!(crystal_clocks_until(&mut monitor, false, 0, 10_000), None);
        // An edge every 1.5 crystal clocks, as 33.3 MHz is to 50 MHz.
        let clocks = crystal_clocks_until(&mut monitor, false, 3, 10_000).unwrap();
        assert!((380..400).contains(&clocks), "{clocks}");
    }

    #[test]
    fn a_stopped_clock_is_dead_within_the_stated_time() {
        for extra in 0..6 {
            let mut monitor = alive();
            assert_eq!(crystal_clocks_until(&mut monitor, true, 3, 1_000 + extra), None);
            let clocks = crystal_clocks_until(&mut monitor, true, 0, 1_000).unwrap();
            assert!((SILENT_CLOCKS..=DEAD_CLOCKS).contains(&clocks), "{clocks}");
            assert_eq!(crystal_clocks_until(&mut monitor, false, 0, 1_000), None);
        }
    }

    #[test]
    fn slower_bus_clocks_are_alive_down_to_the_limit() {
        for (crystal_clocks_per_edge, lives) in [(1, true), (2, true), (4, true), (31, true), (32, true), (33, false)] {
            let mut monitor = ClockMonitor::default();
            let seen = crystal_clocks_until(&mut monitor, false, 2 * crystal_clocks_per_edge, 20_000);
            assert_eq!(seen.is_some(), lives, "{crystal_clocks_per_edge}");
            let mut monitor = alive();
            let dies = crystal_clocks_until(&mut monitor, true, 2 * crystal_clocks_per_edge, 20_000);
            assert_eq!(dies.is_none(), lives, "{crystal_clocks_per_edge}");
        }
    }

    #[test]
    fn a_gap_during_recovery_starts_anew() {
        let mut monitor = ClockMonitor::default();
        assert_eq!(crystal_clocks_until(&mut monitor, false, 3, 300), None);
        assert_eq!(crystal_clocks_until(&mut monitor, false, 0, 50), None);
        let clocks = crystal_clocks_until(&mut monitor, false, 3, 10_000).unwrap();
        assert!(clocks >= 380, "{clocks}");
    }
}
