//! Recursive bias compensation (raab-2008 eq. 15, engelhardt-2013 sections 3.4 and 4).

use crate::place::{Placed, Region};
use crate::{CompensationOptions, LocalMean, Strategy};
use fairflight_paths::transport::{Types, Vertex};
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;
use fairflight_vpl::{Connected, Connections, Correction, Gather, Pairing, Term};

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
/// **Bound.** With 0 ≤ σ_t ≤ σ_samp and free flights every weight is at most 1, so that each vertex of a path adds at most what it finds of
/// emitters: the radiance of a constant environment, and of emitters with extent at most twice the greatest radiance, once by each technique
/// (raab-2008 section 4.2 says: the brightness of the light source). Unlimited recursion survives with the probability of its weight.
///
/// With b = 0 the region is endless: vertices that are placed as if the medium were homogeneous then have weights without a bound, and
/// heavy tails where the medium is not.
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

    /// Returns the pairing of eye points and virtual point lights that this strategy needs.
    #[must_use]
    pub fn pairing(&self) -> Pairing {
        self.options.strategy.pairing()
    }

    /// Number of compensation vertices tried so far, and of those among them that lay where G > b.
    #[must_use]
    pub fn vertices(&self) -> (u64, u64) {
        (self.tried, self.inside)
    }

    /// Light by one compensation vertex of `y`, connected with `which`, and by those behind it.
    #[inline(never)]
    fn step<W: Types>(
        &mut self,
        gather: &mut Gather<'_, W>,
        region: &Region,
        (which, depth): (Connected, u32),
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        self.tried += 1;
        let Some(Placed { vertex, factor, geometric }) =
            region.place(&self.options, self.mean, gather, source)
        else {
            return W::Spectrum::ZERO;
        };
        // Below the bound, or with an infinite G at a distance that underflows: (G − b)/G without G.
        let lost = 1.0 - region.bound / geometric;
        if lost.is_nan() || lost <= 0.0 {
            return W::Spectrum::ZERO;
        }
        self.inside += 1;
        let weight = factor * lost;
        let mut scattered = match (self.options.strategy, which) {
            // Emitters have a vertex of their own.
            (Strategy::ManyToOne, Connected::One(_)) => W::Spectrum::ZERO,
            _ => gather.emitters(&vertex, source) * gather.share(which),
        };
        scattered += gather.connected(&vertex, which, source);
        scattered += self.further(gather, &vertex, (which, depth + 1), weight.magnitude(), source);
        weight * scattered
    }

    /// The compensation at a compensation vertex.
    fn further<W: Types>(
        &mut self,
        gather: &mut Gather<'_, W>,
        x: &Vertex,
        (which, depth): (Connected, u32),
        weight: f64,
        source: &mut impl UniformSource,
    ) -> W::Spectrum {
        let survival = match self.options.steps {
            Some(steps) if depth >= steps => return W::Spectrum::ZERO,
            Some(_) => 1.0,
            None => weight.min(1.0),
        };
        if survival < 1.0 && source.next_uniform() >= survival {
            return W::Spectrum::ZERO;
        }
        let Term::Bounded(bound) = gather.term else { return W::Spectrum::ZERO };
        let region = Region::new(*x, bound, &self.options, gather);
        self.step(gather, &region, (which, depth), source) * (1.0 / survival)
    }
}

impl Strategy {
    /// Returns the pairing of eye points and virtual point lights that the strategy needs.
    #[must_use]
    pub fn pairing(self) -> Pairing {
        match self {
            Self::OneToMany | Self::ManyToOne => Pairing::Every,
            Self::OneToOne => Pairing::One,
        }
    }
}

