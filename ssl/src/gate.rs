//! How many datagrams of one sender are heard.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Duration;

/// Datagrams a second that a sender may send for long: a team's software sends a few hundred.
pub const RATE: f64 = 2_000.0;
/// Datagrams that may come at once.
pub const BURST: f64 = 400.0;
/// Senders that are remembered; those beyond share one allowance.
const SENDERS: usize = 64;

/// A bucket of allowances for every sender.
#[derive(Clone, Debug, Default)]
pub struct Gate {
    /// What is left, and when that was so.
    buckets: BTreeMap<Option<SocketAddr>, (f64, Duration)>,
    /// Datagrams that were not heard.
    pub refused: u64,
}

impl Gate {
    /// Whether a datagram that came now is heard.
    pub fn admits(&mut self, sender: SocketAddr, now: Duration) -> bool {
        let mut key = Some(sender);
        if !self.buckets.contains_key(&key) && self.buckets.len() >= SENDERS {
            // A bucket that is full again is one that nobody needs.
            let full = |(left, at): &(f64, Duration)| left + RATE * now.saturating_sub(*at).as_secs_f64() >= BURST;
            self.buckets.retain(|_, bucket| !full(bucket));
            if self.buckets.len() >= SENDERS {
                key = None;
            }
        }
        let (left, at) = self.buckets.entry(key).or_insert((BURST, now));
        *left = (*left + RATE * now.saturating_sub(*at).as_secs_f64()).min(BURST);
        *at = now;
        let admitted = *left >= 1.0;
        if admitted {
            *left -= 1.0;
        } else {
            self.refused += 1;
        }
        admitted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sender(port: u16) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], port))
    }

    #[test]
    fn a_flood_gets_its_rate_and_disturbs_nobody_else() {
        let mut gate = Gate::default();
        let heard = (0..100_000).filter(|i| gate.admits(sender(9), Duration::from_micros(10 * i))).count();
        assert!((2_390..=2_410).contains(&heard), "{heard}");
        assert!(gate.admits(sender(10), Duration::from_secs(1)));
        assert_eq!(gate.refused, 100_000 - heard as u64);
    }

    #[test]
    fn a_crowd_of_senders_takes_no_more_memory() {
        let mut gate = Gate::default();
        for port in 1..60_000 {
            gate.admits(sender(port), Duration::ZERO);
        }
        assert!(gate.buckets.len() <= SENDERS + 1);
        assert!(gate.admits(sender(1), Duration::from_secs(9)));
    }
}
