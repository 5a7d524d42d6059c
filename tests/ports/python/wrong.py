"""Ports with a mistake, which the test vectors must refuse: the kit's own mutation score.

    python3 wrong.py list                      kinds, precisions and names of mistakes, separated by tabs
    python3 wrong.py PRECISION MISTAKE         answers cases as answers.py does, with that mistake
"""

import sys
from pathlib import Path

import numpy as np

import fairflight_ports as ports


def changed(function, old, new):
    """The port of this name with one piece of its text replaced."""
    text = (Path(__file__).parent / "fairflight_ports.py").read_text()
    start = text.index(f"def {function}(")
    end = text.find("\ndef ", start)
    body = text[start : end if end > 0 else len(text)]
    assert body.count(old) == 1, f"{function}: {body.count(old)} times {old!r}"
    scope = vars(ports)
    exec(body.replace(old, new), scope)


# Kind, precision that shows it, name as the vectors know it, and the change: function, old text, new text.
WRONG = [
    ("unbiased_ray_marching", "binary64", "symmetric means divided by the final N", "symmetric_means", "real(1) / real(n)", "real(1) / real(len(values))"),
    ("unbiased_ray_marching", "binary64", "symmetric means with n counted from 0", "symmetric_means", "real(1) / real(n)", "real(1) / real(max(n - 1, 1))"),
    ("unbiased_ray_marching", "binary64", "the roulette scaled: terms not divided by P", "unbiased_ray_marching", "real(1) / going_on", "real(1)"),
    ("unbiased_ray_marching", "binary64", "P and 1 - P exchanged", "unbiased_ray_marching", "real(1) - stop", "stop"),
    ("unbiased_ray_marching", "binary32", "the comb in world units: u not times h", "unbiased_ray_marching", "u * step + real(tooth)", "u + real(tooth)"),
    ("unbiased_ray_marching", "binary64", "endpoint matching of the other sign", "unbiased_ray_marching", "- jump", "+ jump"),
    ("unbiased_ray_marching", "binary64", "<= for < in the decision to go on", "unbiased_ray_marching", "source.uniform() < going_on", "source.uniform() <= going_on"),
    ("unbiased_ray_marching", "binary64", "<= for < in the decision of a further order", "unbiased_ray_marching", "real(order + 1) < real(2)", "real(order + 1) <= real(2)"),
    ("woodcock", "binary64", "<= for < in the decision to collide", "woodcock", "* majorant < sigma_t", "* majorant <= sigma_t"),
    ("woodcock", "binary32", "<= for < at the end of the profile", "woodcock", "not s < length", "not s <= length"),
    ("double_particle", "binary64", "weights clamped to [0, 1]", "ratio_tracking", "weight *= real(1) - (field(s) - control) / sigma_samp", "weight = min(max(weight * (real(1) - (field(s) - control) / sigma_samp), real(0)), real(1))"),
    ("double_particle", "binary32", "the control's transmittance left out", "ratio_tracking", "weight * np.exp(-(control * length))", "weight"),
    ("jittered_ratio", "binary64", "points in world units, not in strata", "jittered_ratio", "(real(stratum) + source.uniform()) * width", "real(stratum) * width + source.uniform()"),
    ("jittered_ratio", "binary64", "<= for < in the decision of the order", "jittered_ratio", "u < at_least", "u <= at_least"),
    ("spectral_tracking", "binary64", "weights not divided by the probability of the event", "spectral_tracking", "weights * (ratios / probability)", "weights * ratios"),
    ("equiangular", "binary64", "a density per angle, not per length", "equiangular", "distance / (angle * (distance * distance + along * along))", "real(1) / angle"),
    ("henyey_greenstein", "binary64", "not divided by 4 pi", "henyey_greenstein", "(real(4) * real(np.pi) * square * np.sqrt(square))", "(square * np.sqrt(square))"),
    (
        "henyey_greenstein",
        "binary64",
        "the usual inversion, which divides by g",
        "henyey_greenstein_cosine",
        "    back, front, rest =",
        "    if g != 0:\n        inner = (real(1) - g * g) / (real(1) - g + real(2) * g * u)\n        return (real(1) + g * g - inner * inner) / (real(2) * g)\n    back, front, rest =",
    ),
]

if sys.argv[1:] == ["list"]:
    for kind, precision, mistake, *_ in WRONG:
        print(kind, precision, mistake, sep="\t")
else:
    precision, mistake = sys.argv[1:]
    for *_, name, function, old, new in WRONG:
        if name == mistake:
            changed(function, old, new)
    sys.argv[1:] = [precision]
    import answers  # noqa: F401, E402
