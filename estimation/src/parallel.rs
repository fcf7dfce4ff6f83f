//! The same work on many things, on all cores.
//!
//! The work is behind a reference, so that rayon's splitting is compiled once for a kind of result and not once for every
//! place that asks for it.

use rayon::prelude::*;

/// What `work` makes of each number below `count`, in their order.
pub fn numbered<B: Send>(count: usize, work: &(dyn Fn(usize) -> B + Sync)) -> Vec<B> {
    (0..count).into_par_iter().map(work).collect()
}

/// What `work` makes of each item, in their order.
pub fn each<A: Sync, B: Send>(items: &[A], work: &(dyn Fn(&A) -> B + Sync)) -> Vec<B> {
    numbered(items.len(), &|i| work(&items[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_the_items() {
        let items: Vec<u64> = (0..10_000).rev().collect();
        let squares: Vec<u64> = items.iter().map(|x| x * x).collect();
        assert_eq!(each(&items, &|x| x * x), squares);
        assert_eq!(numbered(0, &|i| i), Vec::<usize>::new());
    }
}
