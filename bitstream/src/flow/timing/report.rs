//! Arrival times, slack, and the worst paths.

use super::delays::{CLOCK_SKEW, MEMORY_TO_OUTPUT};
use super::graph::{Arc, End, From, Graph, SHARE};
use crate::flow::netlist::Net;

/// A step of a path: a net and when it arrives at the next part, in ps after the clock.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct PathStep {
    /// The net; `None` is a carry.
    pub net: Option<Net>,
    /// When its driver has it.
    pub driven: u32,
    /// What its wire takes to the next part.
    pub wire: u32,
    /// Connection, if it is one.
    pub connection: Option<u32>,
}

/// A slow path, place by place.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct TimedPath {
    /// What it takes, set-up included, in ps.
    pub delay: u32,
    /// What it may take.
    pub due: u32,
    /// From the start on.
    pub steps: Vec<PathStep>,
}

impl TimedPath {
    /// What is left; negative is too slow.
    #[must_use]
    pub fn slack(&self) -> i64 {
        i64::from(self.due) - i64::from(self.delay)
    }
}

/// Timing of a clock domain.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct DomainReport {
    /// Port of the clock.
    pub port: String,
    /// Of the constraint that the clock has, ps.
    pub period: u32,
    /// The worst paths, worst first, one for each end.
    pub worst: Vec<TimedPath>,
    /// The slowest of those that begin and end inside the device, with the whole period to pass.
    pub inside: Option<TimedPath>,
}

impl DomainReport {
    /// The paths that a report shows, each with what it goes between: the slowest inside, and the one with the least slack.
    pub fn told(&self) -> impl Iterator<Item = (&'static str, &TimedPath)> {
        let inside = self.inside.iter().map(|path| ("registers and memories", path));
        inside.chain(self.worst.first().map(|path| ("pads, and all by slack", path)))
    }
}

/// Timing of a design.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Report {
    /// One for each clock of the graph, in its order.
    pub domains: Vec<DomainReport>,
    /// Share of the period that a connection's worst path takes, in 1/256.
    pub criticality: Vec<u16>,
}

/// Arrival at a node in each domain; `None` where no path of it comes.
struct Arrivals {
    times: Vec<Vec<Option<u32>>>,
}

impl Report {
    /// Analyses the graph with these wire delays, ps per connection; tells the ten worst paths of each domain.
    #[must_use]
    pub fn of(graph: &Graph, wires: &[u32]) -> Self {
        Self::with_paths(graph, wires, 10)
    }

    /// By how much the worst path misses what it is due by, in ps; less than 0 if none does.
    #[must_use]
    pub fn misses(&self) -> i64 {
        let slack = self.domains.iter().filter_map(|domain| domain.worst.first()).map(TimedPath::slack);
        -slack.min().unwrap_or(0)
    }

    /// By how much the slowest path between registers takes more than it should ([`SHARE`]), in ps; less than 0 if it takes less.
    #[must_use]
    pub(crate) fn inside_misses(&self) -> i64 {
        let missed = |domain: &DomainReport| {
            let inside = domain.inside.as_ref()?;
            Some(i64::from(inside.delay) - i64::from(domain.period / 100 * SHARE))
        };
        self.domains.iter().filter_map(missed).max().unwrap_or(0)
    }

