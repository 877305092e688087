// Three action values, and the probabilities that a Boltzmann policy gives them.

/** Eq. (5.10). */
export const boltzmannPolicy = (values, eta) => softmax(values.map((value) => eta * value));

export default explorable({
  controls: ({ values }) => ({
    eta: range({ label: "inverse temperature η", from: 0, to: 60, step: 0.5, value: 5, text: (value) => value.toFixed(1) }),
    ...Object.fromEntries(values.map((value, k) => [`value${k}`, range({ label: `value of action ${k + 1}`, from: 0, to: 1, step: 0.05, value, text: (at) => at.toFixed(2) })])),
  }),
  draw({ stage }) {
    const colours = [PALETTE.BLUE, PALETTE.ORANGE, PALETTE.GREEN];
    const chart = plot({ x: [0, 60], y: [0, 1], xLabel: "inverse temperature η", yLabel: "probability" });
    stage.append(h("figure", {}, chart.element, legend(...colours.map((colour, k) => [colour, `action ${k + 1}`]))));
    return ({ eta, ...named }) => {
      const values = Object.values(named);
      const now = boltzmannPolicy(values, eta);
      const every = Array.from({ length: 121 }, (_, k) => boltzmannPolicy(values, k / 2));
      chart.put(
        `Probabilities over the inverse temperature; at ${eta} they are ${now.map((p) => p.toFixed(2)).join(", ")}`,
        ...colours.map((stroke, a) => chart.line(every.map((row, k) => [k / 2, row[a]]), { stroke })),
        svg("line", { x1: chart.X(eta), x2: chart.X(eta), y1: chart.Y(0), y2: chart.Y(1), stroke: PALETTE.VERMILION, "stroke-dasharray": "4 3" }),
        ...colours.map((fill, a) => svg("circle", { cx: chart.X(eta), cy: chart.Y(now[a]), r: 5, fill })),
      );
      return [
        `Probabilities: ${now.map((p) => number(p, 3)).join(", ")}.`, "",
        Math.max(...now) >= 0.9 ? "The best action is taken at least nine times in ten." : "The best action is taken less than nine times in ten.",
        "Only differences of values count: add the same number to all three, and nothing changes.",
      ].join("\n");
    };
  },
});
