//! The memory that one call may take, set by the size of the file.
//!
//! Every count in the file is checked against the bytes that remain before anything is allocated for it, and each node's
//! masks are stored uncompressed: an upper node takes 8205 bytes of file and 136 KiB of memory, a lower node 1025 bytes and
//! 17 KiB, a leaf 129 bytes and 2112 bytes, a factor of 17 at most, twice that when a growing array has just doubled. The
//! budget is the second line of defence: a forgotten check ends here as an error, not as an aborted process.

use crate::error::VdbError;

/// Bytes of memory that reading may hold for each byte of the file.
pub const MAX_EXPANSION: usize = 48;

/// Bytes of memory that reading may hold besides, whatever the size of the file: buffers for the largest node.
pub const FIXED_ALLOWANCE: usize = 1 << 20;

pub(crate) struct Budget {
    spent: usize,
    limit: usize,
}

impl Budget {
    pub(crate) fn for_file(length: usize) -> Self {
        Self { spent: 0, limit: length.saturating_mul(MAX_EXPANSION).saturating_add(FIXED_ALLOWANCE) }
    }

    /// Notes an allocation about to be made.
    pub(crate) fn charge(&mut self, bytes: usize) -> Result<(), VdbError> {
        let asked = self.spent.saturating_add(bytes);
        if asked > self.limit {
            return Err(VdbError::TooLarge {
                what: "the memory needed by this file".to_owned(),
                asked: asked as u64,
                limit: self.limit as u64,
            });
        }
        self.spent = asked;
        Ok(())
    }

    /// Makes room for `additional` items, at least doubling so that repeated calls stay linear in time.
    pub(crate) fn reserve<T>(&mut self, vec: &mut Vec<T>, additional: usize) -> Result<(), VdbError> {
        let needed = vec.len().saturating_add(additional);
        if needed <= vec.capacity() {
            return Ok(());
        }
        let capacity = needed.max(vec.capacity().saturating_mul(2));
        self.charge((capacity - vec.capacity()).saturating_mul(size_of::<T>()))?;
        vec.reserve_exact(capacity - vec.len());
        Ok(())
    }

    #[cfg(test)]
    pub(crate) fn spent(&self) -> usize {
        self.spent
    }
}

#[cfg(test)]
mod tests {
    use super::{Budget, FIXED_ALLOWANCE, MAX_EXPANSION};
    use crate::error::VdbError;

    #[test]
    fn the_limit_is_linear_in_the_file() {
        let mut budget = Budget::for_file(10);
        let limit = FIXED_ALLOWANCE + 10 * MAX_EXPANSION;
        assert!(budget.charge(limit).is_ok());
        assert!(matches!(budget.charge(1), Err(VdbError::TooLarge { .. })));
    }

    #[test]
    fn huge_reservations_fail_without_allocating() {
        let mut budget = Budget::for_file(1000);
        let mut values: Vec<u64> = Vec::new();
        for huge in [usize::MAX, usize::MAX / 8, 1 << 40] {
            assert!(matches!(budget.reserve(&mut values, huge), Err(VdbError::TooLarge { .. })));
        }
        assert_eq!((values.capacity(), budget.spent()), (0, 0));
    }

    #[test]
    fn growth_is_charged_once() {
        let mut budget = Budget::for_file(0);
        let mut values: Vec<u64> = Vec::new();
        for value in 0..1000 {
            budget.reserve(&mut values, 1).expect("within the allowance");
            values.push(value);
        }
        assert_eq!(budget.spent(), 8 * values.capacity());
        assert!(values.capacity() < 2000);
    }
}
