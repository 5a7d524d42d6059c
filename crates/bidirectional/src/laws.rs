//! Weights of a whole path, twice: recursively, as the integrator has them, and by all densities of all strategies (antwerpen-2011
//! section 5.2).
//!
//! The second takes quadratic time, and nothing of the first enters it but the densities of single vertices: it is for tests, and for who needs the densities
//! themselves.

use crate::thickness::between;
use crate::{Found, LightEnd, LogHeuristic, Node, Place, Subpath, Weigh, WeightThickness};
use fairflight_elementary::{exp, ln};
use fairflight_paths::Heuristic;
use fairflight_paths::transport::{Emitters, Types, World};
use glam::DVec3;

/// A path x_0 … x_k, its first vertex the pinhole.
#[derive(Clone, Debug)]
pub struct Path<'s> {
    /// x_1 … x_(k−1), as one comes to them from the camera.
    pub places: Vec<Place>,
    /// x_k.
    pub end: LightEnd<'s>,
}

impl<'s> Path<'s> {
    /// The path that a strategy found.
    pub fn of<W: Types>(
        (world, emitters): (&World<'s, W>, &Emitters<W::Spectrum>),
        found: &Found<W::Spectrum>,
        eye: &Subpath<W::Spectrum>,
        light: &Subpath<W::Spectrum>,
    ) -> Self {
        let (emitter, at) = found.light_end(light);
        let places = found.places(eye, light).collect();
        Self { places, end: LightEnd::new(world, emitters, emitter, at) }
    }
}

/// The end of a path from which a subpath starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The camera.
    Eye,
    /// The light.
    Light,
}

/// Logarithms of densities, and buffers to be filled again.
#[derive(Clone, Debug, Default)]
pub struct LnDensities {
    eye: Vec<f64>,
    light: Vec<f64>,
    strategies: Vec<f64>,
}

/// Weights of (k + 1 − t, t) for t = 1 … k + 1; 0 where a strategy does not exist.
pub type Weights = Vec<f64>;

