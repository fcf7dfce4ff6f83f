//! Every block's emitted Verilog, compiled, against its twin in `fixed-kin`, clock by clock or
//! operation by operation; and broken blocks, which must be caught.

use fixed_kin::word::{WORD_MAX, WORD_MIN, divide, multiply};
use fixed_kin::{clock_monitor, encoder, imu_spi, interrupt, kicker, pwm, radio, safety, stall};
use hdl::blocks;
use hdl::blocks::divider::DIVISION_STEPS;
use hdl::blocks::multiplier::SCALES;
use hdl::emit::ports::Ports;
use hdl::emit::verilog::emit;
use hdl::stimulus::control::word;
use hdl::stimulus::{self, Columns};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rust_hdl::prelude::Block;
use simulator::cosim::{Clocks, Verilated};

/// Clocks per block of clock-by-clock comparison.
const CLOCKS: usize = 2_000_000;
/// Operations of the arithmetic units.
const OPERATIONS: usize = 1_000_000;

fn compile<B: Block>(name: &str, mut block: B) -> (String, Ports) {
    block.connect_all();
    let ports = Ports::of(&block).unwrap();
    (emit(&block, &top(name)), ports)
}

/// Module name: not that of one of its own ports.
fn top(name: &str) -> String {
    format!("block_{name}")
}

/// Rows of outputs of a module over a stimulus.
fn respond(name: &str, verilog: &str, ports: &Ports, clocks: &Clocks, stimulus: &[u32]) -> Vec<u32> {
    let built = Verilated::build(name, verilog, &top(name), ports).unwrap_or_else(|error| panic!("{error}"));
    built.run_with(clocks, stimulus).unwrap()
}

/// First clock at which the Verilog differs from the twin.
fn first_difference<I: Columns, O: Columns>(
    name: &str,
    verilog: &str,
    ports: &Ports,
    inputs: &[I],
    mut twin: impl FnMut(&I) -> O,
) -> Option<usize> {
    assert!(ports.outputs().map(|port| port.name.as_str()).eq(O::NAMES.iter().copied()), "port order");
    let mut rows = Vec::new();
    inputs.iter().for_each(|row| row.append_to(&mut rows));
    let response = respond(name, verilog, ports, &Clocks::Together, &rows);
    let width = O::NAMES.len();
    let mut expected = Vec::with_capacity(width);
    inputs.iter().zip(response.chunks_exact(width)).position(|(inputs, got)| {
        expected.clear();
        twin(inputs).append_to(&mut expected);
        expected != got
    })
}

macro_rules! equals_its_twin {
    ($test:ident, $module:ident, $block:ty, $twin:ty) => {
        #[test]
        fn $test() {
            let (verilog, ports) = compile(stringify!($module), <$block>::default());
            let inputs = stimulus::$module::stimulus(11, CLOCKS);
            let mut twin = <$twin>::default();
            let difference =
                first_difference(stringify!($module), &verilog, &ports, &inputs, |inputs| twin.clock(inputs));
            assert_eq!(difference, None);
        }
    };
}

equals_its_twin!(encoder_equals_its_twin, encoder, blocks::encoder::Encoder, encoder::Encoder);
equals_its_twin!(safety_equals_its_twin, safety, blocks::safety::Safety, safety::Safety);
equals_its_twin!(pwm_equals_its_twin, pwm, blocks::pwm::Pwm, pwm::Pwm);
equals_its_twin!(stall_equals_its_twin, stall, blocks::stall::Stall, stall::Stall);
equals_its_twin!(imu_spi_equals_its_twin, imu_spi, blocks::imu_spi::ImuSpi, imu_spi::ImuSpi);
equals_its_twin!(interrupt_equals_its_twin, interrupt, blocks::interrupt::Interrupt, interrupt::Interrupt);
equals_its_twin!(kicker_equals_its_twin, kicker, blocks::kicker::Kicker, kicker::Kicker);

#[test]
fn radio_equals_its_twin() {
    let rate = stimulus::radio::CLOCKS_PER_BIT;
    let (verilog, ports) = compile("radio", stimulus::radio::Radio::default());
    for seed in [10, 11] {
        let inputs = stimulus::radio::stimulus(seed, CLOCKS);
        let mut twin = radio::Radio::new(rate);
        let difference = first_difference("radio", &verilog, &ports, &inputs, |inputs| twin.clock(inputs));
        assert_eq!(difference, None);
    }
}

