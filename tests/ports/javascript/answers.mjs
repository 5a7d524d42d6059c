// Answers cases of the test vectors with the port in fairflight.mjs.
//
//     harness check-port --kinds jittered_ratio,unbiased_ray_marching,telescoping,p_series,generalised_poisson node answers.mjs

import { createInterface } from "node:readline";
import { generalisedPoisson, jitteredRatio, pSeries, telescoping, unbiasedRayMarching } from "./fairflight.mjs";

// Linear between nodes; the ends hold outside.
function interpolated({ s: nodes, sigma_t: values }, s) {
  let piece = 0;
  while (piece + 2 < nodes.length && nodes[piece + 1] <= s) piece++;
  const t = Math.min(Math.max((s - nodes[piece]) / (nodes[piece + 1] - nodes[piece]), 0), 1);
  return (1 - t) * values[piece] + t * values[piece + 1];
}

const ESTIMATORS = {
  jittered_ratio: jitteredRatio,
  unbiased_ray_marching: unbiasedRayMarching,
  telescoping: telescoping,
  p_series: pSeries,
  generalised_poisson: generalisedPoisson,
};

function answer({ id, layer, estimator, sure, profile, knowledge, draws, trace }) {
  let taken = 0;
  const distances = [];
  // Beyond the last variate any: the count tells.
  const draw = () => draws[taken++] ?? ["e", 2 ** 52, 1e9];
  const uniform = () => draw()[1] * 2 ** -53;
  const exponential = () => {
    const [, k, given] = draw();
    return layer === "uniforms" ? -Math.log(1 - k * 2 ** -53) : given;
  };
  const field = (s) => {
    distances.push(s);
    return layer === "field" ? (trace[distances.length - 1]?.[1] ?? 0) : interpolated(profile, s);
  };
  const { kind, endpoint_matching: matched, level_ratio: levelRatio, ...others } = estimator;
  const parameters = { length: profile.s.at(-1), majorant: knowledge.majorant, sure, matched, levelRatio, ...others };
  const value = ESTIMATORS[kind](parameters, field, uniform, exponential);
  return { id, value, draws: taken, lookups: distances.length, s: distances };
}

for await (const line of createInterface({ input: process.stdin })) {
  console.log(JSON.stringify(answer(JSON.parse(line))));
}
