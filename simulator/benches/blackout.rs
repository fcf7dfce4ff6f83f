//! How many of 200 starts fetch the ball and reach their coordinates while the overhead camera is off. Writes
//! `docs/measured/blackout.md`.

use measured::Table;
use simulator::blackout::{Blackout, Outcome, REACHED, Senses};

/// Starts, by their seeds; another number as argument, and another first seed after it, prints instead of writing the table.
const STARTS: u64 = 200;

fn outcomes(senses: Senses, starts: std::ops::Range<u64>) -> Vec<Outcome> {
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    std::thread::scope(|scope| {
        let part = |thread: u64| {
            let seeds = starts.clone().filter(move |seed| seed % threads == thread);
            seeds.map(|seed| Blackout::new(seed).run(senses).expect("the simulation runs")).collect::<Vec<_>>()
        };
        let running: Vec<_> = (0..threads).map(|thread| scope.spawn(move || part(thread))).collect();
        running.into_iter().flat_map(|thread| thread.join().expect("no thread panics")).collect()
    })
}

fn main() {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let asked: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let (starts, first) = (asked.first().copied().unwrap_or(STARTS), asked.get(1).copied().unwrap_or(0));
    let rows = [
        ("wheels", Senses::Wheels),
        ("wheels, gyroscope", Senses::Gyroscope),
        ("wheels, gyroscope, camera", Senses::Camera),
    ]
    .map(|(name, senses)| {
        let outcomes = outcomes(senses, first..first + starts);
        let share = |reached: &dyn Fn(&Outcome) -> bool| {
            format!("{:.1}", 100.0 * outcomes.iter().filter(|o| reached(o)).count() as f64 / starts as f64)
        };
        let mut misses: Vec<f64> = outcomes.iter().map(|o| 1e3 * o.miss).collect();
        misses.sort_by(f64::total_cmp);
        let at = |share: f64| format!("{:.0}", misses[((misses.len() - 1) as f64 * share) as usize]);
        vec![
            name.to_owned(),
            share(&|o| o.ball_miss < REACHED),
            share(&|o| o.miss < REACHED),
            share(&|o| o.miss < REACHED && o.ball_miss < REACHED),
            at(0.5),
            at(0.95),
        ]
    });
    if !asked.is_empty() {
        rows.iter().for_each(|row| println!("{}", row.join("  ")));
        return;
    }
    Table {
        name: "blackout",
        title: "Overhead camera off: of 200 starts, how many come within 50 mm of the ball and of their coordinates",
        command: "cargo bench -p simulator --bench blackout",
        columns: &["on board", "ball, %", "coordinates, %", "both, %", "median miss, mm", "95 % miss, mm"],
    }
    .write(&rows);
}
