//! Radiance by walks through a medium.
//!
//! | integrator | source | light |
//! |---|---|---|
//! | [`Attenuation`] | szirmay-kalos-2017 4.2 | the background through the medium, nothing scattered |
//! | [`ParticleTracer`] | szirmay-kalos-2017 4.1 | all orders, importons from the camera |
//! | [`PhotonTracer`] | szirmay-kalos-2017 4.1 | all orders, photons from the lights |
//! | [`LineSplitting`] | raab-2008 3.1, algorithm 2 | all orders, several first collisions per camera ray |
//! | [`single_scattering::SingleScattering`] | szirmay-kalos-2017 4.3 | one scattering event |
//! | [`single_scattering::LineSampled`] | raab-2008 3.1, algorithm 2 | one scattering event |
//! | [`single_scattering::Marching`] | perlin-1989 | one scattering event, a biased baseline |
//! | [`PathTracer`] | raab-2008 4.1 | all orders, surfaces and medium |
//! | [`extend::PathReuse`] | antwerpen-2011 4.7 | the same, of several pixels that use each other's paths |
//!
//! How a path tracer chooses directions and points of lights is a type of its own ([`extend`]).
//!
//! A walk looks the medium up at the rate of a [`SamplingExtinction`], which need not bound the extinction; whether it then has a
//! second moment is what [`second_moment_growth`] measures.
//!
//! ```
//! use fairflight_collision::Version;
//! use fairflight_media::{AnalyticCosine, phase::Rayleigh};
//! use fairflight_paths::{Integrator, ParticleTracer, Uniform, Walk};
//! use fairflight_scene::{Background, Camera, Lights, Volume};
//! use fairflight_sources::Seeded;
//! use glam::{DVec3, dvec3};
//!
//! // A furnace: without absorption every pixel of a uniformly lit medium is as bright as the background.
//! let camera = Camera::new(dvec3(0.0, 0.0, -20.0), dvec3(0.0, 0.0, 10.0), DVec3::Y, 60.0, [1, 1]).unwrap();
//! let medium = AnalyticCosine::new(1.0).unwrap();
//! let volume = Volume { medium, bounds: AnalyticCosine::default_bounds(), albedo: 1.0, phase: Rayleigh };
//! let lights = Lights { background: Background { constant: 1.0, maps: vec![] }, sources: vec![] };
//! let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
//! let mut tracer = ParticleTracer::new(&volume, &lights, walk);
//! let radiance = tracer.radiance(&camera.ray([0, 0], [0.5, 0.5]), &mut Seeded::new(1));
//! assert!((radiance - 1.0).abs() < 1e-12);
//! ```

pub mod extend;
mod grid;
mod growth;
mod heuristic;
mod integrator;
mod lockstep;
mod particle_tracer;
mod path_tracer;
mod photon_tracer;
mod sampling;
mod shadow;
pub mod single_scattering;
mod splitting;
pub mod transport;
mod walk;

pub use grid::{Grid, GridError};
pub use growth::{Criticality, Growth, grows_nowhere, second_moment_growth};
pub use heuristic::Heuristic;
pub use integrator::Integrator;
pub use particle_tracer::{Attenuation, ParticleTracer};
pub use path_tracer::PathTracer;
pub use photon_tracer::PhotonTracer;
pub use sampling::{NotPositive, SamplingExtinction, Uniform};
pub use shadow::{Ratio, RayTransmittance, arriving};
pub use splitting::LineSplitting;
pub use walk::{End, ROULETTE_BELOW, Roulette, ScatteringEvent, Walk};
