// Neural inverse reinforcement learning in the page: Algorithm 10, held to robonav/nirl/nirl.py. With the same seed it
// draws the same numbers. Needs simulator.js, learning/random.js, learning/network.js and learning/worlds.js.

/**
 * @typedef {{inputs: Float64Array[], actions: number[]}} Decisions what an expert sensed, encoded, and what it did
 * @typedef {{inputs: Float64Array[], actions: number[], next: number[], ends: number[], arrived: number, collided: number}} Rollout
 *   decisions of some episodes one after the other; `next`: index of the next decision of the same episode, or -1;
 *   `ends`: the terminal value of the decision's episode
 * @typedef {{iterations: number, hidden: number, inverseTemperature: number, discount: number, learningRate: number,
 *   gradientStep: number[], samples: number, replay: number, episodes: number, obstacles: number, moving: number,
 *   speed: number, maxSteps: number, encoder: Encoder, actions: number}} NIRLSettings
 */

/** The defaults of `robonav.nirl.nirl`, `ReplaySGD` and `RobotTask`. @type {NIRLSettings} */
export const NIRL_SETTINGS = {
  iterations: 140, hidden: 10, inverseTemperature: 25, discount: 0.65, learningRate: 0.8, gradientStep: [0.4, 0.1],
  samples: 9600, replay: 20, episodes: 10, obstacles: 20, moving: 0, speed: 2, maxSteps: 200, actions: 5,
  encoder: { sensors: [1, 2, 3, 4, 7, 8, 9], walls: true, target: "sine-cosine" },
};

/** Steps of demonstrations as decisions. @param {{sensing: Sensing, action: number}[]} steps @returns {Decisions} */
export const decisionsOf = (steps, { encoder }) => ({
  inputs: steps.map(({ sensing }) => Float64Array.from(encode(encoder, sensing))),
  actions: steps.map(({ action }) => action),
});

const TIE = 1e-12; // how far apart rounding brings two balanced accuracies that are equal; the first of them is kept

/** Boltzmann policy, Eq. (5.10). @param {ArrayLike<number>} values */
export const boltzmannPolicy = (values, inverseTemperature) => softmax(values.map((value) => inverseTemperature * value));

const PIECE = 1000; // steps of the descent, or draws, after which the page may answer

const outputsOf = (network, input) => propagate(network, input).activations.at(-1);

/**
 * Step 4: some episodes in new maps with the exploring policy, all robots one second at a time. Returns a Rollout, and yields
 * nothing after each second, where the page may answer.
 */
function* rolloutEpisodes(network, settings, rng) {
  const { episodes, obstacles, moving, speed, maxSteps, encoder, inverseTemperature } = settings;
  const worlds = randomWorlds(episodes, { seed: rng.raw() >> 1n, obstacles, moving }); // Python's integers(2**63)
  const robots = worlds.map((world) => ({ world, pose: startPose(world), outcome: "running", decisions: [] }));
  robots.forEach((robot) => (robot.sensing = sense(robot.world, robot.pose)));
  for (let step = 0; step < maxSteps && robots.some(({ outcome }) => outcome === "running"); step += 1) {
    const running = robots.filter(({ outcome }) => outcome === "running");
    running.forEach((robot) => (robot.action = reflex(robot.sensing, speed)));
    const asked = running.filter(({ action }) => action < 0);
    const draws = rng.uniform(0, 1, asked.length);
    asked.forEach((robot, i) => {
      const input = Float64Array.from(encode(encoder, robot.sensing));
      robot.action = sampleAction(boltzmannPolicy(outputsOf(network, input), inverseTemperature), draws[i]);
      robot.decisions.push({ input, action: robot.action });
    });
    running.forEach((robot) => {
      Object.assign(robot, advance(robot.world, robot.pose, step, robot.action, speed));
      robot.sensing = sense(robot.world, robot.pose);
    });
    yield;
  }
  const rollout = { inputs: [], actions: [], next: [], ends: [], arrived: 0, collided: 0 };
  for (const { decisions, outcome } of robots) {
    decisions.forEach(({ input, action }, k) => {
      rollout.next.push(k + 1 < decisions.length ? rollout.next.length + 1 : -1);
      rollout.inputs.push(input);
      rollout.actions.push(action);
      rollout.ends.push(outcome === "collided" ? 0 : 1); // the survival bonus
    });
    if (outcome in rollout) rollout[outcome] += 1 / episodes;
  }
  return rollout;
}

