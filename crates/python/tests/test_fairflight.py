"""What a user sees: estimates, laws, verdicts, refusals, on fields of all kinds."""

import json
import math
import os
import shutil

import fairflight
import numpy as np
import pytest

RAMP = {"kind": "piecewise_linear", "positions": [0, 1, 4], "sigma_t": [0.25, 1.0, 0.5]}
RATIO = {"kind": "double_particle", "sigma_samp": 0.75}
# One of each way to draw: in lanes, one by one, learning from one estimate to the next.
ESTIMATORS = [
    RATIO,
    {"kind": "double_particle", "sigma_samp": 0.75, "control": {"kind": "constant", "sigma_main": 0.4}},
    {"kind": "woodcock", "majorant": 1.0},
    {"kind": "jittered_ratio", "majorant": 1.0, "epsilon": 0.5},
    {"kind": "unbiased_ray_marching", "teeth": 4, "endpoint_matching": True},
    {"kind": "p_series", "version": "ratio", "pivot": 4},
    {"kind": "next_flight", "version": "ratio", "majorant": 1.0},
    {"kind": "progressive_majorant", "start": 0.25},
]

has_harness = pytest.mark.skipif(
    not (os.environ.get("FAIRFLIGHT_HARNESS") or shutil.which("harness")), reason="no program harness"
)


def ramp(s):
    return float(np.interp(s, RAMP["positions"], RAMP["sigma_t"]))


def ramps(s):
    return np.interp(s, RAMP["positions"], RAMP["sigma_t"])


# Dyadic, so that numpy's arithmetic and the crate's have the same bits.
def dyadic(s):
    return 0.25 + 0.125 * s


DYADIC = {"kind": "piecewise_linear", "positions": [0, 4], "sigma_t": [0.25, 0.75]}


@has_harness
@pytest.mark.parametrize("estimator", ESTIMATORS, ids=lambda spec: spec["kind"])
@pytest.mark.parametrize("samples", [1000, 70_000])
def test_the_same_seed_gives_the_estimates_of_the_harness(estimator, samples):
    drawn = fairflight.draw(RAMP, estimator, samples=samples, seed=7)
    told = fairflight.estimate({"profile": RAMP, "estimator": estimator, "samples": samples, "seed": 7})
    assert drawn.values.shape == (samples,) and drawn.values.dtype == np.float64
    assert drawn.mean == told["estimate"]["mean"]
    assert drawn.variance == told["estimate"]["variance"]
    assert drawn.values.min() == told["estimate"]["minimum"]
    assert drawn.values.max() == told["estimate"]["maximum"]
    assert drawn.lookups == told["cost"]["lookups_per_sample"]


@has_harness
@pytest.mark.parametrize("estimator", ESTIMATORS, ids=lambda spec: spec["kind"])
def test_the_law_is_that_of_the_harness(estimator):
    law = fairflight.moments(RAMP, estimator)
    told = fairflight.estimate({"profile": RAMP, "estimator": estimator, "samples": 10, "seed": 1})["reference"]
    assert law.transmittance == told["transmittance"] and law.optical_thickness == told["optical_thickness"]
    assert (law.variance, law.log_variance) == (told["variance"], told["log_variance"])
    assert law.lookups == told["lookups_per_sample"] and law.doubt is None
    if law.variance is not None:
        assert law.central[0] == pytest.approx(law.variance, rel=1e-12)


@pytest.mark.parametrize("estimator", ESTIMATORS, ids=lambda spec: spec["kind"])
@pytest.mark.parametrize("vectorised", [False, True])
def test_a_callable_gives_the_estimates_of_the_field_that_it_is(estimator, vectorised):
    own = fairflight.Profile(dyadic, 4.0, majorant=0.75, vectorised=vectorised)
    found = fairflight.draw(own, estimator, samples=20_000, seed=3)
    known = fairflight.draw(DYADIC, estimator, samples=20_000, seed=3)
    # The crate interpolates between nodes: the same number, rounded otherwise.
    np.testing.assert_allclose(found.values, known.values, rtol=1e-12, atol=1e-12)
    assert found.lookups == known.lookups


