// Estimators of transmittance, free flights and phase functions: a port to C++17, in one header and in any precision.
//
// Written by docs/PORTING.md. `Real` is float or double. A `Field` is called with a distance and returns the extinction there; a `Source` has
// `uniform()`, in [0, 1), and `exponential()`, -log(1 - uniform()). Nothing allocates but unbiased ray marching beyond sixteen combs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace fairflight {

// Ratio tracking, residual ratio tracking with a constant control: szirmay-kalos-2017 section 4.2, novak-2014.
// Unbiased for any sigma_samp > 0, also below the extinction. Weights may be negative and above 1: do not clamp them.
template <class Real, class Field, class Source>
Real ratio_tracking(Field&& field, Real length, Real sigma_samp, Real control, Source& source) {
    const Real mean_free_path = Real(1) / sigma_samp;
    Real s = 0, weight = 1;
    for (;;) {
        s += source.exponential() * mean_free_path;
        if (!(s < length)) break;
        weight *= Real(1) - (field(s) - control) / sigma_samp;
    }
    return weight * std::exp(-(control * length));
}

// Woodcock tracking: raab-2008 algorithm 1. 1 or 0.
template <class Real, class Field, class Source>
Real woodcock(Field&& field, Real length, Real majorant, Source& source) {
    const Real mean_free_path = Real(1) / majorant;
    Real s = 0;
    for (;;) {
        s += source.exponential() * mean_free_path;
        if (!(s < length)) return 1;
        const Real sigma_t = field(s);
        if (source.uniform() * majorant < sigma_t) return 0;
    }
}

// Jittered ratio tracking: strata of the optical thickness epsilon <= 1 in the majorant. In [0, 1].
template <class Real, class Field, class Source>
Real jittered_ratio(Field&& field, Real length, Real majorant, Real epsilon, Source& source) {
    const Real thickness = majorant * length;
    const Real count = std::max(std::ceil(thickness / epsilon), Real(1));
    const Real width = length / count, e = std::min(thickness / count, epsilon);
    const Real last = std::nextafter(length, Real(0));
    Real product = 1;
    for (Real stratum = 0; stratum < count; stratum += 1) {
        const Real u = source.uniform();
        Real order = 1, at_least = Real(0.5) * e;
        while (u < at_least) {
            order += 1;
            at_least *= e / (order + 1);
        }
        Real bracket = 1, r = 0;
        for (; order > 0; order -= 1) {
            bracket = Real(1) - r * bracket;
            const Real s = (stratum + source.uniform()) * width;
            r = field(std::min(s, last)) / majorant;
        }
        product *= Real(1) - e * (r * bracket);
    }
    return product;
}

// Elementary symmetric means m_0 ... m_N of N values, all powers of an expectation from one set of samples.
template <class Real>
class SymmetricMeans {
public:
    SymmetricMeans() : means{Real(1)} {}

    void push(Real value) {
        const std::size_t n = means.size();  // counts the new value
        means.push_back(0);
        const Real share = Real(1) / Real(n);
        for (std::size_t k = n; k >= 1; --k) means[k] += Real(k) * share * (means[k - 1] * value - means[k]);
    }

    Real operator[](std::size_t k) const { return means[k]; }

private:
    std::vector<Real> means;
};

