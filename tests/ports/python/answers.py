"""Answers cases of the test vectors with the port in fairflight_ports.py: a case a line on standard input, an answer a line on standard output.

    harness check-port [--precision binary32] "python3 answers.py [binary32]"
"""

import json
import sys

import numpy as np

import fairflight_ports as ports

np.seterr(all="ignore")
real = np.float32 if sys.argv[1:] == ["binary32"] else np.float64


class Source:
    """The variates of a case; what is drawn beyond them is told by the number of draws."""

    def __init__(self, draws, exponentials_given):
        self.draws, self.given, self.drawn = draws, exponentials_given, 0

    def draw(self):
        self.drawn += 1
        return self.draws[self.drawn - 1] if self.drawn <= len(self.draws) else None

    def uniform(self):
        draw = self.draw()
        return real(draw[1] * 2.0**-53) if draw else real(0.5)

    def exponential(self):
        draw = self.draw()
        if draw is None:
            return real(1e9)
        if len(draw) > 2 and (self.given or draw[1] is None):
            return real(draw[2])
        return -np.log(real(1) - real(draw[1] * 2.0**-53))


class Generator:
    """Variates of numpy's generator, 24 bits each in single precision, for statistics."""

    def __init__(self, seed):
        self.generator = np.random.default_rng(seed)

    def uniform(self):
        return real(self.generator.integers(1 << 24) * 2.0**-24 if real == np.float32 else self.generator.random())

    def exponential(self):
        return -np.log(real(1) - self.uniform())


class Field:
    """Extinction linear between nodes, or what the trace has where the field is scripted."""

    def __init__(self, case):
        self.s = [real(s) for s in case["profile"]["s"]]
        self.sigma_t = [real(sigma_t) for sigma_t in case["profile"]["sigma_t"]]
        self.trace = case["trace"] if case["layer"] == "field" else None
        self.lookups = []
        self.count = 0

    def __call__(self, at):
        self.count += 1
        if self.count <= MOST_KEPT:
            self.lookups.append(float(at))
        if self.trace is not None:
            return real(self.trace[len(self.lookups) - 1][1]) if len(self.lookups) <= len(self.trace) else real(0)
        piece = 0
        while piece + 2 < len(self.s) and self.s[piece + 1] <= at:
            piece += 1
        t = min(max((at - self.s[piece]) / (self.s[piece + 1] - self.s[piece]), real(0)), real(1))
        return (real(1) - t) * self.sigma_t[piece] + t * self.sigma_t[piece + 1]


# Look-ups whose distances are kept: those of a case.
MOST_KEPT = 1000


def statistics(case):
    """Mean, variance and look-ups of as many estimates as are asked for."""
    source, field = Generator(case["seed"]), Field(case) if "profile" in case else None
    scores = []
    for _ in range(case["samples"]):
        values, event = estimate(case, source, field)
        # A flight that collided scores nothing.
        scores.append(0.0 if event == "collided" else float(values[0]))
    lookups = field.count / len(scores) if field else 0
    return {"id": case["id"], "mean": np.mean(scores), "variance": np.var(scores, ddof=1), "lookups": lookups}


def answer(case):
    source = Source(case["draws"], case["layer"] != "uniforms")
    field = Field(case) if "profile" in case else None
    values, event = estimate(case, source, field)
    said = {"id": case["id"], "value": [float(value) for value in values], "draws": source.drawn}
    if event:
        said["event"] = event
    if field:
        said["lookups"], said["s"] = field.count, field.lookups
    return said


def estimate(case, source, field):
    """Values of one estimate, and the end of a flight."""
    event = None
    length = field.s[-1] if field else None
    majorant = real(case["knowledge"]["majorant"]) if field else None
    if "estimator" in case:
        estimator = case["estimator"]
        if estimator["kind"] == "double_particle":
            control = real(estimator.get("control", {}).get("sigma_t", 0))
            value = ports.ratio_tracking(field, length, real(estimator["sigma_samp"]), control, source, real)
        elif estimator["kind"] == "woodcock":
            value = ports.woodcock(field, length, majorant, source, real)
        elif estimator["kind"] == "jittered_ratio":
            value = ports.jittered_ratio(field, length, majorant, real(estimator["epsilon"]), source, real)
        else:
            settings = estimator["teeth"], estimator["endpoint_matching"], real(estimator["roulette"])
            value = ports.unbiased_ray_marching(field, length, *settings, source, real)
        values = [value]
    elif "phase" in case:
        g = real(case["phase"]["g"])
        cosine = ports.henyey_greenstein_cosine(g, source.uniform(), real)
        values = [cosine, ports.henyey_greenstein(g, cosine, real)]
    elif case["sampler"]["kind"] == "equiangular":
        sampler = case["sampler"]
        origin, direction, light = (np.array(sampler[key], real) for key in ("origin", "direction", "light"))
        closest = np.dot(light - origin, direction)
        aside = light - origin - closest * direction
        distance = np.sqrt(np.dot(aside, aside))
        values = ports.equiangular(closest, distance, real(sampler["length"]), source.uniform(), real)
    else:
        coefficients, sigma_samp = np.array(case["coefficients"], real), real(case["sampler"]["sigma_samp"])
        distance, values = ports.spectral_tracking(field, length, coefficients, sigma_samp, source, real)
        event = "escaped" if distance is None else "collided"
    return values, event


for line in sys.stdin:
    asked = json.loads(line)
    print(json.dumps(statistics(asked) if asked["layer"] == "statistics" else answer(asked)), flush=True)
