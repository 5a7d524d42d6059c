//! Virtual point lights in participating media: generation and gathering (instant radiosity).
//!
//! | part | source | what |
//! |---|---|---|
//! | [`LightPaths`] | engelhardt-2013 3.2 | light paths that leave a [`Vpl`] at each vertex, on surfaces and in the medium |
//! | [`Gather`] | engelhardt-2013 3.3, raab-2008 eq. 14 | what they add at a vertex, bounded or not |
//! | [`VplIntegrator`] | engelhardt-2013 3.3 | radiance along a camera ray |
//! | [`Correction`] | raab-2008 eq. 15 | the seam for what bounding takes away |
//!
//! ```
//! use fairflight_collision::Version;
//! use fairflight_media::{Bounds, EmptySpace, Line, phase::Isotropic};
//! use fairflight_paths::{Heuristic, Integrator, Uniform, Walk, transport::World};
//! use fairflight_scene::surface::Sphere;
//! use fairflight_scene::{Background, Lights, Material, Shape, Surface, Surfaces, Volume};
//! use fairflight_sources::Seeded;
//! use fairflight_transmittance::Regular;
//! use fairflight_vpl::{Emitters, Gather, Ledger, LightPaths, Pairing, Term, Uncorrected, VplIntegrator};
//! use glam::DVec3;
//!
//! // A hollow ball that glows 1/2 and reflects 1/2: the radiance in it is 1/2 + 1/4 + … = 1.
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
//! let (term, heuristic) = (Term::Bounded(f64::INFINITY), Heuristic::Balance);
//! let gather = Gather { world, vpls: &vpls, term, heuristic, walk, shadow: Regular };
//! let mut integrator = VplIntegrator::new(gather, (1, Pairing::Every), Uncorrected);
//! let radiance = integrator.radiance(&Line { origin: DVec3::ZERO, direction: DVec3::X }, &mut source);
//! // Within a ball G = cos²/(2 cos)² is the same for every pair: only the number of lights is left to chance. That of one path has the
//! // standard deviation √2, which makes 0.0056 of the radiance: five of those.
//! assert!((radiance - 1.0).abs() < 0.028);
//! ```

mod correction;
#[cfg(test)]
mod fixtures;
mod gather;
mod integrator;
mod keep_near;
mod light_paths;
mod lockstep;
mod vpl;

pub use fairflight_paths::transport::{Emitters, Ledger};

pub use correction::{Connections, Correction, Uncorrected};
pub use gather::{Connected, Gather, Term};
pub use integrator::{Component, Pairing, VplIntegrator};
pub use keep_near::KeepNear;
pub use light_paths::LightPaths;
pub use vpl::Vpl;
