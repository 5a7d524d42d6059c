//! Transmittance of the camera ray at every distance, from one walk.

use fairflight_collision::CollisionModel;
use fairflight_elementary::exp;
use fairflight_media::{Constant, Extinction, LineThickness, Medium, OpticalThickness, Ray, Vacuum};
use fairflight_sources::UniformSource;
use fairflight_transmittance::{Explorers, Interaction, Regular, Tracking, TransmittanceFunction};

/// A random transmittance function of the camera ray.
///
/// **Law.** After [`trace`](Self::trace), E\[`transmittance(ray, s)`\] = T(0, s) for every s that is chosen without knowledge of
/// the walk. At the walk's own interaction points the law is another one (Slivnyak and Mecke): for a score g that does not
/// depend on the point i itself, E\[Σ g(s_i, T̂ *before* s_i)\] = ∫ σ_samp(s) E\[g(s, T̂(s))\] ds. The factor of s_i would be a bias.
pub trait Primary<M> {
    /// Draws the walk.
    fn trace(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource);

    /// T̂(0, s) of the walk.
    fn transmittance(&self, ray: &Ray<&M>, s: f64) -> f64;

    /// The interaction points of the walk, in increasing order.
    fn interactions(&self) -> &[Interaction];

    /// T̂ before the interaction `index`.
    fn transmittance_before(&self, index: usize) -> f64;

    /// The intensity of interaction points: σ_samp \[1/length\]; 0 for a function without any.
    fn intensity(&self) -> f64;

    /// The extinction fitted to this ray, where the walk has a control.
    fn fitted(&self) -> Option<&Explorers>;
}

/// Explorers that neighbouring rays share.
///
/// Looked up on one ray, explorers are lent to those that follow. A control is free, so that this biases nothing; it is
/// independent of the interaction points of the ray that borrows.
#[derive(Clone, Debug)]
pub struct SharedExplorers {
    explorers: Explorers,
    rays: u32,
    left: u32,
}

impl SharedExplorers {
    /// `count` ≥ 2 explorers, looked up once for `rays` ≥ 1 rays in a row.
    ///
    /// # Errors
    /// If `count < 2`.
    pub fn new(count: usize, rays: u32) -> Result<Self, fairflight_transmittance::TooFewExplorers> {
        let explorers = Explorers::through(&Vacuum::new(0.0), count)?;
        Ok(Self { explorers, rays: rays.max(1), left: 0 })
    }

    /// The explorers of the next ray: looked up on it, or lent by one before.
    pub fn next_ray<F: Extinction>(&mut self, ray: &F) -> &Explorers {
        if self.left == 0 {
            self.explorers.refit(ray);
            self.left = self.rays;
        } else {
            self.explorers.lend(ray.length());
        }
        self.left -= 1;
        &self.explorers
    }
}

/// Tracking with a collision model of any kind, a constant sampling extinction, and explorers as control or none
/// (szirmay-kalos-2017 section 4.2 and 4.3).
#[derive(Clone, Debug)]
pub struct Tracked<L> {
    model: L,
    sigma_samp: f64,
    control: Option<SharedExplorers>,
    walk: Vec<Interaction>,
}

impl<L: CollisionModel + Copy> Tracked<L> {
    /// Tracking at the rate `sigma_samp` > 0 \[1/length\].
    ///
    /// # Errors
    /// If it is not positive.
    pub fn new(
        model: L,
        sigma_samp: f64,
        control: Option<SharedExplorers>,
    ) -> Result<Self, crate::NotPositive> {
        crate::NotPositive::check("sigma_samp", sigma_samp)?;
        Ok(Self { model, sigma_samp, control, walk: Vec::new() })
    }

    fn draw<F: Extinction, C: OpticalThickness>(
        model: &L,
        control: C,
        sampling: Constant,
        field: &F,
        source: &mut impl UniformSource,
        walk: &mut Vec<Interaction>,
    ) {
        TransmittanceFunction::<F>::trace(&Tracking::new(*model, control, sampling), field, source, walk);
    }

    /// The control's transmittance up to `s`.
    fn main(&self, s: f64) -> f64 {
        self.control.as_ref().map_or(1.0, |control| exp(-control.explorers.optical_thickness(0.0, s)))
    }
}

impl<M: Medium, L: CollisionModel + Copy> Primary<M> for Tracked<L> {
    fn trace(&mut self, ray: &Ray<&M>, source: &mut impl UniformSource) {
        self.walk.clear();
        let sampling = Constant::new(self.sigma_samp, ray.length()).expect("checked by the constructor");
        if let Some(control) = &mut self.control {
            Self::draw(&self.model, control.next_ray(ray), sampling, ray, source, &mut self.walk);
        } else {
            Self::draw(&self.model, Vacuum::new(ray.length()), sampling, ray, source, &mut self.walk);
        }
    }
    fn transmittance(&self, _ray: &Ray<&M>, s: f64) -> f64 {
        Interaction::weight_at(&self.walk, s) * self.main(s)
    }
    fn interactions(&self) -> &[Interaction] {
        &self.walk
    }
    fn transmittance_before(&self, index: usize) -> f64 {
        let weight = if index == 0 { 1.0 } else { self.walk[index - 1].weight };
        weight * self.main(self.walk[index].distance)
    }
    fn intensity(&self) -> f64 {
        self.sigma_samp
    }
    fn fitted(&self) -> Option<&Explorers> {
        self.control.as_ref().map(|control| &control.explorers)
    }
}

/// The closed form: no walk, no interaction points.
impl<M: LineThickness> Primary<M> for Regular {
    fn trace(&mut self, _ray: &Ray<&M>, _source: &mut impl UniformSource) {}
    #[inline]
    fn transmittance(&self, ray: &Ray<&M>, s: f64) -> f64 {
        exp(-ray.optical_thickness(0.0, s))
    }
    fn interactions(&self) -> &[Interaction] {
        &[]
    }
    fn transmittance_before(&self, _index: usize) -> f64 {
        unreachable!("a closed form has no interaction points")
    }
    fn intensity(&self) -> f64 {
        0.0
    }
    fn fitted(&self) -> Option<&Explorers> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Bounds, Homogeneous};
    use glam::DVec3;

    #[test]
    fn the_closed_form_at_every_distance() {
        let medium = Homogeneous::new(0.7).unwrap();
        let clip = Bounds::sphere(DVec3::ZERO, 2.0).unwrap().clip(-5.0 * DVec3::Z, DVec3::Z, None);
        let ray = Ray::new(&medium, &clip.unwrap().unwrap());
        for s in [0.0, 0.5, 4.0] {
            let found = Primary::<Homogeneous>::transmittance(&Regular, &ray, s);
            assert!((found - (-0.7_f64 * s).exp()).abs() < 1e-15, "{found} at {s}");
        }
    }
}
