// Neural-network Q-learning in the page: Algorithm 8 and its online form, as robonav/nnql/nnql.py has them; DQN is in dqn.js.
//
// With the same seed these functions draw the same numbers as Python's and compute the same Q-values, up to rounding:
// exponentials differ in their last bit from machine to machine. Learning magnifies such a difference, until a robot
// chooses another action; from there on the two trainings differ, and only their success over many seeds agrees.

/**
 * @typedef {[number, number]} Schedule a quantity's value in the first episode and in the last
 * @typedef {object} LearningSettings
 * @property {"nnql" | "online" | "dqn"} method
 * @property {number} obstacles
 * @property {number} moving
 * @property {number} speed in m/s
 * @property {number} maxSteps
 * @property {number[]} rewards one for each row of Table 4.1
 * @property {boolean} mustMoveAway whether evading is rewarded only if the nearest thing is farther away than before
 * @property {"number" | "signed" | "one-hot" | "sine-cosine" | "raw"} inputs how the target's sector is encoded; raw: the numbers of Eq. (4.5) as they are
 * @property {number} hidden
 * @property {number} episodes
 * @property {Schedule} learningRate alpha
 * @property {number} discount gamma
 * @property {Schedule} gradientStep sigma
 * @property {Schedule} temperature T
 * @property {"shift" | "clip"} rescale
 * @property {number} passes
 * @property {number} tolerance
 * @property {number} seed
 */

const LEARNED_ACTIONS = 5;
const [INITIAL, EXPLORING, WORLDS] = [0, 1, 2]; // what a seed's random numbers are for, as in robonav/nnql/task.py
export const NNQL_ENDS = { starts: [[10, 10], [90, 10]], targets: [[90, 90], [10, 90]] };

// ---- Reward: Table 4.1 ----------------------------------------------------------------------------------------------

const COZY_DISTANCE = 5; // metres
const [SAFE, COZY, DANGEROUS] = [0, 1, 2];
const EVADING = [6, 9]; // rows that reward staying away

const nearestOf = ({ ranges }) => Math.min(...ranges);

/** The property of a state in which the robot goes on, Eq. (4.6). */
export const propertyAt = (nearest) => (nearest < COZY_DISTANCE ? DANGEROUS : nearest < ROBOT.range ? COZY : SAFE);

/** Which row of Table 4.1 holds for a step. @param {Sensing} before @param {Sensing} after @param {string} outcome */
export function rewardRow(before, after, outcome) {
  if (outcome === "arrived") return 0;
  if (outcome === "collided") return 1;
  const [distanceBefore, distanceAfter] = [nearestOf(before), nearestOf(after)];
  const [was, now] = [propertyAt(distanceBefore), propertyAt(distanceAfter)];
  const nearer = clamp(Math.floor(distanceBefore - distanceAfter), 0, 3); // whole metres
  if (now === SAFE) return 2;
  if (was === SAFE) return 3;
  if (was === DANGEROUS && now === COZY) return 4;
  if (was === COZY && now === DANGEROUS) return 5;
  return was === COZY ? 6 + Math.min(nearer, 2) : 9 + nearer;
}

/** The reward of a step. @param {LearningSettings} settings */
export function rewardOf({ rewards, mustMoveAway }, before, after, outcome) {
  const row = rewardRow(before, after, outcome);
  return mustMoveAway && EVADING.includes(row) && nearestOf(after) <= nearestOf(before) ? 0 : rewards[row];
}

// ---- The steps of Algorithm 8 ---------------------------------------------------------------------------------------

/** A quantity that is multiplied by the same factor each episode. @param {Schedule} schedule */
export const geometricSchedule = ([start, end], fraction) => start * (end / start) ** fraction;

/** The probabilities of the actions, Eq. (4.7). */
export function softmaxPolicy(q, temperature) {
  const best = Math.max(...q);
  return softmax(q.map((value) => (value - best) / temperature));
}

/** Q-values after one update of the action taken, Eq. (4.9). */
export function qTargets(q, action, reward, nextValue, learningRate, discount) {
  const targets = Float64Array.from(q);
  targets[action] += learningRate * (reward + discount * nextValue - targets[action]);
  return targets;
}

/** Two readings of the thesis's "rescale". */
export const RESCALE = {
  clip: (q) => q.map((value) => clamp(value, 0, 1)),
  shift: (q) => {
    const [low, high] = [Math.min(...q, 0), Math.max(...q, 1)];
    return q.map((value) => (value - low) / (high - low));
  },
};

const NNQL_SENSORS = [1, 2, 3, 4, 7, 8, 9];

/** What the network reads, as an encoder. @param {LearningSettings} settings */
export const encoderOf = ({ inputs }) => ({ sensors: NNQL_SENSORS, walls: true, target: inputs === "raw" ? "number" : inputs, raw: inputs === "raw" });

/** The network's inputs. @param {Encoder} encoder */
export const inputsFor = (encoder, sensing) => Float64Array.from(encode(encoder, sensing));

/** The network that training starts from, drawn as robonav.nnql.q_network draws it. @param {LearningSettings} settings */
export function firstNetwork({ inputs, hidden, seed }) {
  const read = 2 * NNQL_SENSORS.length + 1 + (inputs === "raw" ? 1 : TARGETS[inputs](1).length);
  return randomNetwork([read, hidden, LEARNED_ACTIONS], defaultRng([seed, INITIAL]));
}

