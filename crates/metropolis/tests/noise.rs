//! Random transmittance, and whatever else is random in a contribution, stays with the state.

mod toys;

use fairflight_metropolis::{Film, Plan, Proposed, Splats, Target, Which};
use fairflight_sources::{PathEnd, Row, SmallStep, UniformSource};
use toys::{SEED, accepted, half, modes, rejected, score, verdict};

/// An unbiased estimate of the modes: noisy in the left half alone.
fn estimate(u: f64, chance: f64) -> f64 {
    let noise = match half(u) {
        [0, 0] if chance < 2.0 / 3.0 => 0.5,
        [0, 0] => 2.0,
        _ => 1.0,
    };
    modes(u) * noise
}

/// A state with its estimate, which stays with it; or is drawn anew at each step, a mistake.
struct Noisy {
    present: (f64, f64),
    proposed: (f64, f64),
    is_drawn_anew: bool,
}

impl Target<f64> for Noisy {
    fn draw(&mut self, source: &mut dyn UniformSource) -> f64 {
        let u = source.next_uniform();
        self.proposed = (u, estimate(u, source.next_uniform()));
        self.proposed.1
    }
    fn propose(&mut self, source: &mut dyn UniformSource) -> Proposed {
        let (u, _) = self.present;
        if self.is_drawn_anew {
            self.present.1 = estimate(u, source.next_uniform());
        }
        let v = SmallStep::new(0.1, 0.5).unwrap().from(u, source.next_uniform());
        self.proposed = (v, estimate(v, source.next_uniform()));
        Proposed { kind: 0, acceptance: (self.proposed.1 / self.present.1).min(1.0) }
    }
    fn accept(&mut self) {
        self.present = self.proposed;
    }
    fn deposit(&self, which: Which, energy: f64, film: &mut Film<'_, f64>) {
        film(half(if which == Which::Present { self.present.0 } else { self.proposed.0 }), energy);
    }
    fn kinds(&self) -> &[&'static str] {
        &["step"]
    }
}

#[test]
fn an_estimate_that_stays_with_its_state_is_as_good_as_the_truth() {
    let plan = Plan::new(16, 1, 30).unwrap();
    let mut target = Noisy { present: (0.0, 0.0), proposed: (0.0, 0.0), is_drawn_anew: false };
    accepted("kept", &verdict(40_000, SEED, |seed| score(&plan, &mut target, seed).0));
    // mlt_fresh_noise: expected |z| 49.
    target.is_drawn_anew = true;
    rejected("mlt_fresh_noise", &verdict(40_000, SEED, |seed| score(&plan, &mut target, seed).0));
}

#[test]
fn in_primary_samples_the_estimate_is_part_of_the_state() {
    let mut integrand = |splats: &mut Splats<f64>, source: &mut dyn UniformSource| {
        let u = source.next_uniform();
        source.row(Row::connection(PathEnd::Camera, 1));
        splats.push(half(u), estimate(u, source.next_uniform()));
    };
    let mut target = fairflight_metropolis::Primary::new(&mut integrand);
    let plan = Plan::new(16, 1, 30).unwrap();
    accepted("primary", &verdict(40_000, SEED, |seed| score(&plan, &mut target, seed).0));
}
