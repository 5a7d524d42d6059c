//! Speed against error of all methods.

use super::POINT;
use super::methods::{self, Method};
use crate::run::Run;
use crate::speed_against_error::{Speed, compare};
use fairflight_harness::Failure;

/// Camera rays per pixel of the points of a curve.
const RAYS: [u32; 3] = [2, 8, 32];

fn compared() -> Vec<Method> {
    let mut compared: Vec<Method> =
        methods::all(1.0).into_iter().filter(|method| !method.is_baseline).collect();
    compared.push(methods::closed_form("closed form, 4 + 4 samples", 4));
    compared.push(methods::closed_form("closed form, 32 + 32 samples", 32));
    compared
}

pub(super) fn steps() -> u64 {
    (compared().len() * RAYS.len()) as u64
}

pub(super) fn study(run: &Run<'_>) -> Result<Speed, Failure> {
    let subject = POINT.subject(run.resolution());
    let text = "The scene with the strong point light. The error is the sample variance of a pixel over its number of rays, averaged over \
                all pixels. Transmittance in closed form costs no look-up and has no variance; what remains is where along the ray \
                scattering is evaluated, and stratified samples of a smooth integrand settle that faster than 1/√n.";
    let integrators = compared().into_iter().map(|method| (method.name, method.integrator)).collect();
    compare(run, &subject, integrators, &RAYS, text)
}
