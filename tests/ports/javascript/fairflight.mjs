// Jittered ratio tracking and unbiased ray marching in JavaScript, in double precision: a port by docs/PORTING.md alone.
//
// field(s) is the extinction at a distance, uniform() a variate in [0, 1).

// The number below a positive one.
function nextDown(x) {
  const bits = new DataView(new ArrayBuffer(8));
  bits.setFloat64(0, x);
  bits.setBigUint64(0, bits.getBigUint64(0) - 1n);
  return bits.getFloat64(0);
}

// Strata of optical thickness epsilon <= 1 in the majorant. In [0, 1].
export function jitteredRatio({ length, majorant, epsilon }, field, uniform) {
  const thickness = majorant * length;
  const count = Math.max(1, Math.ceil(thickness / epsilon));
  const width = length / count;
  const e = Math.min(thickness / count, epsilon);
  const last = nextDown(length);
  let estimate = 1;
  for (let stratum = 0; stratum < count; stratum++) {
    const u = uniform();
    let order = 1;
    for (let atLeast = e / 2; u < atLeast; atLeast *= e / (order + 1)) order++;
    let bracket = 1;
    let r = 0;
    for (let point = 0; point < order; point++) {
      bracket = 1 - r * bracket;
      r = field(Math.min((stratum + uniform()) * width, last)) / majorant;
    }
    estimate *= 1 - e * (r * bracket);
  }
  return estimate;
}

// Elementary symmetric means of order 0 to that of all values.
function symmetricMeans(values) {
  const means = [1];
  values.forEach((value, index) => {
    const n = index + 1;
    means[n] = 0;
    for (let k = n; k >= 1; k--) means[k] += k * (1 / n) * (means[k - 1] * value - means[k]);
  });
  return means;
}

// kettunen-2021. roulette is the probability of stopping at order 0.
export function unbiasedRayMarching({ length, teeth, matched, roulette }, field, uniform) {
  const step = length / teeth;
  const start = matched ? field(0) : 0;
  const jump = matched ? step * (field(length) - start) : 0;
  const comb = () => {
    const u = uniform();
    let sum = 0;
    for (let tooth = 0; tooth < teeth; tooth++) sum += field(Math.min(u * step + tooth * step, length));
    return step * sum - jump * (u - 0.5);
  };
  const goingOn = 1 - roulette;
  let order = 0;
  if (uniform() < goingOn) {
    order = 2;
    while (uniform() * (order + 1) < 2) order++;
  }
  const first = comb();
  const deviations = [0];
  for (let i = 1; i <= order; i++) deviations.push(first - comb());
  let sum = 0;
  deviations.forEach((pivot, j) => {
    const others = deviations.filter((_, i) => i !== j).map((deviation) => deviation - pivot);
    let series = 1;
    symmetricMeans(others).forEach((mean, k) => {
      if (k > 0) series += (1 / goingOn) * 2 ** (1 - k) * mean;
    });
    sum += Math.exp(pivot) * series;
  });
  return (sum / (order + 1)) * Math.exp(-first);
}