impl<W: Types, K: WeightThickness<W::Medium>> Weigh<'_, W, K> {
    /// The recursive weights of all strategies. `twist` may change each node of either subpath, numbered from 0, before the next
    /// one is made of it: a mistake to be found.
    pub fn recursive(&self, path: &Path<'_>, mut twist: impl FnMut(Side, usize, &mut Node)) -> Weights {
        let Path { places, end } = path;
        let k = places.len() + 1;
        if k == 1 {
            return vec![0.0, 1.0];
        }
        let mut nodes = |side: Side, places: &mut dyn Iterator<Item = Place>| {
            let mut nodes: Vec<Node> = Vec::new();
            for (index, place) in places.enumerate() {
                let mut node = match (nodes.last(), side) {
                    (Some(previous), _) => self.next(previous, place),
                    (None, Side::Eye) => self.first_of_eye(place),
                    (None, Side::Light) => self.first_of_light(end, place),
                };
                twist(side, index, &mut node);
                nodes.push(node);
            }
            nodes
        };
        let eye = nodes(Side::Eye, &mut places.iter().copied());
        let light = nodes(Side::Light, &mut places.iter().rev().map(|place| place.reversed()));
        let at_light = self.at_light(&eye[k - 2], end);
        (1..=k + 1)
            .map(|t| match k + 1 - t {
                0 => at_light.met,
                1 => at_light.sampled,
                // x_1 is the last node of the light subpath, x_t the one with k − 1 − t before it.
                _ if t == 1 => {
                    let exists = |z: &&Node| z.place.is_connectable() && self.light_paths > 0.0;
                    light.last().filter(exists).map_or(0.0, |z| self.light_image(z))
                }
                _ => {
                    let (y, z) = (&eye[t - 2], &light[k - 1 - t]);
                    let connectable = y.place.is_connectable() && z.place.is_connectable();
                    if connectable { self.connection(y, z) } else { 0.0 }
                }
            })
            .collect()
    }

    /// The same by the densities of all strategies ([`ln_densities`](Self::ln_densities)).
    pub fn direct(&self, path: &Path<'_>) -> Weights {
        let k = path.places.len() + 1;
        if k == 1 {
            return vec![0.0, 1.0];
        }
        let mut densities = LnDensities::default();
        let ln = self.ln_densities(path, &mut densities);
        let greatest = ln.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if self.heuristic == Heuristic::Maximum {
            // Of those as great the first: the least t.
            let first = ln.iter().position(|&ln| ln >= greatest - 1e-9);
            return (0..ln.len()).map(|i| f64::from(u8::from(Some(i) == first))).collect();
        }
        let powers: Vec<f64> = ln.iter().map(|ln| exp(self.heuristic.scale(ln - greatest))).collect();
        let sum: f64 = powers.iter().sum();
        powers.iter().map(|power| power / sum).collect()
    }

    /// ln of the densities of (k + 1 − t, t) for t = 1 … k + 1, k ≥ 2, each a product over the whole path, times n_L for t = 1; ln 0 where a strategy does not exist:
    ///
    /// ```text
    /// p_(s,t) = Π_(0<i<t) P→(x_i) · Π_(t≤j<k) P←(x_j) · {P→(x_k), P_dir, P_sub}
    /// ```
    pub fn ln_densities<'l>(&self, path: &Path<'_>, buffers: &'l mut LnDensities) -> &'l [f64] {
        let LnDensities { eye, light, strategies } = buffers;
        let Path { places, end } = path;
        let k = places.len() + 1;
        self.ln_from_eye(path, eye);
        self.ln_from_light(path, light);
        let last = &places[k - 2];
        let ln_if = |exists: bool, ln: f64| if exists { ln } else { f64::NEG_INFINITY };
        strategies.clear();
        strategies.extend((1..=k + 1).map(|t| {
            let s = k + 1 - t;
            let connectable = |i: usize| places[i - 1].is_connectable();
            let product = eye[1..t].iter().chain(&light[t.min(k)..k]).copied();
            let at_end = match s {
                0 => 0.0,
                1 => ln_if(connectable(k - 1), ln(end.pdf_direct(last))),
                _ => {
                    let exists = connectable(t) && (t == 1 || connectable(t - 1));
                    let count = if t == 1 { ln(self.light_paths) } else { 0.0 };
                    ln_if(exists, ln(end.pdf_start()) + count)
                }
            };
            accurate_sum(product.chain([at_end]))
        }));
        strategies
    }

    /// ln P→(x_i), i = 1 … k, at index i.
    fn ln_from_eye(&self, path: &Path<'_>, densities: &mut Vec<f64>) {
        let Path { places, end } = path;
        let (phase, volume) = (&self.world.volume.phase, self.world.volume);
        let origin = self.camera.origin();
        let k = places.len() + 1;
        densities.clear();
        densities.resize(k + 1, 0.0);
        let first = &places[0];
        let importance = self.camera.importance(first.position);
        let towards = (first.position - origin).normalize();
        let thickness = between(volume, &self.thickness, origin, first.position);
        densities[1] = ln(importance) + ln(first.facing(towards)) - thickness;
        for i in 2..=k {
            let before = if i == 2 { origin } else { places[i - 3].position };
            let at = &places[i - 2];
            let incident = (at.position - before).normalize();
            densities[i] = if i == k {
                let (towards, _) = end.seen_from(at.position);
                ln(at.scatter(phase, incident, towards)) + end.ln_met(at) - self.to_light(end, at)
            } else {
                self.ln_edge(at, incident, &places[i - 1])
            };
        }
    }

    /// ln P←(x_j), j = 1 … k − 1, at index j.
    fn ln_from_light(&self, path: &Path<'_>, densities: &mut Vec<f64>) {
        let Path { places, end } = path;
        let k = places.len() + 1;
        densities.clear();
        densities.resize(k + 1, 0.0);
        let last = &places[k - 2];
        densities[k - 1] = end.ln_emitted(last) - self.to_light(end, last);
        for j in (1..k - 1).rev() {
            let at = places[j].reversed();
            let incident = match places.get(j + 1) {
                Some(behind) => (at.position - behind.position).normalize(),
                None => -end.seen_from(at.position).0,
            };
            densities[j] = self.ln_edge(&at, incident, &places[j - 1]);
        }
    }

    /// ln P of `to`, drawn from `at` where one arrived along `incident`.
    fn ln_edge(&self, at: &Place, incident: DVec3, to: &Place) -> f64 {
        let offset = to.position - at.position;
        let (squared, direction) = (offset.length_squared(), offset.normalize());
        let thickness = between(self.world.volume, &self.thickness, at.position, to.position);
        let scattered = at.scatter(&self.world.volume.phase, incident, direction);
        ln(scattered) + ln(to.facing(direction)) - ln(squared) - thickness
    }
}

/// A sum without the rounding of its partial sums: logarithms of forty edges of τ = 50 leave digits for their differences.
fn accurate_sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0);
    for term in terms {
        let next = sum + term;
        if next.is_infinite() {
            return next;
        }
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}
