// The largest of noisy estimates is too large on average; one that another network estimates is not.

/** The mean error of the largest of some estimates: their errors' scatter times the mean of the largest of n standard normal numbers. */
export const largestError = (means, actions, error) => error * means[actions - 1];

/** By how much the values rise in the end if each target adds an error: the sum of discount^t errors. */
export const riseOfValues = (bias, discount) => bias / (1 - discount);

export default explorable({
  controls: ({ means }) => ({
    actions: range({ label: "actions", from: 1, to: means.length, value: 2 }),
    error: range({ label: "standard deviation of the errors", from: 0, to: 0.5, step: 0.02, value: 0.2, text: (value) => value.toFixed(2) }),
    discount: range({ label: "discount γ", from: 0, to: 0.95, step: 0.05, value: 0.6, text: (value) => value.toFixed(2) }),
  }),
  draw({ given: { means }, stage }) {
    const chart = plot({ x: [1, means.length], y: [0, 1], xLabel: "actions, all of value 0", yLabel: "mean estimate" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.VERMILION, "the largest estimate"], [PALETTE.GREEN, "the same action, estimated by another network"])));
    return ({ actions, error, discount }) => {
      const bias = largestError(means, actions, error);
      chart.put(
        `With ${actions} actions the largest estimate is ${bias.toFixed(2)} on average`,
        chart.line(means.map((_, k) => [k + 1, largestError(means, k + 1, error)]), { stroke: PALETTE.VERMILION }),
        chart.line([[1, 0], [means.length, 0]], { stroke: PALETTE.GREEN, "stroke-width": 5 }),
        svg("circle", { cx: chart.X(actions), cy: chart.Y(bias), r: 6, fill: PALETTE.VERMILION }),
      );
      return [
        `Mean of the largest estimate: ${number(bias, 3)}. True largest value: 0.`,
        `If each target adds this error, the values rise by ${number(riseOfValues(bias, discount), 3)} in the end.`, "",
        "Double Q-learning chooses with one network and takes the value from another, whose errors are independent: then the mean is 0.",
      ].join("\n");
    };
  },
});