impl<W: Types> Correction<W> for Compensation<'_> {
    fn recover(&mut self, at: Connections<'_, '_, W>, source: &mut impl UniformSource) -> W::Spectrum {
        let Connections { gather, y, which } = at;
        let Term::Bounded(bound) = gather.term else { return W::Spectrum::ZERO };
        if bound == f64::INFINITY || self.options.steps == Some(0) {
            return W::Spectrum::ZERO;
        }
        let region = Region::new(*y, bound, &self.options, gather);
        if which == Connected::All && self.options.strategy == Strategy::ManyToOne {
            // engelhardt-2013 section 5 splits the integral likewise: from emitters once, from each light by itself.
            let mut sum = self.step(gather, &region, (Connected::Nothing, 0), source);
            for index in 0..gather.vpls.len() {
                sum += self.step(gather, &region, (Connected::One(index), 0), source);
            }
            return sum;
        }
        self.step(gather, &region, (which, 0), source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{REFLECTANCE, Scene, hazy, in_medium, mean, on_floor, room, vacuum};
    use crate::{Placement, Visibility};
    use fairflight_media::EmptySpace;
    use fairflight_paths::transport::Lobe;
    use fairflight_scene::Source;
    use fairflight_sources::Scripted;
    use fairflight_vpl::Vpl;
    use glam::{DVec3, dvec3};
    use std::f64::consts::{FRAC_1_PI, PI};

    const EXACT: CompensationOptions = CompensationOptions::EXACT;
    /// Variates of the direction straight up from the floor, and straight down from the ceiling.
    const ACROSS: [f64; 2] = [0.0, 0.0];

    /// A floor at 0 and a ceiling at 1/2 (G = 4 straight across), a point light of irradiance 16 in the middle of both.
    fn lit() -> Scene<EmptySpace> {
        vacuum(room(0.5), vec![Source::point(0.25 * DVec3::Z, 4.0 * PI).unwrap()])
    }
    /// Radiance that the light adds at either surface, per reflectance.
    const DIRECT: f64 = 16.0 * FRAC_1_PI;

    fn lights() -> [Vpl<f64>; 3] {
        [(0.1, 3.0), (0.3, 0.7), (-0.2, -1.5)].map(|(x, power)| {
            let vertex = in_medium(dvec3(x, 0.05, 0.2), DVec3::X);
            Vpl { vertex, incident: DVec3::X, power, bounce: 1 }
        })
    }

    /// The vertex straight above [`on_floor`].
    fn on_ceiling() -> Vertex {
        Vertex { position: 0.5 * DVec3::Z, lobe: Lobe::Diffuse { normal: DVec3::NEG_Z, surface: 1 } }
    }

    fn connected(y: &Vertex, bound: f64, which: Connected) -> f64 {
        lit().gather(&lights(), bound).connected(y, which, &mut Scripted::new([]))
    }

    fn all_of<'a, 's, W: Types>(gather: &'a mut Gather<'s, W>, y: &'a Vertex) -> Connections<'a, 's, W> {
        Connections { gather, y, which: Connected::All }
    }

    fn recovered(
        options: CompensationOptions,
        bound: f64,
        which: Connected,
        script: &[f64],
    ) -> (f64, (u64, u64)) {
        let (scene, vpls, mean) = (lit(), lights(), mean(0.5));
        let mut compensation = Compensation::new(options, &mean);
        let mut source = Scripted::new(script.iter().copied());
        let found = compensation.recover(
            Connections { gather: &mut scene.gather(&vpls, bound), y: &on_floor(), which },
            &mut source,
        );
        assert_eq!(source.remaining(), 0);
        (found, compensation.vertices())
    }

    fn one_step() -> CompensationOptions {
        CompensationOptions { steps: Some(1), ..EXACT }
    }

    #[test]
    fn one_step_by_hand() {
        // Across G = 4: with b = 1 a quarter is left to connections, three to the vertex above.
        let weight = REFLECTANCE * 0.75;
        let above = connected(&on_ceiling(), 1.0, Connected::All);
        let (found, vertices) = recovered(one_step(), 1.0, Connected::All, &ACROSS);
        assert!((found - weight * (DIRECT + above)).abs() < 1e-14);
        assert_eq!(vertices, (1, 1));
        // The connections of the vertex are bounded as well; b = 0 leaves none of them, and is path tracing.
        assert!(above.abs() < connected(&on_ceiling(), f64::INFINITY, Connected::All).abs());
        let (found, _) = recovered(one_step(), 0.0, Connected::All, &ACROSS);
        assert!((found - REFLECTANCE * DIRECT).abs() < 1e-14);
        // Emitters belong to all lights together, a share of them to each.
        for k in 0..3 {
            let (found, _) = recovered(one_step(), 1.0, Connected::One(k), &ACROSS);
            let above = connected(&on_ceiling(), 1.0, Connected::One(k));
            assert!((found - weight * (DIRECT / 3.0 + above)).abs() < 1e-14);
        }
    }

    #[test]
    fn every_strategy_sums_the_same() {
        // With the same vertex for all of them the strategies differ by rounding alone.
        let strategy = |strategy, steps| CompensationOptions { strategy, steps: Some(steps), ..EXACT };
        for steps in 1..4usize {
            let across = [0.0; 2 * 3];
            let script = &across[..2 * steps];
            let limit = steps as u32;
            let (all, once) = recovered(strategy(Strategy::OneToMany, limit), 1.0, Connected::All, script);
            let (each, apart) =
                recovered(strategy(Strategy::ManyToOne, limit), 1.0, Connected::All, &script.repeat(4));
            let mean = (0..3)
                .map(|k| {
                    3.0 * recovered(strategy(Strategy::OneToOne, limit), 1.0, Connected::One(k), script).0
                })
                .sum::<f64>()
                / 3.0;
            assert!((all - each).abs() < 1e-14 && (all - mean).abs() < 1e-14, "{all} {each} {mean}");
            // One vertex for each light, and one for the emitters.
            assert_eq!((once.0, apart.0), (steps as u64, 4 * steps as u64));
        }
        assert_eq!(Strategy::OneToMany.pairing(), Pairing::Every);
        assert_eq!(Strategy::ManyToOne.pairing(), Pairing::Every);
        assert_eq!(Strategy::OneToOne.pairing(), Pairing::One);
        let mean = mean(0.5);
        let one = Compensation::new(strategy(Strategy::OneToOne, 1), &mean);
        assert_eq!(one.pairing(), Pairing::One);
    }

    #[test]
    fn steps_follow_each_other_until_they_are_used_up() {
        let weight = REFLECTANCE * 0.75;
        let up = weight * (DIRECT + connected(&on_ceiling(), 1.0, Connected::All));
        let down = weight * weight * (DIRECT + connected(&on_floor(), 1.0, Connected::All));
        let steps = |steps, script: &[f64]| {
            recovered(CompensationOptions { steps: Some(steps), ..EXACT }, 1.0, Connected::All, script).0
        };
        assert!((steps(2, &[0.0; 4]) - up - down).abs() < 1e-14);
        assert!((steps(3, &[0.0; 6]) - up * (1.0 + weight * weight) - down).abs() < 1e-13);
        assert_eq!(steps(0, &[]), 0.0);
        // Unlimited, roulette with the weight ends it; what survives counts as much more.
        let unlimited = |script: &[f64]| recovered(EXACT, 1.0, Connected::All, script).0;
        assert!((unlimited(&[0.0, 0.0, weight]) - up).abs() < 1e-14);
        assert!(
            (unlimited(&[0.0, 0.0, 0.999 * weight, 0.0, 0.0, weight]) - up - down / weight).abs() < 1e-13
        );
    }

    #[test]
    fn what_lies_beyond_the_bound_counts_for_nothing() {
        // At the cosine c the other surface is 1/(2c) away, with G = 4c⁴: inside the region of radius 1 from c = 0.5 on, inside the bound
        // from c = 0.707 on. A cosine is √(1 − u).
        for (u, inside) in [(0.45, true), (0.55, false), (0.8, false)] {
            let (found, vertices) = recovered(one_step(), 1.0, Connected::All, &[u, 0.3]);
            assert_eq!((found != 0.0, vertices), (inside, (1, u64::from(inside))), "{u}");
        }
    }

    #[test]
    fn where_nothing_is_bounded_nothing_is_recovered_and_nothing_drawn() {
        for strategy in [Strategy::OneToMany, Strategy::ManyToOne] {
            let options = CompensationOptions { strategy, ..EXACT };
            assert_eq!(recovered(options, f64::INFINITY, Connected::All, &[]), (0.0, (0, 0)));
        }
        let (scene, vpls, mean) = (lit(), lights(), mean(0.5));
        let mut gather = scene.gather(&vpls, 1.0);
        gather.term = Term::Excess(1.0);
        let mut source = Scripted::new([]);
        let found = Compensation::new(EXACT, &mean).recover(all_of(&mut gather, &on_floor()), &mut source);
        assert_eq!(found, 0.0);
    }

    #[test]
    fn without_virtual_point_lights_emitters_are_still_seen() {
        let (scene, mean) = (lit(), mean(0.5));
        for strategy in [Strategy::OneToMany, Strategy::ManyToOne, Strategy::OneToOne] {
            let options = CompensationOptions { strategy, ..one_step() };
            let mut gather = scene.gather(&[], 1.0);
            let mut source = Scripted::new(ACROSS);
            let found =
                Compensation::new(options, &mean).recover(all_of(&mut gather, &on_floor()), &mut source);
            assert!((found - REFLECTANCE * 0.75 * DIRECT).abs() < 1e-14);
        }
    }

    #[test]
    fn in_the_medium_there_are_no_cosines() {
        let scene = hazy(room(2.0));
        let vpls = lights();
        let (mean, y) = (mean(0.5), in_medium(DVec3::Z, DVec3::Z));
        for placement in [Placement::FreeFlight, Placement::LocallyHomogeneous] {
            let options = CompensationOptions { placement, visibility: Visibility::Local, ..one_step() };
            let script =
                [&[0.0, 0.0, 0.1][..], if placement == Placement::FreeFlight { &[0.1][..] } else { &[] }];
            let mut gather = scene.gather(&vpls, 4.0);
            let region = Region::new(y, 4.0, &options, &gather);
            let mut source = Scripted::new(script.concat());
            let x = region.place(&options, &mean, &mut gather, &mut source).unwrap();
            let distance = x.vertex.position.distance(y.position);
            let lost = 1.0 - 4.0 * distance * distance;
            assert!(lost > 0.0 && x.vertex.surface().is_none());
            let above = gather.connected(&x.vertex, Connected::All, &mut Scripted::new([]));
            let mut source = Scripted::new(script.concat());
            let found = Compensation::new(options, &mean).recover(all_of(&mut gather, &y), &mut source);
            assert!((found - x.factor * lost * above).abs() < 1e-14 * above.abs(), "{placement:?}");
        }
    }
}
