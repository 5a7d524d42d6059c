//! Every mutation keeps the contribution of paths, by independent paths of one kind; factors left out are found.
//!
//! A twin is the mutation with a wrong ratio: by a function of the path that stands in f J, or should.

mod path_common;

use fairflight_metropolis::Mutation;
use fairflight_metropolis::laws::{Drift, Probes, Steps};
use fairflight_metropolis::path::{
    Caustic, LaiLens, Lens, PathState, PathWorld, Propagation, Scattering, Towards,
};
use fairflight_sources::Seeded;
use path_common::{Boxed, Mistake, Scene, Traced, Twin, fine_sizes, hall, mirrored, probes, sizes};

/// False alarm of one case, all functions together.
const ALPHA: f64 = 1e-6;

/// A mutation on paths of one kind.
struct Case {
    name: &'static str,
    kinds: &'static str,
    mutation: fn(&dyn PathWorld) -> Boxed<'_>,
    /// Indices of probes that it moves.
    moved: &'static [usize],
    /// Mistakes: their name, and the logarithm of the wrong f J over the right one.
    twins: &'static [(&'static str, Mistake)],
}

/// ln of the cosine of the first edge to the axis of the camera.
fn ln_cosine(x: &PathState) -> f64 {
    x.edges[0].direction.z.ln()
}

fn ln_length(x: &PathState, edge: usize) -> f64 {
    x.edges[edge].length.ln()
}

fn ln_facing(x: &PathState, vertex: usize, edge: usize) -> f64 {
    x.vertices[vertex].facing(x.edges[edge].direction).ln()
}

fn ln_scattered(world: &dyn PathWorld, x: &PathState, vertex: usize) -> f64 {
    x.vertices[vertex].scatter(world, x.edges[vertex - 1].direction, x.edges[vertex].direction).ln()
}

fn ln_importance(world: &dyn PathWorld, x: &PathState) -> f64 {
    world.camera().importance(x.vertices[1].position).ln()
}

/// Of a path V S: dA(x_3) per direction at x_1, over the plane mirror.
fn ln_chain(x: &PathState) -> f64 {
    2.0 * (x.edges[1].length + x.edges[2].length).ln() - ln_facing(x, 3, 2)
}

/// Of a path V S: G to the mirror.
fn ln_to_mirror(x: &PathState) -> f64 {
    ln_facing(x, 2, 1) - 2.0 * ln_length(x, 1)
}

const CASES: &[Case] = &[
    Case {
        name: "lens, distance kept",
        kinds: "VV",
        mutation: |world| Box::new(Lens::new(world, sizes())),
        moved: &[0, 1, 2, 4, 5],
        twins: &[
            ("no cos³ of the camera", |_, x| -3.0 * ln_cosine(x)),
            ("the camera's Jacobian inverted (eq. 3.18)", |_, x| -6.0 * ln_cosine(x)),
            ("G of the connection left out", |_, x| 2.0 * ln_length(x, 1)),
            ("T of the connection left out", |_, x| -x.edges[1].ln_transmittance),
            ("phase at the kept vertex left out", |world, x| -ln_scattered(world, x, 2)),
        ],
    },
    Case {
        name: "lens, distance scaled",
        kinds: "VV",
        mutation: |world| Box::new(Lens::new(world, sizes()).scaling()),
        moved: &[0, 1, 2, 3, 4, 5],
        twins: &[
            ("r of the logarithmic step left out", |_, x| -ln_length(x, 0)),
            ("T of the camera's ray left out", |_, x| -x.edges[0].ln_transmittance),
        ],
    },
    Case {
        name: "lens, onto a surface",
        kinds: "DV",
        mutation: |world| Box::new(Lens::new(world, sizes())),
        moved: &[0, 1, 2, 3, 4],
        twins: &[
            ("cosine of the surface's Jacobian left out", |_, x| ln_facing(x, 1, 0)),
            ("T of the camera's ray left out", |_, x| -x.edges[0].ln_transmittance),
        ],
    },
    Case {
        name: "propagation from the eye",
        kinds: "V",
        mutation: |world| Box::new(Propagation::new(world, sizes(), Towards::Eye)),
        moved: &[3, 4, 5],
        twins: &[
            ("r² of the volume left out", |_, x| -2.0 * ln_length(x, 0)),
            ("r of the logarithmic step left out", |_, x| -ln_length(x, 0)),
        ],
    },
    Case {
        name: "propagation from a vertex",
        kinds: "DV",
        mutation: |world| Box::new(Propagation::new(world, sizes(), Towards::Eye)),
        moved: &[4, 6],
        twins: &[
            ("no Jacobian", |_, x| -3.0 * ln_length(x, 1)),
            ("r of the logarithmic step left out", |_, x| -ln_length(x, 1)),
            ("G of the connection with the light left out", |_, x| 2.0 * ln_length(x, 2)),
        ],
    },
    Case {
        name: "propagation from the light",
        kinds: "VV",
        mutation: |world| Box::new(Propagation::new(world, sizes(), Towards::Light)),
        moved: &[0, 1, 2, 3, 4, 5, 6],
        twins: &[("phase at the far neighbour left out", |world, x| -ln_scattered(world, x, 1))],
    },
    Case {
        name: "scattering towards the eye",
        kinds: "VV",
        mutation: |world| Box::new(Scattering::new(world, sizes(), Towards::Eye)),
        moved: &[0, 1, 2, 3, 5],
        twins: &[
            ("the camera as if x_1 came from the film", |world, x| -ln_importance(world, x)),
            ("no cos³ of the camera", |_, x| 3.0 * ln_cosine(x)),
        ],
    },
    Case {
        name: "scattering towards the eye, on a surface",
        kinds: "DV",
        mutation: |world| Box::new(Scattering::new(world, sizes(), Towards::Eye)),
        moved: &[0, 1, 2, 3, 4],
        twins: &[("T to the camera left out", |_, x| -x.edges[0].ln_transmittance)],
    },
    Case {
        name: "scattering towards the light",
        kinds: "DV",
        mutation: |world| Box::new(Scattering::new(world, sizes(), Towards::Light)),
        moved: &[6, 7],
        twins: &[("cosine at the surface left out", |_, x| -ln_facing(x, 1, 1))],
    },
    Case {
        name: "caustic from the light",
        kinds: "V",
        mutation: |world| Box::new(Caustic::new(world, sizes())),
        moved: &[0, 1, 2, 3, 5],
        twins: &[
            ("cosine at the lamp left out", |_, x| -ln_facing(x, 2, 1)),
            ("1/d² of the connection left out", |_, x| 2.0 * ln_length(x, 0)),
        ],
    },
    Case {
        name: "lens through a mirror",
        kinds: "VS",
        mutation: |world| Box::new(Lens::new(world, fine_sizes())),
        moved: &[0, 1, 2, 4, 5, 6, 7],
        twins: &[("Jacobian of the chain left out", |_, x| -ln_chain(x))],
    },
    Case {
        name: "Lai's lens",
        kinds: "VS",
        mutation: |world| Box::new(LaiLens::new(world, fine_sizes())),
        moved: &[0, 1, 2, 4, 5, 7],
        twins: &[
            ("G to the kept vertex of the mirror left out", |_, x| -ln_to_mirror(x)),
            ("no Jacobian of the chain", |_, x| -ln_to_mirror(x) - ln_chain(x)),
        ],
    },
    Case {
        name: "caustic over a mirror",
        kinds: "VS",
        mutation: |world| Box::new(Caustic::new(world, fine_sizes())),
        moved: &[0, 1, 2, 3, 4, 5, 6],
        twins: &[
            ("the camera's factor left out", |world, x| -ln_importance(world, x)),
            ("no cos³ of the camera", |_, x| 3.0 * ln_cosine(x)),
            ("phase at x_1 left out", |world, x| -ln_scattered(world, x, 1)),
        ],
    },
];

