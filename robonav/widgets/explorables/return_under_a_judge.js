// The return of an episode under a reward that a discriminator gives, over the number of its steps.

/** The rewards of a step, by what they are called; D is the probability that the step is the learner's. */
export const REWARDS = {
  "−log D": (d) => -Math.log(d),
  "log(1 − D)": (d) => Math.log(1 - d),
  "log(1 − D) − log D": (d) => Math.log(1 - d) - Math.log(d),
};

const MOST = 60; // steps of the longest episode
const SHORT = 10; // steps of the other one

/** Which of two episodes has the larger return, in words. */
function better(reward) {
  if (Math.abs(reward) < 1e-9) return "Both earn the same.";
  return `The ${reward > 0 ? "longer" : "shorter"} episode earns more.`;
}

export default explorable({
  controls: ({ d }) => ({
    name: segments({ label: "reward", options: Object.keys(REWARDS), value: "−log D" }),
    d: range({ label: "D of every step", from: 0.05, to: 0.95, step: 0.05, value: d, text: (value) => value.toFixed(2) }),
    steps: range({ label: "steps of the longer episode", from: SHORT + 5, to: MOST, step: 5, value: 40, text: (value) => value.toFixed(0) }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, MOST], y: [-180, 180], xLabel: "steps of the episode", yLabel: "return" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "return, without a discount"], [PALETTE.VERMILION, "the two episodes"])));
    return ({ name, d, steps }) => {
      const reward = REWARDS[name](d);
      const dot = (at) => svg("circle", { cx: chart.X(at), cy: chart.Y(at * reward), r: 6, fill: PALETTE.VERMILION });
      chart.put(
        "Return over the number of steps",
        chart.line([[0, 0], [MOST, 0]], { stroke: PALETTE.INK, "stroke-width": 1 }),
        chart.line([[0, 0], [MOST, MOST * reward]], { stroke: PALETTE.BLUE }),
        dot(SHORT), dot(steps),
      );
      return [
        `Reward of a step: ${number(reward, 3)}.`,
        `Return of ${SHORT} steps: ${number(SHORT * reward)}. Return of ${steps} steps: ${number(steps * reward)}.`, "",
        better(reward),
      ].join("\n");
    };
  },
});
