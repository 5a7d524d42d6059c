// Estimators of transmittance, free flights and phase functions: a port to WGSL in single precision.
//
// Written by docs/PORTING.md. Who uses it declares
//     fn field(s: f32) -> f32             the extinction at a distance
//     fn uniform_variate() -> f32         in [0, 1), a multiple of 2^-24
//     fn exponential_variate() -> f32     -log(1 - uniform_variate())
// WGSL grants sin, cos and tan an absolute error of 2^-11 and atan2 one of 4096 units: what needs them has polynomials here (moshier-1989).

// Ratio tracking, residual ratio tracking with a constant control: szirmay-kalos-2017 section 4.2, novak-2014.
fn ratio_tracking(length: f32, sigma_samp: f32, control: f32) -> f32 {
    let mean_free_path = 1.0 / sigma_samp;
    var weight = 1.0;
    var s = exponential_variate() * mean_free_path;
    while s < length {
        weight *= 1.0 - (field(s) - control) / sigma_samp;
        s += exponential_variate() * mean_free_path;
    }
    return weight * exp(-(control * length));
}

// Woodcock tracking: raab-2008 algorithm 1. 1 or 0.
fn woodcock(length: f32, majorant: f32) -> f32 {
    let mean_free_path = 1.0 / majorant;
    var s = exponential_variate() * mean_free_path;
    while s < length {
        let sigma_t = field(s);
        if uniform_variate() * majorant < sigma_t {
            return 0.0;
        }
        s += exponential_variate() * mean_free_path;
    }
    return 1.0;
}

// The number below a positive one, for which WGSL has no function.
fn next_down(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) - 1u);
}

// Jittered ratio tracking: strata of the optical thickness epsilon <= 1 in the majorant. In [0, 1].
fn jittered_ratio(length: f32, majorant: f32, epsilon: f32) -> f32 {
    let thickness = majorant * length;
    let count = max(ceil(thickness / epsilon), 1.0);
    let width = length / count;
    let e = min(thickness / count, epsilon);
    var product = 1.0;
    for (var stratum = 0.0; stratum < count; stratum += 1.0) {
        let u = uniform_variate();
        var order = 1.0;
        var at_least = 0.5 * e;
        while u < at_least {
            order += 1.0;
            at_least *= e / (order + 1.0);
        }
        var bracket = 1.0;
        var r = 0.0;
        for (; order > 0.0; order -= 1.0) {
            bracket = 1.0 - r * bracket;
            let s = (stratum + uniform_variate()) * width;
            r = field(min(s, next_down(length))) / majorant;
        }
        product *= 1.0 - e * (r * bracket);
    }
    return product;
}

// Orders of unbiased ray marching that fit an array. A greater one, P 2^16/17!, comes once in 5.4 10^10 estimates at P = 0.1, in 5.4 10^9 at P = 1: its last terms are
// cut, a bias below what any run of them shows.
const MOST_ORDER = 16u;

// One comb: an estimate of the optical thickness.
fn comb(length: f32, teeth: u32, step: f32, jump: f32) -> f32 {
    let u = uniform_variate();
    var sum = 0.0;
    for (var tooth = 0u; tooth < teeth; tooth++) {
        sum += field(min(u * step + f32(tooth) * step, length));
    }
    return step * sum - jump * (u - 0.5);
}

// Unbiased ray marching: kettunen-2021. `stop` is the probability of stopping at order 0.
fn unbiased_ray_marching(length: f32, teeth: u32, match_ends: bool, stop: f32) -> f32 {
    let step = length / f32(teeth);
    var jump = 0.0;
    if match_ends {
        let start = field(0.0);
        jump = step * (field(length) - start);
    }
    let going_on = 1.0 - stop;
    var order = 0u;
    if uniform_variate() < going_on {
        order = 2u;
        while order < MOST_ORDER && uniform_variate() * f32(order + 1u) < 2.0 {
            order++;
        }
    }
    let first = comb(length, teeth, step, jump);
    if order == 0u {
        return exp(-first);
    }
    var deviations: array<f32, 17>;
    for (var i = 1u; i <= order; i++) {
        deviations[i] = first - comb(length, teeth, step, jump);
    }
    var sum = 0.0;
    for (var pivot = 0u; pivot <= order; pivot++) {
        // Elementary symmetric means: n counts the values so far, the new one included.
        var means: array<f32, 17>;
        means[0] = 1.0;
        var n = 0u;
        for (var i = 0u; i <= order; i++) {
            if i != pivot {
                n++;
                let value = deviations[i] - deviations[pivot];
                let share = 1.0 / f32(n);
                for (var k = n; k >= 1u; k--) {
                    means[k] += f32(k) * share * (means[k - 1u] * value - means[k]);
                }
            }
        }
        var series = 1.0;
        var weight = 1.0 / going_on;
        for (var k = 1u; k <= order; k++) {
            series += weight * means[k];
            weight *= 0.5;
        }
        sum += exp(deviations[pivot]) * series;
    }
    return sum / f32(order + 1u) * exp(-first);
}

