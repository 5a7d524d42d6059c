//! Radiance by walks through a medium.

mod expected_value;
mod integrator;
mod particle_tracer;
mod sampling;
mod shadow;
pub mod single_scattering;
mod walk;

pub use expected_value::ExpectedValue;
pub use integrator::Integrator;
pub use particle_tracer::{Attenuation, ParticleTracer};
pub use sampling::{NotPositive, SamplingExtinction, Uniform};
pub use shadow::{Ratio, RayTransmittance, arriving};
pub use walk::{End, ROULETTE_BELOW, ScatteringEvent, Walk};
