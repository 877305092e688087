// TD(0) on the random walk through five rooms: a large learning rate forgets the start sooner, a small one averages out the noise.

/** TD(0) over given episodes, without a discount: the values after each episode, the start first. @param {number[][]} episodes rooms passed, ends included */
export function tdHistory(episodes, alpha, prize, states) {
  const values = new Float64Array(states).fill(0.5);
  values[0] = values[states - 1] = 0;
  const history = [values.slice()];
  for (const episode of episodes) {
    for (let t = 0; t + 1 < episode.length; t += 1) {
      const [s, next] = [episode[t], episode[t + 1]];
      values[s] += alpha * ((next === prize ? 1 : 0) + values[next] - values[s]);
    }
    history.push(values.slice());
  }
  return history;
}

/** Every-visit Monte Carlo over given episodes: means of the returns; 0.5 where none is known yet. */
export function monteCarloHistory(episodes, prize, states) {
  const [sums, counts] = [new Float64Array(states), new Float64Array(states)];
  const now = () => sums.map((sum, s) => (counts[s] ? sum / counts[s] : 0.5));
  const history = [now()];
  for (const episode of episodes) {
    episode.slice(0, -1).forEach((s) => {
      sums[s] += episode.at(-1) === prize ? 1 : 0;
      counts[s] += 1;
    });
    history.push(now());
  }
  return history;
}

/** The root mean square error over the rooms. */
export const errorOf = (values, truth) => Math.sqrt(truth.reduce((sum, value, i) => sum + (values[i + 1] - value) ** 2, 0) / truth.length);

const EPISODES = 100;

export default explorable({
  controls: ({ rate }) => ({
    alpha: range({ label: "learning rate α", from: 0.01, to: 0.5, step: 0.01, value: rate, text: (value) => value.toFixed(2) }),
    episode: range({ label: "episodes", from: 0, to: EPISODES, value: 10 }),
    run: range({ label: "run in the first picture", from: 1, to: 20, value: 1 }),
  }),
  draw({ given, stage }) {
    const { truth, prize } = given;
    const runs = given.episodes.map((episodes) => episodes.split(" ").map((episode) => [...episode].map(Number)));
    const states = truth.length + 2;
    const monte = runs.map((episodes) => monteCarloHistory(episodes, prize, states));
    const meanError = (histories) => histories[0].map((_, k) => histories.reduce((sum, history) => sum + errorOf(history[k], truth), 0) / histories.length);
    const baseline = meanError(monte);
    const rooms = plot({ x: [0.6, 5.4], y: [0, 1], xLabel: "room", yLabel: "value", height: 200, xTicks: [1, 2, 3, 4, 5] });
    const errors = plot({ x: [0, EPISODES], y: [0, 0.3], xLabel: "episodes", yLabel: "error, mean of 20 runs", height: 200 });
    stage.append(h("figure", {}, rooms.element, errors.element, legend([PALETTE.GREY, "truth"], [PALETTE.BLUE, "TD(0), one run"], [PALETTE.GREEN, "TD(0), error"], [PALETTE.ORANGE, "Monte Carlo"])));
    return ({ alpha, episode, run }) => {
      const histories = runs.map((episodes) => tdHistory(episodes, alpha, prize, states));
      const error = meanError(histories);
      const inside = (values) => truth.map((_, i) => [i + 1, values[i + 1]]);
      const dots = (values, fill) => inside(values).map(([x, y]) => svg("circle", { cx: rooms.X(x), cy: rooms.Y(y), r: 5, fill }));
      const [td, mc] = [histories[run - 1][episode], monte[run - 1][episode]];
      rooms.put(
        `Values of five rooms after ${episode} episodes of run ${run}`,
        rooms.line(truth.map((value, i) => [i + 1, value]), { stroke: PALETTE.GREY }),
        rooms.line(inside(mc), { stroke: PALETTE.ORANGE, "stroke-width": 1.5 }), ...dots(mc, PALETTE.ORANGE),
        rooms.line(inside(td), { stroke: PALETTE.BLUE, "stroke-width": 1.5 }), ...dots(td, PALETTE.BLUE),
      );
      const curve_ = (series, stroke) => errors.line(series.map((value, k) => [k, Math.min(value, 0.3)]), { stroke });
      const at = { x1: errors.X(episode), x2: errors.X(episode), y1: errors.Y(0), y2: errors.Y(0.3), stroke: PALETTE.VERMILION, "stroke-width": 1.5 };
      errors.put("Error against episodes", svg("line", at), curve_(baseline, PALETTE.ORANGE), curve_(error, PALETTE.GREEN));
      return [
        `After ${episode} ${episode === 1 ? "episode" : "episodes"}, mean of 20 runs:`,
        `TD(0) with α = ${alpha.toFixed(2)}: error ${number(error[episode], 3)}`,
        `Monte Carlo: error ${number(baseline[episode], 3)}`, "",
        `With this α the error after 10 episodes is ${number(error[10], 3)}, after 100 it is ${number(error[100], 3)}.`,
      ].join("\n");
    };
  },
});
