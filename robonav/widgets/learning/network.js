// Networks that learn in the page: cost, backpropagation and gradient descent, held to robonav.networks.

/**
 * @typedef {{m: number, x: Float64Array, y: Float64Array}} Examples m rows of inputs and of labels, one after the other
 * @typedef {Network & {parameters: Float64Array}} FlatNetwork all weights, then all biases, in one array
 * @typedef {{evaluate: (parameters: Float64Array, gradient: Float64Array) => number, accuracy: () => number}} Cost
 */

/** How many weights and biases a network has. */
const parameterCount = (sizes) => sizes.slice(1).reduce((sum, units, l) => sum + units * (sizes[l] + 1), 0);

/**
 * A network whose arrays are parts of one array: all weights, then all biases.
 * @param {number[]} sizes
 * @returns {FlatNetwork}
 */
export function flatNetwork(sizes, parameters = new Float64Array(parameterCount(sizes))) {
  let at = 0;
  const next = (length) => parameters.subarray(at, (at += length));
  const weights = sizes.slice(1).map((units, l) => next(units * sizes[l]));
  const biases = sizes.slice(1).map((units) => next(units));
  return { sizes, weights, biases, parameters };
}

/** A copy of any network as a flat one. @param {Network} network */
export function flattened({ sizes, weights, biases }) {
  const network = flatNetwork(sizes);
  weights.forEach((values, l) => network.weights[l].set(values));
  biases.forEach((values, l) => network.biases[l].set(values));
  return network;
}

/** Small random weights and biases, as `robonav.networks.random_network`. @param {RandomNumbers} rng */
export function randomNetwork(sizes, rng, spread = null) {
  const network = flatNetwork(sizes);
  sizes.slice(1).forEach((units, l) => {
    const bound = spread ?? Math.sqrt(6 / (sizes[l] + units));
    network.weights[l].set(rng.uniform(-bound, bound, units * sizes[l]));
    network.biases[l].set(rng.uniform(-bound, bound, units));
  });
  return network;
}

/** The action that a uniform random number draws. */
export function sampleAction(probabilities, drawn) {
  let [sum, action] = [0, 0];
  for (const probability of probabilities) {
    sum += probability;
    if (sum <= drawn) action += 1;
  }
  return Math.min(action, probabilities.length - 1);
}

/** Rows of numbers as examples. @param {number[][]} x @param {number[][]} y @returns {Examples} */
export const examplesOf = (x, y) => ({ m: x.length, x: Float64Array.from(x.flat()), y: Float64Array.from(y.flat()) });

/** `log(1 + exp(z))` without overflow. */
export const softplus = (z) => Math.max(z, 0) + Math.log1p(Math.exp(-Math.abs(z)));

/** One example's place in each layer: activations and errors, kept from example to example. */
const scratch = (sizes) => ({
  a: sizes.map((units) => new Float64Array(units)),
  delta: sizes.map((units) => new Float64Array(units)),
  z: new Float64Array(sizes.at(-1)),
});

/** Forward propagation of the input in `a[0]`, Eq. (3.3). */
function forward({ sizes, weights, biases }, { a, z }) {
  const last = weights.length - 1;
  for (let l = 0; l <= last; l += 1) {
    const [inputs, outputs, w, b, below, above] = [sizes[l], sizes[l + 1], weights[l], biases[l], a[l], a[l + 1]];
    for (let i = 0, k = 0; i < outputs; i += 1) {
      let sum = b[i];
      for (let j = 0; j < inputs; j += 1, k += 1) sum += w[k] * below[j];
      if (l === last) z[i] = sum;
      above[i] = 1 / (1 + Math.exp(-sum));
    }
  }
}

/** The errors of every hidden layer from those of the output layer, Eq. (3.14). */
function backward({ sizes, weights }, { a, delta }) {
  for (let l = weights.length - 1; l > 0; l -= 1) {
    const [inputs, outputs, w, below, above, values] = [sizes[l], sizes[l + 1], weights[l], delta[l], delta[l + 1], a[l]];
    below.fill(0);
    for (let i = 0, k = 0; i < outputs; i += 1) {
      const error = above[i];
      for (let j = 0; j < inputs; j += 1, k += 1) below[j] += error * w[k];
    }
    for (let j = 0; j < inputs; j += 1) below[j] *= values[j] * (1 - values[j]);
  }
}

/** Adds `step` times one example's derivatives to weights and biases, Eqs. (3.15), (3.25) and (3.26). */
function add({ sizes, weights, biases }, { a, delta }, step) {
  for (let l = 0; l < weights.length; l += 1) {
    const [inputs, outputs, w, b, below, above] = [sizes[l], sizes[l + 1], weights[l], biases[l], a[l], delta[l + 1]];
    for (let i = 0, k = 0; i < outputs; i += 1) {
      const error = step * above[i];
      b[i] += error;
      for (let j = 0; j < inputs; j += 1, k += 1) w[k] += error * below[j];
    }
  }
}

