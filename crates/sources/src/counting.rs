//! A source that counts what is drawn from it.

use crate::{Row, UniformSource};

/// Counts the variates that a sampler draws, so that a test asserts cost and not only value.
#[derive(Clone, Debug)]
pub struct Counting<S> {
    inner: S,
    drawn: u64,
}

impl<S> Counting<S> {
    /// Counts what is drawn from `inner` from here on.
    pub fn new(inner: S) -> Self {
        Self { inner, drawn: 0 }
    }

    /// The number of variates drawn so far.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }
}

impl<S: UniformSource> UniformSource for Counting<S> {
    #[inline]
    fn next_uniform(&mut self) -> f64 {
        self.drawn += 1;
        self.inner.next_uniform()
    }

    #[inline]
    fn row(&mut self, row: Row) {
        self.inner.row(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scripted;

    #[test]
    fn it_counts() {
        let mut source = Counting::new(Scripted::new([0.1, 0.2, 0.3]));
        source.next_uniform();
        source.next_exponential();
        assert_eq!(source.drawn(), 2);
    }
}
