//! A vertex of a path as densities see it, and of a subpath with what its weights will need.

use crate::LogHeuristic;
use fairflight_elementary::ln;
use fairflight_media::PhaseFunction;
use fairflight_paths::transport::{Lobe, Vertex};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Scattering at a vertex, as far as densities ask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Site {
    /// Scattering by the phase function of the medium.
    Medium {
        /// The extinction at the vertex \[1/length\].
        sigma_t: f64,
    },
    /// Lambert.
    Diffuse {
        /// Normal of unit length, on the side of the path.
        normal: DVec3,
        /// The surface.
        surface: usize,
    },
    /// Reflection or refraction into one direction.
    Smooth {
        /// Normal of unit length, on either side.
        normal: DVec3,
        /// The surface.
        surface: usize,
        /// Index of refraction where the path goes on, over that from where it came; 1 where it is reflected.
        ratio: f64,
    },
}

/// A vertex between the two ends of a path, however it was found.
///
/// Densities are functions of positions: directions are differences of them, and not those that a walk drew, so that a path has one
/// set of densities whichever strategy made it. None is 0: where rounding says so it is [`f64::MIN_POSITIVE`], which as any other
/// number is lawful in a weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Point in space.
    pub position: DVec3,
    /// Scattering there.
    pub site: Site,
    /// q: the probability to go on, min(1, greatest channel of reflectance or albedo).
    pub survival: f64,
}

impl Place {
    /// Returns true if a strategy may connect here: the direction is not bound to one.
    #[inline]
    #[must_use]
    pub fn is_connectable(&self) -> bool {
        !matches!(self.site, Site::Smooth { .. })
    }

    /// The surface that it lies on.
    #[inline]
    #[must_use]
    pub fn surface(&self) -> Option<usize> {
        match self.site {
            Site::Medium { .. } => None,
            Site::Diffuse { surface, .. } | Site::Smooth { surface, .. } => Some(surface),
        }
    }

    /// The same on the way back.
    #[inline]
    #[must_use]
    pub fn reversed(self) -> Self {
        match self.site {
            Site::Smooth { normal, surface, ratio } => {
                Self { site: Site::Smooth { normal, surface, ratio: 1.0 / ratio }, ..self }
            }
            Site::Medium { .. } | Site::Diffuse { .. } => self,
        }
    }

    /// D of raab-2008 eq. 8 and, in the medium, σ_t of its eq. 12: what a vertex has at the end of an edge in its density, besides T/r².
    #[inline]
    #[must_use]
    pub(crate) fn facing(&self, direction: DVec3) -> f64 {
        let factor = match self.site {
            Site::Medium { sigma_t } => sigma_t,
            Site::Diffuse { normal, .. } | Site::Smooth { normal, .. } => normal.dot(direction).abs(),
        };
        factor.max(f64::MIN_POSITIVE)
    }

    /// The density, survival included, of leaving along `outgoing` what arrived along `incident` \[1/sr\].
    ///
    /// On a smooth surface the Dirac of both directions is left out, as is Fresnel's probability, which is the same both ways: what
    /// remains of the ratio of the true densities is |cosine| · ratio of indices on either side. n² dσ⊥ dA is the same before and
    /// behind the surface, so that forward over backward density is p(a) n_b²/(p(b) n_a²) = (p(a) c)/(p(b)/c) with c = n_b/n_a.
    #[inline]
    #[must_use]
    pub(crate) fn scatter<P: PhaseFunction>(&self, phase: &P, incident: DVec3, outgoing: DVec3) -> f64 {
        let density = match self.site {
            Site::Medium { .. } => self.survival * phase.eval(incident.dot(outgoing)),
            Site::Diffuse { normal, .. } => self.survival * FRAC_1_PI * normal.dot(outgoing).abs(),
            Site::Smooth { normal, ratio, .. } => ratio * normal.dot(outgoing).abs(),
        };
        density.max(f64::MIN_POSITIVE)
    }
}

/// A vertex v_i of a subpath (i = 1 at the camera or the light), with logarithms of densities in the measure of its place: area or volume.
///
/// Arrows are relative to the direction of the subpath: P→ as it was drawn, P← against it (antwerpen-2011 section 5.3, with the
/// distance densities that its errata ask for in a medium: raab-2008 eq. 12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The vertex.
    pub place: Place,
    /// The direction of travel with which the subpath arrived, of unit length.
    pub incident: DVec3,
    /// ln P→(v_i).
    pub ln_forward: f64,
    /// ln of D E/r² at v_(i−1): what P←(v_(i−1)) has, besides the density of the direction.
    pub ln_geometry: f64,
    /// ln 1 if v_(i−1) and v_i may be connected, else ln 0; at the first node the number of samples and the density of the strategy
    /// that ends here, relative to the others (ln n_L of the light image, ln P_dir/P_sub of next-event estimation).
    pub ln_connectable: f64,
    /// The recursive sum of v_(i−1), scaled by the heuristic.
    pub ln_before: f64,
}

impl Node {
    /// The node behind `previous` at `place`, with the optical thickness between the two.
    #[inline]
    #[must_use]
    pub(crate) fn after<P: PhaseFunction>(
        previous: &Self,
        place: Place,
        thickness: f64,
        (phase, heuristic): (&P, impl LogHeuristic),
    ) -> Self {
        let offset = place.position - previous.place.position;
        let squared = offset.length_squared();
        let incident = offset / squared.sqrt();
        let scattered = previous.place.scatter(phase, previous.incident, incident);
        let is_connectable = place.is_connectable() && previous.place.is_connectable();
        Self {
            place,
            incident,
            // P→ = q p_ω D E/r²: raab-2008 eq. 12 per volume, with survival.
            ln_forward: ln(scattered * place.facing(incident) / squared) - thickness,
            // The edge (v_(i−1), v_i), as the definition of antwerpen-2011 5.3 has it; its algorithms 2 and 3 print the edge before.
            ln_geometry: ln(previous.place.facing(incident) / squared) - thickness,
            ln_connectable: if is_connectable { 0.0 } else { f64::NEG_INFINITY },
            ln_before: previous.ln_others(phase, heuristic, incident),
        }
    }

    /// ln of all strategies that end before this node, relative to the one that goes on along `outgoing`, scaled by the heuristic:
    ///
    /// ```text
    /// l_i = add( chi_(i−1),  ln P←(v_(i−1)) + l_(i−1) ) − ln P→(v_i)
    /// ```
    ///
    /// antwerpen-2011 section 5.3, in logarithms. The direction is needed for P←, which is why it is finished here and not when the
    /// node is made.
    #[inline]
    #[must_use]
    pub(crate) fn ln_others<P: PhaseFunction>(
        &self,
        phase: &P,
        heuristic: impl LogHeuristic,
        outgoing: DVec3,
    ) -> f64 {
        let back = self.place.reversed().scatter(phase, -outgoing, -self.incident);
        let behind = heuristic.scale(ln(back) + self.ln_geometry) + self.ln_before;
        heuristic.add(heuristic.scale(self.ln_connectable), behind) - heuristic.scale(self.ln_forward)
    }

    /// The vertex to which something may be connected; `None` on a smooth surface.
    #[inline]
    #[must_use]
    pub fn vertex(&self) -> Option<Vertex> {
        let lobe = match self.place.site {
            Site::Medium { .. } => Lobe::Phase { incident: self.incident },
            Site::Diffuse { normal, surface } => Lobe::Diffuse { normal, surface },
            Site::Smooth { .. } => return None,
        };
        Some(Vertex { position: self.place.position, lobe })
    }
}