/** One example's cost and its derivatives by the sums of the output layer. */
const ERRORS = {
  "squared-error": ({ a, delta }, y, at) => { // Eqs. (3.6) and (3.13)
    const [output, errors] = [a.at(-1), delta.at(-1)];
    let cost = 0;
    for (let i = 0; i < output.length; i += 1) {
      const error = output[i] - y[at + i];
      cost += (error * error) / 2;
      errors[i] = error * output[i] * (1 - output[i]);
    }
    return cost;
  },
  "cross-entropy": ({ a, z, delta }, y, at) => { // Eqs. (3.22) and (3.23)
    const [output, errors] = [a.at(-1), delta.at(-1)];
    let cost = 0;
    for (let i = 0; i < output.length; i += 1) {
      cost += softplus(z[i]) - y[at + i] * z[i];
      errors[i] = output[i] - y[at + i];
    }
    return cost;
  },
};

/**
 * A cost to minimise with its gradient: "squared-error", Eqs. (3.7) and (3.9), or "cross-entropy", Eqs. (3.22) and (3.27).
 * @param {string} kind
 * @param {number[]} sizes
 * @param {Examples} examples
 * @returns {Cost} `accuracy` is the fraction of examples that the network evaluated last answers as they are labelled
 */
export function costFunction(kind, sizes, { m, x, y }, regularisation = 0) {
  const [n, outputs, place, error] = [sizes[0], sizes.at(-1), scratch(sizes), ERRORS[kind]];
  const decay = kind === "cross-entropy" ? regularisation / m : regularisation;
  let right = 0;
  const answers = (z, at) => {
    if (outputs === 1) return z[0] > 0 === y[at] > 0.5;
    return largest(z) === largest(y.subarray(at, at + outputs));
  };
  /** The cost of these parameters; `gradient` gets its derivatives by them. */
  const evaluate = (parameters, gradient) => {
    const [network, slopes] = [flatNetwork(sizes, parameters), flatNetwork(sizes, gradient.fill(0))];
    let cost = 0;
    right = 0;
    for (let example = 0; example < m; example += 1) {
      for (let j = 0; j < n; j += 1) place.a[0][j] = x[example * n + j];
      forward(network, place);
      cost += error(place, y, example * outputs);
      if (answers(place.z, example * outputs)) right += 1;
      backward(network, place);
      add(slopes, place, 1);
    }
    let squares = 0;
    for (let k = 0; k < gradient.length; k += 1) gradient[k] /= m;
    network.weights.forEach((weights, l) => {
      for (let k = 0; k < weights.length; k += 1) {
        squares += weights[k] * weights[k];
        slopes.weights[l][k] += decay * weights[k];
      }
    });
    return cost / m + (decay / 2) * squares;
  };
  return { evaluate, accuracy: () => right / m };
}

/**
 * Batch gradient descent, Eq. (3.16): yields the cost and the accuracy before the first step and after each.
 * @param {Cost} cost
 * @param {Float64Array} parameters changed in place
 */
export function* gradientDescent(cost, parameters, { gradientStep, iterations }) {
  const gradient = new Float64Array(parameters.length);
  for (let iteration = 0; ; iteration += 1) {
    yield { cost: cost.evaluate(parameters, gradient), accuracy: cost.accuracy() };
    if (iteration === iterations) return;
    for (let k = 0; k < parameters.length; k += 1) parameters[k] -= gradientStep * gradient[k]; // Eq. (3.8)
  }
}

/**
 * A function that trains a network, in place, on pairs of input and target, one pair at a time, as
 * `robonav.nnql.train_on_pairs`: at most so many passes, until the mean cost changes by less than a tolerance.
 * @param {FlatNetwork} network
 * @returns {(inputs: ArrayLike<number>[], targets: ArrayLike<number>[], step: number, passes: number, tolerance: number) => number}
 *   gives the mean cost of the last pass
 */
export function trainOnPairs(network) {
  const place = scratch(network.sizes);
  return (inputs, targets, step, passes, tolerance) => {
    let previous = Infinity;
    for (let pass = 0; pass < passes; pass += 1) {
      let cost = 0;
      for (let pair = 0; pair < inputs.length; pair += 1) {
        place.a[0].set(inputs[pair]);
        forward(network, place);
        cost += ERRORS["cross-entropy"](place, targets[pair], 0) / inputs.length;
        backward(network, place);
        add(network, place, -step); // Eq. (4.12)
      }
      if (Math.abs(previous - cost) < tolerance) return cost;
      previous = cost;
    }
    return previous;
  };
}