/** A function that gives the worlds of a training by episode, as robonav.nnql.NavigationTask.worlds. @param {LearningSettings} settings */
export function trainingWorlds({ seed, episodes, obstacles, moving }) {
  const own = defaultRng([seed, WORLDS]).raw() >> 1n; // as integers(2**63)
  const keys = worldKeysOf(episodes, own);
  return (episode) => drawWorld(keys[episode], { obstacles, moving, ...NNQL_ENDS });
}

// ---- Algorithm 8 ----------------------------------------------------------------------------------------------------

/** By how much the weights of each layer changed, biases included: summed, and summed without their signs (Fig. 4.3). */
export function weightChanges(before, after) {
  return after.weights.map((_, l) => {
    let [signed, absolute] = [0, 0];
    for (const part of ["weights", "biases"]) {
      after[part][l].forEach((value, i) => {
        signed += value - before[part][l][i];
        absolute += Math.abs(value - before[part][l][i]);
      });
    }
    return { signed, absolute };
  });
}

/**
 * What learns in {@link neuralQLearning}: Q-values of a state, what to do at the start of an episode, and learning from a step.
 * @typedef {{state: Float64Array, q: Float64Array, action: number, reward: number, next: Float64Array, terminal: boolean}} Decision
 * What the latest update learned from: pairs of input and target, or the gradient itself.
 * @typedef {{inputs?: Float64Array[], targets?: Float64Array[], gradient?: Float64Array}} Learned
 * `outside` is the share of the episode's targets that were not in [0, 1] before they were rescaled, or null where none are.
 * @typedef {{values: (state: Float64Array) => Float64Array, begin: (episode: number, fraction: number) => void, learn: (decision: Decision) => Learned, outside?: () => number | null}} Learner
 */

/** NNQL, or with the latest pair alone its online form. @param {LearningSettings} settings @returns {Learner} */
function nnqlLearner(settings, network) {
  const { discount, passes, tolerance } = settings;
  const [descend, rescale] = [trainOnPairs(network), RESCALE[settings.rescale]];
  let [inputs, targets, alpha, sigma, updates, beyond] = [[], [], 0, 0, 0, 0];
  const values = (state) => propagate(network, state).activations.at(-1);
  return {
    values,
    begin: (episode, fraction) => {
      [inputs, targets, updates, beyond] = [[], [], 0, 0]; // 6
      [alpha, sigma] = [geometricSchedule(settings.learningRate, fraction), geometricSchedule(settings.gradientStep, fraction)];
    },
    learn: ({ state, q, action, reward, next, terminal }) => {
      const future = terminal ? 0 : Math.max(...values(next));
      const target = qTargets(q, action, reward, future, alpha, discount); // 13
      [updates, beyond] = [updates + 1, beyond + (target[action] < 0 || target[action] > 1 ? 1 : 0)];
      if (settings.method === "online") [inputs, targets] = [[], []]; // the latest pair alone
      inputs.push(state); // 15
      targets.push(rescale(target)); // 14, 15
      descend(inputs, targets, sigma, passes, tolerance); // 16
      return { inputs, targets };
    },
    outside: () => (updates > 0 ? beyond / updates : null),
  };
}

/** What makes a learner of each method; learning/dqn.js adds its own. */
const LEARNERS = { nnql: nnqlLearner, online: nnqlLearner };

/**
 * Neural-network Q-learning (NNQL), Algorithm 8, or another method in its loop.
 *
 * Yields after each episode what happened in it, and nothing after each update, where a page without a worker may answer. With
 * `watch`, that function is called after each update of the network. With `start`, the training begins with the weights of a
 * robot, and the network reads what that robot reads.
 * @param {LearningSettings} settings
 * @param {{watch?: (update: {q: Float64Array, network: Network} & Learned) => void, start?: {network: Network, encoder: Encoder} | null}} options
 */
export function* neuralQLearning(settings, { watch = () => {}, start = null } = {}) {
  const { episodes, speed, maxSteps, seed } = settings;
  const encoder = start?.encoder ?? encoderOf(settings);
  const [network, worldOf] = [start ? flattened(start.network) : firstNetwork(settings), trainingWorlds(settings)];
  const learner = LEARNERS[settings.method](settings, network);
  for (let episode = 0; episode < episodes; episode += 1) { // 2
    const fraction = episode / Math.max(episodes - 1, 1);
    const [temperature, rng] = [geometricSchedule(settings.temperature, fraction), defaultRng([seed, EXPLORING, episode])];
    const first = worldOf(episode); // 3
    let [world, pose, step, outcome] = [first, startPose(first), 0, "running"]; // 4
    let sensing = sense(world, pose); // 5
    let state = inputsFor(encoder, sensing);
    learner.begin(episode, fraction);
    const [before, path] = [flattened(network), [[pose.x, pose.y]]];
    while (outcome === "running" && step < maxSteps) { // 8
      const q = learner.values(state); // 9
      let action = sampleAction(softmaxPolicy(q, temperature), rng.random()); // 10
      const own = reflex(sensing, speed, settings.direction);
      if (own >= 0) action = own;
      ({ world, pose, outcome } = advance(world, pose, step, action, speed)); // 11
      const reached = sense(world, pose);
      const next = inputsFor(encoder, reached);
      if (own < 0) { // in a safe state the reflex acts
        const reward = rewardOf(settings, sensing, reached, outcome); // 12
        const learned = learner.learn({ state, q, action, reward, next, terminal: outcome !== "running" });
        watch({ q, network, ...learned });
        yield;
      }
      [sensing, state, step] = [reached, next, step + 1];
      path.push([pose.x, pose.y]);
    } // 17 to 20
    yield { episode, world: first, path, outcome: outcome === "running" ? "out of steps" : outcome, changes: weightChanges(before, network), outside: learner.outside?.() ?? null, network };
  }
}
