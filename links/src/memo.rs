//! What laws in some numbers made of a segment: a search asks for the same ones again while it changes other numbers.

use std::sync::{Arc, Mutex, PoisonError};

/// Answers kept, those asked for last: ten starts of slip are asked for together, and what a fit tries beside.
const KEPT: usize = 16;

/// Rows `[wheel][tick]`, or nothing.
pub(crate) type Answer = Option<Arc<Vec<Vec<f64>>>>;

/// Answers by the numbers that they follow from. A copy begins without any.
#[derive(Debug, Default)]
pub struct Memo {
    known: Mutex<Vec<(Vec<f64>, Answer)>>,
}

impl Clone for Memo {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Memo {
    /// The answer of these numbers, worked out if it is not there.
    pub(crate) fn get(&self, numbers: Vec<f64>, work: impl FnOnce() -> Answer) -> Answer {
        if let Some(known) = self.find(&numbers) {
            return known;
        }
        // Others are not kept waiting.
        let answer = work();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.truncate(KEPT - 1);
        known.insert(0, (numbers, answer.clone()));
        answer
    }

    fn find(&self, numbers: &[f64]) -> Option<Answer> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let place = known.iter().position(|(of, _)| of == numbers)?;
        known[..=place].rotate_right(1);
        Some(known[0].1.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_asked_for_last_is_worked_out_once() {
        let memo = Memo::default();
        let mut worked = 0;
        let mut ask = |number: usize| {
            let answer = memo.get(vec![number as f64], || {
                worked += 1;
                Some(Arc::new(vec![vec![number as f64]]))
            });
            assert_eq!(answer.unwrap()[0][0], number as f64);
            worked
        };
        assert_eq!([ask(0), ask(1), ask(0)], [1, 2, 2]);
        // Others push out what was asked for first.
        for number in 2..=KEPT {
            ask(number);
        }
        assert_eq!(ask(0), KEPT + 1, "asked for after 1");
        assert_eq!(ask(1), KEPT + 2);
        assert_eq!(memo.clone().known.lock().unwrap().len(), 0);
    }
}
