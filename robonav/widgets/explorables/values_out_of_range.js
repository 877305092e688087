// Values that do not fit into outputs between 0 and 1: clipped or shifted, they become nearly equal.

/** The values of actions with these first rewards, after each of which the best one is always taken, Eq. (2.11). */
export const trueValues = (rewards, discount) => rewards.map((reward) => reward + (discount * Math.max(...rewards)) / (1 - discount));

export default explorable({
  controls: ({ discount }) => ({
    discount: range({ label: "discount γ", from: 0, to: 0.95, step: 0.05, value: discount, text: (value) => value.toFixed(2) }),
    how: segments({ label: "values above 1 are", options: [["clip", "clipped"], ["shift", "shifted and divided"]], value: "clip" }),
  }),
  draw({ given: { rewards }, stage }) {
    const top = 13;
    const chart = plot({ x: [0.4, 5.6], y: [0, top], xLabel: "action", yLabel: "true value", xTicks: [1, 2, 3, 4, 5], height: 190 });
    const outputs = plot({ x: [0.4, 5.6], y: [0, 1], xLabel: "action", yLabel: "target of the output", xTicks: [1, 2, 3, 4, 5], height: 190 });
    stage.append(h("figure", {}, chart.element, outputs.element));
    const bars = (picture, values, fill) => values.map((value, k) => svg("rect", {
      x: picture.X(k + 0.65), width: picture.X(0.7) - picture.X(0), y: picture.Y(value), height: picture.Y(0) - picture.Y(value), fill,
    }));
    return ({ discount, how }) => {
      const values = trueValues(rewards, discount);
      const targets = RESCALE[how](values);
      chart.put(`True values: ${values.map((value) => number(value)).join(", ")}`, ...bars(chart, values, PALETTE.BLUE));
      outputs.put(`Targets: ${[...targets].map((value) => number(value)).join(", ")}`, ...bars(outputs, [...targets], PALETTE.ORANGE));
      const sorted = [...targets].sort((a, b) => b - a);
      const kinds = new Set([...targets].map((value) => value.toFixed(6))).size;
      return [
        `Rewards of the actions: ${rewards.join(", ")}.`,
        `True values: ${values.map((value) => number(value)).join(", ")}.`,
        `Targets: ${[...targets].map((value) => number(value)).join(", ")}.`, "",
        kinds === 1 ? "The network cannot distinguish any two actions." : `The value of the best action exceeds the next one by ${number(sorted[0] - sorted[1], 3)}; the targets have ${kinds} different values.`,
      ].join("\n");
    };
  },
});
