//! `harness list`: what there is to choose from.

use crate::report::registry::REPORTS;
use crate::{DONE, Failure};
use std::io::Write;

const LIST: &str = "\
profiles       constant          sigma_t, length
               piecewise_constant edges, sigma_t
               piecewise_linear  positions, sigma_t
               expression        sigma_t (in s), length, [majorant]
               ray               medium, origin, direction, [length]
media          homogeneous       sigma_t, bounds
               analytic_cosine   [scale], [bounds]          szirmay-kalos-2017 eq. 21
               perlin            [octaves], [frequency], [lacunarity], [gain], [seed], [scale], [offset], bounds
               expression        sigma_t (in x, y, z), [majorant], bounds
               vdb               file, [grid], [scale], [allow_negative], [bounds]
bounds         sphere            center, radius
               box               min, max
estimators     woodcock          majorant                   raab-2008 algorithm 1
               double_particle   sigma_samp, [control]      szirmay-kalos-2017 4.2: ratio and residual ratio tracking
               single_particle   version, albedo, sigma_samp, [control]
               line_integral     majorant, splits           raab-2008 algorithm 2
               ray_marching      steps, jitter              a biased baseline
               next_flight       majorant, version          delta, ratio, unidirectional, bidirectional; georgiev-2019
               p_series          version, [pivot]           cmf, cumulative, ratio, next_flight; georgiev-2019
               generalised_poisson pivot, rate              fearnhead-2008
               unbiased_ray_marching [teeth] or [pivot], [endpoint_matching], [comb], [order], [roulette], [segments]
                                                            kettunen-2021; combs uniform, periodised, bernoulli (order 2, 3)
               telescoping       teeth, level_ratio, [endpoint_matching]
                                                            misso-2022
               jittered_ratio    majorant or cells, epsilon values in [0, 1]; ours
               residual_cells    cells, [rate]              residual ratio tracking between bounds
               adaptive_ratio    majorant, floor            misso-2023
               regular                                      the closed form, where there is one
               hybrid            [majorant]                 chooses by pilots; ours
               jackknife         teeth                      peters-2025, biased
               naive             teeth                      the exponential of one comb, biased
               progressive_majorant start                   misso-2023, biased and consistent
cells          a number of equal ones along the ray, or edges, minorants, majorants
versions       terminating, non_terminating, adaptive
sigma_samp     a number, or an object of edges and values; of walks in a scene a number, or cells, factor and floor
controls       none
               constant          sigma_main
               piecewise_linear  positions, sigma_main
               explorers         count
integrators    transmittance     estimator
               particle_tracer   version, sigma_samp, [particles], [colour], [max_collisions],
                                 [allow_supercritical]      szirmay-kalos-2017 4.1
               line_splitting    majorant, splits, [starts], and those of particle_tracer
                                                            raab-2008 3.1
               single_scattering sampling, estimator, samples_per_ray, [heuristic], [shadow], [shared_explorers], [starts]
                                                            szirmay-kalos-2017 4.3
               path_tracer       [heuristic], [max_vertices], [estimator], [version], [sigma_samp], [max_collisions],
                                 [allow_supercritical]      raab-2008 4.1, among surfaces
               vpl               light_paths, clamp (b, null or \"scene\"), [eye_samples], [compensation], [component],
                                 [keep_near], [local_mean_cells], and those of path_tracer but max_vertices
                                                            raab-2008 4.2, engelhardt-2013, among surfaces
compensation   strategy          one_to_many, many_to_one, one_to_one
               [placement]       free_flight, locally_homogeneous
               [transmittance]   exact, approximate
               [steps]           a number, or null for unlimited
               [visibility]      full, local, ignored
component      all, connections, correction, lost
heuristic      balance, power; path_tracer and vpl also maximum
sampling       attenuation, attenuation_resampled, source, scattering, source_and_scattering, attenuation_and_source,
               attenuation_and_scattering
phases         isotropic, rayleigh, hazy_mie
               henyey_greenstein g
               schlick           k
               tabulated         cosines, values
lights         environment       radiance
               environment_map   file
               point             position, power
               directional       direction, irradiance
surfaces       rectangle         corner, edge_u, edge_v, material, [emission]
               sphere            center, radius, material, [emission]
material       diffuse           reflectance
               mirror
               dielectric        ior
";

pub(crate) fn run(stdout: &mut dyn Write) -> Result<i32, Failure> {
    let mut list = String::new();
    for (k, kind) in REPORTS.iter().enumerate() {
        let word = if k == 0 { "reports" } else { "" };
        list.push_str(&format!("{word:<15}{:<18}{}\n", kind.name, kind.about));
    }
    list.push_str(LIST);
    stdout
        .write_all(list.as_bytes())
        .map_err(|error| Failure::NotWritten(format!("cannot write the list: {error}")))?;
    Ok(DONE)
}