// Unbiased ray marching: kettunen-2021. `stop` is the probability of stopping at order 0.
template <class Real, class Field, class Source>
Real unbiased_ray_marching(Field&& field, Real length, unsigned teeth, bool match_ends, Real stop, Source& source) {
    const Real step = length / Real(teeth);
    Real jump = 0;
    if (match_ends) {
        const Real start = field(Real(0));
        jump = step * (field(length) - start);
    }
    const Real going_on = Real(1) - stop;
    std::size_t order = 0;
    if (source.uniform() < going_on) {
        order = 2;
        while (source.uniform() * Real(order + 1) < Real(2)) ++order;
    }
    const auto comb = [&] {
        const Real u = source.uniform();
        Real sum = 0;
        for (unsigned tooth = 0; tooth < teeth; ++tooth) sum += field(std::min(u * step + Real(tooth) * step, length));
        return step * sum - jump * (u - Real(0.5));
    };
    const Real first = comb();
    if (order == 0) return std::exp(-first);
    std::vector<Real> deviations{Real(0)};
    for (std::size_t i = 0; i < order; ++i) deviations.push_back(first - comb());
    Real sum = 0;
    for (std::size_t pivot = 0; pivot <= order; ++pivot) {
        SymmetricMeans<Real> means;
        for (std::size_t i = 0; i <= order; ++i)
            if (i != pivot) means.push(deviations[i] - deviations[pivot]);
        Real series = 1, weight = Real(1) / going_on;
        for (std::size_t k = 1; k <= order; ++k, weight *= Real(0.5)) series += weight * means[k];
        sum += std::exp(deviations[pivot]) * series;
    }
    return sum / Real(order + 1) * std::exp(-first);
}

// A free flight for three wavelengths.
template <class Real>
struct SpectralFlight {
    bool collided;
    Real distance;
    std::array<Real, 3> weights;
};

// Spectral tracking with the history-aware average: kutz-2017. Weights stay in [0, 3] if no wavelength passes sigma_samp.
template <class Real, class Field, class Source>
SpectralFlight<Real> spectral_tracking(Field&& field, Real length, std::array<Real, 3> coefficients, Real sigma_samp,
                                       Source& source) {
    const Real mean_free_path = Real(1) / sigma_samp;
    std::array<Real, 3> weights{1, 1, 1};
    Real s = 0;
    for (;;) {
        s += source.exponential() * mean_free_path;
        if (!(s < length)) return {false, length, weights};
        const Real gray = field(s);
        std::array<Real, 3> ratios{};
        Real collides = 0, passes = 0;
        for (int l = 0; l < 3; ++l) {
            ratios[l] = coefficients[l] * gray / sigma_samp;
            collides += std::abs(weights[l] * ratios[l]);
            passes += std::abs(weights[l] * (Real(1) - ratios[l]));
        }
        const Real probability = collides / (collides + passes);
        if (source.uniform() < probability) {
            for (int l = 0; l < 3; ++l) weights[l] *= ratios[l] / probability;
            return {true, s, weights};
        }
        for (int l = 0; l < 3; ++l) weights[l] *= (Real(1) - ratios[l]) / (passes / (collides + passes));
    }
}

// Equiangular distances for a point light: kulla-2012. `closest` is where the ray comes closest, `distance` that of the light from the ray.
// Returns the distance along the ray and its density per length.
template <class Real>
std::pair<Real, Real> equiangular(Real closest, Real distance, Real length, Real u) {
    const Real from = std::atan2(-closest, distance), angle = std::atan2(length - closest, distance) - from;
    const Real s = std::min(std::max(closest + distance * std::tan(from + u * angle), Real(0)), length);
    const Real along = s - closest;
    return {s, distance / (angle * (distance * distance + along * along))};
}

// The cosine of the scattering angle by henyey-1941, without a division by g: right at g = 0 and near 1 and -1.
template <class Real>
Real henyey_greenstein_cosine(Real g, Real u) {
    const Real back = Real(1) - g, front = Real(1) + g, rest = Real(1) - u;
    const Real d = back * rest + front * u;
    const Real below = Real(2) * rest * (back / d) * (back / d) * (rest + front * u);
    if (below < Real(1)) return Real(1) - below;
    return Real(2) * u * (front / d) * (front / d) * (back * rest + u) - Real(1);
}

// The phase function of henyey-1941 per steradian.
template <class Real>
Real henyey_greenstein(Real g, Real cosine) {
    const Real back = Real(1) - g, front = Real(1) + g;
    const Real square = Real(0.5) * (back * back * (Real(1) + cosine) + front * front * (Real(1) - cosine));
    return back * front / (Real(4) * Real(3.14159265358979323846) * square * std::sqrt(square));
}

}  // namespace fairflight
