// The accuracy of a policy on an expert's demonstrations, in three ways of counting, beside success in new maps.

/** Shares of steps in which a policy takes the expert's action: `kept` is the share of safe steps that count. */
export function accuracy({ right }, { counts, safe }, measure, kept) {
  if (measure === "balanced") return right.reduce((sum, number_, k) => sum + number_ / counts[k], 0) / counts.length;
  const extra = kept * safe;
  const total = (values) => values.reduce((sum, value) => sum + value, 0);
  return (total(right) + extra) / (total(counts) + extra);
}

export default explorable({
  controls: () => ({
    measure: segments({ label: "what is counted", options: [["pairs", "accuracy"], ["balanced", "balanced accuracy"], ["success", "success in new maps"]], value: "pairs" }),
    kept: range({ label: "safe steps that count", from: 0, to: 1, step: 0.05, value: 0, text: (share) => `${Math.round(100 * share)} %` }),
  }),
  draw({ given, stage }) {
    const chart = plot({ x: [0, 100], y: [0, 3], xLabel: "per cent", yLabel: "", yTicks: [], height: 230 });
    stage.append(h("figure", {}, chart.element));
    const colours = [PALETTE.GREY, PALETTE.GREEN, PALETTE.BLUE];
    return ({ measure, kept }) => {
      const shares = given.policies.map((policy) => (measure === "success" ? policy.success : accuracy(policy, given, measure, kept)));
      const shapes = given.policies.flatMap(({ name }, k) => {
        const y = chart.Y(2.75 - k);
        return [
          svg("text", { x: chart.X(1), y: y - 3, "font-size": 14 }, `${name}: ${number(100 * shares[k], 1)} %`),
          svg("rect", { x: chart.X(0), y: y + 4, height: 26, width: chart.X(100 * shares[k]) - chart.X(0), fill: colours[k] }),
        ];
      });
      chart.put(given.policies.map(({ name }, k) => `${name} ${number(100 * shares[k], 1)} per cent`).join(", "), ...shapes);
      const pairs = given.counts.reduce((sum, value) => sum + value, 0);
      const steps = {
        pairs: kept > 0 ? `Counted: ${pairs} steps near obstacles, and ${number(kept * given.safe, 0)} of ${given.safe} safe steps, in which all policies go on to the target.` : `Counted: ${pairs} steps near obstacles. In ${given.counts[0]} of them the expert goes straight on.`,
        balanced: "Counted: the mean of the accuracies for the five actions.",
        success: `Counted: how many of ${given.maps} new maps are reached.`,
      };
      return steps[measure];
    };
  },
});