/// Independent paths of one kind with their weights, from which all cases of that kind draw: more even ones than a path tracer's, since most of those are faint.
fn bank(scene: &Scene, kinds: &'static str, (samples, seed): (u64, u64)) -> Vec<(PathState, f64)> {
    let view = scene.view();
    let traced = Traced { world: &view, kinds };
    let mut source = Seeded::new(seed);
    let threshold = 10.0 * traced.mean_weight(&mut source);
    // The pilot has a quarter of the samples besides.
    (0..samples + samples / 4)
        .map(|_| {
            let (path, weight) = traced.even_sample(threshold, &mut source);
            (path, weight / threshold)
        })
        .collect()
}

/// Judges the cases of one kind: the right mutations, and their twins.
fn judge(kinds: &'static str, scene: &Scene, (samples, seed): (u64, u64)) {
    let view = scene.view();
    let bank = bank(scene, kinds, (samples, seed));
    for case in CASES.iter().filter(|case| case.kinds == kinds) {
        let moved = probes(case.moved);
        let judged = |mutation: &mut dyn Mutation<PathState>| {
            let mut states = bank.iter();
            let sample = |source: &mut Seeded, each: &mut dyn FnMut(&PathState, f64, &mut Seeded)| {
                let (path, weight) = states.next().unwrap();
                each(path, *weight, source);
            };
            let steps = Steps { samples, seed, alpha: ALPHA };
            steps.judge(Probes { moved: &moved, kept: &[] }, sample, mutation)
        };
        let right = judged(&mut *(case.mutation)(&view));
        println!("{:42} acceptance {:.2}  z {:+5.1}", case.name, right.acceptance, right.worst().z);
        assert!(!right.is_rejected(), "{}: {:#?}", case.name, right.worst());
        let reach = |drift: &Drift| drift.verdict.detectable_relative_bias.unwrap_or(f64::INFINITY);
        let least = right.drifts.iter().map(reach).fold(f64::INFINITY, f64::min);
        assert!(least < 0.1, "{}: {least}", case.name);
        for &(name, mistake) in case.twins {
            let twin = judged(&mut Twin { right: (case.mutation)(&view), world: &view, mistake });
            println!("    {name:50} z {:+5.1}  drift {:+.3}", twin.worst().z, twin.worst().relative);
            assert!(twin.is_rejected(), "{}, {name}: {:#?}", case.name, twin.worst());
        }
    }
}

// Of each kind as many paths as its weakest twin asks for: the pilots' |z| of the functions that reject are 8.5 and more.

#[test]
fn one_vertex_in_the_medium() {
    judge("V", &hall(), (200_000, 1)); // cosine at the lamp: 9.7
}

#[test]
fn two_vertices_in_the_medium() {
    judge("VV", &hall(), (250_000, 1)); // T of the connection: 9.0
}

#[test]
fn a_vertex_on_a_surface_and_one_in_the_medium() {
    judge("DV", &hall(), (160_000, 1)); // r³ from a vertex has 122, and the heaviest tails
}

#[test]
fn a_vertex_in_the_medium_and_a_mirror() {
    judge("VS", &mirrored(), (100_000, 1)); // G to the mirror: 16
}
