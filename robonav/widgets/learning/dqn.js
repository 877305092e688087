// Double DQN in the page, as robonav/nnql/dqn.py has it: replay, a target network, the Huber loss and Adam. Needs nnql.js.

const REPLAYING = 3; // what a seed's random numbers are for, as in robonav/nnql/task.py
const [BATCH, COPY_EVERY] = [32, 1000]; // transitions of an update, and updates between two target networks

/** Adam (Kingma and Ba 2015), as torch.optim.Adam; gives the function that makes a step. @param {Float64Array} parameters changed in place */
export function adam(parameters, step) {
  const [a, b, small] = [0.9, 0.999, 1e-8];
  const [first, second] = [new Float64Array(parameters.length), new Float64Array(parameters.length)];
  let number = 0;
  return (gradient) => {
    number += 1;
    const [size, root] = [step / (1 - a ** number), Math.sqrt(1 - b ** number)];
    for (let k = 0; k < parameters.length; k += 1) {
      first[k] += (1 - a) * (gradient[k] - first[k]);
      second[k] = b * second[k] + (1 - b) * gradient[k] * gradient[k];
      parameters[k] -= (size * first[k]) / (Math.sqrt(second[k]) / root + small);
    }
  };
}

/** Double DQN with linear outputs. @param {LearningSettings} settings @param {FlatNetwork} network @returns {Learner} */
function dqnLearner({ seed, discount, gradientStep }, network) {
  const [target, gradient, place] = [flattened(network), flatNetwork(network.sizes), scratch(network.sizes)];
  const [descend, buffer] = [adam(network.parameters, gradientStep[0]), []];
  let [rng, updates] = [null, 0];
  const values = (state) => propagate(network, state).z;
  /** Adds the derivatives of one transition's Huber loss, divided by the size of the batch. */
  const learnFrom = ({ state, action, reward, next, terminal }) => {
    const future = terminal ? 0 : propagate(target, next).z[largest(values(next))];
    place.a[0].set(state);
    forward(network, place);
    place.delta.at(-1).fill(0);
    place.delta.at(-1)[action] = clamp(place.z[action] - (reward + discount * future), -1, 1) / BATCH;
    backward(network, place);
    add(gradient, place, 1);
  };
  return {
    values,
    begin: (episode) => (rng = defaultRng([seed, REPLAYING, episode])),
    learn: (decision) => {
      buffer.push(decision);
      gradient.parameters.fill(0);
      if (buffer.length < BATCH) return { gradient: gradient.parameters };
      const drawn = Array.from({ length: BATCH }, () => rng.integers(0, buffer.length));
      for (const k of drawn) learnFrom(buffer[k]);
      descend(gradient.parameters);
      updates += 1;
      if (updates % COPY_EVERY === 0) target.parameters.set(network.parameters);
      return { gradient: gradient.parameters };
    },
  };
}
LEARNERS.dqn = dqnLearner;
