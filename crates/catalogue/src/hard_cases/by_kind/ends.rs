//! Row 14: the variates at both ends of their lattice.

use super::{Profile, subjects};
use crate::hard_cases::{HardCase, Outcome};
use fairflight_freeflight::Flight;
use fairflight_media::Extinction;
use fairflight_sources::{LARGEST_VARIATE, Seeded, UniformSource};

/// One end of the lattice for a while, then variates like any other: a walk of flights of length 0 would never end, nor would a roulette
/// that always goes on.
pub(crate) struct End {
    variate: f64,
    left: u32,
    then: Seeded,
}

impl End {
    /// `left` times `variate`, and then the stream of `left`.
    pub(crate) fn new(variate: f64, left: u32) -> Self {
        Self { variate, left, then: Seeded::new(left.into()) }
    }
}

impl UniformSource for End {
    fn next_uniform(&mut self) -> f64 {
        if self.left == 0 {
            return self.then.next_uniform();
        }
        self.left -= 1;
        self.variate
    }
}

/// Row 14 of one kind: the variates at either end of the lattice, and then any.
pub(super) fn at_the_ends(kind: &'static str) -> HardCase {
    let title = format!("the uniform variates 0 and 1 - 2^-53: {kind}");
    let evaluate = move || {
        let profiles = [
            Profile::constant(0.7, 3.0, (0.0, 1.0)),
            // Empty at first, and in the middle.
            Profile::steps(&[0.0, 1.0, 3.0, 4.0, 5.0], &[0.0, 0.5, 0.0, 0.2]),
        ];
        for subject in subjects().into_iter().filter(|subject| subject.kind == kind) {
            for (profile, variate) in
                profiles.iter().flat_map(|profile| [(profile, 0.0), (profile, LARGEST_VARIATE)])
            {
                if !(1..5).all(|left| (subject.draw)(profile, &mut End::new(variate, left))) {
                    return Outcome::said(false, format!("{}, variates of {variate}", subject.name));
                }
            }
        }
        Outcome::said(true, "finite, and a collision only where matter is")
    };
    HardCase::deterministic(14, title, kind, "finite", "finite", evaluate).about([kind])
}

/// A flight that collided did so on the profile, where there is matter, with a finite weight.
pub(super) fn is_lawful<F: Extinction>(field: &F, flight: Flight) -> bool {
    let collides = |s: f64| (0.0..=field.length()).contains(&s) && field.sigma_t(s) > 0.0;
    flight.weight().is_finite() && flight.distance().is_none_or(collides)
}
