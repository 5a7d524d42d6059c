//! Mistakes in joining paths from both ends.
//!
//! Most move no mean that a sample could tell: weights need only sum to one for that, and a mistake in a strategy that is rarely made
//! is a small one. The exact law finds them.

use super::{Evident, Rejection, Twin};
use crate::bidirectional::means::axis;
use crate::bidirectional::partition::{Change, defects};
use crate::bidirectional::scenes::{bulb, mixed, uneven};
use crate::bidirectional::{View, pairs};
use fairflight_bidirectional::laws::{Path, Side};
use fairflight_bidirectional::{Bidirectional, Exact, Node, Site, Subpath, Walking, WeightThickness};
use fairflight_media::{LineThickness, Medium, Ray};
use fairflight_paths::{Heuristic, Ratio, RayTransmittance, Uniform};
use fairflight_sources::{Seeded, UniformSource};
use fairflight_transmittance::Regular;
use std::cell::RefCell;

/// Lists the twins.
pub(super) fn twins() -> Vec<Twin> {
    let mut twins = unlike_sums();
    twins.extend(unlike_means());
    twins.into_iter().map(|twin| twin.about(["bidirectional"])).collect()
}

/// A mistake in the nodes of a path, by which weights do not sum to one: off by more than `least` on average.
fn unlike_sum<M: LineThickness + Sync + 'static>(
    id: &'static str,
    mistake: &'static str,
    (profile, view): (&'static str, fn() -> View<M>),
    twist: fn(&View<M>, Side, usize, &mut Node),
    least: f64,
) -> Twin {
    let never = (0, Evident::Exactly);
    Twin::new("weights of strategies", id, mistake, profile, never, move |run| {
        let view = view();
        let change = |side: Side, index: usize, node: &mut Node| twist(&view, side, index, node);
        let found = defects(&view, (Heuristic::Balance, Exact), (300, run.seed), Change::Nodes(&change));
        off(found.mean(), least)
    })
}

fn off(mean: f64, least: f64) -> Rejection {
    Rejection::exact(mean > least, format!("sums of weights are off by {mean:.1e} on average"))
}

fn unlike_sums() -> Vec<Twin> {
    let of_mixed = ("lamps and a mirror in haze", mixed as fn() -> _);
    let of_uneven = ("glass, a lamp and a point light in smoke", uneven as fn() -> _);
    vec![
        unlike_sum(
            "bdpt_light_without_direct",
            "at the second vertex of a light path next-event estimation has the density of the start of a light path",
            of_mixed,
            // Right: P_dir/P_sub, as it comes.
            |_, side, index, node| {
                if (side, index) == (Side::Light, 0) && node.ln_connectable.is_finite() {
                    node.ln_connectable = 0.0;
                }
            },
            1e-2,
        ),
        unlike_sum(
            "bdpt_previous_edge",
            "the geometric term of the edge before, as algorithms 2 and 3 of antwerpen-2011 print it",
            of_mixed,
            // Right: of the edge that is drawn backwards. At its first vertex a subpath has none before.
            |_, _, index, node| {
                if index > 0 {
                    node.ln_geometry -= node.ln_forward;
                }
            },
            1e-2,
        ),
        unlike_sum(
            "bdpt_through_mirrors",
            "strategies that would connect a smooth surface are counted",
            of_mixed,
            |_, _, index, node| {
                if index > 0 && node.ln_connectable == f64::NEG_INFINITY {
                    node.ln_connectable = 0.0; // right: ln 0
                }
            },
            1e-4,
        ),
        unlike_sum(
            "bdpt_zero_is_one",
            "a density of 0 is taken for the Dirac that cancels (pbrt-v4, remap0)",
            of_uneven,
            |_, _, _, node| {
                if node.ln_before == f64::NEG_INFINITY {
                    node.ln_before = 0.0; // right: ln 0
                    node.ln_geometry = node.ln_geometry.max(0.0);
                }
            },
            1e-4,
        ),
        unlike_sum(
            "bdpt_inverted_camera",
            "the Jacobian of the camera as antwerpen-2011 eq. 3.18 prints it",
            of_mixed,
            |view, side, index, node| {
                if (side, index) == (Side::Eye, 0) {
                    // Right: once, and not less twice.
                    node.ln_forward -= 2.0 * view.camera.importance(node.place.position).ln();
                }
            },
            1e-2,
        ),
        unlike_sum(
            "bdpt_pixel_count",
            "one light path in weights where there is one for each pixel",
            ("lamps and a mirror in haze, 16 pixels", || mixed().in_pixels([4, 4])),
            |_, side, index, node| {
                if (side, index) == (Side::Eye, 0) && node.place.is_connectable() {
                    node.ln_connectable = 0.0; // right: ln 16
                }
            },
            1e-3,
        ),
        unlike_sum(
            "bdpt_path_length_roulette",
            "roulette by the index of the vertex on its subpath, which is another one from the other end",
            of_mixed,
            |_, _, index, node| {
                if index > 2 {
                    node.ln_forward += 0.5_f64.ln(); // right: what the place says alone
                }
            },
            1e-3,
        ),
        Twin::new(
            "weights of strategies",
            "bdpt_random_tau",
            "a transmittance drawn for each weight, however unbiased (raab-2008 section 4.3 warns of it)",
            "glass, a lamp and a point light in smoke",
            (0, Evident::Exactly),
            |run| {
                let thickness = Drawn(RefCell::new(Seeded::new(run.seed)));
                let how = (Heuristic::Balance, thickness);
                off(defects(&uneven(), how, (300, run.seed), Change::Nothing).mean(), 1e-2)
            },
        ),
    ]
}