/** Several rollouts as one. @param {Rollout[]} parts @returns {Rollout} */
function concatenated(parts) {
  const whole = { inputs: [], actions: [], next: [], ends: [] };
  for (const { inputs, actions, next, ends } of parts) {
    const offset = whole.inputs.length;
    inputs.forEach((input, k) => {
      whole.inputs.push(input);
      whole.actions.push(actions[k]);
      whole.next.push(next[k] < 0 ? -1 : next[k] + offset);
      whole.ends.push(ends[k]);
    });
  }
  return whole;
}

/** Weights of decisions, with sum 1: the less often an action occurs, the more each of its decisions weighs. */
export function inverseFrequencyWeights(actions, count) {
  const times = new Array(count).fill(0);
  actions.forEach((action) => (times[action] += 1));
  const weights = actions.map((action) => actions.length / times[action]);
  const sum = weights.reduce((total, weight) => total + weight, 0);
  return weights.map((weight) => weight / sum);
}

/** The expert's features minus the policy's in the same states, theta's row after row. @param {Decisions} expert */
function featureGap({ inputs, actions }, probabilities, weights, count) {
  const width = inputs[0].length + 1;
  const gap = new Float64Array(count * width);
  inputs.forEach((input, t) => {
    for (let a = 0; a < count; a += 1) {
      const difference = weights[t] * ((a === actions[t] ? 1 : 0) - probabilities[t][a]);
      for (let j = 0; j < width; j += 1) gap[a * width + j] += difference * (j < width - 1 ? input[j] : 1);
    }
  });
  return gap;
}

/** theta, shortened to length 1 if it is longer. */
function inUnitBall(theta) {
  const length = Math.hypot(...theta);
  return length > 1 ? theta.map((value) => value / length) : theta;
}

/** The reward theta . f(s, a), Eq. (5.2). */
export function rewardAt(theta, input, action) {
  const width = input.length + 1;
  let sum = theta[action * width + width - 1];
  for (let j = 0; j < width - 1; j += 1) sum += theta[action * width + j] * input[j];
  return sum;
}

/** Rewards in [0, 1]: divided by the 95th percentile of their size, clipped and shifted. */
function scaledToUnitInterval(rewards) {
  const sizes = Float64Array.from(rewards, Math.abs).sort();
  const place = 0.95 * (sizes.length - 1);
  const [low, high] = [sizes[Math.floor(place)], sizes[Math.ceil(place)]];
  const scale = low + (high - low) * (place - Math.floor(place));
  return rewards.map((reward) => (scale > 0 ? (clamp(reward / scale, -1, 1) + 1) / 2 : 0.5));
}

/**
 * Steps 9 and 10: stochastic gradient descent with a SARSA target, Eq. (5.16), for one decision at a time. Yields nothing now
 * and then, where the page may answer.
 * @param {FlatNetwork} network one hidden layer; changed in place
 * @param {Rollout} decisions
 * @returns {Generator<undefined, number>} the mean cost of the outputs before their steps
 */
function* sarsaDescent({ sizes: [width, units], weights: [w1, w2], biases: [b1, b2] }, { inputs, actions, next, ends }, rewards, order, { learningRate, discount }, step) {
  const hidden = new Float64Array(units);
  const logit = (input, action) => {
    let z = b2[action];
    for (let i = 0; i < units; i += 1) {
      let sum = b1[i];
      for (let j = 0; j < width; j += 1) sum += w1[i * width + j] * input[j];
      hidden[i] = sigmoid(sum);
      z += w2[action * units + i] * hidden[i];
    }
    return z;
  };
  let cost = 0;
  for (const [done, t] of order.entries()) {
    if (done % PIECE === 0) yield;
    const future = next[t] >= 0 ? sigmoid(logit(inputs[next[t]], actions[next[t]])) : ends[t];
    const [input, a] = [inputs[t], actions[t]];
    const z = logit(input, a);
    const q = sigmoid(z);
    const target = clamp(q + learningRate * (rewards[t] + discount * future - q), 0, 1);
    cost += softplus(z) - target * z;
    const slope = step * (q - target);
    for (let i = 0; i < units; i += 1) {
      const back = slope * w2[a * units + i] * hidden[i] * (1 - hidden[i]);
      w2[a * units + i] -= slope * hidden[i];
      b1[i] -= back;
      for (let j = 0; j < width; j += 1) w1[i * width + j] -= back * input[j];
    }
    b2[a] -= slope;
  }
  return cost / order.length;
}

