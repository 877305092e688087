// What is left of a sign that a robot saw some steps ago: in a window of steps, and in a unit with an update gate.

/** How much of its number a unit keeps for some steps in which its update gate is z and its candidate is 0. */
export const kept = (z, steps) => z ** steps;

/** Whether a window of k steps still holds what was seen some steps ago. */
export const holds = (k, steps) => steps < k;

const MOST = 40; // steps

export default explorable({
  controls: ({ z }) => ({
    z: range({ label: "update gate z", from: 0.5, to: 1, step: 0.01, value: z, text: (value) => value.toFixed(2) }),
    k: range({ label: "window k", from: 1, to: 30, step: 1, value: 8, text: (value) => value.toFixed(0) }),
    steps: range({ label: "steps since the niche", from: 0, to: MOST, step: 1, value: 0, text: (value) => value.toFixed(0) }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, MOST], y: [0, 1], xLabel: "steps since the niche", yLabel: "share that is left" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "unit: zⁿ"], [PALETTE.ORANGE, "window of k steps"], [PALETTE.VERMILION, "now"])));
    return ({ z, k, steps }) => {
      const times = Array.from({ length: MOST + 1 }, (_, step) => step);
      const edge = Math.min(k, MOST);
      chart.put(
        "What is left of the sign over the steps",
        chart.line([[0, 1], [edge, 1], [edge, 0], [MOST, 0]], { stroke: PALETTE.ORANGE }),
        chart.line(times.map((step) => [step, kept(z, step)]), { stroke: PALETTE.BLUE }),
        svg("circle", { cx: chart.X(steps), cy: chart.Y(kept(z, steps)), r: 6, fill: PALETTE.VERMILION }),
      );
      return [
        `The unit keeps ${number(z)} in each step, and ${number(kept(z, steps), 3)} after ${steps} steps.`,
        `The window of ${k} ${holds(k, steps) ? "still holds the step beside the niche" : "has lost the step beside the niche"}.`,
      ].join("\n");
    };
  },
});