    /// The same with so many paths.
    #[must_use]
    pub fn with_paths(graph: &Graph, wires: &[u32], paths: usize) -> Self {
        let domains = graph.clocks.len();
        let arrivals = arrive(graph, wires);
        let (mut criticality, mut reports) = (vec![0_u16; wires.len()], Vec::new());
        for domain in 0..domains {
            let times = &arrivals.times[domain];
            let time = |arc: Arc| Some(times[graph.driver(arc.from) as usize]? + wire(wires, arc.from) + arc.delay);
            let mut ends: Vec<(i64, u32, usize)> = Vec::new();
            // Latest time at which a node may settle so that every end is met, as (due − remaining).
            let mut due: Vec<i64> = vec![i64::MAX; times.len()];
            for (at, end) in graph.ends.iter().enumerate().filter(|(_, end)| end.clock as usize == domain) {
                if let Some(delay) = time(end.arc) {
                    ends.push((i64::from(end.due) - i64::from(delay), delay, at));
                }
                lower(graph, &mut due, wires, end.arc, i64::from(end.due));
            }
            for node in graph.order.iter().rev() {
                let own = due[*node as usize];
                if own < i64::MAX {
                    graph.into[*node as usize].iter().for_each(|arc| lower(graph, &mut due, wires, *arc, own));
                }
            }
            let period = i64::from(graph.clocks[domain].period);
            let mut share = |arc: Arc, own: i64| {
                let (From::Connection(connection), Some(time)) = (arc.from, time(arc)) else { return };
                let slack = own - i64::from(time);
                let share = ((period - slack) * 256 / period).clamp(0, 4_095) as u16;
                let entry = &mut criticality[connection as usize];
                *entry = share.max(*entry);
            };
            for (node, arcs) in graph.into.iter().enumerate().filter(|(node, _)| due[*node] < i64::MAX) {
                arcs.iter().for_each(|arc| share(*arc, due[node]));
            }
            graph.ends.iter().filter(|end| end.clock as usize == domain).for_each(|end| share(end.arc, end.due.into()));
            ends.sort_unstable();
            let worst =
                ends.iter().take(paths).map(|(_, delay, at)| path(graph, wires, times, &graph.ends[*at], *delay));
            let whole = |at: usize| i64::from(graph.ends[at].due) == period - i64::from(CLOCK_SKEW);
            let inside = ends
                .iter()
                .map(|(_, delay, at)| (*delay, *at))
                .filter(|(_, at)| whole(*at))
                .map(|(delay, at)| path(graph, wires, times, &graph.ends[at], delay))
                // Inputs begin later than any register.
                .find(|path| path.steps.first().is_some_and(|step| step.driven <= MEMORY_TO_OUTPUT));
            let clock = &graph.clocks[domain];
            let worst = worst.collect();
            reports.push(DomainReport { port: clock.port.clone(), period: clock.period, worst, inside });
        }
        Self { domains: reports, criticality }
    }
}

fn wire(wires: &[u32], from: From) -> u32 {
    if let From::Connection(connection) = from { wires[connection as usize] } else { 0 }
}

fn lower(graph: &Graph, due: &mut [i64], wires: &[u32], arc: Arc, own: i64) {
    let entry = &mut due[graph.driver(arc.from) as usize];
    *entry = (*entry).min(own - i64::from(wire(wires, arc.from)) - i64::from(arc.delay));
}

fn arrive(graph: &Graph, wires: &[u32]) -> Arrivals {
    let mut times = vec![vec![None; graph.into.len()]; graph.clocks.len()];
    for (domain, times) in times.iter_mut().enumerate() {
        for node in &graph.order {
            let node = *node as usize;
            let mut latest = graph.starts[node].filter(|(_, clock)| *clock as usize == domain).map(|(time, _)| time);
            for arc in &graph.into[node] {
                if let Some(from) = times[graph.driver(arc.from) as usize] {
                    latest = latest.max(Some(from + wire(wires, arc.from) + arc.delay));
                }
            }
            times[node] = latest;
        }
    }
    Arrivals { times }
}

fn path(graph: &Graph, wires: &[u32], times: &[Option<u32>], end: &End, delay: u32) -> TimedPath {
    let mut steps = Vec::new();
    let mut arc = end.arc;
    loop {
        let node = graph.driver(arc.from) as usize;
        let driven = times[node].unwrap_or(0);
        let connection = if let From::Connection(connection) = arc.from { Some(connection) } else { None };
        steps.push(PathStep { net: graph.names[node], driven, wire: wire(wires, arc.from), connection });
        let before = graph.into[node].iter().find(|arc| {
            times[graph.driver(arc.from) as usize].map(|from| from + wire(wires, arc.from) + arc.delay) == Some(driven)
        });
        let Some(next) = before else { break };
        arc = *next;
    }
    steps.reverse();
    TimedPath { delay, due: end.due, steps }
}