def test_a_callable_is_judged_and_its_law_is_not_called_proved():
    own = fairflight.Profile(ramp, 4.0, majorant=1.0, breakpoints=[1.0])
    law = fairflight.moments(own, RATIO)
    exact = fairflight.moments(RAMP, RATIO)
    assert law.transmittance == pytest.approx(exact.transmittance, rel=1e-12)
    assert law.variance == pytest.approx(exact.variance, rel=1e-9)
    assert law.lookups == exact.lookups
    assert "no bound of sigma_t is proved" in law.doubt
    drawn = fairflight.draw(own, RATIO, samples=50_000, seed=5)
    assert fairflight.judge(drawn.values, exact.mean, central=exact.central).sound is True
    assert drawn.lookups == pytest.approx(exact.lookups, rel=0.02)


def test_arrays_are_nodes():
    nodes = fairflight.Profile.linear(np.array([0.0, 1.0, 4.0]), [0.25, 1, 0.5])
    assert (nodes.length, nodes.majorant, nodes.sigma_t(0.5)) == (4.0, 1.0, 0.625)
    spec = {**RAMP, "positions": np.array([0, 1, 4]), "sigma_t": np.array([0.25, 1.0, 0.5])}
    values = [fairflight.draw(profile, RATIO, samples=100, seed=1).values for profile in (nodes, spec, RAMP)]
    assert (values[0] == values[1]).all() and (values[1] == values[2]).all()


def test_a_vectorised_callable_is_asked_for_many_distances():
    sizes = set()

    def counting(s):
        assert isinstance(s, np.ndarray) and s.ndim == 1
        sizes.add(s.size)
        return ramps(s)

    own = fairflight.Profile(counting, 4.0, vectorised=True)
    fairflight.draw(own, RATIO, samples=10_000, seed=1)
    assert sizes == {16}
    assert own.sigma_t(0.5) == 0.625
    # A constant is none for each distance.
    constant = fairflight.Profile(lambda s: [1.0], 4.0, vectorised=True)
    with pytest.raises(ValueError, match="a value for each of 16 distances, found 1"):
        fairflight.draw(constant, RATIO, samples=10, seed=1)


def test_verdicts():
    law = fairflight.moments(RAMP, {"kind": "woodcock", "majorant": 1.0})
    values = fairflight.draw(RAMP, {"kind": "woodcock", "majorant": 1.0}, samples=100_000, seed=2).values
    for known in ({"two_valued": 1.0}, {"variance": law.variance, "least": 0, "greatest": 1}, {"central": law.central}):
        assert fairflight.judge(values, law.mean, **known).sound is True
        assert fairflight.judge(values, 1.2 * law.mean, **known).sound is False
    assert fairflight.judge(values[:10], law.mean, two_valued=1.0).sound is None
    verdict = fairflight.judge(2 * values, law.mean, two_valued=1.0)
    assert verdict.sound is False and "neither 0 nor 1" in verdict.reason
    with pytest.raises(ValueError, match="false_alarm"):
        fairflight.judge(values, law.mean, false_alarm=0.7)


class Cloudless(Exception):
    pass


@pytest.mark.parametrize("vectorised", [False, True])
def test_an_exception_of_a_callable_comes_through(vectorised):
    asked = []

    def raising(s):
        asked.append(s)
        if len(asked) > 100:
            raise Cloudless("at last")
        return ramps(s)

    own = fairflight.Profile(raising, 4.0, vectorised=vectorised)
    for use in (
        lambda: fairflight.draw(own, RATIO, samples=10_000, seed=1),
        lambda: fairflight.moments(own, RATIO),
        lambda: own.sigma_t(1.0),
    ):
        with pytest.raises(Cloudless, match="at last"):
            use()
    # After the first exception nobody asks again.
    assert len(asked) == 103