// A free flight for three wavelengths.
struct SpectralFlight {
    collided: bool,
    distance: f32,
    weights: vec3<f32>,
}

fn sum_of(x: vec3<f32>) -> f32 {
    return x.x + x.y + x.z;
}

// Spectral tracking with the history-aware average: kutz-2017. Weights stay in [0, 3] if no wavelength passes sigma_samp.
fn spectral_tracking(length: f32, coefficients: vec3<f32>, sigma_samp: f32) -> SpectralFlight {
    let mean_free_path = 1.0 / sigma_samp;
    var weights = vec3<f32>(1.0);
    var s = exponential_variate() * mean_free_path;
    while s < length {
        let ratios = coefficients * field(s) / sigma_samp;
        let collides = sum_of(abs(weights * ratios));
        let passes = sum_of(abs(weights * (vec3<f32>(1.0) - ratios)));
        let probability = collides / (collides + passes);
        if uniform_variate() < probability {
            return SpectralFlight(true, s, weights * (ratios / probability));
        }
        weights *= (vec3<f32>(1.0) - ratios) / (passes / (collides + passes));
        s += exponential_variate() * mean_free_path;
    }
    return SpectralFlight(false, length, weights);
}

// tan x for |x| < pi/2: sine and cosine of the smaller of x and its complement.
fn tangent(x: f32) -> f32 {
    // pi/2 in two parts.
    let complement = (1.57079637 - abs(x)) - 4.37113883e-8;
    let is_steep = abs(x) > 0.785398163;
    let y = select(abs(x), complement, is_steep);
    let z = y * y;
    let sine = y + y * z * (-1.6666654611e-1 + z * (8.3321608736e-3 + z * -1.9515295891e-4));
    let cosine = 1.0 - 0.5 * z + z * z * (4.166664568298827e-2 + z * (-1.388731625493765e-3 + z * 2.443315711809948e-5));
    return sign(x) * select(sine / cosine, cosine / sine, is_steep);
}

// atan(y/x) for x > 0.
fn angle(y: f32, x: f32) -> f32 {
    let a = abs(y) / x;
    var base = 0.0;
    var t = a;
    if a > 2.414213562373095 {
        base = 1.57079633;
        t = -1.0 / a;
    } else if a > 0.4142135623730950 {
        base = 0.785398163;
        t = (a - 1.0) / (a + 1.0);
    }
    let z = t * t;
    let p = t + t * z * (-3.33329491539e-1 + z * (1.99777106478e-1 + z * (-1.38776856032e-1 + z * 8.05374449538e-2)));
    return sign(y) * (base + p);
}

// Equiangular distances for a point light: kulla-2012. The distance along the ray and its density per length.
fn equiangular(closest: f32, distance: f32, length: f32, u: f32) -> vec2<f32> {
    let start = angle(-closest, distance);
    let width = angle(length - closest, distance) - start;
    let s = clamp(closest + distance * tangent(start + u * width), 0.0, length);
    let along = s - closest;
    return vec2<f32>(s, distance / (width * (distance * distance + along * along)));
}

// The cosine of the scattering angle by henyey-1941, without a division by g.
fn henyey_greenstein_cosine(g: f32, u: f32) -> f32 {
    let back = 1.0 - g;
    let front = 1.0 + g;
    let rest = 1.0 - u;
    let d = back * rest + front * u;
    let below = 2.0 * rest * (back / d) * (back / d) * (rest + front * u);
    if below < 1.0 {
        return 1.0 - below;
    }
    return 2.0 * u * (front / d) * (front / d) * (back * rest + u) - 1.0;
}

// The phase function of henyey-1941 per steradian.
fn henyey_greenstein(g: f32, cosine: f32) -> f32 {
    let back = 1.0 - g;
    let front = 1.0 + g;
    let square = 0.5 * (back * back * (1.0 + cosine) + front * front * (1.0 - cosine));
    return back * front / (4.0 * 3.14159265 * square * sqrt(square));
}
