"""Answers cases of the test vectors with the port in fairflight.wgsl, on the first GPU that wgpu finds (a software one will do).

    harness check-port --precision binary32 python3 answers.py
    harness check-port --statistics 1000000 python3 answers.py
"""

import json
import struct
import sys
from pathlib import Path

import numpy as np
import wgpu

KINDS = {
    "double_particle": 0,
    "woodcock": 1,
    "jittered_ratio": 2,
    "unbiased_ray_marching": 3,
    "spectral_tracking": 4,
    "equiangular": 5,
    "henyey_greenstein": 6,
}
OUTPUTS = {"spectral_tracking": 3, "equiangular": 2, "henyey_greenstein": 2}
LAYERS = {"field": 0, "exponentials": 1, "uniforms": 2, "statistics": 3}
DISTANCES = 6
MOST_LOOKUPS = 1000
# Invocations of a workgroup, and estimates of an invocation at most: a sum of few in single precision.
WORKGROUP = 64
MOST_EACH = 64

folder = Path(__file__).parent
device = wgpu.gpu.request_adapter_sync(power_preference="high-performance").request_device_sync()
code = "\n".join((folder / name).read_text() for name in ("fairflight.wgsl", "answers.wgsl"))
module = device.create_shader_module(code=code)
pipelines = {
    name: device.create_compute_pipeline(layout="auto", compute={"module": module, "entry_point": name}) for name in ("main", "statistics")
}


def output(count):
    """A buffer of so many numbers."""
    return device.create_buffer(size=4 * count, usage=wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC)


one_answer = output(DISTANCES + MOST_LOOKUPS)


def parameters(case):
    """Name of the kind, a flag, and the four numbers that answers.wgsl takes for it."""
    if "estimator" in case:
        estimator = case["estimator"]
        kind = estimator["kind"]
        if kind == "double_particle":
            return kind, 0, [estimator["sigma_samp"], estimator.get("control", {}).get("sigma_t", 0), 0, 0]
        if kind == "unbiased_ray_marching":
            return kind, int(estimator["endpoint_matching"]), [estimator["roulette"], estimator["teeth"], 0, 0]
        return kind, 0, [estimator.get("epsilon", 0), 0, 0, 0]
    if "phase" in case:
        return case["phase"]["kind"], 0, [case["phase"]["g"], 0, 0, 0]
    sampler = case["sampler"]
    if sampler["kind"] == "spectral_tracking":
        return sampler["kind"], 0, [sampler["sigma_samp"], *case["coefficients"]]
    origin, direction, light = (np.array(sampler[key], np.float32) for key in ("origin", "direction", "light"))
    closest = np.dot(light - origin, direction)
    aside = light - origin - closest * direction
    return sampler["kind"], 0, [closest, np.sqrt(np.dot(aside, aside)), 0, 0]


def run(entry, case, workgroups, buffer, statistics=(0, 0, 0)):
    """Kind of a case, and the numbers that an entry point leaves for it."""
    kind, flag, numbers = parameters(case)
    profile = case.get("profile", {"s": [0, 1], "sigma_t": [0, 0]})
    length = profile["s"][-1] if "profile" in case else case.get("sampler", {}).get("length", 0)
    draws = [[(draw[1] or 0) * 2.0**-53, draw[2] if len(draw) > 2 else -1] for draw in case.get("draws", [])] or [[0, -1]]
    trace = [step[1] for step in case.get("trace", [])]
    counts = KINDS[kind], LAYERS[case["layer"]], len(profile["s"]), len(draws), len(trace), flag
    majorant = case.get("knowledge", {}).get("majorant", 0)
    inputs = [
        struct.pack("6I6f3I", *counts, length, majorant, *numbers, *statistics),
        np.array([profile["s"], profile["sigma_t"]], np.float32).T.tobytes(),
        np.array(draws, np.float32).tobytes(),
        np.array(trace or [0], np.float32).tobytes(),
    ]
    buffers = [device.create_buffer_with_data(data=data, usage=wgpu.BufferUsage.STORAGE) for data in inputs] + [buffer]
    entries = [{"binding": i, "resource": {"buffer": bound, "offset": 0, "size": bound.size}} for i, bound in enumerate(buffers)]
    encoder = device.create_command_encoder()
    shader = encoder.begin_compute_pass()
    shader.set_pipeline(pipelines[entry])
    shader.set_bind_group(0, device.create_bind_group(layout=pipelines[entry].get_bind_group_layout(0), entries=entries))
    shader.dispatch_workgroups(workgroups)
    shader.end()
    device.queue.submit([encoder.finish()])
    return kind, np.frombuffer(device.queue.read_buffer(buffer), np.float32)


def statistics(case):
    """Mean, variance and look-ups of as many estimates as are asked for."""
    samples = case["samples"]
    each = max(k for k in range(1, MOST_EACH + 1) if samples % k == 0)
    invocations = samples // each
    workgroups = -(-invocations // WORKGROUP)
    _, found = run("statistics", case, workgroups, output(3 * invocations), (case["seed"], invocations, each))
    sums = found.reshape(-1, 3).sum(axis=0, dtype=np.float64)
    mean = sums[0] / samples
    variance = (sums[1] - samples * mean * mean) / (samples - 1)
    return {"id": case["id"], "mean": mean, "variance": variance, "lookups": sums[2] / samples}


def answer(case):
    kind, found = run("main", case, 1, one_answer)
    drawn, lookups, event = (int(number) for number in found[:3])
    said = {"id": case["id"], "value": [float(value) for value in found[3 : 3 + OUTPUTS.get(kind, 1)]], "draws": drawn}
    if "profile" in case:
        said["lookups"] = lookups
        said["s"] = [float(s) for s in found[DISTANCES : DISTANCES + lookups]]
    if event >= 0:
        said["event"] = "collided" if event else "escaped"
    return said


for line in sys.stdin:
    asked = json.loads(line)
    print(json.dumps(statistics(asked) if asked["layer"] == "statistics" else answer(asked)), flush=True)
