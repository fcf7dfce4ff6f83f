//! The program on the sequencer against `fixed_kin::control::Core`, tick by tick.

use fixed_kin::AXES;
use fixed_kin::control::{Configuration, Core, SetPointMode, TickInputs, TickOutputs};
use fixed_kin::format::{Duty, Speed};
use fixed_kin::modulation::Modulation;
use fixed_kin::pose::Pose;
use fixed_kin::registers::MIN_TICK_PERIOD;
use fixed_kin::speed::{EncoderSample, SpeedMode};
use hdl::blocks::sequencer::Sequencer;
use hdl::blocks::trigonometry::Trigonometry;
use hdl::program::{InputPort, OutputPort, control_tick};
use hdl::sim::{cycle, settle};
use hdl::stimulus::control::{Scenario, scenario};
use rust_hdl::prelude::*;

struct Bench {
    sequencer: Sequencer,
    trigonometry: Trigonometry,
    modulation: [Modulation; AXES],
    reverse: bool,
    longest: u32,
}

impl Bench {
    fn new() -> Self {
        let mut sequencer = Sequencer::new(&control_tick());
        sequencer.connect_all();
        let mut trigonometry = Trigonometry::default();
        trigonometry.connect_all();
        Self { sequencer, trigonometry, modulation: Default::default(), reverse: false, longest: 0 }
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
            p if p == InputPort::IndexEvent as usize => u32::from(inputs.indices[axis].event),
            p if p == InputPort::IndexClear as usize => u32::from(inputs.indices[axis].clear),
            p if p == InputPort::IndexCount as usize => u32::from(inputs.indices[axis].count),
            p if p == InputPort::Odometry as usize => u32::from(inputs.odometry),
            p if p == InputPort::Fraction as usize => self.trigonometry.fraction.val().index() as u32,
            p if p == InputPort::Sine as usize => self.trigonometry.sine.val().index() as u32,
            p if p == InputPort::Cosine as usize => self.trigonometry.cosine.val().index() as u32,
            _ => 0,
        };
        self.sequencer.input_data.next = u64::from(data).to_bits();
        settle(&mut self.sequencer);
        if self.sequencer.output_strobe.val() {
            let value = self.sequencer.output_data.val().index() as u32;
            let port = self.sequencer.output_port.val().index();
            if port == OutputPort::Compare as usize {
                let compare = (value >> 12) as u16 & 0x1FFF;
                self.modulation[axis] = Modulation { compare, reverse: self.reverse };
            } else if port == OutputPort::Direction as usize {
                self.reverse = value >> 31 == 1;
            } else {
                self.trigonometry.angle.next = u64::from(value).to_bits();
                self.trigonometry.load.next = true;
            }
        }
        cycle(&mut self.trigonometry, |t, level| t.clock.next = level.into());
        self.trigonometry.load.next = false;
        cycle(&mut self.sequencer, |s, level| s.clock.next = level.into());
    }

    fn write(&mut self, address: usize, word: i32) {
        self.sequencer.bus_write_address.next = address.to_bits();
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

    fn tick(&mut self, configuration: &Configuration, inputs: &TickInputs, expected: &TickOutputs) -> TickOutputs {
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
        let moved = expected.moved;
        let mut outputs = TickOutputs { modulation: self.modulation, moved, ..TickOutputs::default() };
        for axis in 0..AXES {
            outputs.counts[axis] = self.read(0xC4 + axis);
            outputs.speeds[axis] = Speed::from_bits(self.read(0xC8 + axis));
            outputs.references[axis] = Speed::from_bits(self.read(0xCC + axis));
            outputs.duties[axis] = Duty::from_bits(self.read(0xD0 + axis));
        }
        let [x, y, heading] = [0, 1, 2].map(|k| self.read(0xD4 + k));
        outputs.pose = Pose { x, y, heading: heading as u32 };
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
        let got = bench.tick(&configuration, &inputs, &expected);
        assert_eq!(got, expected, "tick {number}, inputs {inputs:?}");
        for axis in 0..AXES {
            assert_eq!(bench.read(0xA4 + axis), core.loops[axis].integral.to_bits(), "integral, tick {number}");
            assert_eq!(bench.read(0x9C + axis), core.index_positions[axis], "index, tick {number}");
        }
    }
    // Every axis captures an index and zeroes its counts at it, at every tick, and creeps backwards without an
    // edge in most of them: all that takes longest.
    let mut creep = 0_u16;
    for (number, Scenario { configuration, mut inputs }) in scenario(8, ticks / 4).into_iter().enumerate() {
        inputs.armed = true;
        inputs.set_points_valid = true;
        inputs.odometry = true;
        inputs.set_point_mode = SetPointMode::Twist;
        inputs.speed_mode = SpeedMode::CountAndTime;
        inputs.tick_period = MIN_TICK_PERIOD;
        inputs.now = (1_000 * number as u32) & 0xFF_FFFF;
        if number % 8 == 0 {
            creep = creep.wrapping_sub(1);
        }
        let edge_time = (8_000 * (number as u32 / 8)).wrapping_sub(5) & 0xFF_FFFF;
        inputs.encoders = [EncoderSample { count: creep, edge_time, direction: false }; AXES];
        inputs.indices.iter_mut().for_each(|index| (index.event, index.clear) = (true, true));
        let expected = core.tick(&configuration, &inputs);
        assert_eq!(bench.tick(&configuration, &inputs, &expected), expected, "tick {number}, inputs {inputs:?}");
    }
    println!("longest control tick: {} clocks", bench.longest);
    assert!(bench.longest <= MIN_TICK_PERIOD, "{} clocks", bench.longest);
}
