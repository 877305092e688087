// A reward for each step, and what the end counts: does a robot look for the end or put it off?

/** The value, times 1 - discount, of going on for n steps and ending then. */
export const valueOfEnding = (steps, reward, end, discount) => (1 - discount ** steps) * reward + discount ** steps * end;

const LONGEST = 15;

export default explorable({
  controls: ({ reward, end, discount }) => ({
    reward: range({ label: "reward of each step", from: 0, to: 1, step: 0.05, value: reward, text: (value) => value.toFixed(2) }),
    end: range({ label: "value of an end", from: 0, to: 1, step: 0.05, value: end, text: (value) => value.toFixed(2) }),
    discount: range({ label: "discount γ", from: 0.3, to: 0.95, step: 0.05, value: discount, text: (value) => value.toFixed(2) }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, LONGEST], y: [0, 1], xLabel: "steps until the end", yLabel: "value, scaled" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "value of ending after so many steps"], [PALETTE.GREY, "value of never ending"])));
    return ({ reward, end, discount }) => {
      const values = Array.from({ length: LONGEST + 1 }, (_, n) => valueOfEnding(n, reward, end, discount));
      chart.put(
        "Value over the number of steps until the end",
        chart.line([[0, reward], [LONGEST, reward]], { stroke: PALETTE.GREY, "stroke-dasharray": "5 4" }),
        chart.line(values.map((value, n) => [n, value]), { stroke: PALETTE.BLUE }),
        ...values.map((value, n) => svg("circle", { cx: chart.X(n), cy: chart.Y(value), r: 4, fill: PALETTE.BLUE })),
      );
      const wish = Math.abs(reward - end) < 1e-9 ? "All times of ending have the same value." : reward > end ? "It delays the end: every further step gives more than the end." : "It tries to end the episode: the end gives more than any further step.";
      return [`Ending now: ${number(values[0])}. After 5 steps: ${number(values[5])}. Never: ${number(reward)}.`, "", wish, "So the value of an end is part of the reward, although no feature describes it."].join("\n");
    };
  },
});