/// An optical thickness from ratio tracking.
#[derive(Clone)]
struct Drawn(RefCell<Seeded>);

impl<M: Medium> WeightThickness<M> for Drawn {
    fn thickness(&self, ray: &Ray<&M>) -> f64 {
        let drawn = ratio().estimate(ray, &mut *self.0.borrow_mut());
        -drawn.max(1e-12).ln()
    }
}

fn ratio() -> Ratio<Uniform> {
    Ratio(Uniform::new(0.8).expect(super::trial::LAWFUL))
}

/// Samples whose light paths are looked through for vertices on glass.
const PATHS: u32 = 200;

/// Radiance that vertices of light paths on smooth surfaces bring where `change` lets them: 0, since nothing is connected there.
fn through_glass(seed: u64, change: impl Fn(&mut Subpath<f64>)) -> f64 {
    let view = bulb();
    let emitters = view.emitters::<Regular>();
    let weigh = view.weigh(&emitters, Heuristic::Balance, Exact);
    let mut integrator = Bidirectional::new(weigh, Walking::new(view.walk), Regular);
    let (mut light, mut source, mut sum) = (Subpath::empty(), Seeded::new(seed), 0.0);
    for _ in 0..PATHS {
        integrator.trace_light(&mut light, &mut source);
        light.steps.retain(|step| matches!(step.node.place.site, Site::Smooth { .. }));
        change(&mut light);
        let line = view.camera.ray([0, 0], [source.next_uniform(), source.next_uniform()]);
        integrator.strategies(&line, &light, &mut source, |_, found| {
            sum += if found.strategy.light >= 2 { found.value } else { 0.0 };
        });
    }
    sum
}

fn unlike_means() -> Vec<Twin> {
    vec![
        Twin::new(
            "bidirectional path tracing",
            "bdpt_connect_glass",
            "vertices on glass are connected, as if it were white",
            "a lamp in glass, in haze",
            (0, Evident::Exactly),
            |run| {
                let as_diffuse = |light: &mut Subpath<f64>| {
                    for step in &mut light.steps {
                        if let Site::Smooth { normal, surface, .. } = step.node.place.site {
                            // Right: nothing is scattered into directions that one could choose.
                            step.node.place.site = Site::Diffuse { normal, surface };
                            step.scattered = step.arriving;
                        }
                    }
                };
                let sum = through_glass(run.seed, as_diffuse);
                Rejection::exact(
                    sum > 0.0,
                    format!("{PATHS} samples find {sum:.2} through vertices on glass"),
                )
            },
        ),
        Twin::new(
            "pairs of strategies",
            "bdpt_no_cos3",
            "a light image without the cosines of the camera",
            "lamps and a mirror in haze",
            (130_000, Evident::Mean { z: 63.8 }),
            |run| {
                let view = mixed();
                let (axis, origin) = (axis(&view), view.camera.origin());
                let cosine = |path: &Path<'_>| (path.places[0].position - origin).normalize().dot(axis);
                let found = pairs::check(&view, &[(2, 1, 2)], &|path| cosine(path).powi(3), run);
                Rejection {
                    rejected: found.holds == Some(false),
                    mean_z: found.mean_z,
                    variance_z: None,
                    reason: found.reason,
                }
            },
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_light_paths_bring_nothing_from_glass() {
        assert_eq!(through_glass(3, |_| ()), 0.0);
    }
}
