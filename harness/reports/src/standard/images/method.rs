//! Estimates of one pixel with its share of the look-ups.

use super::borrowed::Borrowed;
use fairflight_collision::{Albedo, DoubleParticle};
use fairflight_harness::field::KnownField;
use fairflight_media::{
    Bounded, Constant, Counted, Domain, Extinction, FieldError, OpticalThickness, PiecewiseLinear, Vacuum,
    Violation, Watched,
};
use fairflight_sources::Seeded;
use fairflight_transmittance::{Explorers, Offset, RayMarching, Tracking, TransmittanceEstimator, Woodcock};
use std::cell::RefCell;
use std::error::Error;

/// A way to estimate the transmittance of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Method {
    /// The classical loop: a look-up at the start of each step from where the ray enters, the last step cut short.
    MarchFromEntry { step: f64 },
    /// Midpoints of equal steps of about this length.
    March { step: f64 },
    /// Woodcock flights.
    Woodcock { majorant: f64 },
    /// Double particle without control.
    Ratio { sigma_samp: f64 },
    /// Double particle, the control through look-ups of the pixel's own ray.
    OwnExplorers { count: usize, sigma_samp: f64 },
    /// Double particle, the control through the interaction points of the pixels before.
    BorrowedExplorers { sigma_samp: f64 },
}

/// The estimate of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    pub(super) mean: f64,
    pub(super) lookups: u64,
    /// A look-up that the method does not admit.
    pub(super) violation: Option<Violation>,
}

/// One pixel: `rays` estimates by `method` on its ray.
pub(super) struct Estimate<'a> {
    pub(super) method: Method,
    pub(super) rays: u64,
    pub(super) source: &'a mut Seeded,
    /// Look-ups of the pixels before; filled only by the method that borrows.
    pub(super) borrowed: &'a mut Borrowed,
    /// Distance to the medium from the camera, which neighbouring rays share.
    pub(super) entry: f64,
}

/// The values that a method admits: Woodcock's up to its majorant, every finite one otherwise.
#[derive(Clone, Copy)]
struct Below(f64);

impl Domain for Below {
    fn admits(&self, _s: f64, sigma_t: f64) -> bool {
        sigma_t <= self.0
    }
}

impl Estimate<'_> {
    /// Draws the estimates of the pixel on its ray.
    ///
    /// # Errors
    /// If a parameter of the method is not lawful.
    pub(super) fn draw(self, field: &dyn KnownField) -> Result<Pixel, Box<dyn Error>> {
        let Self { method, rays, source, borrowed, entry } = self;
        let limit = if let Method::Woodcock { majorant } = method { majorant } else { f64::INFINITY };
        let looked_up = Counted::new(Watched::new(field, Below(limit)));
        let length = field.length();
        let mean = match method {
            Method::MarchFromEntry { step } => march_from_entry(&looked_up, step),
            Method::March { step } => {
                let steps = (length / step).round().max(1.0) as u32;
                average(&RayMarching::new(steps, Offset::Fixed)?, &looked_up, rays, source)
            }
            Method::Woodcock { majorant } => {
                average(&Woodcock, &Bounded::new(&looked_up, majorant)?, rays, source)
            }
            Method::Ratio { sigma_samp } => {
                average(&double_particle(Vacuum::new(length), sigma_samp)?, &looked_up, rays, source)
            }
            Method::OwnExplorers { count, sigma_samp } => {
                let control = Explorers::through(&looked_up, count)?;
                average(&double_particle(control, sigma_samp)?, &looked_up, rays, source)
            }
            Method::BorrowedExplorers { sigma_samp } => {
                let (positions, values) = borrowed.control(entry, length);
                let control = PiecewiseLinear::new(positions, values)?;
                let recorded = Recorded { field: &looked_up, points: RefCell::default() };
                let mean = average(&double_particle(control, sigma_samp)?, &recorded, rays, source);
                borrowed.give(entry, &recorded.points.into_inner());
                mean
            }
        };
        Ok(Pixel { mean, lookups: looked_up.lookups(), violation: looked_up.field().violation() })
    }
}

/// exp(−Σ σ_t(k step) · length of step k): biased.
fn march_from_entry<F: Extinction>(field: &F, step: f64) -> f64 {
    let length = field.length();
    let starts = (0..).map(|k| f64::from(k) * step).take_while(|&s| s < length);
    (-starts.map(|s| field.sigma_t(s) * step.min(length - s)).sum::<f64>()).exp()
}

fn double_particle<C: OpticalThickness>(
    control: C,
    sigma_samp: f64,
) -> Result<Tracking<DoubleParticle, C, Constant>, FieldError> {
    let sampling = Constant::new(sigma_samp, control.length())?;
    Ok(Tracking::new(DoubleParticle { albedo: Albedo::default() }, control, sampling))
}

fn average<F: Extinction, E: TransmittanceEstimator<F>>(
    estimator: &E,
    field: &F,
    rays: u64,
    source: &mut Seeded,
) -> f64 {
    (0..rays).map(|_| estimator.estimate(field, source)).sum::<f64>() / rays as f64
}

/// Keeps what was looked up, for the pixels that follow.
struct Recorded<'a, F> {
    field: &'a F,
    points: RefCell<Vec<(f64, f64)>>,
}

impl<F: Extinction> Extinction for Recorded<'_, F> {
    fn sigma_t(&self, s: f64) -> f64 {
        let sigma_t = self.field.sigma_t(s);
        self.points.borrow_mut().push((s, sigma_t));
        sigma_t
    }
    fn length(&self) -> f64 {
        self.field.length()
    }
}
