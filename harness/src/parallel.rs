//! Work that is spread over the threads of the current pool.

use crate::Failure;
use rayon::prelude::*;

/// Returns what `each` makes of 0 to `count` − 1, in that order.
///
/// `each` is behind a pointer, so that rayon is compiled once per type of result and not once per loop: for work of microseconds and more. A
/// task is one number, since some take a thousand times as long as others.
pub fn in_parallel<R: Send>(count: usize, each: &(dyn Fn(usize) -> R + Sync)) -> Vec<R> {
    (0..count).into_par_iter().with_max_len(1).map(each).collect()
}

/// Returns what `each` makes of 0 to `count` − 1, or the failure of the least of them that fails.
pub fn try_in_parallel<R: Send>(
    count: usize,
    each: &(dyn Fn(usize) -> Result<R, Failure> + Sync),
) -> Result<Vec<R>, Failure> {
    in_parallel(count, each).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_their_order_and_the_first_failure_counts() {
        assert_eq!(in_parallel(5, &|i| 10 * i), [0, 10, 20, 30, 40]);
        let odd = |i: usize| if i % 2 == 1 { Err(Failure::refused(format!("{i}"))) } else { Ok(i) };
        assert_eq!(try_in_parallel(5, &odd), Err(Failure::refused("1")));
        assert_eq!(try_in_parallel(1, &odd), Ok(vec![0]));
    }
}
