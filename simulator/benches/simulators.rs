//! Clocks per second of the whole chip in three simulators, idle but for its control ticks.
//!
//! The ratios hold on any machine; the figures are those of the one that ran it.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use hdl::sim::cycle;
use simulator::cosim::{Verilated, icarus};
use std::hint::black_box;

fn simulators(c: &mut Criterion) {
    let mut group = c.benchmark_group("chip clocks");
    group.sample_size(10);
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).expect("the committed chip");

    const VERILATED: u64 = 1_000_000;
    group.throughput(Throughput::Elements(VERILATED));
    match Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports).and_then(|built| built.start()) {
        Ok(mut session) => {
            group.bench_function("verilator", |b| b.iter(|| session.run(VERILATED)));
        }
        Err(error) => eprintln!("verilator not measured: {error}"),
    }

    const SIMULATED: u64 = 5_000;
    group.throughput(Throughput::Elements(SIMULATED));
    let mut core = Box::new(hdl::design::core());
    core.ads_n.next = true;
    core.blast_n.next = true;
    group.bench_function("rust-hdl", |b| {
        b.iter(|| {
            for _ in 0..SIMULATED {
                cycle(&mut *core, |core, level| {
                    core.lclk.next = level.into();
                    core.synclk.next = level.into();
                });
            }
        });
    });

    const INTERPRETED: usize = 20_000;
    group.throughput(Throughput::Elements(INTERPRETED as u64));
    let core = hdl::emit::verilog::emit(&*core, "chip");
    let ports = Ports::parse(&core, "chip", &["lclk", "synclk"]).expect("the core");
    let stimulus: Vec<u32> =
        (0..INTERPRETED).flat_map(|_| ports.inputs().map(|port| u32::from(port.name.ends_with("_n")))).collect();
    match icarus::run("chip", &core, "chip", &ports, &stimulus) {
        Ok(_) => {
            group.bench_function("icarus, compilation included", |b| {
                b.iter(|| black_box(icarus::run("chip", &core, "chip", &ports, &stimulus)));
            });
        }
        Err(error) => eprintln!("icarus not measured: {error}"),
    }
    group.finish();
}

criterion_group!(benches, simulators);
criterion_main!(benches);
