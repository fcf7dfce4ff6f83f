//! The contracts of the word's operations, proven by trying: every operand of the multiplier at the edges of the word, every
//! denominator at the edges of the numerator, every pair around the edges of the sums. Nothing panics (overflow checks are
//! on), nothing wraps, every result is the one that the contract leaves.

use fixed_kin::word::{Scale, WORD_MAX, WORD_MIN, add, divide, multiply, saturate, subtract};

/// Words at which something changes: ends, powers of two and their neighbours, and some between.
fn edges() -> Vec<i32> {
    let mut words = vec![0, 1, -1, WORD_MAX, WORD_MAX - 1, WORD_MIN, WORD_MIN + 1, 0x1555_5555, -0x0AAA_AAAB];
    for bit in 1..29 {
        words.extend([1 << bit, (1 << bit) - 1, -(1 << bit), -(1 << bit) - 1]);
    }
    words
}

fn is_word(value: i32) -> bool {
    (WORD_MIN..=WORD_MAX).contains(&value)
}

/// Half up: r ≤ a·b/2ᶠ + ½ < r + 1, unless that is no word.
fn check_product(a: i32, b: i32, scale: Scale) {
    let (got, one) = (i64::from(multiply(a, b, scale)), 1_i64 << scale.fraction_bits());
    let doubled = 2 * i64::from(a) * i64::from(b) + one;
    let holds = match got {
        _ if got == i64::from(WORD_MAX) => doubled >= 2 * one * got,
        _ if got == i64::from(WORD_MIN) => doubled < 2 * one * (got + 1),
        _ => 2 * one * got <= doubled && doubled < 2 * one * (got + 1),
    };
    assert!(holds && got.abs() <= 1 << 29, "{a} · {b}, {scale:?}: {got}");
}

#[test]
fn every_operand_of_the_multiplier_at_the_edges_of_the_word() {
    let edges = edges();
    for scale in [Scale::PERIOD, Scale::COUNTS, Scale::COEFFICIENT] {
        let half = 1_i32 << (scale.operand_bits() - 1);
        for b in -half..half {
            edges.iter().for_each(|a| check_product(*a, b, scale));
        }
    }
    for scale in [Scale::FINE, Scale::WIDE] {
        let half = 1_i32 << (scale.operand_bits() - 1);
        for b in -half..half {
            [WORD_MIN, -1, 1, WORD_MAX].iter().for_each(|a| check_product(*a, b, scale));
        }
        for b in edges.iter().filter(|b| (-half..half).contains(*b)) {
            (WORD_MIN..=WORD_MAX).step_by(10_007).for_each(|a| check_product(a, *b, scale));
        }
    }
}

#[test]
fn bits_beyond_the_operand_do_not_count() {
    for scale in [Scale::PERIOD, Scale::COUNTS, Scale::COEFFICIENT, Scale::FINE, Scale::WIDE] {
        let beyond = -1_i32 << scale.operand_bits();
        for a in edges() {
            for b in edges() {
                assert_eq!(multiply(a, b, scale), multiply(a, b ^ beyond, scale), "{a} · {b}, {scale:?}");
            }
        }
    }
}

#[test]
fn sums_around_all_edges_are_exact_or_at_the_end() {
    let near = |edge: i32| (-20..=20).map(move |k| edge + k).filter(|w| is_word(*w));
    let words: Vec<i32> = edges().into_iter().flat_map(near).collect();
    for &a in &words {
        for &b in &words {
            let (sum, difference) = (i64::from(a) + i64::from(b), i64::from(a) - i64::from(b));
            let nearest = |value: i64| value.max(WORD_MIN.into()).min(WORD_MAX.into());
            assert_eq!(
                (i64::from(add(a, b)), i64::from(subtract(a, b))),
                (nearest(sum), nearest(difference)),
                "{a}, {b}"
            );
            assert_eq!(i64::from(saturate(sum)), nearest(sum));
        }
    }
    assert_eq!([saturate(i64::MIN), saturate(i64::MAX)], [WORD_MIN, WORD_MAX]);
    // Arguments that are no words saturate too.
    assert_eq!([add(i32::MAX, i32::MAX), subtract(i32::MIN, i32::MAX)], [WORD_MAX, WORD_MIN]);
}

/// Towards zero: |q|·d ≤ |n|·2³² < (|q| + 1)·d, or ±(2²⁹ − 1) where that is more; the sign of the numerator.
fn check_quotient(n: i32, d: u32) {
    let got = divide(n, d);
    let (q, whole) = (u128::from(got.unsigned_abs()), u128::from(n.unsigned_abs()) << 32);
    let towards_zero = q * u128::from(d) <= whole;
    let nearest = got.abs() == WORD_MAX || whole < (q + 1) * u128::from(d);
    assert!(towards_zero && nearest && (got == 0 || (got < 0) == (n < 0)), "{n} / {d}: {got}");
}

#[test]
fn every_denominator_of_the_gateware_at_the_edges_of_the_numerator() {
    for d in 1..1 << 24 {
        [0, 1, -1, 3, (1 << 21) - 1, -(1 << 21)].iter().for_each(|n| check_quotient(*n, d));
    }
    for n in edges().into_iter().chain([i32::MIN, i32::MAX]) {
        (1..u32::MAX).step_by(65_521).chain([2, 3, 7, u32::MAX]).for_each(|d| check_quotient(n, d));
        assert_eq!(divide(n, 0), if n < 0 { -WORD_MAX } else { WORD_MAX }, "{n} / 0");
    }
}
