// Policies tried in maps: one episode, many episodes, and the interval of a rate. Needs simulator.js and learning/worlds.js.

/**
 * @typedef {{rule?: string, network?: Network, encoder?: Encoder, temperature?: number}} Policy
 * @typedef {{obstacles: number, moving?: number, speed: number, noise?: number, slip?: number[][] | null, maxSteps?: number, direction?: "exact" | "sector"}} Conditions
 */

/** What a policy does with what it senses. @param {Policy} policy @returns {number} */
function actionOf(policy, sensing, world, step) {
  if (policy.rule) return RULES[policy.rule](sensing);
  return consult(policy, sensing, gumbel(world.key, step)).action;
}

/**
 * One episode of a policy in a world, Algorithm 9.
 * @param {Policy} policy
 * @param {World} first
 * @param {Conditions} conditions
 */
export function rollout(policy, first, { speed, noise = 0, slip = null, maxSteps = 500, direction = ROBOT.direction }) {
  let [world, pose, outcome] = [first, startPose(first), "running"];
  const poses = [pose];
  for (let step = 0; step < maxSteps && outcome === "running"; step += 1) {
    const sensing = sense(world, pose, noise, step);
    const own = reflex(sensing, speed, direction);
    const action = own < 0 ? actionOf(policy, sensing, world, step) : own;
    ({ world, pose, outcome } = advance(world, pose, step, action, speed, slip));
    poses.push(pose);
  }
  return { poses, outcome: outcome === "running" ? "out of steps" : outcome };
}

/**
 * A job: several policies in the same new maps; yields how many of each arrived so far.
 * @param {{policies: Policy[], seed: number, count: number, conditions: Conditions}} argument
 */
export function* trialsJob({ policies, seed, count, conditions }) {
  const arrived = policies.map(() => 0);
  for (const [i, world] of randomWorlds(count, { seed, ...conditions }).entries()) {
    policies.forEach((policy, k) => (arrived[k] += rollout(policy, world, conditions).outcome === "arrived" ? 1 : 0));
    yield { done: i + 1, total: count, live: { at: i + 1, arrived: [...arrived] } };
  }
  return arrived;
}

/** Wilson's 95 % interval of a rate, in [0, 1] (Wilson 1927). */
export function wilsonInterval(successes, n) {
  const z = 1.959963984540054;
  const [rate, spread] = [successes / n, (z * z) / n];
  const middle = (rate + spread / 2) / (1 + spread);
  const half = (z / (1 + spread)) * Math.sqrt((rate * (1 - rate)) / n + spread / (4 * n));
  return [Math.max(0, middle - half), Math.min(1, middle + half)];
}
