"""Answers cases of the test vectors with the port in fairflight.cuh.

    c++ -x c++ -D__device__= -D__global__= -O2 -shared -fPIC answers.cu -o answers.so         the same text as C++, on a CPU (tests/ports/run adds the prelude)
    clang ... answers.cu -o answers.ptx                                                       for a GPU: prelude.cuh has the command; or nvcc -ptx
    harness check-port --precision binary32 python3 answers.py FILE.so|FILE.ptx
"""

import ctypes
import json
import math
import struct
import sys

ROOM = 1000
FLOATS = 6 + ROOM
LAYERS = ["field", "exponentials", "uniforms"]


def of_light(sampler):
    """Where the ray comes closest to the light, and how far the light is from it then."""
    to_light = [light - origin for light, origin in zip(sampler["light"], sampler["origin"])]
    closest = sum(a * b for a, b in zip(to_light, sampler["direction"]))
    return [closest, math.hypot(*(a - closest * b for a, b in zip(to_light, sampler["direction"])))]


# In the order of the numbers in answers.cu: what a kind is told beside length and majorant, and how many values it returns.
KINDS = {
    "double_particle": (lambda case, it: [it["sigma_samp"], it.get("control", {}).get("sigma_t", 0)], 1),
    "woodcock": (lambda case, it: [], 1),
    "jittered_ratio": (lambda case, it: [it["epsilon"]], 1),
    "unbiased_ray_marching": (lambda case, it: [it["roulette"], it["teeth"]], 1),
    "spectral_tracking": (lambda case, it: [it["sigma_samp"], *case["coefficients"]], 3),
    "equiangular": (lambda case, it: of_light(it), 2),
    "henyey_greenstein": (lambda case, it: [it["g"]], 2),
}


def packed(case, it):
    """The arguments of the kernel, as bytes."""
    profile = case.get("profile", {"s": [0, 1], "sigma_t": [0, 0]})
    trace = [step[1] for step in case.get("trace", [])]
    numbers = KINDS[it["kind"]][0](case, it)
    length = profile["s"][-1] if "profile" in case else it.get("length", 0)
    counts = len(profile["s"]), len(case["draws"]), len(trace), int(it.get("endpoint_matching", False))
    floats = [length, case.get("knowledge", {}).get("majorant", 0), *numbers, 0, 0, 0, 0][:6]
    case_bytes = struct.pack("6I6f", list(KINDS).index(it["kind"]), LAYERS.index(case["layer"]), *counts, *floats)
    nodes = [number for node in zip(profile["s"], profile["sigma_t"]) for number in node]
    variates = [number for draw in case["draws"] for number in ((draw[1] or 0) * 2.0**-53, draw[2] if len(draw) > 2 else 0)]
    return [case_bytes, *(struct.pack(f"{len(all_of)}f", *all_of) for all_of in (nodes, variates, trace or [0]))]


class OnCpu:
    """The kernel compiled as C++: one thread."""

    def __init__(self, path):
        self.kernel = ctypes.CDLL(path).answer

    def run(self, inputs):
        answers = (ctypes.c_float * FLOATS)()
        self.kernel(*inputs, answers, ctypes.c_uint(ROOM))
        return answers


class OnGpu:
    """The kernel as PTX, by the driver of the first GPU."""

    def __init__(self, path):
        self.cuda = ctypes.CDLL("libcuda.so.1")
        device, context, module, self.kernel = ctypes.c_int(), ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_void_p()
        self.call("cuInit", 0)
        self.call("cuDeviceGet", ctypes.byref(device), 0)
        self.call("cuCtxCreate_v2", ctypes.byref(context), 0, device)
        with open(path, "rb") as text:
            self.call("cuModuleLoadData", ctypes.byref(module), text.read() + b"\0")
        self.call("cuModuleGetFunction", ctypes.byref(self.kernel), module, b"answer")

    def call(self, name, *arguments):
        code = getattr(self.cuda, name)(*arguments)
        if code:
            raise RuntimeError(f"{name}: error {code}")

    def run(self, inputs):
        answers = (ctypes.c_float * FLOATS)()
        buffers = [ctypes.c_uint64() for _ in range(len(inputs) + 1)]
        for buffer, data in zip(buffers, [*inputs, bytes(answers)]):
            self.call("cuMemAlloc_v2", ctypes.byref(buffer), ctypes.c_size_t(len(data)))
            self.call("cuMemcpyHtoD_v2", buffer, data, ctypes.c_size_t(len(data)))
        arguments = [*buffers, ctypes.c_uint(ROOM)]
        pointers = (ctypes.c_void_p * len(arguments))(*(ctypes.addressof(argument) for argument in arguments))
        self.call("cuLaunchKernel", self.kernel, 1, 1, 1, 1, 1, 1, 0, None, pointers, None)
        self.call("cuMemcpyDtoH_v2", answers, buffers[-1], ctypes.c_size_t(ctypes.sizeof(answers)))
        for buffer in buffers:
            self.call("cuMemFree_v2", buffer)
        return answers


def answer(device, case):
    it = case.get("estimator") or case.get("sampler") or case["phase"]
    found = device.run(packed(case, it))
    drawn, lookups, event = (int(number) for number in found[:3])
    said = {"id": case["id"], "value": list(found[3 : 3 + KINDS[it["kind"]][1]]), "draws": drawn}
    if "profile" in case:
        said.update(lookups=lookups, s=list(found[6 : 6 + lookups]))
    if event >= 0:
        said["event"] = "collided" if event else "escaped"
    return said


device = (OnGpu if sys.argv[1].endswith(".ptx") else OnCpu)(sys.argv[1])
for line in sys.stdin:
    print(json.dumps(answer(device, json.loads(line))), flush=True)
