//! Photons on surfaces and in participating media.
//!
//! | part | source | what |
//! |---|---|---|
//! | [`PhotonMap`] | antwerpen-2011 4.5 | vertices of light paths, found by their place |
//! | [`Guided`] | antwerpen-2011 4.5 (jensen-1995) | directions in which a path tracer goes on, chosen by the light that photons tell of: unbiased for any map |
//! | [`BeamRadiance`] | jarosz-2008 | radiance from the photons along a whole ray: biased |
//!
//! A map is made by a pass of its own, from a stream of its own, before the paths that use it: of photons that depend on a path neither
//! would know what it draws.
//!
//! ```
//! use fairflight_collision::Version;
//! use fairflight_media::{Bounds, Homogeneous, Line, phase::Isotropic};
//! use fairflight_paths::extend::OwnShare;
//! use fairflight_paths::transport::{MadeOf, World};
//! use fairflight_paths::{Heuristic, Integrator, PathTracer, Uniform, Walk};
//! use fairflight_photons::{BeamRadiance, GuideOptions, Guided, PhotonMap};
//! use fairflight_scene::{Background, Lights, NoSurfaces, Volume};
//! use fairflight_sources::Seeded;
//! use fairflight_transmittance::Regular;
//! use fairflight_vpl::{Emitters, Ledger, LightPaths};
//! use glam::DVec3;
//!
//! // Haze that absorbs nothing under a sky of 1: it is not to be seen.
//! let volume = Volume {
//!     medium: Homogeneous::new(1.0).unwrap(),
//!     bounds: Bounds::aligned_box(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap(),
//!     albedo: 1.0,
//!     phase: Isotropic,
//! };
//! let lights = Lights { background: Background { constant: 1.0, maps: vec![] }, sources: vec![] };
//! let world: World<'_, MadeOf<_, _, _, _, Uniform, Regular>> = World::new(&volume, &NoSurfaces, &lights);
//! let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
//!
//! // A pass of its own leaves the photons.
//! let emitters = Emitters::new(&lights, &NoSurfaces, world.enclosing_ball(), DVec3::ZERO);
//! let light_paths = LightPaths::new(world, &emitters, walk);
//! let (mut vertices, mut source) = (Vec::new(), Seeded::new(1));
//! for _ in 0..10_000 {
//!     light_paths.trace(1e-4, &mut Ledger::empty(), &mut source, |vertex| vertices.push(vertex));
//! }
//! let map = PhotonMap::new(vertices);
//! let ray = Line { origin: DVec3::ZERO, direction: DVec3::X };
//!
//! // Guided paths need them to know where to go, and not to be right.
//! let many = |n| std::num::NonZeroU32::new(n).unwrap();
//! let options = GuideOptions { nearest: many(20), cells: many(16), own_share: OwnShare::default() };
//! let tracer = PathTracer::new(world, walk, Regular, Heuristic::Balance);
//! let mut guided = tracer.with_extension(Guided::new(&map, options));
//! let mean = (0..10_000).map(|_| guided.radiance(&ray, &mut source)).sum::<f64>() / 10_000.0;
//! assert!((mean - 1.0).abs() < 0.05);
//!
//! // The beam radiance estimate is made of them.
//! let mut beam = BeamRadiance::new(world, (&map, 0.2), walk, Regular, Heuristic::Balance).unwrap();
//! assert!((beam.radiance(&ray, &mut source) - 1.0).abs() < 0.2);
//! ```

mod any;
mod beam;
mod guide;
mod map;
mod tree;

pub use any::AnyExtension;
pub use beam::{BeamRadiance, NotARadius, SurfaceLight};
pub use guide::{GuideOptions, Guided};
pub use map::{Photon, PhotonMap};
