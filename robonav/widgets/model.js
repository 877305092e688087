// A small decision process in the page, and the sums over it that planners make.

/**
 * @typedef {{states: number, actions: number, probabilities: (state: number, action: number) => number[][], reward: (state: number, action: number) => number}} Model
 *   probabilities: the states that may follow, each with its probability
 */

/** The model as Python's `page_model` packs it. @returns {Model} */
export function modelOf({ transitions, rewards }) {
  const [{ shape: [actions, states], values }, { values: means }] = [unpack(transitions), unpack(rewards)];
  const probabilities = Array.from({ length: actions }, (_, a) =>
    Array.from({ length: states }, (__, s) => {
      const row = values.subarray((a * states + s) * states, (a * states + s + 1) * states);
      return [...row].map((p, next) => [next, p]).filter(([, p]) => p > 0);
    }));
  return { states, actions, probabilities: (s, a) => probabilities[a][s], reward: (s, a) => means[s * actions + a] };
}

/** Eq. (2.15): the mean reward, and the discounted mean of the values that may follow. @param {Model} model */
export const actionValue = (model, discount, values, s, a) =>
  model.reward(s, a) + discount * model.probabilities(s, a).reduce((sum, [next, p]) => sum + p * values[next], 0);

/** The values of all actions in a state. @param {Model} model */
export const actionValues = (model, discount, values, s) =>
  Array.from({ length: model.actions }, (_, a) => actionValue(model, discount, values, s, a));

/** One sweep of evaluation, Eq. (2.24). @param {Model} model */
export const evaluationSweep = (model, discount, values, policy) =>
  values.map((_, s) => actionValue(model, discount, values, s, policy[s]));

/** One sweep of value iteration, Eq. (2.26). @param {Model} model */
export const optimalitySweep = (model, discount, values) => values.map((_, s) => Math.max(...actionValues(model, discount, values, s)));

/** The policy that is greedy for some values, Eq. (2.25): it keeps an action unless another one is truly better. @param {Model} model */
export const greedy = (model, discount, values, policy) =>
  policy.map((own, s) => {
    const q = actionValues(model, discount, values, s);
    return q[own] >= Math.max(...q) - 1e-9 ? own : largest(q);
  });

/** The values of a policy, by sweeps until nothing changes. @param {Model} model */
export function valuesOf(model, discount, policy, sweeps = 20_000) {
  let values = new Array(model.states).fill(0);
  for (let k = 0; k < sweeps; k += 1) {
    const next = evaluationSweep(model, discount, values, policy);
    const change = Math.max(...next.map((value, s) => Math.abs(value - values[s])));
    values = next;
    if (change < 1e-13) break;
  }
  return values;
}
