//! Sampling extinction in space: how often a walk looks the medium up, and where.

use fairflight_elementary::lanes::{LANES, Lanes};
use fairflight_media::Line;

/// The rate σ_samp(p) at which walks meet collisions.
///
/// **Law.** The distance from `from` to the returned one has the rate σ_samp along the line: `depth` = ∫ σ_samp between the
/// two (szirmay-kalos-2017 eq. 4). It need not bound the extinction; it must be positive wherever the extinction is not 0,
/// or the walk passes matter unseen: a silent bias.
pub trait SamplingExtinction {
    /// The next collision on `line`, within `length`, and σ_samp there; `None` if there is none.
    fn fly(&self, line: &Line, from: f64, length: f64, depth: f64) -> Option<(f64, f64)>;

    /// The next collisions of all lanes, ∞ for none, and σ_samp there: each with the bits of [`fly`](Self::fly). `line` tells that of a lane.
    #[inline(always)]
    fn fly_lanes(&self, line: impl Fn(usize) -> Line, [from, length, depth]: [&Lanes; 3]) -> [Lanes; 2] {
        let mut flights = [[f64::INFINITY; LANES], [1.0; LANES]];
        for i in 0..LANES {
            if let Some((s, sigma_samp)) = self.fly(&line(i), from[i], length[i], depth[i]) {
                (flights[0][i], flights[1][i]) = (s, sigma_samp);
            }
        }
        flights
    }

    /// The greatest value \[1/length\].
    fn highest(&self) -> f64;

    /// The least value \[1/length\]; 0 nowhere.
    fn lowest(&self) -> f64;
}

/// The same everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform {
    sigma_samp: f64,
    mean_free_path: f64,
}

/// A sampling extinction that is not a positive number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{what} must be a finite number above 0, found {found}")]
pub struct NotPositive {
    /// The parameter.
    pub what: &'static str,
    /// The value given.
    pub found: f64,
}

impl NotPositive {
    pub(crate) fn check(what: &'static str, found: f64) -> Result<(), Self> {
        if found > 0.0 && found.is_finite() { Ok(()) } else { Err(Self { what, found }) }
    }
}

impl Uniform {
    /// σ_samp \[1/length\].
    ///
    /// # Errors
    /// If it is not positive and finite.
    pub fn new(sigma_samp: f64) -> Result<Self, NotPositive> {
        NotPositive::check("sigma_samp", sigma_samp)?;
        Ok(Self { sigma_samp, mean_free_path: 1.0 / sigma_samp })
    }
}

impl SamplingExtinction for Uniform {
    #[inline]
    fn fly(&self, _line: &Line, from: f64, length: f64, depth: f64) -> Option<(f64, f64)> {
        let s = from + depth * self.mean_free_path;
        (s < length).then_some((s, self.sigma_samp))
    }
    #[inline(always)]
    fn fly_lanes(&self, _line: impl Fn(usize) -> Line, [from, length, depth]: [&Lanes; 3]) -> [Lanes; 2] {
        let mut to = [0.0; LANES];
        for i in 0..LANES {
            let s = from[i] + depth[i] * self.mean_free_path;
            to[i] = if s < length[i] { s } else { f64::INFINITY };
        }
        [to, [self.sigma_samp; LANES]]
    }
    fn highest(&self) -> f64 {
        self.sigma_samp
    }
    fn lowest(&self) -> f64 {
        self.sigma_samp
    }
}

impl<R: SamplingExtinction> SamplingExtinction for &R {
    #[inline]
    fn fly(&self, line: &Line, from: f64, length: f64, depth: f64) -> Option<(f64, f64)> {
        (**self).fly(line, from, length, depth)
    }
    #[inline(always)]
    fn fly_lanes(&self, line: impl Fn(usize) -> Line, distances: [&Lanes; 3]) -> [Lanes; 2] {
        (**self).fly_lanes(line, distances)
    }
    fn highest(&self) -> f64 {
        (**self).highest()
    }
    fn lowest(&self) -> f64 {
        (**self).lowest()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_pass_through_a_reference() {
        fn bounds(sampling: impl SamplingExtinction) -> [f64; 2] {
            [sampling.lowest(), sampling.highest()]
        }
        let uniform = &Uniform::new(0.3).unwrap();
        assert_eq!(bounds(uniform), [0.3; 2]);
        assert_eq!(bounds(*uniform), [0.3; 2]);
    }
}
