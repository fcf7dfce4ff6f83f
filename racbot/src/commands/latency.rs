//! `racbot latency`

use crate::terminal::{Answer, Failure, Table, positive, wrapped};
use clap::Args;
use driver::realtime::{Latency, MonotonicClock, Rights, measure_latency, stop_on_signals};
use serde_json::json;
use std::fmt::Write as _;
use std::time::Duration;

/// Widest bar of the histogram.
const BAR: usize = 44;

/// Options of `latency`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    /// Period of the timer in microseconds
    #[arg(long, value_name = "US", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(50..=1_000_000))]
    period_us: u32,

    /// How long to measure, in seconds
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    seconds: f64,

    /// Real-time priority asked for
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u8).range(1..=99))]
    priority: u8,
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        positive("--seconds", self.seconds, 86_400.0)?;
        let stop = stop_on_signals().map_err(Failure::data)?;
        let rights = Rights::acquire(self.priority);
        let period = Duration::from_micros(self.period_us.into());
        let ticks = (self.seconds / period.as_secs_f64()).ceil() as u64;
        let latency = measure_latency(&mut MonotonicClock, period, ticks, &stop, |_| {});
        Ok(Answer { text: self.text(&latency, &rights), json: self.json(&latency, &rights), wrong: None })
    }

    fn text(&self, latency: &Latency, rights: &Rights) -> String {
        let [min, mean, max] = latency.min_mean_max_us();
        let us = |value: f64| format!("{value:.1}");
        let mut table = Table::new(1, &["thread", "prio", "period", "cycles", "min", "act", "avg", "p99.9", "max"]);
        let priority = if rights.scheduling.refused.is_some() { 0 } else { self.priority };
        let act = us(latency.last.as_secs_f64() * 1e6);
        table.row(
            ["T: 0".to_owned(), priority.to_string(), self.period_us.to_string(), latency.count().to_string()]
                .into_iter()
                .chain([us(min), act, us(mean), us(latency.quantile_us(0.999)), us(max)]),
        );
        let mut text = format!("wake-up after the timer, in microseconds\n\n{}\n", table.render());
        let bars = latency.histogram();
        let most = bars.iter().map(|(_, count)| *count).max().unwrap_or(1).max(1);
        let mut lower = 0.0;
        for (upper, count) in bars {
            // A single outlier is what one looks for: it has a bar, too.
            let long = (count as f64 / most as f64 * BAR as f64).round().max(f64::from(u8::from(count > 0)));
            let _ = writeln!(text, "{lower:>8.0} .. {upper:>7.0} {count:>9}  {}", "#".repeat(long as usize));
            lower = upper;
        }
        let _ = writeln!(text, "\nmissed periods: {}", latency.missed);
        for remark in rights.remarks() {
            text += &wrapped(remark, 2);
        }
        text
    }

    fn json(&self, latency: &Latency, rights: &Rights) -> serde_json::Value {
        let [min, mean, max] = latency.min_mean_max_us();
        let bars: Vec<_> =
            latency.histogram().iter().map(|(upper, count)| json!({ "below_us": upper, "count": count })).collect();
        json!({
            "period_us": self.period_us, "priority": self.priority, "cycles": latency.count(),
            "min_us": min, "avg_us": mean, "max_us": max, "act_us": latency.last.as_secs_f64() * 1e6,
            "p50_us": latency.quantile_us(0.5), "p99_us": latency.quantile_us(0.99),
            "p999_us": latency.quantile_us(0.999), "missed": latency.missed, "histogram": bars,
            "fifo": rights.scheduling.refused.is_none(), "memory_locked": rights.memory.refused.is_none(),
            "remarks": rights.remarks().collect::<Vec<_>>(),
        })
    }
}
