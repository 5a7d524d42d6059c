//! Bias compensation for bounded virtual point lights, exact and approximate.
//!
//! | part | source | what |
//! |---|---|---|
//! | [`Compensation`] | raab-2008 eq. 15, engelhardt-2013 4 | the recursion, for every choice of [`CompensationOptions`] |
//! | [`TruncatedExponential`] | engelhardt-2013 eq. 4 and 5 | distances within the bounding region |
//! | [`LocalMean`] | engelhardt-2013 4.2 | the extinction that those take for granted |
//! | [`Brightness`] | raab-2008 4.2 | a bound from the scene |
//!
//! ```
//! use fairflight_collision::Version;
//! use fairflight_compensation::{Compensation, CompensationOptions, LocalMean};
//! use fairflight_media::{Bounds, EmptySpace, Line, phase::Isotropic};
//! use fairflight_paths::{Heuristic, Integrator, Uniform, Walk, transport::World};
//! use fairflight_scene::surface::Sphere;
//! use fairflight_scene::{Background, Lights, Material, Shape, Surface, Surfaces, Volume};
//! use fairflight_sources::Seeded;
//! use fairflight_transmittance::Regular;
//! use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Pairing, Term, VplIntegrator};
//! use glam::DVec3;
//!
//! // A hollow ball that glows 1/2 and reflects 1/2: the radiance in it is 1/2 + 1/4 + … = 1. Within it G = cos²/(2 cos)² = 1/4 for every pair.
//! let ball = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
//! let surfaces = Surfaces::new(vec![Surface::new(ball, Material::Diffuse { reflectance: 0.5 }, 0.5).unwrap()]);
//! let lights = Lights { background: Background::dark(), sources: vec![] };
//! let bounds = Bounds::sphere(DVec3::ZERO, 1.0).unwrap();
//! let volume = Volume { medium: EmptySpace, bounds, albedo: 0.0, phase: Isotropic };
//! let world = World::new(&volume, &surfaces, &lights);
//! let walk = Walk::new(Version::NonTerminating, Uniform::new(1.0).unwrap());
//!
//! let emitters = Emitters::new(&lights, &surfaces, world.enclosing_ball(), DVec3::ZERO);
//! let paths = LightPaths::new(world, &emitters, walk);
//! let (mut vpls, mut ledger, mut source) = (Vec::new(), Ledger::empty(), Seeded::new(1));
//! for _ in 0..1000 {
//!     paths.trace(1e-3, &mut ledger, &mut source, |vpl| vpls.push(vpl));
//! }
//! // A bound that leaves 0.4 of each connection, and what makes up for the rest.
//! let (term, heuristic) = (Term::Bounded(0.1), Heuristic::Balance);
//! let gather = Gather { world, vpls: &vpls, term, heuristic, walk, shadow: Regular };
//! let mean = LocalMean::of(&volume.medium, &bounds, [1; 3], 1);
//! let correction = Compensation::new(CompensationOptions::EXACT, &mean);
//! let mut integrator = VplIntegrator::new(gather, (1, Pairing::Every), correction);
//! let ray = Line { origin: DVec3::ZERO, direction: DVec3::X };
//! let radiance = (0..1000).map(|_| integrator.radiance(&ray, &mut source)).sum::<f64>() / 1000.0;
//! // Without compensation it would be 0.85. One standard error is 0.0062: the number of lights, and roulette.
//! assert!((radiance - 1.0).abs() < 5.0 * 0.0062);
//! ```

mod bound;
mod compensation;
#[cfg(test)]
mod fixtures;
mod local_mean;
mod options;
mod place;
mod truncated_exponential;

pub use bound::Brightness;
pub use compensation::Compensation;
pub use local_mean::LocalMean;
pub use options::{CompensationOptions, OptionsError, Placement, Strategy, TransmittanceUse, Visibility};
pub use truncated_exponential::TruncatedExponential;
