"""Estimators of transmittance on fields of your own.

Fairflight is the open reference of unbiased volumetric light transport. This package gives its estimators of the transmittance exp(-integral of sigma_t) along a ray to
Python: on any kind of profile that its program knows, on nodes, and on a callable of yours.

>>> import fairflight
>>> cloud = fairflight.Profile.linear([0, 1, 4], [0.25, 1.0, 0.5])
>>> ratio_tracking = {"kind": "double_particle", "sigma_samp": 1.0}
>>> drawn = fairflight.draw(cloud, ratio_tracking, samples=100_000, seed=1)
>>> law = fairflight.moments(cloud, ratio_tracking)
>>> fairflight.judge(drawn.values, law.mean, central=law.central).sound
True

An estimator and a profile are written as in the specs of the program (``harness list`` shows all kinds), as dictionaries. What is refused is a ``ValueError`` in the words
of the program; an exception of a callable comes through.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import warnings
from collections.abc import Mapping
from typing import Any

from . import _native
from ._native import Draws, Law, Profile, Verdict, judge

__all__ = ["Draws", "Law", "Profile", "Verdict", "draw", "estimate", "judge", "moments"]

Spec = Mapping[str, Any]


def draw(profile: Profile | Spec, estimator: Spec, *, samples: int, seed: int) -> Draws:
    """Draws estimates of the transmittance of a profile.

    The same seed gives the same estimates as ``harness estimate``, bit for bit: batches of 4096 have streams of their own, on any number of threads. Of a callable,
    estimates are drawn by the calling thread.

    Raises ValueError if a spec is not lawful, the two do not fit, or a look-up finds what the estimator does not admit (a value that is not finite, one above the declared
    or claimed majorant, a negative one where it must not be); and what a callable raises.
    """
    return _native.draw(_profile(profile), _json(estimator), samples, seed)


def moments(profile: Profile | Spec, estimator: Spec) -> Law:
    """The law of one estimate in closed form: mean, variance, higher central moments, expected look-ups.

    They are integrals along the ray, by quadrature where the profile has no closed form: a callable is looked up some hundred to some ten thousand times, and what it does
    between those distances is not seen (``Law.doubt`` says so; ``breakpoints`` of the profile help).

    Raises what ``draw`` raises.
    """
    return _native.moments(_profile(profile), _json(estimator))


def estimate(spec: Spec) -> dict[str, Any]:
    """The result of ``harness estimate`` on an experiment: profile, estimator, samples, seed; perhaps a sweep.

    Calls the program ``harness``, found by the environment variable FAIRFLIGHT_HARNESS, else in PATH. Its warnings are warnings here. A verdict against the estimator is no
    exception: it is told in the result.

    Raises ValueError if the program refuses the spec, FileNotFoundError if there is no program.
    """
    program = os.environ.get("FAIRFLIGHT_HARNESS") or shutil.which("harness")
    if program is None:
        raise FileNotFoundError("no program harness in PATH; FAIRFLIGHT_HARNESS can name it")
    command = [program, "estimate", "-", "--json"]
    done = subprocess.run(command, input=_json(spec), capture_output=True, text=True, encoding="utf-8", check=False)
    told = done.stderr.strip()
    # 1: a law failed; the result is still written.
    if done.returncode not in (0, 1):
        error = ValueError if done.returncode == 2 else RuntimeError
        raise error(told.removeprefix("refused: "))
    for line in told.splitlines():
        if line.startswith("warning: "):
            warnings.warn(line.removeprefix("warning: "), stacklevel=2)
    return json.loads(done.stdout)


def _profile(profile: Profile | Spec) -> Profile:
    return profile if isinstance(profile, Profile) else Profile.read(_json(profile))


def _json(spec: Spec) -> str:
    return json.dumps(spec, default=_plain)


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy as Python has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a spec holds numbers, words, lists and dictionaries, found {value!r}")
