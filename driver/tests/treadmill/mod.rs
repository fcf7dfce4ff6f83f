//! A bit-true card whose wheels turn as they are told: no motors, no body, time as the test wants it.

use allocation_counter::opt_out;
use driver::realtime::Clock;
use driver::{BusError, Registers};
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::speed::EncoderSample;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

/// Clock of the card; a control period of 1 ms is a whole number of its ticks.
pub(super) const CLOCK_HZ: f64 = 33_333_000.0;

#[derive(Debug)]
struct Inside {
    card: Card,
    now: Duration,
    ticked: Duration,
    positions: [f64; AXES],
    pins: Pins,
    reads: u64,
    writes: u64,
    /// Oversleeps by so much at its tick of this number.
    oversleep: Option<(u64, Duration)>,
    sleeps: u64,
}

/// Registers and clock of one card; clones are the same one.
#[derive(Clone, Debug)]
pub(super) struct Treadmill(Rc<RefCell<Inside>>);

#[allow(dead_code, reason = "every test uses its part")]
impl Treadmill {
    pub(super) fn new() -> Self {
        Self(Rc::new(RefCell::new(Inside {
            card: Card::new(1),
            now: Duration::ZERO,
            ticked: Duration::ZERO,
            positions: [0.0; AXES],
            pins: Pins::default(),
            reads: 0,
            writes: 0,
            oversleep: None,
            sleeps: 0,
        })))
    }

    pub(super) fn oversleep(&self, at: u64, by: Duration) {
        self.0.borrow_mut().oversleep = Some((at, by));
    }

    pub(super) fn press_emergency_stop(&self) {
        self.0.borrow_mut().pins.emergency_stop = true;
    }

    pub(super) fn armed(&self) -> bool {
        self.0.borrow().card.armed()
    }

    /// Words read and written so far.
    pub(super) fn transfers(&self) -> (u64, u64) {
        let inside = self.0.borrow();
        (inside.reads, inside.writes)
    }
}

impl Inside {
    fn run_to(&mut self, now: Duration) {
        self.now = self.now.max(now);
        let period = Duration::from_secs_f64(f64::from(self.card.tick_period()) / CLOCK_HZ);
        while self.ticked + period <= self.now {
            self.ticked += period;
            let time = self.card.time().wrapping_add(self.card.tick_period()) & 0xFF_FFFF;
            let outputs = self.card.tick(&self.pins);
            for (axis, position) in self.positions.iter_mut().enumerate() {
                // Counts per clock, as the set points are.
                let speed = f64::from(outputs.references[axis].to_bits()) * 2_f64.powi(-32);
                *position += speed * f64::from(self.card.tick_period());
                let sample = EncoderSample { count: *position as i64 as u16, edge_time: time, direction: speed > 0.0 };
                self.pins.encoders[axis] = sample;
            }
        }
    }
}

impl Registers for Treadmill {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        let mut word = 0;
        opt_out(|| {
            let mut inside = self.0.borrow_mut();
            inside.reads += 1;
            word = inside.card.read(offset);
        });
        Ok(word)
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        opt_out(|| {
            let mut inside = self.0.borrow_mut();
            inside.writes += 1;
            inside.card.write(offset, data);
        });
        Ok(())
    }
}

impl Clock for Treadmill {
    fn now(&mut self) -> Duration {
        self.0.borrow().now
    }

    fn sleep_until(&mut self, at: Duration) {
        opt_out(|| {
            let mut inside = self.0.borrow_mut();
            inside.sleeps += 1;
            let over =
                inside.oversleep.filter(|(sleep, _)| *sleep == inside.sleeps).map_or(Duration::ZERO, |(_, by)| by);
            inside.run_to(at + over);
        });
    }
}
