// SARSA and Q-learning beside a cliff, learned in the page: the path depends on how much is explored.

const [EPISODES, RATE, LONGEST, ROBOTS] = [1500, 0.1, 200, 10];

/** An action: any of them with probability epsilon, otherwise one of the best. */
function epsilonGreedy(values, epsilon, random) {
  if (random() < epsilon) return Math.floor(values.length * random());
  const best = Math.max(...values);
  const ties = [...values.keys()].filter((a) => values[a] === best);
  return ties.length === 1 ? ties[0] : ties[Math.floor(ties.length * random())];
}

/**
 * Learn for some episodes, without a discount: Q-learning, Algorithm 5, Eq. (2.29), or SARSA, Algorithm 6, Eq. (2.30).
 * With the same random numbers robonav.mdp.q_learning and robonav.mdp.sarsa learn the same.
 */
export function learnOnCliff({ moves, rewards, ends, begin }, method, { epsilon, episodes = EPISODES, seed }) {
  const random = numbersFrom(seed);
  const q = moves.map(() => [0, 0, 0, 0]);
  const choose = (s) => epsilonGreedy(q[s], epsilon, random);
  for (let episode = 0; episode < episodes; episode += 1) {
    let [s, chosen] = [begin, null]; // SARSA chooses its next action before it learns, Q-learning afterwards
    for (let step = 0; step < LONGEST && !ends[s]; step += 1) {
      const a = chosen ?? choose(s);
      const next = moves[s][a];
      chosen = method === "SARSA" ? choose(next) : null;
      const future = ends[next] ? 0 : method === "SARSA" ? q[next][chosen] : Math.max(...q[next]);
      q[s][a] += RATE * (rewards[next] + future - q[s][a]);
      s = next;
    }
  }
  return q;
}

/** The mean of what ten robots learn, each with a seed of its own, so that the luck of one does not decide. */
export function learnTogether(given, method, { epsilon, episodes, seed }) {
  const all = Array.from({ length: ROBOTS }, (_, k) => learnOnCliff(given, method, { epsilon, episodes, seed: seed * ROBOTS + k }));
  return all[0].map((row, s) => row.map((_, a) => all.reduce((sum, q) => sum + q[s][a], 0) / ROBOTS));
}

/** The best action in each cell; of equal ones, the first that leads to another cell. */
export function bestActions({ moves }, q) {
  return q.map((values, s) => {
    const ties = [...values.keys()].filter((a) => values[a] >= Math.max(...values) - 1e-9);
    return ties.find((a) => moves[s][a] !== s) ?? ties[0];
  });
}

/** Where the best actions lead from the start. */
export function greedyTrajectory({ moves, ends, begin }, q) {
  const [trajectory, best] = [[begin], bestActions({ moves }, q)];
  while (!ends[trajectory.at(-1)] && trajectory.length < 30) trajectory.push(moves[trajectory.at(-1)][best[trajectory.at(-1)]]);
  return trajectory;
}

export default explorable({
  controls: ({ begin }) => ({
    epsilon: range({ label: "random actions, ε", from: 0, to: 0.5, step: 0.05, value: 0, text: (value) => value.toFixed(2) }),
    episodes: range({ label: "episodes", from: 0, to: EPISODES, step: 50, value: 1000 }),
    again: press({ label: "Learn again with other seeds", act: (state) => (state.seed += 1) }),
  }),
  start: () => ({ seed: 1 }),
  draw({ given, stage }) {
    const methods = ["Q-learning", "SARSA"];
    const grids = methods.map((name) => gridPicture({ layout: given.layout, name, write: (value) => number(value, Math.abs(value) < 9.95 ? 1 : 0) }));
    const captions = methods.map(() => h("p", { class: "told" }));
    stage.append(h("div", { class: "row" }, ...methods.map((name, k) => h("figure", { class: "half" }, h("figcaption", {}, name), grids[k].element, captions[k]))));
    const top = given.layout.rows.length - 2; // rows above the cliff's edge
    const away = (trajectory) => top - Math.min(...trajectory.map((s) => given.layout.cells[s][0]));
    const said = (rows) => ["along the edge", "one row away from the edge", "along the far wall"][rows] ?? `${rows} rows away`;
    return ({ epsilon, episodes, seed }) => {
      const trajectories = methods.map((method, k) => {
        const q = learnTogether(given, method, { epsilon, episodes, seed });
        const trajectory = greedyTrajectory(given, q);
        grids[k].show({ values: q.map((row) => Math.max(...row)), policy: bestActions(given, q), said: "learned values", trajectory }, 20, -1);
        const arrived = given.layout.rows[given.layout.cells[trajectory.at(-1)][0]][given.layout.cells[trajectory.at(-1)][1]] === "G";
        captions[k].textContent = !arrived ? "Without exploring, this path does not reach G." : `Without exploring, this path takes ${trajectory.length - 1} steps.`;
        return arrived ? said(away(trajectory)) : null;
      });
      const best = given.best[Math.round(epsilon / 0.05)];
      return [
        ...methods.map((name, k) => trajectories[k] ? `${name}'s path leads ${trajectories[k]}.` : `${name}'s path does not lead to G yet.`),
        `Values and paths are the mean of ${ROBOTS} robots after ${episodes} episodes each.`, "",
        `For a robot that explores with ε = ${epsilon.toFixed(2)} the best path leads ${said(best.rows)}, with an expected return of ${number(best.value, 1)}.`,
      ].join("\n");
    };
  },
});
