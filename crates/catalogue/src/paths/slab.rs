//! A plane-parallel slab as a scene: a box so wide that no walk comes to its sides.

use super::doubling::{Lit, OBLIQUE};
use fairflight_media::{Bounds, FieldError, Homogeneous, Line, PhaseFunction};
use fairflight_scene::{Background, EnvironmentMap, Lights, SceneError, Source, Spectrum, Volume};
use glam::{DVec3, dvec3};

/// Half of the width of the box \[mean free paths\].
pub const HALF_WIDTH: f64 = 10_000.0;

/// The slab 0 ≤ y ≤ `optical_thickness` of extinction 1.
///
/// # Errors
/// If the thickness is no positive number.
pub fn volume<P, C>(
    optical_thickness: f64,
    albedo: C,
    phase: P,
) -> Result<Volume<Homogeneous, P, C>, FieldError> {
    Ok(Volume {
        medium: Homogeneous::new(1.0)?,
        bounds: Bounds::aligned_box(
            dvec3(-HALF_WIDTH, 0.0, -HALF_WIDTH),
            dvec3(HALF_WIDTH, optical_thickness, HALF_WIDTH),
        )?,
        albedo,
        phase,
    })
}

/// Light from above.
///
/// # Errors
/// None, as long as the light is a number.
pub fn lights<C: Spectrum>(lit: Lit) -> Result<Lights<C>, SceneError> {
    let mut lights = Lights { background: Background::dark(), sources: Vec::new() };
    match lit {
        Lit::Diffusely => {
            let map = EnvironmentMap::new(1, 2, vec![C::splat(1.0), C::ZERO])?;
            lights.background.maps.push(map);
        }
        Lit::Normally => lights.sources.push(Source::directional(-DVec3::Y, C::splat(1.0))?),
    }
    Ok(lights)
}

/// The ray that sees the light reflected, or transmitted, at the cosine of [`super::doubling::Slab::respond`].
#[must_use]
pub fn line(lit: Lit, reflected: bool, optical_thickness: f64) -> Line {
    let cosine = match lit {
        Lit::Diffusely => 1.0,
        Lit::Normally => OBLIQUE,
    };
    let down = if reflected { -cosine } else { cosine };
    let direction = dvec3(((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt(), down, 0.0);
    let y = if reflected { optical_thickness + 1.0 } else { -1.0 };
    Line { origin: dvec3(0.0, y, 0.0), direction }
}

/// A bound of what the sides of the box change, for radiance of at most 1 all around.
///
/// Only paths differ that come to a side, and each contributes at most g^n after n collisions, g = max(a, 1). From anywhere in the slab
/// a particle leaves without a further collision with a probability of at least p = 4π min(phase) E_2(τ/2) > 4π min(phase)
/// e^{−τ/2}/(τ/2 + 2): of walks of more than k collisions there is at most (g (1 − p))^k/(1 − g (1 − p)). Those of k or fewer come to
/// the side only if k flights are longer than it is far, with a probability of at most (W/k)^k e^{k − W} by Chernoff's bound,
/// W ≥ k. The best k is taken.
#[must_use]
pub fn sideways<P: PhaseFunction>(optical_thickness: f64, albedo: f64, phase: &P) -> f64 {
    let least = (0..=100).map(|i| phase.eval(f64::from(i) / 50.0 - 1.0)).fold(f64::INFINITY, f64::min);
    let half = 0.5 * optical_thickness;
    let leaves = 4.0 * std::f64::consts::PI * least * (-half).exp() / (half + 2.0);
    let gain = albedo.max(1.0);
    let stays = gain * (1.0 - leaves);
    if stays >= 1.0 {
        return f64::INFINITY;
    }
    let mut best = f64::INFINITY;
    let mut k = 1.0;
    while k < 0.5 * HALF_WIDTH {
        let long = stays.powf(k) / (1.0 - stays);
        let far = (k * (gain.ln() + (HALF_WIDTH / k).ln() + 1.0) - HALF_WIDTH).exp();
        best = best.min(long + far);
        k *= 2.0;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::phase::{HenyeyGreenstein, Isotropic, Rayleigh};

    #[test]
    fn the_sides_are_out_of_reach() {
        for bound in [
            sideways(5.0, 0.999, &Isotropic),
            sideways(5.0, 0.999, &Rayleigh),
            sideways(1.0, 0.9, &HenyeyGreenstein::new(0.5).unwrap()),
            sideways(0.3, 1.2, &Isotropic),
        ] {
            assert!(bound < 1e-15, "{bound}");
        }
        assert_eq!(sideways(5.0, 1.2, &Isotropic), f64::INFINITY);
    }
}
