// A cloned policy that errs more where the expert never was: errors add up faster than decisions.

/**
 * Expected errors in 1, 2, ... decisions, for a robot that starts on the expert's path: it errs there with probability
 * `error` and leaves the path, errs off the path with probability `off`, and returns after a decision that is right with probability `back`.
 */
export function expectedErrors({ error, off, back }, decisions) {
  let [away, sum] = [0, 0];
  return Array.from({ length: decisions }, () => {
    sum += (1 - away) * error + away * off;
    away = (1 - away) * error + away * (1 - (1 - off) * back);
    return sum;
  });
}

const MOST = 200;
const percent = (value) => `${number(100 * value, 0)} %`;

export default explorable({
  controls: () => ({
    error: range({ label: "errs on the expert's path", from: 0, to: 0.1, step: 0.01, value: 0.01, text: percent }),
    off: range({ label: "errs off the path", from: 0, to: 1, step: 0.05, value: 0.9, text: percent }),
    back: range({ label: "a right decision leads back", from: 0, to: 1, step: 0.05, value: 0.2, text: percent }),
    decisions: range({ label: "decisions", from: 10, to: MOST, step: 10, value: 20 }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, MOST], y: [0, 100], xLabel: "decisions T", yLabel: "expected errors" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "cloned"], [PALETTE.GREEN, "if it erred as rarely everywhere"])));
    return (state) => {
      const { error, decisions } = state;
      const cloned = expectedErrors(state, MOST);
      const even = expectedErrors({ ...state, off: error }, MOST);
      const points = (series) => [[0, 0], ...series.map((value, k) => [k + 1, value]).filter(([, value]) => value <= 100)];
      const at = { x1: chart.X(decisions), x2: chart.X(decisions), y1: chart.Y(0), y2: chart.Y(100), stroke: PALETTE.VERMILION, "stroke-width": 1.5 };
      chart.put("Expected errors against decisions", svg("line", at), chart.line(points(even), { stroke: PALETTE.GREEN }), chart.line(points(cloned), { stroke: PALETTE.BLUE }));
      return [
        `In ${decisions} decisions: ${number(cloned[decisions - 1], 1)} errors expected.`,
        `If it erred in ${percent(error)} of its decisions in all states: ${number(even[decisions - 1], 1)}.`,
      ].join("\n");
    };
  },
});
