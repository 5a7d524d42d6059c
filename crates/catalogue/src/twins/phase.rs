//! Mistakes with a phase function.

use super::trial::LAWFUL;
use super::{Evident, Rejection, Twin};
use crate::vectors::Answer;
use fairflight_laws::phase::{check_exactly, check_samples};
use fairflight_media::phase::{HenyeyGreenstein, Schlick};
use fairflight_media::{PhaseFunction, Scattered};
use fairflight_sources::UniformSource;
use glam::{DVec3, dvec3};

/// A phase function whose scattered direction is about the direction back to where the particle came from.
struct Reversed<P>(P);

impl<P: PhaseFunction> PhaseFunction for Reversed<P> {
    fn eval(&self, cosine: f64) -> f64 {
        self.0.eval(cosine)
    }
    fn sample_cosine(&self, u: f64) -> f64 {
        self.0.sample_cosine(u)
    }
    fn mean_cosine(&self) -> f64 {
        self.0.mean_cosine()
    }
    fn sample(&self, incident: DVec3, u: f64, v: f64) -> Scattered {
        self.0.sample(-incident, u, v) // right: about the direction of travel
    }
}

/// The inversion as printed.
struct Cancelling {
    g: f64,
    right: HenyeyGreenstein,
}

impl PhaseFunction for Cancelling {
    fn eval(&self, cosine: f64) -> f64 {
        self.right.eval(cosine)
    }
    fn sample_cosine(&self, u: f64) -> f64 {
        let g = self.g;
        let quotient = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
        // Right: the form without the division by g.
        ((1.0 + g * g - quotient * quotient) / (2.0 * g)).clamp(-1.0, 1.0)
    }
    fn mean_cosine(&self) -> f64 {
        self.right.mean_cosine()
    }
}

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    vec![
        // The mean cosine is −g, the variance that of the right one, (1 + 2g²)/3 − g² = 1/4 at g = 1/2: 2g √N/σ.
        Twin::new(
            "phase function",
            "phase_about_the_reversed_direction",
            "the lobe about the direction towards the last collision, not the direction of travel",
            "Henyey-Greenstein, g = 0.5",
            (20_000, Evident::Mean { z: 282.8 }),
            |run| {
                let evidence = check_samples(&Reversed(HenyeyGreenstein::new(0.5).expect(LAWFUL)), run);
                Rejection {
                    rejected: evidence.cosine.sound == Some(false),
                    mean_z: evidence.mean_z,
                    variance_z: None,
                    reason: format!("cosine {}", evidence.cosine.reason),
                }
            },
        )
        .answers(|vector, source| {
            let [x, y, z] = vector.numbers("/incident")[..] else { return None };
            let (incident, reversed) = (dvec3(x, y, z), Reversed(Schlick::new((vector.number)("/phase/k")?).ok()?));
            let (u, v) = (source.next_uniform(), source.next_uniform());
            let Scattered { direction, pdf_solid_angle, .. } = reversed.sample(incident, u, v);
            let values = vec![incident.dot(direction), direction.length(), pdf_solid_angle];
            Some(Answer { values, collided: None })
        }),
        Twin::new(
            "phase function",
            "henyey_greenstein_that_cancels",
            "the inversion as printed, (1 + g² − ((1 − g²)/(1 − g + 2gu))²)/(2g), whose rounding error is 1e-16/g",
            "Henyey-Greenstein, g = 1e-12",
            (0, Evident::Exactly),
            |_| {
                let right = HenyeyGreenstein::new(1e-12).expect(LAWFUL);
                match (check_exactly(&right), check_exactly(&Cancelling { g: 1e-12, right })) {
                    (Ok(()), Err(broken)) => Rejection::exact(true, broken.to_string()),
                    (right, _) => Rejection::exact(false, format!("not told from the right one: {right:?}")),
                }
            },
        )
        .answers(|vector, source| {
            let g = (vector.number)("/phase/g").filter(|g| *g != 0.0)?;
            let cancelling = Cancelling { g, right: HenyeyGreenstein::new(g).ok()? };
            let cosine = cancelling.sample_cosine(source.next_uniform());
            Some(Answer { values: vec![cosine, cancelling.eval(cosine)], collided: None })
        }),
    ]
}