/// See [`a_broken_pwm_is_caught`]: a radio that takes a frame for whole whatever its CRC.
#[test]
fn a_radio_that_forgives_damage_is_caught() {
    let rate = stimulus::radio::CLOCKS_PER_BIT;
    let (verilog, ports) = compile("radio", stimulus::radio::Radio::default());
    let broken = mutate(&verilog, "check_state == residue", "check_state != 32'h0");
    let inputs = stimulus::radio::stimulus(11, 1_000_000);
    let mut twin = radio::Radio::new(rate);
    let difference = first_difference("radio", &broken, &ports, &inputs, |inputs| twin.clock(inputs));
    assert!(difference.is_some());
}

#[test]
fn clock_monitor_equals_its_twin() {
    let (verilog, ports) = compile("clock_monitor", blocks::clock_monitor::ClockMonitor::default());
    let inputs = stimulus::clock_monitor::stimulus(11, CLOCKS);
    let mut rows = Vec::new();
    inputs.iter().for_each(|row| row.append_to(&mut rows));
    assert_eq!(rows.len(), inputs.len(), "the two clocks are the whole stimulus, one word a step");
    let response = respond("clock_monitor", &verilog, &ports, &Clocks::PerStep, &rows);
    let mut twin = clock_monitor::ClockMonitor::default();
    for (step, (inputs, got)) in inputs.iter().zip(response).enumerate() {
        assert_eq!(u32::from(twin.clock(inputs).lclk_dead), got, "step {step}");
    }
}

/// Stimulus rows of one operation: start with operands, then idle until the result stands.
fn operation(rows: &mut Vec<u32>, operands: &[u32], steps: u32) {
    rows.push(1);
    rows.extend(operands);
    for _ in 0..steps {
        rows.extend(std::iter::repeat_n(0, operands.len() + 1));
    }
}

#[test]
fn a_million_products_equal_the_reference() {
    let (verilog, ports) = compile("multiplier", blocks::multiplier::Multiplier::default());
    let mut random = ChaCha8Rng::seed_from_u64(21);
    for _ in 0..10 {
        let mut rows = Vec::new();
        let wanted: Vec<(usize, i32)> = (0..OPERATIONS / 10)
            .map(|_| {
                let scale = random.random_range(0..SCALES.len());
                let (a, b) = (word(&mut random), random.next_u32() as i32);
                operation(&mut rows, &[scale as u32, a as u32, b as u32], SCALES[scale].digits());
                (rows.len() / 4 - 1, multiply(a, b, SCALES[scale]))
            })
            .collect();
        let response = respond("multiplier", &verilog, &ports, &Clocks::Together, &rows);
        for (row, expected) in wanted {
            assert_eq!(response[2 * row + 1] as i32, expected);
        }
    }
}

#[test]
fn a_million_quotients_equal_the_reference() {
    let (verilog, ports) = compile("divider", blocks::divider::Divider::default());
    let mut random = ChaCha8Rng::seed_from_u64(22);
    for _ in 0..10 {
        let mut rows = Vec::new();
        let wanted: Vec<(usize, i32)> = (0..OPERATIONS / 10)
            .map(|_| {
                let numerator = i32::from(random.next_u32() as i16 >> random.random_range(0..16));
                let denominator = random.next_u32() >> random.random_range(8..32);
                operation(&mut rows, &[numerator as u32, denominator], DIVISION_STEPS);
                // The program adds the one.
                (rows.len() / 3 - 1, divide(numerator, denominator) - i32::from(numerator < 0))
            })
            .collect();
        let response = respond("divider", &verilog, &ports, &Clocks::Together, &rows);
        for (row, expected) in wanted {
            assert_eq!(response[2 * row + 1] as i32, expected);
        }
    }
}

