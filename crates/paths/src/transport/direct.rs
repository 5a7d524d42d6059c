//! Light that comes straight from an emitter, by two techniques whose weights sum to one.

use super::{Vertex, World};
use crate::{Heuristic, RayTransmittance};
use fairflight_media::{Medium, PhaseFunction};
use fairflight_scene::{Geometry, Hit, Segment, Spectrum};
use fairflight_sources::UniformSource;
use glam::DVec3;

/// From where a path came to an emitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The vertex that chose the direction.
    pub vertex: Vertex,
    /// With this density \[1/sr\].
    pub pdf_solid_angle: f64,
}

impl<G, M, P, C> World<'_, G, M, P, C>
where
    C: Spectrum,
    G: Geometry<C>,
    M: Medium,
    P: PhaseFunction,
{
    /// Next-event estimation: the light of all emitters that `vertex` scatters towards where its path came from, per reflectance or
    /// albedo, weighted against [`emission`](Self::emission) and [`background`](Self::background).
    ///
    /// Every light takes its turn: point and directional ones count whole, since no direction meets them by chance; surfaces and
    /// environment maps are chosen by solid angle, and weighted by `heuristic` against the directions that the vertex chooses itself. The
    /// constant background is left to those.
    ///
    /// **Weights** compare densities of the direction alone. That both techniques also meet the transmittance of the same ray, one as an
    /// estimate and one as a chance, changes no expectation: for each direction the weights are numbers that sum to 1.
    ///
    /// **Variance.** A point light at the distance r counts 1/r²; in a medium around it there is no second moment, and no second technique
    /// to help (raab-2008 section 4.1). For emitters of some size the weak singularity is gone: weight/density ≤ 1/density of the
    /// other technique, so that a contribution is at most L_e.
    pub fn emitters_at<T, S>(
        &self,
        heuristic: Heuristic,
        vertex: &Vertex,
        shadow: &mut T,
        source: &mut S,
    ) -> C
    where
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        let phase = &self.volume.phase;
        let mut radiance = C::ZERO;
        for light in &self.lights.sources {
            let Some(connection) = light.connect(vertex.position) else { continue };
            let pdf = vertex.pdf_solid_angle(phase, connection.towards);
            if pdf > 0.0 {
                let segment = vertex.leave(connection.towards, connection.distance.unwrap_or(f64::INFINITY));
                let visibility = self.attenuated_visibility(&segment, shadow, source);
                radiance += connection.irradiance * (pdf * visibility);
            }
        }
        for map in &self.lights.background.maps {
            let [choice, u, v] = std::array::from_fn(|_| source.next_uniform());
            let Some((towards, arriving)) = map.sample(choice, u, v) else { continue };
            let scattered = vertex.pdf_solid_angle(phase, towards);
            if scattered > 0.0 {
                let pdf = map.pdf_solid_angle(towards);
                let segment = vertex.leave(towards, f64::INFINITY);
                let visibility = self.attenuated_visibility(&segment, shadow, source);
                radiance += arriving * (heuristic.mis_weight(pdf, scattered) * scattered / pdf * visibility);
            }
        }
        for &index in self.surfaces.emitters() {
            // What an emitter sees of itself is left to the directions that the vertex chooses.
            if vertex.surface() == Some(index) {
                continue;
            }
            let (u, v) = (source.next_uniform(), source.next_uniform());
            let Some(sample) = self.surfaces.sample_towards(index, vertex.position, u, v) else { continue };
            let scattered = vertex.pdf_solid_angle(phase, sample.direction);
            if scattered > 0.0 {
                let towards = vertex.leave(sample.direction, sample.distance);
                let segment = Segment { to: Some(index), ..towards };
                let visibility = self.attenuated_visibility(&segment, shadow, source);
                let pdf = sample.pdf_solid_angle;
                let emission = self.surfaces.surfaces()[index].emission;
                radiance += emission * (heuristic.mis_weight(pdf, scattered) * scattered / pdf * visibility);
            }
        }
        radiance
    }

    /// The radiance that a surface emits towards a path that met it along `direction`: whole for one from the camera or a smooth surface, weighted against
    /// [`emitters_at`](Self::emitters_at) for one that a vertex sent there.
    #[inline]
    pub fn emission(
        &self,
        heuristic: Heuristic,
        from: Option<&Scattered>,
        direction: DVec3,
        hit: &Hit<'_, C>,
    ) -> C {
        let emission = hit.surface.emission;
        match from {
            Some(Scattered { vertex, pdf_solid_angle }) if emission != C::ZERO => {
                let shape = &hit.surface.shape;
                let is_own = vertex.surface() == Some(hit.index);
                let pdf =
                    if is_own { 0.0 } else { shape.pdf_towards(vertex.position, direction, hit.distance) };
                emission * heuristic.mis_weight(*pdf_solid_angle, pdf)
            }
            _ => emission,
        }
    }

    /// The same for the background, where a path leaves everything.
    #[inline]
    pub fn background(&self, heuristic: Heuristic, from: Option<&Scattered>, towards: DVec3) -> C {
        let background = &self.lights.background;
        let Some(Scattered { pdf_solid_angle, .. }) = from else { return background.radiance(towards) };
        let mut radiance = background.constant;
        for map in &background.maps {
            radiance +=
                map.radiance(towards) * heuristic.mis_weight(*pdf_solid_angle, map.pdf_solid_angle(towards));
        }
        radiance
    }
}
