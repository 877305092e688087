// Two policies, judged by accuracy and by balanced accuracy.

/** Accuracy and balanced accuracy of a policy, from the expert's frequency of each action and the share of each predicted. */
export function scores(frequency, predicted) {
  const total = frequency.reduce((sum, count) => sum + count, 0);
  const seen = frequency.map((count, a) => [count, predicted[a]]).filter(([count]) => count > 0);
  return {
    accuracy: seen.reduce((sum, [count, share]) => sum + count * share, 0) / total,
    balanced: seen.reduce((sum, [, share]) => sum + share, 0) / seen.length,
  };
}

export default explorable({
  controls: ({ forward, careful }) => ({
    forward: range({ label: "the expert goes forward in", from: 0.2, to: 0.95, step: 0.05, value: forward, text: (value) => `${Math.round(100 * value)} %` }),
    careful: range({ label: "the careful policy predicts", from: 0.2, to: 1, step: 0.05, value: careful, text: (value) => `${Math.round(100 * value)} %` }),
  }),
  draw({ given: { others }, stage }) {
    const chart = plot({ x: [0, 4], y: [0, 1], xLabel: "", yLabel: "score", xTicks: [], height: 230 });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "careful"], [PALETTE.ORANGE, "always forward"])));
    return ({ forward, careful }) => {
      const frequency = [forward, ...new Array(others).fill((1 - forward) / others)];
      const [one, other] = [frequency.map(() => careful), frequency.map((_, a) => (a === 0 ? 1 : 0))].map((predicted) => scores(frequency, predicted));
      const bar = (at, share, fill) => svg("rect", { x: chart.X(at), y: chart.Y(share), width: chart.X(0.6) - chart.X(0), height: chart.Y(0) - chart.Y(share), fill });
      const text = (at, words) => svg("text", { x: chart.X(at), y: chart.Y(0) + 17, "font-size": 13, "text-anchor": "middle" }, words);
      chart.put(
        "Accuracy and balanced accuracy of the two policies",
        bar(0.4, one.accuracy, PALETTE.BLUE), bar(1.1, other.accuracy, PALETTE.ORANGE), text(1.05, "accuracy"),
        bar(2.4, one.balanced, PALETTE.BLUE), bar(3.1, other.balanced, PALETTE.ORANGE), text(3.05, "balanced accuracy"),
      );
      const better = (name) => (one[name] > other[name] + 1e-9 ? "careful" : one[name] < other[name] - 1e-9 ? "always forward" : "neither");
      return [
        `Accuracy: ${number(one.accuracy)} against ${number(other.accuracy)}. Kept: ${better("accuracy")}.`,
        `Balanced accuracy: ${number(one.balanced)} against ${number(other.balanced)}. Kept: ${better("balanced")}.`, "",
        "Balanced accuracy is the mean of the shares predicted for each action. A policy that always takes the same action predicts one action fully and the others never.",
      ].join("\n");
    };
  },
});