/** The outputs of a network with one hidden layer in many states, and the action whose sum is largest in each. */
function answersIn({ sizes: [width, units, count], weights: [w1, w2], biases: [b1, b2] }, inputs) {
  const hidden = new Float64Array(units);
  const values = inputs.map(() => new Float64Array(count));
  const greedy = inputs.map((input, t) => {
    for (let i = 0; i < units; i += 1) {
      let sum = b1[i];
      for (let j = 0; j < width; j += 1) sum += w1[i * width + j] * input[j];
      hidden[i] = 1 / (1 + Math.exp(-sum));
    }
    let [best, highest] = [0, -Infinity];
    for (let a = 0; a < count; a += 1) {
      let z = b2[a];
      for (let i = 0; i < units; i += 1) z += w2[a * units + i] * hidden[i];
      values[t][a] = 1 / (1 + Math.exp(-z));
      if (z > highest) [best, highest] = [a, z];
    }
    return best;
  });
  return { values, greedy };
}

/** How well greedy actions predict the expert's, every action weighing the same. */
const balancedAccuracy = (greedy, actions, weights) => greedy.reduce((sum, action, t) => sum + (action === actions[t] ? weights[t] : 0), 0);

/**
 * Algorithm 10: yields what each iteration found, and returns the policy that predicts the expert best. Within an iteration
 * it yields nothing now and then, where a page without a worker may answer.
 * With `reward` it learns no reward and improves the policy under that one.
 * @param {Decisions} expert
 * @param {NIRLSettings} settings
 * @param {number} seed
 * @param {Float64Array | null} reward theta of a reward learned elsewhere
 */
export function* nirl(expert, settings, seed, reward = null) {
  const { iterations, hidden, inverseTemperature, discount, gradientStep, samples, replay, actions } = settings;
  const rng = defaultRng(seed);
  const width = expert.inputs[0].length;
  const network = randomNetwork([width, hidden, actions], rng); // 1
  const balance = inverseFrequencyWeights(expert.actions, actions);
  const episodes = [];
  let theta = new Float64Array(actions * (width + 1));
  let answers = answersIn(network, expert.inputs);
  let best = { network: flattened(network), theta, balanced: balancedAccuracy(answers.greedy, expert.actions, balance), iteration: 0 };
  for (let iteration = 1; iteration <= iterations; iteration += 1) { // 2, 3, 11
    const rollout = yield* rolloutEpisodes(network, settings, rng); // 4
    episodes.push(rollout);
    const probabilities = answers.values.map((values) => boltzmannPolicy(values, inverseTemperature));
    const gap = featureGap(expert, probabilities, balance, actions);
    theta = reward ?? theta.map((value, k) => value + gap[k] / Math.sqrt(iteration)); // 5
    const weights = inUnitBall(theta);
    const margin = weights.reduce((sum, value, k) => sum + value * gap[k], 0); // 6
    const recent = concatenated(episodes.slice(-replay));
    let cost = NaN;
    if (recent.inputs.length > 0) {
      const rewards = scaledToUnitInterval(recent.inputs.map((input, t) => rewardAt(weights, input, recent.actions[t])));
      yield;
      const order = [];
      while (order.length < samples) {
        order.push(rng.integers(0, recent.inputs.length));
        if (order.length % PIECE === 0) yield;
      }
      const fraction = (iteration - 1) / Math.max(iterations - 1, 1);
      const step = gradientStep[0] * (gradientStep[1] / gradientStep[0]) ** fraction;
      cost = yield* sarsaDescent(network, recent, rewards.map((r) => (1 - discount) * r), order, settings, step); // 9, 10
    }
    answers = answersIn(network, expert.inputs);
    const balanced = balancedAccuracy(answers.greedy, expert.actions, balance);
    if (balanced > best.balanced + TIE) best = { network: flattened(network), theta: weights, balanced, iteration };
    yield { iteration, iterations, margin, cost, balanced, arrived: rollout.arrived, collided: rollout.collided, theta: weights };
  }
  return best;
}
