//! Chains in path space: which mutations a scene admits, and the target that they move over.

use super::bidirectional::Joined;
use crate::Failure;
use crate::estimator::InScene;
use crate::spec::{MutationKind, StepsSpec};
use fairflight_bidirectional::Exact;
use fairflight_media::{LineThickness, Ray};
use fairflight_metropolis::path::{
    Caustic, EdgeTransmittance, Fresh, LaiLens, Lens, Named, NullCollisions, PathTarget, Propagation,
    Scattering, StepSizes, Towards, View,
};
use fairflight_metropolis::{Importance, Target};
use fairflight_scene::Spectrum;
use fairflight_sources::UniformSource;

/// Mutations of paths that fit a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PathSpace {
    /// Mutations with their shares.
    mutations: Vec<(MutationKind, f64)>,
    has_closed_form: bool,
}

/// The share of longer paths among fresh ones, edge by edge.
const MORE: f64 = 0.7;

impl PathSpace {
    /// The mutations that were asked for, or all that the medium admits.
    pub(super) fn build(spec: &StepsSpec, scene: &InScene<'_>) -> Result<Self, Failure> {
        use MutationKind::{Bidirectional, Caustic, LaiLens, Lens, Propagation, Scattering};
        let has_closed_form = scene.medium.has_closed_form();
        if spec.over.is_none() && spec.transport.estimator.is_some() {
            return Err(Failure::refused(
                "integrator.estimator: space: path has its own transmittance, in closed form or by the null collisions of its states",
            ));
        }
        let all = [Lens, LaiLens, Caustic, Scattering, Propagation, Bidirectional].into_iter();
        let lawful = all.filter(|kind| has_closed_form || *kind != Bidirectional);
        let mut mutations: Vec<_> = lawful.map(|kind| (kind, kind.variants())).collect();
        if let Some(asked) = &spec.mutations {
            mutations.clone_from(asked);
            if mutations.iter().any(|(kind, _)| *kind == Bidirectional) && !has_closed_form {
                return Err(Failure::refused(
                    "integrator.mutations: bidirectional needs a medium whose optical thickness has a closed form: homogeneous, \
                     analytic_cosine or vdb",
                ));
            }
        }
        Ok(Self { mutations, has_closed_form })
    }

    /// Does `work` with chains over the paths that `joined` finds; gives the number of walks that were cut.
    ///
    /// # Errors
    /// If the sampling extinction lies below the extinction: contributions of either sign have no density.
    pub(super) fn with_target<'s, M: LineThickness + 's, C: Spectrum + 's>(
        &self,
        (joined, importance): (Joined<'s, M, C>, Option<&'s Importance>),
        work: &mut dyn FnMut(&mut dyn Target<C>),
    ) -> Result<u64, Failure> {
        let refuse =
            |error: &dyn std::fmt::Display| Failure::refused(format!("integrator.sigma_samp: {error}"));
        let (weigh, walk) = (joined.weigh(), *joined.walking().walk.sampling());
        let (world, camera, emitters) = (weigh.world, weigh.camera, weigh.emitters);
        let medium = &world.volume.medium;
        let lowest = fairflight_paths::SamplingExtinction::lowest(&walk);
        // An empty medium has no collisions to draw.
        let is_bounded = M::IS_EMPTY || medium.upper_bound().is_some_and(|bound| bound <= lowest);
        if !is_bounded {
            return Err(refuse(&format!(
                "space: path needs a majorant of the medium, which {lowest} is not known to be"
            )));
        }
        let edges = if self.has_closed_form {
            Edges::Exact
        } else {
            Edges::Drawn(NullCollisions::new(medium, lowest).map_err(|error| refuse(&error))?)
        };
        let view = View { world, camera, edges };
        let sizes = StepSizes::of_image(camera.resolution());
        let (mut named, mut shares): (Vec<Named<'_>>, Vec<f64>) = (Vec::new(), Vec::new());
        for (kind, share) in &self.mutations {
            match kind {
                MutationKind::Lens => {
                    named.push(("lens", Box::new(Lens::new(&view, sizes))));
                    named.push(("scaling_lens", Box::new(Lens::new(&view, sizes).scaling())));
                }
                MutationKind::LaiLens => named.push(("lai_lens", Box::new(LaiLens::new(&view, sizes)))),
                MutationKind::Caustic => named.push(("caustic", Box::new(Caustic::new(&view, sizes)))),
                MutationKind::Scattering => {
                    for (name, towards) in
                        [("scattering_to_eye", Towards::Eye), ("scattering_to_light", Towards::Light)]
                    {
                        named.push((name, Box::new(Scattering::new(&view, sizes, towards))));
                    }
                }
                MutationKind::Propagation => {
                    for (name, anchor) in
                        [("propagation_from_eye", Towards::Eye), ("propagation_from_light", Towards::Light)]
                    {
                        named.push((name, Box::new(Propagation::new(&view, sizes, anchor))));
                    }
                }
                MutationKind::Bidirectional => {
                    let fresh = Fresh::new((world, camera), emitters, walk, MORE);
                    named.push(("bidirectional", Box::new(fresh.map_err(|error| refuse(&error))?)));
                }
            }
            shares.resize(named.len(), share / kind.variants());
        }
        let refuse =
            |error: &dyn std::fmt::Display| Failure::refused(format!("integrator.mutations: {error}"));
        let target = PathTarget::new(joined, &view, named, 2).map_err(|error| refuse(&error))?;
        let mut target = target.with_shares(&shares).map_err(|error| refuse(&error))?;
        if let Some(importance) = importance {
            target = target.with_importance(importance);
        }
        work(&mut target);
        Ok(target.integrator().truncated())
    }
}

/// Transmittance of the edges of paths.
#[derive(Clone, Copy, Debug)]
enum Edges {
    Exact,
    Drawn(NullCollisions),
}

impl<M: LineThickness> EdgeTransmittance<M> for Edges {
    fn ln_transmittance(&self, ray: &Ray<&M>, source: &mut dyn UniformSource) -> f64 {
        match self {
            Self::Exact => Exact.ln_transmittance(ray, source),
            Self::Drawn(nulls) => nulls.ln_transmittance(ray, source),
        }
    }
    fn ln_found(&self, ray: &Ray<&M>, source: &mut dyn UniformSource) -> f64 {
        match self {
            Self::Exact => Exact.ln_found(ray, source),
            Self::Drawn(nulls) => nulls.ln_found(ray, source),
        }
    }
}
