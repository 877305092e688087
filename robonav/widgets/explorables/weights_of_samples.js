// Importance weights of fifty samples under a growing theta.

/** Weights in proportion to exp(theta f), which sum to 1. */
export const sampleWeights = (features, theta) => softmax(features.map((feature) => theta * feature));

/** How many equally weighted samples would be as good: 1 over the sum of squares. */
export const effectiveSamples = (weights) => 1 / weights.reduce((sum, weight) => sum + weight * weight, 0);

export default explorable({
  controls: ({ theta }) => ({
    theta: range({ label: "θ, per step to the right", from: -1, to: 3, step: 0.05, value: theta, text: (value) => number(value) }),
  }),
  draw({ given: { features, expert }, stage }) {
    const chart = plot({ x: [0, 1], y: [0, 0.5], xLabel: "share of steps to the right", yLabel: "weight", height: 230 });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "samples"], [PALETTE.ORANGE, "the expert's mean"], [PALETTE.GREEN, "the weighted mean"])));
    return ({ theta }) => {
      const weights = sampleWeights(features, 20 * theta);
      const mean = weights.reduce((sum, weight, i) => sum + weight * features[i], 0);
      const upright = (at, stroke) => svg("line", { x1: chart.X(at), x2: chart.X(at), y1: chart.Y(0), y2: chart.Y(0.5), stroke, "stroke-width": 2 });
      chart.put(
        "Weights of the samples", upright(expert, PALETTE.ORANGE), upright(mean, PALETTE.GREEN),
        ...features.map((feature, i) => svg("circle", { cx: chart.X(feature), cy: chart.Y(Math.min(weights[i], 0.5)), r: 4.5, fill: PALETTE.BLUE, "fill-opacity": 0.5 })),
      );
      return [
        `Weighted mean: ${number(mean)}. The expert's: ${number(expert)}. The gradient of the dual is their difference, ${number(expert - mean)}.`,
        `The weighted samples correspond to ${number(effectiveSamples(weights), 1)} samples of equal weight.`, "",
        Math.max(...features) < expert ? `No sample goes to the right as often as the expert: the largest share is ${number(Math.max(...features))}. However large θ is, the weighted mean cannot reach the expert's.` : "Some samples go to the right at least as often as the expert.",
      ].join("\n");
    };
  },
});
