//! The serial multiplier and the divider against `fixed_kin::word`.

use fixed_kin::word::{WORD_MAX, WORD_MIN, divide, multiply};
use hdl::blocks::divider::{DIVISION_STEPS, Divider};
use hdl::blocks::multiplier::{Multiplier, SCALES};
use hdl::sim::cycle;
use hdl::stimulus::control::word;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rust_hdl::prelude::*;

/// Of each here; a million of the emitted Verilog, which is compiled, in `testbench/tests/verilog_blocks.rs`.
const OPERATIONS: usize = 100_000;

struct Bench {
    multiplier: Multiplier,
    divider: Divider,
}

impl Bench {
    fn new() -> Self {
        let mut bench = Self { multiplier: Multiplier::default(), divider: Divider::default() };
        bench.multiplier.connect_all();
        bench.divider.connect_all();
        bench
    }

    fn multiply(&mut self, scale: usize, a: i32, b: i32) -> i32 {
        let unit = &mut self.multiplier;
        unit.start.next = true;
        unit.scale.next = scale.to_bits();
        unit.a.next = u64::from(a as u32).to_bits();
        unit.b.next = u64::from(b as u32).to_bits();
        cycle(unit, |u, level| u.clock.next = level.into());
        unit.start.next = false;
        for _ in 0..SCALES[scale].digits() {
            assert!(unit.busy.val(), "done too early");
            cycle(unit, |u, level| u.clock.next = level.into());
        }
        assert!(!unit.busy.val(), "not done");
        unit.result.val().index() as u32 as i32
    }

    fn divide(&mut self, numerator: i16, denominator: u32) -> i32 {
        let unit = &mut self.divider;
        unit.start.next = true;
        unit.numerator.next = u64::from(i32::from(numerator) as u32).to_bits();
        unit.denominator.next = u64::from(denominator).to_bits();
        cycle(unit, |u, level| u.clock.next = level.into());
        unit.start.next = false;
        for _ in 0..DIVISION_STEPS {
            assert!(unit.busy.val(), "done too early");
            cycle(unit, |u, level| u.clock.next = level.into());
        }
        assert!(!unit.busy.val(), "not done");
        // The program adds the one.
        unit.quotient.val().index() as u32 as i32 + i32::from(numerator < 0)
    }
}

#[test]
fn a_hundred_thousand_products_equal_the_reference() {
    let operations = if cfg!(debug_assertions) { 20_000 } else { OPERATIONS };
    let mut bench = Bench::new();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..operations {
        let scale = random.random_range(0..SCALES.len());
        let (a, b) = (word(&mut random), random.next_u32() as i32);
        assert_eq!(bench.multiply(scale, a, b), multiply(a, b, SCALES[scale]), "{a} * {b}, scale {scale}");
    }
}

#[test]
fn a_hundred_thousand_quotients_equal_the_reference() {
    let operations = if cfg!(debug_assertions) { 10_000 } else { OPERATIONS };
    let mut bench = Bench::new();
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..operations {
        let numerator = random.next_u32() as i16 >> random.random_range(0..16);
        let denominator = random.next_u32() >> random.random_range(8..32);
        let got = bench.divide(numerator, denominator);
        assert_eq!(got, divide(numerator.into(), denominator), "{numerator} / {denominator}");
    }
}

#[test]
fn corners() {
    let mut bench = Bench::new();
    let corners = [WORD_MIN, WORD_MIN + 1, -1, 0, 1, WORD_MAX - 1, WORD_MAX];
    for (scale, format) in SCALES.into_iter().enumerate() {
        let top = 1 << (format.operand_bits() - 1);
        for a in corners {
            for b in [-top, -top + 1, -1, 0, 1, top - 1, i32::MIN, i32::MAX] {
                assert_eq!(bench.multiply(scale, a, b), multiply(a, b, format), "{a} * {b}");
            }
        }
    }
    for numerator in [0, 1, 2, 7, 8, i16::MAX, -1, -2, -8, -i16::MAX, i16::MIN] {
        for denominator in [0, 1, 2, 8, 9, 1_000, 32_767, 32_768, 65_535, 65_536, 262_143, 262_144, 0xFF_FFFF] {
            assert_eq!(
                bench.divide(numerator, denominator),
                divide(numerator.into(), denominator),
                "{numerator} / {denominator}"
            );
        }
    }
}