def test_what_a_callable_may_not_return_is_refused():
    def draw(sigma_t, estimator=RATIO, **declared):
        return fairflight.draw(fairflight.Profile(sigma_t, 4.0, **declared), estimator, samples=1000, seed=1)

    with pytest.raises(ValueError, match=r"profile: sigma_t is NaN at s = "):
        draw(lambda s: math.nan)
    with pytest.raises(ValueError, match=r"profile: sigma_t = 2 exceeds the declared majorant 1 at s = "):
        draw(lambda s: 2.0, majorant=1.0)
    with pytest.raises(ValueError, match=r"estimator.majorant: 1 is none, since sigma_t = 2 at s = "):
        draw(lambda s: 2.0, {"kind": "woodcock", "majorant": 1.0})
    with pytest.raises(ValueError, match=r"estimator.majorant: needs sigma_t of at least 0, but sigma_t = -0.5 at s = "):
        draw(lambda s: -0.5, {"kind": "woodcock", "majorant": 1.0})
    with pytest.raises(TypeError):
        draw(lambda s: "dense")
    # Ratio tracking takes any sign.
    assert draw(lambda s: -0.5).mean > 1
    with pytest.raises(ValueError, match="needs its optical thickness in closed form|closed form"):
        draw(lambda s: 0.5, {"kind": "regular"})
    with pytest.raises(ValueError, match="estimator.cells: the profile does not know its bounds in cells"):
        draw(lambda s: 0.5, {"kind": "residual_cells", "rate": 2, "cells": 4}, majorant=1.0)


@has_harness
@pytest.mark.parametrize(
    ("part", "spec"),
    [
        ("estimator", {"kind": "duoble_particle", "sigma_samp": 1}),
        ("estimator", {"kind": "double_particle", "sigma_samp": -1}),
        ("estimator", {"kind": "double_particle", "sigma_samp": 1, "kontrol": 2}),
        ("estimator", {"kind": "unbiased_ray_marching", "teeth": 3, "pivot": 4}),
        ("profile", {"kind": "piecewise_linear", "positions": [0, 1], "sigma_t": [1]}),
        ("profile", {"kind": "constant", "sigma_t": 1}),
    ],
)
def test_refusals_have_the_words_of_the_harness(part, spec):
    experiment = {"profile": RAMP, "estimator": RATIO, part: spec}
    with pytest.raises(ValueError) as here:
        fairflight.draw(experiment["profile"], experiment["estimator"], samples=10, seed=1)
    with pytest.raises(ValueError) as there:
        fairflight.estimate({**experiment, "samples": 10, "seed": 1})
    assert str(there.value) == f"standard input: {here.value}"


def test_arguments_are_checked():
    with pytest.raises(ValueError, match="sigma_t: must be callable, found 1.0; Profile.linear takes nodes"):
        fairflight.Profile(1.0, 4.0)
    for wrong in ({"length": -1.0}, {"length": math.inf}, {"length": 1.0, "majorant": math.nan}, {"length": 1.0, "breakpoints": [1.0]}):
        with pytest.raises(ValueError, match="profile."):
            fairflight.Profile(ramp, **wrong)
    with pytest.raises(ValueError, match="positions"):
        fairflight.Profile.linear([0, 1, 1], [1, 1, 1])
    with pytest.raises(ValueError, match="samples"):
        fairflight.draw(RAMP, RATIO, samples=0, seed=1)
    with pytest.raises(MemoryError, match="no room"):
        fairflight.draw(RAMP, RATIO, samples=2**60, seed=1)
    with pytest.raises(TypeError, match="a spec holds"):
        fairflight.draw(RAMP, {"kind": "woodcock", "majorant": object()}, samples=1, seed=1)
    with pytest.raises(ValueError, match="not JSON"):
        fairflight.Profile.read("{")


@has_harness
def test_the_program_sweeps_and_warns():
    sweep = {"path": "estimator.sigma_samp", "values": [0.5, 1.0]}
    told = fairflight.estimate({"profile": RAMP, "estimator": RATIO, "samples": 100, "seed": 1, "sweep": sweep})
    assert [point["value"] for point in told["points"]] == [0.5, 1.0]
    ray = {"kind": "ray", "medium": {"kind": "analytic_cosine"}, "origin": [50, 0, 0], "direction": [0, 0, 1]}
    with pytest.warns(UserWarning, match="the ray misses the medium"):
        fairflight.estimate({"profile": ray, "estimator": RATIO, "samples": 100, "seed": 1})


def test_no_program_is_said(monkeypatch):
    monkeypatch.delenv("FAIRFLIGHT_HARNESS", raising=False)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(FileNotFoundError, match="FAIRFLIGHT_HARNESS"):
        fairflight.estimate({"profile": RAMP, "estimator": RATIO, "samples": 1, "seed": 1})


def test_everything_has_a_docstring():
    for name in fairflight.__all__:
        assert getattr(fairflight, name).__doc__, name
    assert json.loads(fairflight._json({"a": np.float32(0.5), "b": np.arange(2)})) == {"a": 0.5, "b": [0, 1]}
