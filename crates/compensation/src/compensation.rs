//! Recursive bias compensation (raab-2008 eq. 15, engelhardt-2013 sections 3.4 and 4).

use crate::place::{Placed, Region};
use crate::{CompensationOptions, LocalMean, Strategy};
use fairflight_media::{Medium, PhaseFunction};
use fairflight_paths::transport::Vertex;
use fairflight_paths::{RayTransmittance, SamplingExtinction};
use fairflight_scene::{Geometry, Spectrum};
use fairflight_sources::UniformSource;
use fairflight_vpl::{Connected, Correction, Gather, Pairing, Term};

/// Makes up for what bounded connections lose.
///
/// Bounding G at b leaves out ∫ L_s(x → y) f(y) max(G − b, 0) V dx at y, where L_s is the light that is *scattered* at x (what x emits
/// reaches y by next-event estimation, which is not bounded). In directions and distances, with dx = r² dt dω or r² dω/|cos θ_x|,
///
/// > ∫ ∫ L_s f(y) |cos θ_y| τ · (G − b)₊/G dt dω, and the surface end point without dt,
///
/// so that a direction by f(y)·|cos θ_y| and a distance by τ leave the weight (G − b)₊/G < 1 times albedo or reflectance at x. It is 0 wherever
/// G ≤ b, in particular beyond d = 1/√b: there the recursion ends. At x the same is to be found again:
///
/// > L_s(x) = albedo(x) · ( D(x) + Σ_k bounded connection(x, k) + compensation(x) ).
///
/// ```text
/// compensate(y)
///     choose a direction by f · cosine, a distance by the placement            → x, weight
///     nothing if G(x, y) ≤ b
///     weight · (G − b)/G · ( share · D(x) + bounded connections of x + compensate(x) )
/// ```
///
/// **Law.** For unlimited steps, exact transmittance and full or local visibility: connections + correction have the expectation of
/// unbounded connections, for every b ≥ 0. b = 0 is path tracing, b = ∞ leaves nothing to do.
///
/// **Bound.** With 0 ≤ σ_t ≤ σ_samp and free flights every weight is at most 1, so that a path adds at most the greatest radiance of
/// emitters per vertex (raab-2008 section 4.2). Unlimited recursion survives with the probability of its weight.
#[derive(Clone, Debug)]
pub struct Compensation<'m> {
    options: CompensationOptions,
    mean: &'m LocalMean,
    tried: u64,
    inside: u64,
}

impl<'m> Compensation<'m> {
    /// `mean` is that of the medium; free flights do not use it.
    #[must_use]
    pub fn new(options: CompensationOptions, mean: &'m LocalMean) -> Self {
        Self { options, mean, tried: 0, inside: 0 }
    }

    /// How points of eye rays must be connected for this strategy.
    #[must_use]
    pub fn pairing(&self) -> Pairing {
        self.options.strategy.pairing()
    }

    /// How many compensation vertices were tried, and how many of them lay where G > b.
    #[must_use]
    pub fn vertices(&self) -> (u64, u64) {
        (self.tried, self.inside)
    }

    /// One compensation vertex of `y` connected with `which`, and those behind it.
    fn step<G, M, P, C, R, T, S>(
        &mut self,
        gather: &mut Gather<'_, G, M, P, C, R, T>,
        region: &Region,
        (which, depth): (Connected, u32),
        source: &mut S,
    ) -> C
    where
        G: Geometry<C>,
        M: Medium,
        P: PhaseFunction,
        C: Spectrum,
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        self.tried += 1;
        let Some(Placed { vertex, factor, geometric }) =
            region.place(&self.options, self.mean, gather, source)
        else {
            return C::ZERO;
        };
        // Below the bound, or with an infinite G at a distance that underflows: (G − b)/G without G.
        let lost = 1.0 - region.bound / geometric;
        if lost.is_nan() || lost <= 0.0 {
            return C::ZERO;
        }
        self.inside += 1;
        let weight = factor * lost;
        let share = gather.share(which);
        let mut scattered = gather.emitters(&vertex, source) * share;
        scattered += gather.connected(&vertex, which, source);
        scattered += self.further(gather, &vertex, (which, depth + 1), weight.magnitude(), source);
        weight * scattered
    }

    /// The compensation at a compensation vertex.
    fn further<G, M, P, C, R, T, S>(
        &mut self,
        gather: &mut Gather<'_, G, M, P, C, R, T>,
        x: &Vertex,
        (which, depth): (Connected, u32),
        weight: f64,
        source: &mut S,
    ) -> C
    where
        G: Geometry<C>,
        M: Medium,
        P: PhaseFunction,
        C: Spectrum,
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        let survival = match self.options.steps {
            Some(steps) if depth >= steps => return C::ZERO,
            Some(_) => 1.0,
            None => weight.min(1.0),
        };
        if survival < 1.0 && source.next_uniform() >= survival {
            return C::ZERO;
        }
        let Term::Bounded(bound) = gather.term else { return C::ZERO };
        let region = Region::new(*x, bound, &self.options, gather);
        self.step(gather, &region, (which, depth), source) * (1.0 / survival)
    }
}

impl Strategy {
    /// How points of eye rays are connected.
    #[must_use]
    pub fn pairing(self) -> Pairing {
        match self {
            Self::OneToMany | Self::ManyToOne => Pairing::Every,
            Self::OneToOne => Pairing::One,
        }
    }
}

impl<C: Spectrum> Correction<C> for Compensation<'_> {
    fn recover<G, M, P, R, T, S>(
        &mut self,
        gather: &mut Gather<'_, G, M, P, C, R, T>,
        y: &Vertex,
        which: Connected,
        source: &mut S,
    ) -> C
    where
        G: Geometry<C>,
        M: Medium,
        P: PhaseFunction,
        R: SamplingExtinction,
        T: RayTransmittance<M>,
        S: UniformSource + ?Sized,
    {
        let Term::Bounded(bound) = gather.term else { return C::ZERO };
        if bound == f64::INFINITY || self.options.steps == Some(0) {
            return C::ZERO;
        }
        let region = Region::new(*y, bound, &self.options, gather);
        let lights = gather.vpls.len();
        if which == Connected::All && self.options.strategy == Strategy::ManyToOne && lights > 0 {
            let mut sum = C::ZERO;
            for index in 0..lights {
                sum += self.step(gather, &region, (Connected::One(index), 0), source);
            }
            return sum;
        }
        self.step(gather, &region, (which, 0), source)
    }
}
