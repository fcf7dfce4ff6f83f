//! The program on the sequencer against `fixed_kin::control::Core`, tick by tick.

use fixed_kin::AXES;
use fixed_kin::control::{Configuration, Core, SetPointMode, TickInputs, TickOutputs};
use fixed_kin::format::{Duty, Speed};
use fixed_kin::modulation::Modulation;
use fixed_kin::registers::MIN_TICK_PERIOD;
use fixed_kin::speed::SpeedMode;
use hdl::blocks::sequencer::Sequencer;
use hdl::program::{InputPort, control_tick};
use hdl::sim::{cycle, settle};
use hdl::stimulus::control::{Scenario, scenario};
use rust_hdl::prelude::*;

struct Bench {
    sequencer: Sequencer,
    modulation: [Modulation; AXES],
    reverse: bool,
    longest: u32,
}

impl Bench {
    fn new() -> Self {
        let mut sequencer = Sequencer::new(&control_tick());
        sequencer.connect_all();
        Self { sequencer, modulation: Default::default(), reverse: false, longest: 0 }
    }

    fn clock(&mut self, inputs: &TickInputs) {
        settle(&mut self.sequencer);
        let axis = self.sequencer.axis.val().index();
        let sample = inputs.encoders[axis];
        let port = self.sequencer.input_port.val().index();
        let data = match port {
            p if p == InputPort::Count as usize => u32::from(sample.count),
            p if p == InputPort::EdgeTime as usize => sample.edge_time,
            p if p == InputPort::Line as usize => u32::from(sample.line()),
            p if p == InputPort::Now as usize => inputs.now,
            p if p == InputPort::TickPeriod as usize => inputs.tick_period,
            p if p == InputPort::CountAndTime as usize => u32::from(inputs.speed_mode == SpeedMode::CountAndTime),
            p if p == InputPort::Twist as usize => u32::from(inputs.set_point_mode == SetPointMode::Twist),
            p if p == InputPort::Armed as usize => u32::from(inputs.armed),
            p if p == InputPort::SetPointsValid as usize => u32::from(inputs.set_points_valid),
            p if p == InputPort::PwmPeriod as usize => u32::from(inputs.pwm_period),
            _ => 0,
        };
        self.sequencer.input_data.next = u64::from(data).to_bits();
        settle(&mut self.sequencer);
        if self.sequencer.output_strobe.val() {
            let value = self.sequencer.output_data.val().index() as u32;
            if self.sequencer.output_port.val() {
                let compare = (value >> 12) as u16 & 0x1FFF;
                self.modulation[axis] = Modulation { compare, reverse: self.reverse };
            } else {
                self.reverse = value >> 31 == 1;
            }
        }
        cycle(&mut self.sequencer, |s, level| s.clock.next = level.into());
    }

    fn write(&mut self, address: usize, word: i32) {
        self.sequencer.bus_address.next = address.to_bits();
        self.sequencer.bus_write_data.next = u64::from(word as u32).to_bits();
        self.sequencer.bus_write.next = true;
        cycle(&mut self.sequencer, |s, level| s.clock.next = level.into());
        self.sequencer.bus_write.next = false;
    }

    fn read(&mut self, address: usize) -> i32 {
        self.sequencer.bus_address.next = address.to_bits();
        cycle(&mut self.sequencer, |s, level| s.clock.next = level.into());
        self.sequencer.bus_read_data.val().index() as u32 as i32
    }

    fn tick(&mut self, configuration: &Configuration, inputs: &TickInputs) -> TickOutputs {
        for (address, word) in configuration.to_words().into_iter().enumerate() {
            self.write(address, word);
        }
        for (index, word) in inputs.set_points.into_iter().enumerate() {
            self.write(0x80 + index, word);
        }
        self.sequencer.tick.next = true;
        self.clock(inputs);
        self.sequencer.tick.next = false;
        let mut clocks = 1;
        while self.sequencer.running.val() {
            self.clock(inputs);
            clocks += 1;
            assert!(clocks < 2 * MIN_TICK_PERIOD, "the program does not end");
        }
        self.longest = self.longest.max(clocks);
        let mut outputs = TickOutputs { modulation: self.modulation, ..TickOutputs::default() };
        for axis in 0..AXES {
            outputs.counts[axis] = self.read(0xC4 + axis);
            outputs.speeds[axis] = Speed::from_bits(self.read(0xC8 + axis));
            outputs.references[axis] = Speed::from_bits(self.read(0xCC + axis));
            outputs.duties[axis] = Duty::from_bits(self.read(0xD0 + axis));
        }
        for k in 0..3 {
            outputs.twist[k] = self.read(0xD4 + k);
        }
        outputs
    }
}

#[test]
fn the_program_equals_the_reference_and_fits_the_shortest_tick() {
    let ticks = if cfg!(debug_assertions) { 100 } else { 2_000 };
    let mut bench = Bench::new();
    let mut core = Core::default();
    for (number, Scenario { configuration, inputs }) in scenario(7, ticks).into_iter().enumerate() {
        let expected = core.tick(&configuration, &inputs);
        let got = bench.tick(&configuration, &inputs);
        assert_eq!(got, expected, "tick {number}, inputs {inputs:?}");
        for axis in 0..AXES {
            assert_eq!(bench.read(0xA4 + axis), core.loops[axis].integral.to_bits(), "integral, tick {number}");
        }
    }
    println!("longest control tick: {} clocks", bench.longest);
    assert!(bench.longest <= MIN_TICK_PERIOD, "{} clocks", bench.longest);
}
