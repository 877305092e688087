// SARSA and Q-learning beside a cliff, learned in the page: the path depends on how much is explored.

const [EPISODES, RATE, LONGEST, ROBOTS] = [1500, 0.1, 200, 10];

/** The update of one step: Eq. (2.30) for SARSA, Eq. (2.29) for Q-learning, which takes the best next action. */
export function updated(q, { s, a, reward, next, nextAction, ended }, method, rate) {
  const future = ended ? 0 : method === "SARSA" ? q[next][nextAction] : Math.max(...q[next]);
  return q[s][a] + rate * (reward + future - q[s][a]);
}

/** Learn for some episodes, without a discount; `seen` hears of every step. */
export function learnOnCliff({ moves, rewards, ends, begin }, method, { epsilon, episodes = EPISODES, seed, seen = () => {} }) {
  const random = numbersFrom(seed);
  const q = moves.map(() => [0, 0, 0, 0]);
  const choose = (s) => {
    if (random() < epsilon) return Math.floor(4 * random());
    const best = Math.max(...q[s]);
    const ties = [0, 1, 2, 3].filter((a) => q[s][a] === best);
    return ties[Math.floor(ties.length * random())];
  };
  for (let episode = 0; episode < episodes; episode += 1) {
    let [s, a] = [begin, choose(begin)];
    for (let step = 0; step < LONGEST; step += 1) {
      const next = moves[s][a];
      const ended = ends[next];
      const nextAction = ended ? 0 : choose(next);
      const transition = { s, a, reward: rewards[next], next, nextAction, ended };
      seen(transition);
      q[s][a] = updated(q, transition, method, RATE);
      if (ended) break;
      [s, a] = [next, nextAction];
    }
  }
  return q;
}

/** The mean of what ten robots learn, each with a seed of its own, so that the luck of one does not decide. */
export function learnTogether(given, method, { epsilon, episodes, seed }) {
  const all = Array.from({ length: ROBOTS }, (_, k) => learnOnCliff(given, method, { epsilon, episodes, seed: seed * ROBOTS + k }));
  return all[0].map((row, s) => row.map((_, a) => all.reduce((sum, q) => sum + q[s][a], 0) / ROBOTS));
}

/** Where the best actions lead from the start. */
export function greedyWalk({ moves, ends, begin }, q) {
  const walk = [begin];
  while (!ends[walk.at(-1)] && walk.length < 30) walk.push(moves[walk.at(-1)][largest(q[walk.at(-1)])]);
  return walk;
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
    const grids = methods.map((name) => gridPicture({ layout: given.layout, name }));
    const captions = methods.map(() => h("p", { class: "told" }));
    stage.append(h("div", { class: "row" }, ...methods.map((name, k) => h("figure", { class: "half" }, h("figcaption", {}, name), grids[k].element, captions[k]))));
    const top = given.layout.rows.length - 2; // rows above the cliff's edge
    const away = (walk) => top - Math.min(...walk.map((s) => given.layout.cells[s][0]));
    const said = (rows) => ["along the edge", "one row away from the edge", "along the far wall"][rows] ?? `${rows} rows away`;
    return ({ epsilon, episodes, seed }) => {
      const walks = methods.map((method, k) => {
        const q = learnTogether(given, method, { epsilon, episodes, seed });
        const walk = greedyWalk(given, q);
        grids[k].show({ values: q.map((row) => Math.max(...row)), policy: q.map(largest), said: "learned values", walk }, 20, -1);
        const arrived = given.layout.rows[given.layout.cells[walk.at(-1)][0]][given.layout.cells[walk.at(-1)][1]] === "G";
        captions[k].textContent = !arrived ? "Without exploring, this path does not reach G." : `Without exploring, this path takes ${walk.length - 1} steps.`;
        return arrived ? said(away(walk)) : null;
      });
      const best = given.best[Math.round(epsilon / 0.05)];
      return [
        ...methods.map((name, k) => walks[k] ? `${name}'s path leads ${walks[k]}.` : `${name}'s path does not lead to G yet.`),
        `Values and paths are the mean of ${ROBOTS} robots after ${episodes} episodes each.`, "",
        `For a robot that explores with ε = ${epsilon.toFixed(2)} the best path leads ${said(best.rows)}, with an expected return of ${number(best.value, 1)}.`,
      ].join("\n");
    };
  },
});
