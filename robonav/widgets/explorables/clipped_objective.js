// The clipped surrogate of PPO over the ratio of probabilities, and its slope at one ratio.

/** The clipped surrogate of one step, Eq. (7) of Schulman et al. (2017). */
export function clippedSurrogate(ratio, advantage, epsilon) {
  const clipped = Math.min(Math.max(ratio, 1 - epsilon), 1 + epsilon);
  return Math.min(ratio * advantage, clipped * advantage);
}

/** Its derivative with respect to the ratio: the advantage, or 0 where clipping has made the smaller of the two. */
export function surrogateSlope(ratio, advantage, epsilon) {
  const outside = advantage > 0 ? ratio > 1 + epsilon : ratio < 1 - epsilon;
  return outside ? 0 : advantage;
}

const MOST = 2; // the largest ratio, and the largest size of an advantage

/** What gradient ascent does to the probability of the action, in words. */
function pushed(slope) {
  if (slope === 0) return "The gradient is 0: this step does not change the policy.";
  return `Gradient ascent makes the action ${slope > 0 ? "likelier" : "less likely"}.`;
}

export default explorable({
  controls: ({ advantage, epsilon }) => ({
    ratio: range({ label: "ratio ρ", from: 0, to: MOST, step: 0.05, value: 1, text: (value) => value.toFixed(2) }),
    advantage: range({ label: "advantage A", from: -MOST, to: MOST, step: 0.1, value: advantage, text: (value) => number(value, 1) }),
    epsilon: range({ label: "ε", from: 0.05, to: 0.5, step: 0.05, value: epsilon, text: (value) => value.toFixed(2) }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, MOST], y: [-4, 4], xLabel: "ratio ρ", yLabel: "gain" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "clipped"], [PALETTE.GREY, "not clipped: ρ A"], [PALETTE.ORANGE, "1 − ε and 1 + ε"], [PALETTE.VERMILION, "the ratio now"])));
    return ({ ratio, advantage, epsilon }) => {
      const low = Number((1 - epsilon).toFixed(10));
      const high = Number((1 + epsilon).toFixed(10));
      const gain = (at) => clippedSurrogate(at, advantage, epsilon);
      const [now, slope] = [gain(ratio), surrogateSlope(ratio, advantage, epsilon)];
      const limit = (at) => chart.line([[at, -4], [at, 4]], { stroke: PALETTE.ORANGE, "stroke-dasharray": "5 4", "stroke-width": 1.5 });
      chart.put(
        "Clipped surrogate over the ratio", limit(low), limit(high),
        chart.line([[0, 0], [MOST, MOST * advantage]], { stroke: PALETTE.GREY, "stroke-dasharray": "5 4", "stroke-width": 1.5 }),
        chart.line([0, low, high, MOST].map((at) => [at, gain(at)]), { stroke: PALETTE.BLUE }),
        svg("circle", { cx: chart.X(ratio), cy: chart.Y(now), r: 6, fill: PALETTE.VERMILION }),
      );
      const clipped = Math.min(Math.max(ratio, low), high);
      return [
        `Gain: the smaller of ${number(ratio)} · ${number(advantage, 1)} and ${number(clipped)} · ${number(advantage, 1)}, which is ${number(now, 3)}.`,
        `Gradient with respect to the ratio: ${number(slope, 1)}.`, "", pushed(slope),
      ].join("\n");
    };
  },
});