/// The checks can fail: a PWM whose full duty has a gap, and a multiplier that drops its rounding.
#[test]
fn a_broken_pwm_is_caught() {
    let (verilog, ports) = compile("pwm", blocks::pwm::Pwm::default());
    let broken = mutate(&verilog, "coming_q > active_compare_q", "coming_q >= active_compare_q");
    let inputs = stimulus::pwm::stimulus(11, 200_000);
    let mut twin = pwm::Pwm::default();
    let difference = first_difference("pwm", &broken, &ports, &inputs, |inputs| twin.clock(inputs));
    assert!(difference.is_some());
}

/// See [`a_broken_pwm_is_caught`]: a stall detector whose count runs on from window to window.
#[test]
fn a_stall_detector_that_forgets_nothing_is_caught() {
    let (verilog, ports) = compile("stall", blocks::stall::Stall::default());
    let broken = mutate(&verilog, "net_d = zero", "net_d = net_q");
    let inputs = stimulus::stall::stimulus(11, 200_000);
    let mut twin = stall::Stall::default();
    let difference = first_difference("stall", &broken, &ports, &inputs, |inputs| twin.clock(inputs));
    assert!(difference.is_some());
}

/// See [`a_broken_pwm_is_caught`]: a reader of the sensor that stores a word before its last bit is in.
#[test]
fn a_word_that_is_not_whole_is_caught() {
    let (verilog, ports) = compile("imu_spi", blocks::imu_spi::ImuSpi::default());
    let broken = mutate(&verilog, "word_end = 5'b11110", "word_end = 5'b11100");
    let inputs = stimulus::imu_spi::stimulus(11, 200_000);
    let mut twin = imu_spi::ImuSpi::default();
    let difference = first_difference("imu_spi", &broken, &ports, &inputs, |inputs| twin.clock(inputs));
    assert!(difference.is_some());
}

/// Sine, cosine and fraction of every entry's two ends and a million more angles.
#[test]
fn a_million_angles_equal_the_reference() {
    use fixed_kin::pose::{fraction, sine};
    let (verilog, ports) = compile("trigonometry", blocks::trigonometry::Trigonometry::default());
    let mut random = ChaCha8Rng::seed_from_u64(24);
    let ends = (0..1_024_u32).flat_map(|entry| [entry << 22, (entry << 22) | 0x3F_FFFF]);
    let angles: Vec<u32> = ends.chain((0..OPERATIONS).map(|_| random.next_u32())).collect();
    for angles in angles.chunks(100_000) {
        let mut rows = Vec::with_capacity(6 * angles.len());
        angles.iter().for_each(|&angle| rows.extend([1, angle, 0, !angle]));
        let response = respond("trigonometry", &verilog, &ports, &Clocks::Together, &rows);
        for (angle, got) in angles.iter().zip(response.chunks_exact(6)) {
            let expected = [sine(*angle, 0), sine(*angle, 1), fraction(*angle)].map(|word| word as u32 & 0x3_FFFF);
            assert_eq!(got[3..], expected, "{angle:#x}");
        }
    }
}

/// See [`a_broken_pwm_is_caught`].
#[test]
fn a_multiplier_without_rounding_is_caught() {
    let (verilog, ports) = compile("multiplier", blocks::multiplier::Multiplier::default());
    let broken = mutate(&verilog, "half_coefficient = 32'h8000", "half_coefficient = 32'h0");
    let mut rows = Vec::new();
    let mut random = ChaCha8Rng::seed_from_u64(23);
    let mut wanted = Vec::new();
    for _ in 0..1_000 {
        let (a, b) = (random.random_range(WORD_MIN..=WORD_MAX), random.next_u32() as i32);
        operation(&mut rows, &[0, a as u32, b as u32], SCALES[0].digits());
        wanted.push((rows.len() / 4 - 1, multiply(a, b, SCALES[0])));
    }
    let response = respond("multiplier", &broken, &ports, &Clocks::Together, &rows);
    let wrong = wanted.iter().filter(|(row, expected)| response[2 * row + 1] as i32 != *expected).count();
    assert!(wrong > 100, "{wrong} of 1000 products differ");
}

fn mutate(verilog: &str, from: &str, to: &str) -> String {
    let broken = verilog.replacen(from, to, 1);
    assert_ne!(broken, verilog, "nothing to break: no `{from}` in the text");
    broken
}
