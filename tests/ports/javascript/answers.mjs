// Answers cases of the test vectors with the port in fairflight.mjs.
//
//     harness check-port --kinds jittered_ratio,unbiased_ray_marching node answers.mjs

import { createInterface } from "node:readline";
import { jitteredRatio, unbiasedRayMarching } from "./fairflight.mjs";

// Linear between nodes; the ends hold outside.
function interpolated({ s: nodes, sigma_t: values }, s) {
  let piece = 0;
  while (piece + 2 < nodes.length && nodes[piece + 1] <= s) piece++;
  const t = Math.min(Math.max((s - nodes[piece]) / (nodes[piece + 1] - nodes[piece]), 0), 1);
  return (1 - t) * values[piece] + t * values[piece + 1];
}

function answer({ id, layer, estimator, profile, knowledge, draws, trace }) {
  let taken = 0;
  const distances = [];
  // Beyond the last variate any: the count tells.
  const uniform = () => (draws[taken++]?.[1] ?? 2 ** 52) * 2 ** -53;
  const field = (s) => {
    distances.push(s);
    return layer === "field" ? (trace[distances.length - 1]?.[1] ?? 0) : interpolated(profile, s);
  };
  const length = profile.s.at(-1);
  const { kind, epsilon, teeth, endpoint_matching: matched, roulette } = estimator;
  const value =
    kind === "jittered_ratio"
      ? jitteredRatio({ length, majorant: knowledge.majorant, epsilon }, field, uniform)
      : unbiasedRayMarching({ length, teeth, matched, roulette }, field, uniform);
  return { id, value, draws: taken, lookups: distances.length, s: distances };
}

for await (const line of createInterface({ input: process.stdin })) {
  console.log(JSON.stringify(answer(JSON.parse(line))));
}
