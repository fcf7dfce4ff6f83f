//! What passes between a fault and the next try.

use crate::pilot::Pilot;

/// Rest before a robot may be armed anew, s.
const REST_S: f64 = 0.5;

/// A robot that was switched off, and why.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rest {
    why: String,
    /// Whether wheels were held from outside: their motors, once cooled, may try again whatever is asked for.
    stalled: bool,
    rested_s: f64,
}

impl Rest {
    pub(crate) fn after(why: String, stalled: bool) -> Self {
        Self { why, stalled, rested_s: 0.0 }
    }

    /// The next try failed too.
    pub(crate) fn again(&mut self, why: String) {
        (self.why, self.rested_s) = (why, 0.0);
    }

    /// In words for the team.
    pub(crate) fn words(&self) -> String {
        let why = &self.why;
        if self.stalled {
            format!("it pushes against something and stalls ({why}); it is armed anew after half a second")
        } else {
            format!("{why}; it is armed anew after half a second without motion asked for")
        }
    }

    /// Another moment, s. Whether it may be armed anew now.
    pub(crate) fn passes(&mut self, pilot: &mut Pilot, dt: f64) -> bool {
        pilot.wait(dt);
        self.rested_s = if pilot.asks_for_rest() || self.stalled { self.rested_s + dt } else { 0.0 };
        self.rested_s >= REST_S
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pilot::{Motion, Order};
    use runs::frames::Twist;
    use runs::robot::Robot;

    /// Moments of 10 ms until it may be armed anew, of at most 100, with or without motion asked for.
    fn moments(stalled: bool, asks: bool) -> Option<usize> {
        let mut pilot = Pilot::new(&Robot::racbot()).unwrap();
        let mut rest = Rest::after("a wheel stands".to_owned(), stalled);
        (1..=100).find(|_| {
            let speed = if asks { 0.3 } else { 0.0 };
            let motion = Some(Motion::Local(Twist { vx: speed, vy: 0.0, omega: 0.0 }));
            pilot.order(Order { motion, ..Order::default() });
            rest.passes(&mut pilot, 0.01)
        })
    }

    #[test]
    fn who_is_asked_to_move_stays_off_unless_it_was_held() {
        assert_eq!(moments(false, false), Some(50));
        assert_eq!(moments(false, true), None);
        assert_eq!(moments(true, true), Some(50));
    }
}
