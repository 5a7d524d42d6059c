//! A source that replays a list: exact algebra in tests.

use crate::UniformSource;

/// Returns the given variates in order, and panics when they are exhausted: a sampler that draws more than it should is
/// a failing test, not a silent repetition.
#[derive(Clone, Debug)]
pub struct Scripted {
    variates: Vec<f64>,
    drawn: usize,
}

impl Scripted {
    /// A source of exactly these variates.
    ///
    /// # Panics
    /// If a variate is outside `[0, 1)`.
    #[must_use]
    pub fn new(variates: impl IntoIterator<Item = f64>) -> Self {
        let variates: Vec<f64> = variates.into_iter().collect();
        for u in &variates {
            assert!((0.0..1.0).contains(u), "a scripted variate must lie in [0, 1): {u}");
        }
        Self { variates, drawn: 0 }
    }

    /// Number of variates that are left.
    #[must_use]
    pub fn remaining(&self) -> usize {
        self.variates.len() - self.drawn
    }
}

impl UniformSource for Scripted {
    fn next_uniform(&mut self) -> f64 {
        let u = *self.variates.get(self.drawn).expect("the scripted source is exhausted");
        self.drawn += 1;
        u
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "exhausted")]
    fn it_fails_when_exhausted() {
        let mut source = Scripted::new([0.5]);
        assert_eq!(source.next_uniform(), 0.5);
        assert_eq!(source.remaining(), 0);
        source.next_uniform();
    }

    #[test]
    #[should_panic(expected = "must lie in [0, 1)")]
    fn it_refuses_one() {
        let _ = Scripted::new([1.0]);
    }
}
