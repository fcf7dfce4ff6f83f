//! What a speed loop takes its set points for: it subtracts from them the speeds that it measures.

use estimation::normal_equations::solve;
use nalgebra::{DMatrix, DVector};
use runs::robot::Robot;
use runs::{Columns, Log};

use super::samples::{FEWEST, HELD, MOST_TICKS};

/// Share of the squared change of duty from row to row that set points and speeds make, from which a loop makes the duties
/// of them: six simulated loops had 0.97 to 0.99 at the rate of the loop.
const MADE: f64 = 0.9;

/// Set points that a loop takes for one speed by the counts: what the duty answers a change of speed with per what it
/// answers one of set point with. A set point in another unit is as many times the speed that it asks for, however far a
/// weak loop stays behind it. `None` where the duties are not made so.
pub(super) fn per_speed(robot: &Robot, logs: &[Log]) -> Option<f64> {
    let (mut information, mut score, mut square, mut rows) = (DMatrix::zeros(4, 4), DVector::zeros(4), 0.0, 0_usize);
    let mut add = |row: DVector<f64>, change: f64| {
        information.ger(1.0, &row, &row, 1.0);
        score.axpy(change, &row, 1.0);
        square += change * change;
        rows += 1;
    };
    for log in logs {
        let columns = Columns { counts: true, reference: true, duty: true, ..Columns::NONE };
        let run = log.part(0..log.len().min(MOST_TICKS), columns);
        let wheels = run.counts.len().min(run.reference.len()).min(run.duty.len());
        for i in 0..wheels {
            let gaps = run.count_gaps.get(i).map_or(&[][..], |gaps| gaps);
            let (reference, duty) = (&run.reference[i], &run.duty[i]);
            let whole = |k: &usize| reference[*k].is_finite() && duty[*k].is_finite() && gaps.binary_search(k).is_err();
            let sampled: Vec<usize> = (0..run.len()).filter(whole).collect();
            let most = sampled.iter().map(|k| duty[*k].abs()).fold(0.0, f64::max);
            let turn = |a: usize, b: usize| run.counts[i][b].wrapping_sub(run.counts[i][a]) as f64;
            let speed = |a: usize, b: usize| turn(a, b) / robot.counts_per_wheel_rad() / (run.t[b] - run.t[a]);
            for three in sampled.windows(3) {
                let &[a, b, c] = three else { continue };
                // At its limit a duty answers nothing.
                if duty[b].abs().min(duty[c].abs()) < HELD * most {
                    let (last, now) = (speed(a, b), speed(b, c));
                    // The integral's part goes with set point and speed themselves.
                    let row = [reference[c] - reference[b], last - now, reference[c], now];
                    add(DVector::from_row_slice(&row), duty[c] - duty[b]);
                }
            }
        }
    }
    let answers = solve(&information, &score);
    let made = answers.dot(&score) > MADE * square && rows >= FEWEST && answers[0] > 0.0 && answers[1] > 0.0;
    made.then(|| answers[1] / answers[0])
}
