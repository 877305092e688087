// L-BFGS with a line search for the strong Wolfe conditions, step for step as torch's, which chapter 3 uses.

const MEMORY = 10; // pairs of steps and gradient changes that approximate the curvature
const MOST_EVALUATIONS = 25; // of a line search
const FLAT = 1e-9; // the largest entry of a gradient that counts as zero
const [ARMIJO, CURVATURE] = [1e-4, 0.9];

const dot = (a, b) => {
  let sum = 0;
  for (let k = 0; k < a.length; k += 1) sum += a[k] * b[k];
  return sum;
};
const addScaled = (a, scale, b) => {
  for (let k = 0; k < a.length; k += 1) a[k] += scale * b[k];
};
const magnitude = (a) => a.reduce((most, value) => Math.max(most, Math.abs(value)), 0);

/** The minimum of the cubic through two points with their slopes, between two bounds. */
function cubicMinimum(p, q, low = Math.min(p.t, q.t), high = Math.max(p.t, q.t)) {
  const d1 = p.slope + q.slope - (3 * (p.cost - q.cost)) / (p.t - q.t);
  const square = d1 * d1 - p.slope * q.slope;
  if (!(square >= 0)) return (low + high) / 2;
  const d2 = Math.sqrt(square);
  const [a, b] = p.t <= q.t ? [p, q] : [q, p];
  const minimum = b.t - (b.t - a.t) * ((b.slope + d2 - d1) / (b.slope - a.slope + 2 * d2));
  return Math.min(Math.max(minimum, low), high);
}

/**
 * A step length that satisfies the strong Wolfe conditions (Nocedal and Wright 2006, Algorithms 3.5 and 3.6).
 * @param {(t: number) => Point} at evaluates a step length: {t, cost, slope, gradient}
 * @param {Point} origin the point of step length 0
 */
function strongWolfe(at, origin, first) {
  const tooHigh = (point) => point.cost > origin.cost + ARMIJO * point.t * origin.slope;
  const flatEnough = (point) => Math.abs(point.slope) <= -CURVATURE * origin.slope;
  let [previous, point, count, bracket] = [origin, at(first), 0, null];
  while (count < MOST_EVALUATIONS && bracket === null) {
    if (tooHigh(point) || (count > 1 && point.cost >= previous.cost)) bracket = [previous, point];
    else if (flatEnough(point)) return point;
    else if (point.slope >= 0) bracket = [previous, point];
    else {
      const t = cubicMinimum(previous, point, point.t + 0.01 * (point.t - previous.t), point.t * 10);
      [previous, point] = [point, at(t)];
      count += 1;
    }
  }
  bracket ??= [origin, point];
  let low = bracket[0].cost <= bracket[1].cost ? 0 : 1;
  let slow = false;
  while (count < MOST_EVALUATIONS) {
    const [least, most] = [Math.min(bracket[0].t, bracket[1].t), Math.max(bracket[0].t, bracket[1].t)];
    if (most - least === 0) break;
    let t = cubicMinimum(bracket[0], bracket[1]);
    const edge = 0.1 * (most - least);
    if (Math.min(most - t, t - least) < edge) {
      if (slow || t >= most || t <= least) {
        t = Math.abs(t - most) < Math.abs(t - least) ? most - edge : least + edge;
        slow = false;
      } else slow = true;
    } else slow = false;
    point = at(t);
    count += 1;
    if (tooHigh(point) || point.cost >= bracket[low].cost) {
      bracket[1 - low] = point;
      low = bracket[0].cost <= bracket[1].cost ? 0 : 1;
    } else {
      const done = flatEnough(point);
      if (!done && point.slope * (bracket[1 - low].t - bracket[low].t) >= 0) bracket[1 - low] = bracket[low];
      bracket[low] = point;
      if (done) break;
    }
  }
  return bracket[low];
}

/**
 * Minimises a cost by L-BFGS (Liu and Nocedal 1989); yields the cost and the accuracy before the first iteration and after each.
 * Ends early where no step lowers the cost.
 * @param {Cost} cost
 * @param {Float64Array} parameters changed in place
 */
export function* lbfgs(cost, parameters, iterations) {
  const here = new Float64Array(parameters.length);
  let gradient = new Float64Array(parameters.length);
  let value = cost.evaluate(parameters, gradient);
  yield { cost: value, accuracy: cost.accuracy() };
  let direction = gradient.map((slope) => -slope);
  const memory = [];
  let scale = 1;
  for (let iteration = 0; iteration < iterations; iteration += 1) {
    if (magnitude(gradient) <= FLAT) return;
    const slope = dot(gradient, direction);
    if (slope > 0) return;
    here.set(parameters);
    const at = (t) => {
      for (let k = 0; k < here.length; k += 1) parameters[k] = here[k] + t * direction[k];
      const there = new Float64Array(here.length);
      const reached = cost.evaluate(parameters, there);
      return { t, cost: reached, accuracy: cost.accuracy(), gradient: there, slope: dot(there, direction) };
    };
    const first = iteration === 0 ? Math.min(1, 1 / gradient.reduce((sum, entry) => sum + Math.abs(entry), 0)) : 1;
    const point = strongWolfe(at, { t: 0, cost: value, gradient, slope }, first);
    const step = direction.map((entry) => point.t * entry);
    for (let k = 0; k < here.length; k += 1) parameters[k] = here[k] + step[k];
    if (parameters.every((entry, k) => entry === here[k])) return;
    const change = point.gradient.map((entry, k) => entry - gradient[k]);
    [value, gradient] = [point.cost, point.gradient];
    const curvature = dot(change, step);
    if (curvature > 1e-10) {
      if (memory.length === MEMORY) memory.shift();
      memory.push({ change, step, rho: 1 / curvature });
      scale = curvature / dot(change, change);
    }
    direction = gradient.map((entry) => -entry);
    const shares = memory.map(() => 0);
    for (let i = memory.length - 1; i >= 0; i -= 1) {
      shares[i] = dot(memory[i].step, direction) * memory[i].rho;
      addScaled(direction, -shares[i], memory[i].change);
    }
    for (let k = 0; k < direction.length; k += 1) direction[k] *= scale;
    memory.forEach((pair, i) => addScaled(direction, shares[i] - dot(pair.change, direction) * pair.rho, pair.step));
    yield { cost: value, accuracy: point.accuracy };
  }
}
