//! Light that is scattered once, by quadrature.

use fairflight_media::{
    Bounds, Line, LineThickness, OpticalThickness, PhaseFunction, Ray, Tolerance, adaptive_integral,
};
use fairflight_scene::{Lights, Source, Volume};
use fairflight_stats::Reference;
use glam::DVec3;
use std::f64::consts::PI;

/// szirmay-kalos-2017 eq. 22, and the background behind the medium, along the mean of `lines`:
///
/// > L = T(S) L_background + Σ_lights ∫ T(s) σ_t(s) a ρ E(s) T(s → light) ds
///
/// with both transmittances in closed form, split where a line comes closest to a point light. How a point sees a light is
/// written out here again: nothing of the integrators is used.
#[must_use]
pub fn reference<M: LineThickness, P: PhaseFunction>(
    volume: &Volume<M, P, f64>,
    lights: &Lights<f64>,
    lines: &[Line],
) -> Reference {
    let mut sum = Reference::exact(0.0);
    for line in lines {
        let one = along(volume, lights, line);
        sum.mean += one.mean / lines.len() as f64;
        sum.error += one.error / lines.len() as f64;
    }
    sum
}

fn along<M: LineThickness, P: PhaseFunction>(
    volume: &Volume<M, P, f64>,
    lights: &Lights<f64>,
    line: &Line,
) -> Reference {
    let background = lights.background.radiance(line.direction);
    let Some(ray) = profile(&volume.medium, &volume.bounds, *line, None) else {
        return Reference::exact(background);
    };
    let passes = |ray: &Ray<&M>, length: f64| (-ray.optical_thickness(0.0, length)).exp();
    let length = fairflight_media::Extinction::length(&ray);
    let mut reference = Reference::exact(background * passes(&ray, length));
    for light in &lights.sources {
        let closest = match *light {
            Source::Point { position, .. } => (position - ray.world_point(0.0)).dot(line.direction),
            Source::Directional { .. } => 0.0,
        };
        let breaks: Vec<f64> = Some(closest).filter(|&s| s > 0.0 && s < length).into_iter().collect();
        let integral = adaptive_integral(length, &breaks, Tolerance::to(1e-10), |s| {
            let point = ray.world_point(s);
            let (towards, distance, irradiance) = seen(light, point);
            let shadow =
                profile(&volume.medium, &volume.bounds, Line { origin: point, direction: towards }, distance);
            let arriving = irradiance
                * shadow.map_or(1.0, |shadow| passes(&shadow, fairflight_media::Extinction::length(&shadow)));
            let scattered =
                volume.medium.sigma_t(point) * volume.albedo * volume.phase.eval(line.direction.dot(towards));
            [passes(&ray, s) * scattered * arriving]
        });
        reference.mean += integral.value[0];
        reference.error += integral.error[0];
    }
    reference
}

/// The direction to a light, its distance, and the irradiance without the medium.
fn seen(light: &Source<f64>, point: DVec3) -> (DVec3, Option<f64>, f64) {
    match *light {
        Source::Point { position, power } => {
            let distance = position.distance(point);
            ((position - point) / distance, Some(distance), power / (4.0 * PI * distance * distance))
        }
        Source::Directional { direction, irradiance } => (-direction, None, irradiance),
    }
}

fn profile<'m, M: LineThickness>(
    medium: &'m M,
    bounds: &Bounds,
    line: Line,
    length: Option<f64>,
) -> Option<Ray<&'m M>> {
    let clip = bounds.clip(line.origin, line.direction, length).ok().flatten()?;
    Some(Ray::new(medium, &clip))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fairflight_media::{Homogeneous, phase::Isotropic};
    use fairflight_scene::Background;
    use glam::dvec3;

    #[test]
    fn parallel_light_along_the_ray_has_a_closed_form() {
        // Seen against the light through a slab of τ = 2: in and out along one line, ∫ e^{-s} e^{-(S − s)} = S e^{-S}.
        let volume = Volume {
            medium: Homogeneous::new(1.0).unwrap(),
            bounds: Bounds::aligned_box(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap(),
            albedo: 0.5,
            phase: Isotropic,
        };
        let lights = Lights {
            background: Background { constant: 0.25, maps: vec![] },
            sources: vec![Source::directional(-DVec3::Z, 3.0).unwrap()],
        };
        let line = Line { origin: dvec3(0.1, 0.2, -5.0), direction: DVec3::Z };
        let found = reference(&volume, &lights, &[line]);
        let exact = (-2.0_f64).exp() * (0.25 + 0.5 * 3.0 / (4.0 * PI) * 2.0);
        assert!((found.mean - exact).abs() < 1e-12, "{found:?} {exact}");
    }
}
