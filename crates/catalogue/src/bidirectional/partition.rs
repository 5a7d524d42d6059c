//! Weights of every path that any strategy finds: each is the one by all densities, and together they are one.

use super::scenes::{View, sample};
use crate::checks::paths::LAWFUL;
use fairflight_bidirectional::laws::{Path, Side};
use fairflight_bidirectional::{Bidirectional, LightEnd, Node, Place, Subpath, Walking, WeightThickness};
use fairflight_media::LineThickness;
use fairflight_paths::Heuristic;
use fairflight_paths::transport::Light;
use fairflight_sources::Seeded;
use fairflight_transmittance::Regular;
use glam::DVec3;

/// Heuristics whose weights are checked.
pub const HEURISTICS: [Heuristic; 3] = [Heuristic::Balance, Heuristic::Power, Heuristic::Maximum];

/// Distances of weights from what they should be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defects {
    /// Number of paths.
    pub paths: u64,
    /// The greatest distance of a weight that was used from the recursive one of its whole path, relative to it.
    pub used: f64,
    /// The greatest distance of a recursive weight from the one by all densities, relative to it.
    pub recursive: f64,
    /// The greatest distance of the sum of recursive weights from one.
    pub sum: f64,
    /// The same, summed over paths.
    pub sums: f64,
}

impl Defects {
    /// The greatest of all.
    #[must_use]
    pub fn greatest(&self) -> f64 {
        self.used.max(self.recursive).max(self.sum)
    }

    /// The mean distance of the sum of weights from one.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sums / self.paths as f64
    }

    fn observe(&mut self, recursive: &[f64], direct: &[f64]) {
        let worst = recursive.iter().zip(direct).map(|(&a, &b)| relative(a, b)).fold(0.0, f64::max);
        let sum = (recursive.iter().sum::<f64>() - 1.0).abs();
        self.paths += 1;
        self.recursive = self.recursive.max(worst);
        self.sum = self.sum.max(sum);
        self.sums += sum;
    }
}

fn relative(a: f64, b: f64) -> f64 {
    (a - b).abs() / b.max(1e-100)
}

/// A change of what weights are made of.
#[derive(Clone, Copy)]
pub enum Change<'a> {
    /// Of each place of a path before anything is made of it: a surrogate of its densities.
    Places(&'a (dyn Fn(&mut Place) + Send + Sync)),
    /// Of each node of either subpath, numbered from 0, before the next one is made of it: a mistake.
    Nodes(&'a (dyn Fn(Side, usize, &mut Node) + Send + Sync)),
    /// None.
    Nothing,
}

/// **Law.** The recursive weights of a path sum to one, each is the one by all densities, and the weight that the integrator used for it
/// is the recursive one.
///
/// Of the paths that `samples` samples find, those through smooth surfaces to a point light included. Where places are changed the used
/// weights are not judged: the integrator has those of the true ones.
#[must_use]
pub fn defects<M: LineThickness, K: WeightThickness<M> + Clone>(
    view: &View<M>,
    (heuristic, thickness): (Heuristic, K),
    (samples, seed): (u32, u64),
    change: Change<'_>,
) -> Defects {
    let emitters = view.emitters::<Regular>();
    let world = view.world::<Regular>();
    let laws = view.weigh::<Regular, K>(&emitters, heuristic, thickness.clone());
    let walking = Walking { point_caustics: true, ..Walking::new(view.walk) };
    let weigh = view.weigh(&emitters, heuristic, thickness);
    let mut integrator = Bidirectional::new(weigh, walking, Regular);
    let (mut light, mut source) = (Subpath::empty(), Seeded::new(seed));
    let mut defects = Defects::default();
    for index in 0..samples {
        let [columns, rows] = view.camera.resolution();
        let pixel = [index % columns, index / columns % rows];
        sample(&mut integrator, &mut light, pixel, &mut source, |found, eye, light| {
            let mut path = Path::of((&world, &emitters), found, eye, light);
            if let Change::Places(surrogate) = change {
                path.places.iter_mut().for_each(surrogate);
            }
            let recursive = laws.recursive(&path, |side, index, node| {
                if let Change::Nodes(mistake) = change {
                    mistake(side, index, node);
                }
            });
            defects.observe(&recursive, &laws.direct(&path));
            if !matches!(change, Change::Places(_)) {
                let weight = recursive[found.strategy.eye as usize - 1];
                defects.used = defects.used.max(relative(found.weight, weight));
            }
        });
    }
    defects
}

/// The same of one path through these points in the medium to the first light, by all heuristics.
#[must_use]
pub fn by_hand<M: LineThickness>(view: &View<M>, points: &[DVec3]) -> Defects {
    let emitters = view.emitters::<Regular>();
    let world = view.world::<Regular>();
    let mut defects = Defects::default();
    for heuristic in HEURISTICS {
        let weigh = view.weigh::<Regular, _>(&emitters, heuristic, fairflight_bidirectional::Exact);
        let places: Vec<Place> = points.iter().map(|&point| weigh.place_in_medium(point)).collect();
        assert!(!places.is_empty(), "{LAWFUL}");
        let end = LightEnd::new(&world, &emitters, Light::Source(0), DVec3::ZERO);
        let path = Path { places, end };
        defects.observe(&weigh.recursive(&path, |_, _, _| {}), &weigh.direct(&path));
    }
    defects
}
