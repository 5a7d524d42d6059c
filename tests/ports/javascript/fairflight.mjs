// Some estimators of transmittance in JavaScript, in double precision: a port by docs/PORTING.md and docs/porting alone.
//
// field(s) is the extinction at a distance, uniform() a variate in [0, 1), exponential() is -Math.log(1 - uniform()).

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

// A comb of as many teeth, by its variate: an estimate of the optical thickness.
function combOf({ length, teeth, matched }, field) {
  const step = length / teeth;
  const start = matched ? field(0) : 0;
  const jump = matched ? step * (field(length) - start) : 0;
  return (u) => {
    let sum = 0;
    for (let tooth = 0; tooth < teeth; tooth++) sum += field(Math.min(u * step + tooth * step, length));
    return step * sum - jump * (u - 0.5);
  };
}

// kettunen-2021. roulette is the probability of stopping at order 0.
export function unbiasedRayMarching({ roulette, ...combs }, field, uniform) {
  const thickness = combOf(combs, field);
  const comb = () => thickness(uniform());
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

// misso-2022, blanchet-2015: levelRatio is the probability of stopping at each level.
export function telescoping({ levelRatio, ...combs }, field, uniform) {
  let level = 0;
  while (!(uniform() < levelRatio)) level++;
  const thickness = combOf(combs, field);
  const u = uniform();
  const n = 2 ** level;
  let [mean, sum, difference] = [0, 0, 0];
  for (let a = 0; a < n; a++) {
    const x = thickness((a + u) / n);
    mean += Math.exp(-x);
    sum += x;
    difference += a % 2 ? x : -x;
  }
  const base = mean / n;
  if (level === 0) return base;
  const probability = levelRatio * (1 - levelRatio) ** level;
  return base - (2 * Math.exp(-sum / n) * Math.sinh(difference / (2 * n)) ** 2) / probability;
}

// The number of exponentials whose sum stays below a rate.
function poisson(rate, exponential) {
  let count = 0;
  for (let sum = exponential(); sum < rate; sum += exponential()) count++;
  return count;
}

// wagner-1987, fearnhead-2008.
export function generalisedPoisson({ length, pivot, rate }, field, uniform, exponential) {
  const count = poisson(rate, exponential);
  let product = 1;
  for (let k = 0; k < count; k++) product *= (pivot - length * field(length * uniform())) / rate;
  return product * Math.exp(rate - pivot);
}

// georgiev-2019, bhanot-1985: the power series of exp(pivot - thickness), in four versions. Orders up to `sure` are reached for certain by the version cmf.
export function pSeries({ length, version, pivot, sure }, field, uniform, exponential) {
  const depth = () => length * field(length * uniform());
  const atPivot = Math.exp(-pivot);
  let [term, total] = [atPivot, atPivot];
  if (version === "cmf") {
    for (let k = 1; ; k++) {
      let factor = 1 / k;
      if (k > sure) {
        const q = Math.min(1, pivot * factor);
        if (q < 1 && !(uniform() < q)) return total;
        factor /= q;
      }
      term *= (pivot - depth()) * factor;
      total += term;
    }
  }
  if (version === "cumulative") {
    for (let k = 1; ; k++) {
      term *= (pivot - depth()) / k;
      const q = Math.abs(term) / atPivot;
      if (q < 1) {
        if (!(uniform() < q)) return total;
        term *= 1 / q;
      }
      total += term;
    }
  }
  const count = poisson(pivot, exponential);
  if (version === "ratio") {
    let product = 1;
    for (let k = 0; k < count; k++) product *= 1 - depth() / pivot;
    return product;
  }
  let rest = 0;
  for (let [j, addend] = [0, 1]; rest + addend !== rest; addend *= pivot / (count + ++j)) rest += addend;
  let estimate = 1 / rest;
  for (let k = count; k >= 1; k--) {
    rest = 1 + (pivot / k) * rest;
    estimate = estimate * (1 - depth() / pivot) + 1 / rest;
  }
  return estimate;
}
