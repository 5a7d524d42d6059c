"""Look-ups per second of profiles of all kinds, by ratio tracking; what a call costs.

python lookups.py
"""

import math
import time

import fairflight
import numpy as np

RATIO = {"kind": "double_particle", "sigma_samp": 1.0}
# 16 batches: a lane for each.
SAMPLES = 16 * 4096
PROFILES = {
    "nodes": fairflight.Profile.linear([0, 4], [0.25, 0.75]),
    "formula, sin": {"kind": "expression", "sigma_t": "0.5 + 0.25*sin(3*s)", "length": 4},
    "callable, two operations": fairflight.Profile(lambda s: 0.25 + 0.125 * s, 4.0),
    "callable, math.sin": fairflight.Profile(lambda s: 0.5 + 0.25 * math.sin(3 * s), 4.0),
    "callable, numpy.sin": fairflight.Profile(lambda s: 0.5 + 0.25 * np.sin(3 * s), 4.0),
    "vectorised, two operations": fairflight.Profile(lambda s: 0.25 + 0.125 * s, 4.0, vectorised=True),
    "vectorised, numpy.sin": fairflight.Profile(lambda s: 0.5 + 0.25 * np.sin(3 * s), 4.0, vectorised=True),
}


def seconds(call, rounds=7):
    """The least of a few rounds."""
    found = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        found.append(time.perf_counter() - start)
    return min(found)


for name, profile in PROFILES.items():
    lookups = fairflight.draw(profile, RATIO, samples=SAMPLES, seed=1).lookups
    took = seconds(lambda: fairflight.draw(profile, RATIO, samples=SAMPLES, seed=1))
    print(f"{name:28} {SAMPLES * lookups / took / 1e6:6.2f} million look-ups/s")
thin = fairflight.Profile.linear([0, 1], [1, 1])
print(f"a call of one estimate       {1e6 * seconds(lambda: fairflight.draw(thin, RATIO, samples=1, seed=1), 2000):6.2f} us")
