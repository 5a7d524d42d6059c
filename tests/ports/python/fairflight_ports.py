"""Estimators of transmittance, free flights and phase functions: a port to Python with numpy scalars, in any precision.

Written by docs/PORTING.md. `real` is numpy.float64 or numpy.float32. A field is called with a distance and returns the extinction there; a source has
uniform(), in [0, 1), and exponential(), -log(1 - uniform()).
"""

import numpy as np


def ratio_tracking(field, length, sigma_samp, control, source, real=np.float64):
    """Ratio tracking, residual ratio tracking with a constant control (szirmay-kalos-2017 section 4.2, novak-2014)."""
    mean_free_path = real(1) / sigma_samp
    s, weight = real(0), real(1)
    while True:
        s += source.exponential() * mean_free_path
        if not s < length:
            return weight * np.exp(-(control * length))
        weight *= real(1) - (field(s) - control) / sigma_samp


def woodcock(field, length, majorant, source, real=np.float64):
    """Woodcock tracking (raab-2008 algorithm 1): 1 or 0."""
    mean_free_path = real(1) / majorant
    s = real(0)
    while True:
        s += source.exponential() * mean_free_path
        if not s < length:
            return real(1)
        sigma_t = field(s)
        if source.uniform() * majorant < sigma_t:
            return real(0)


def jittered_ratio(field, length, majorant, epsilon, source, real=np.float64):
    """Jittered ratio tracking: strata of the optical thickness epsilon <= 1 in the majorant."""
    thickness = majorant * length
    count = max(np.ceil(thickness / epsilon), real(1))
    width, e = length / count, min(thickness / count, epsilon)
    last = np.nextafter(length, real(0))
    product = real(1)
    for stratum in range(int(count)):
        u = source.uniform()
        order, at_least = 1, real(0.5) * e
        while u < at_least:
            order += 1
            at_least *= e / real(order + 1)
        bracket, r = real(1), real(0)
        for _ in range(order):
            bracket = real(1) - r * bracket
            s = (real(stratum) + source.uniform()) * width
            r = field(min(s, last)) / majorant
        product *= real(1) - e * (r * bracket)
    return product


def symmetric_means(values, real=np.float64):
    """m_0 ... m_N: all powers of an expectation from one set of samples."""
    means = [real(1)]
    for value in values:
        n = len(means)  # counts the new value
        means.append(real(0))
        share = real(1) / real(n)
        for k in range(n, 0, -1):
            means[k] += real(k) * share * (means[k - 1] * value - means[k])
    return means


def unbiased_ray_marching(field, length, teeth, match_ends, stop, source, real=np.float64):
    """Unbiased ray marching (kettunen-2021); `stop` is the probability of stopping at order 0."""
    step = length / real(teeth)
    jump = real(0)
    if match_ends:
        start = field(real(0))
        jump = step * (field(length) - start)
    going_on = real(1) - stop
    order = 0
    if source.uniform() < going_on:
        order = 2
        while source.uniform() * real(order + 1) < real(2):
            order += 1

    def comb():
        u = source.uniform()
        total = real(0)
        for tooth in range(teeth):
            total += field(min(u * step + real(tooth) * step, length))
        return step * total - jump * (u - real(0.5))

    first = comb()
    if order == 0:
        return np.exp(-first)
    deviations = [real(0)] + [first - comb() for _ in range(order)]
    total = real(0)
    for pivot, own in enumerate(deviations):
        means = symmetric_means([other - own for i, other in enumerate(deviations) if i != pivot], real)
        series, weight = real(1), real(1) / going_on
        for mean in means[1:]:
            series += weight * mean
            weight *= real(0.5)
        total += np.exp(own) * series
    return total / real(order + 1) * np.exp(-first)


def spectral_tracking(field, length, coefficients, sigma_samp, source, real=np.float64):
    """Spectral tracking with the history-aware average (kutz-2017): where it ended, and a weight for each wavelength."""
    mean_free_path = real(1) / sigma_samp
    weights = np.ones(len(coefficients), real)
    s = real(0)
    while True:
        s += source.exponential() * mean_free_path
        if not s < length:
            return None, weights
        ratios = coefficients * field(s) / sigma_samp
        collides = passes = real(0)
        for l in range(len(weights)):
            collides += abs(weights[l] * ratios[l])
            passes += abs(weights[l] * (real(1) - ratios[l]))
        probability = collides / (collides + passes)
        if source.uniform() < probability:
            return s, weights * (ratios / probability)
        weights = weights * ((real(1) - ratios) / (passes / (collides + passes)))


def equiangular(closest, distance, length, u, real=np.float64):
    """A distance for a point light `distance` beside the ray, closest at `closest` (kulla-2012), and its density per length."""
    start = np.arctan2(-closest, distance)
    angle = np.arctan2(length - closest, distance) - start
    s = min(max(closest + distance * np.tan(start + u * angle), real(0)), length)
    along = s - closest
    return s, distance / (angle * (distance * distance + along * along))


def henyey_greenstein_cosine(g, u, real=np.float64):
    """The cosine of the scattering angle (henyey-1941) without a division by g."""
    back, front, rest = real(1) - g, real(1) + g, real(1) - u
    d = back * rest + front * u
    below = real(2) * rest * (back / d) * (back / d) * (rest + front * u)
    if below < real(1):
        return real(1) - below
    return real(2) * u * (front / d) * (front / d) * (back * rest + u) - real(1)


def henyey_greenstein(g, cosine, real=np.float64):
    """The phase function of henyey-1941 per steradian."""
    back, front = real(1) - g, real(1) + g
    square = real(0.5) * (back * back * (real(1) + cosine) + front * front * (real(1) - cosine))
    return back * front / (real(4) * real(np.pi) * square * np.sqrt(square))
