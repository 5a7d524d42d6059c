// Estimators of transmittance, free flights and phase functions: a port to CUDA in single precision.
//
// Written by docs/PORTING.md. A `Field` is called with a distance and returns the extinction there; a `Source` has `uniform()`, in [0, 1), a multiple of 2^-24, and
// `exponential()`, -logf(1 - uniform()). Without CUDA, with __device__ defined as nothing, the same text is C++.
#pragma once

namespace fairflight {

// Ratio tracking, residual ratio tracking with a constant control: szirmay-kalos-2017 section 4.2, novak-2014.
template <class Field, class Source>
__device__ float ratio_tracking(Field& field, float length, float sigma_samp, float control, Source& source) {
    const float mean_free_path = 1.0f / sigma_samp;
    float s = source.exponential() * mean_free_path, weight = 1.0f;
    for (; s < length; s += source.exponential() * mean_free_path) weight *= 1.0f - (field(s) - control) / sigma_samp;
    return weight * expf(-(control * length));
}

// Woodcock tracking: raab-2008 algorithm 1. 1 or 0.
template <class Field, class Source>
__device__ float woodcock(Field& field, float length, float majorant, Source& source) {
    const float mean_free_path = 1.0f / majorant;
    for (float s = source.exponential() * mean_free_path; s < length; s += source.exponential() * mean_free_path) {
        const float sigma_t = field(s);
        if (source.uniform() * majorant < sigma_t) return 0.0f;
    }
    return 1.0f;
}

// The number below a positive one.
__device__ inline float next_down(float x) {
    union { float number; unsigned bits; } same = {x};
    --same.bits;
    return same.number;
}

// Jittered ratio tracking: strata of the optical thickness epsilon <= 1 in the majorant. In [0, 1].
template <class Field, class Source>
__device__ float jittered_ratio(Field& field, float length, float majorant, float epsilon, Source& source) {
    const float thickness = majorant * length, count = fmaxf(ceilf(thickness / epsilon), 1.0f);
    const float width = length / count, e = fminf(thickness / count, epsilon), last = next_down(length);
    float product = 1.0f;
    for (float stratum = 0.0f; stratum < count; stratum += 1.0f) {
        const float u = source.uniform();
        unsigned order = 1;
        for (float at_least = 0.5f * e; u < at_least; at_least *= e / float(order + 1)) ++order;
        float bracket = 1.0f, r = 0.0f;
        for (; order > 0; --order) {
            bracket = 1.0f - r * bracket;
            r = field(fminf((stratum + source.uniform()) * width, last)) / majorant;
        }
        product *= 1.0f - e * (r * bracket);
    }
    return product;
}

// One comb of unbiased ray marching: an estimate of the optical thickness.
template <class Field, class Source>
__device__ float comb(Field& field, float length, unsigned teeth, float jump, Source& source) {
    const float step = length / float(teeth), u = source.uniform();
    float sum = 0.0f;
    for (unsigned tooth = 0; tooth < teeth; ++tooth) sum += field(fminf(u * step + float(tooth) * step, length));
    return step * sum - jump * (u - 0.5f);
}

// Orders of unbiased ray marching that fit a thread's registers. A greater one comes once in 5.4 10^9 estimates that go on: its last terms are cut.
constexpr unsigned MOST_ORDER = 16;

// Unbiased ray marching: kettunen-2021. `stop` is the probability of stopping at order 0.
template <class Field, class Source>
__device__ float unbiased_ray_marching(Field& field, float length, unsigned teeth, bool match_ends, float stop, Source& source) {
    float jump = 0.0f;
    if (match_ends) {
        const float start = field(0.0f);
        jump = length / float(teeth) * (field(length) - start);
    }
    const float going_on = 1.0f - stop;
    unsigned order = 0;
    if (source.uniform() < going_on)
        for (order = 2; order < MOST_ORDER && source.uniform() * float(order + 1) < 2.0f;) ++order;
    const float first = comb(field, length, teeth, jump, source);
    float deviations[MOST_ORDER + 1] = {0.0f};
    for (unsigned i = 1; i <= order; ++i) deviations[i] = first - comb(field, length, teeth, jump, source);
    float sum = 0.0f;
    for (unsigned pivot = 0; pivot <= order; ++pivot) {
        // Elementary symmetric means: n counts the values so far, the new one included.
        float means[MOST_ORDER + 1] = {1.0f};
        unsigned n = 0;
        for (unsigned i = 0; i <= order; ++i) {
            if (i == pivot) continue;
            const float value = deviations[i] - deviations[pivot], share = 1.0f / float(++n);
            for (unsigned k = n; k >= 1; --k) means[k] += float(k) * share * (means[k - 1] * value - means[k]);
        }
        float series = 1.0f, weight = 1.0f / going_on;
        for (unsigned k = 1; k <= order; ++k, weight *= 0.5f) series += weight * means[k];
        sum += expf(deviations[pivot]) * series;
    }
    return sum / float(order + 1) * expf(-first);
}

// A free flight for three wavelengths.
struct SpectralFlight {
    bool collided;
    float distance, weights[3];
};

// Spectral tracking with the history-aware average: kutz-2017. Weights stay in [0, 3] if no wavelength passes sigma_samp.
template <class Field, class Source>
__device__ SpectralFlight spectral_tracking(Field& field, float length, const float (&coefficients)[3], float sigma_samp, Source& source) {
    const float mean_free_path = 1.0f / sigma_samp;
    SpectralFlight flight = {false, source.exponential() * mean_free_path, {1.0f, 1.0f, 1.0f}};
    while (flight.distance < length) {
        const float gray = field(flight.distance);
        float ratios[3], collides = 0.0f, passes = 0.0f;
        for (int l = 0; l < 3; ++l) {
            ratios[l] = coefficients[l] * gray / sigma_samp;
            collides += fabsf(flight.weights[l] * ratios[l]);
            passes += fabsf(flight.weights[l] * (1.0f - ratios[l]));
        }
        const float probability = collides / (collides + passes);
        flight.collided = source.uniform() < probability;
        for (int l = 0; l < 3; ++l)
            flight.weights[l] *= flight.collided ? ratios[l] / probability : (1.0f - ratios[l]) / (passes / (collides + passes));
        if (flight.collided) return flight;
        flight.distance += source.exponential() * mean_free_path;
    }
    flight.distance = length;
    return flight;
}

// Equiangular distances for a point light: kulla-2012. The distance along the ray, and its density per length.
__device__ inline float equiangular(float closest, float distance, float length, float u, float& pdf) {
    const float from = atan2f(-closest, distance), angle = atan2f(length - closest, distance) - from;
    const float s = fminf(fmaxf(closest + distance * tanf(from + u * angle), 0.0f), length);
    pdf = distance / (angle * (distance * distance + (s - closest) * (s - closest)));
    return s;
}

// The cosine of the scattering angle by henyey-1941, without a division by g.
__device__ inline float henyey_greenstein_cosine(float g, float u) {
    const float back = 1.0f - g, front = 1.0f + g, rest = 1.0f - u, d = back * rest + front * u;
    const float below = 2.0f * rest * (back / d) * (back / d) * (rest + front * u);
    return below < 1.0f ? 1.0f - below : 2.0f * u * (front / d) * (front / d) * (back * rest + u) - 1.0f;
}

// The phase function of henyey-1941 per steradian.
__device__ inline float henyey_greenstein(float g, float cosine) {
    const float back = 1.0f - g, front = 1.0f + g;
    const float square = 0.5f * (back * back * (1.0f + cosine) + front * front * (1.0f - cosine));
    return back * front / (4.0f * 3.14159265f * square * sqrtf(square));
}

}  // namespace fairflight
