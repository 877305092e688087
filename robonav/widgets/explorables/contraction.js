// Two starts of value iteration approach each other.

/** The values of every sweep from a start, the start first. */
export function sweepsFrom(model, discount, start, count) {
  const history = [start];
  for (let k = 0; k < count; k += 1) history.push(optimalitySweep(model, discount, history.at(-1)));
  return history;
}

/** The largest difference of two value functions. */
export const apart = (one, other) => Math.max(...one.map((value, s) => Math.abs(value - other[s])));

const SWEEPS = 60;

export default explorable({
  controls: () => ({
    discount: range({ label: "discount γ", from: 0.5, to: 0.98, step: 0.01, value: 0.9, text: (value) => value.toFixed(2) }),
    first: field({ label: "orange start, state 0", from: -20, to: 20, value: 20 }),
    second: field({ label: "orange start, state 1", from: -20, to: 20, value: 20 }),
    sweep: range({ label: "sweep", from: 0, to: SWEEPS, value: 0 }),
  }),
  draw({ given, stage }) {
    const model = modelOf(given.model);
    const chart = plot({ x: [0, SWEEPS], y: [-20, 20], xLabel: "sweep k", yLabel: "value of state 0" });
    const gap = plot({ x: [0, SWEEPS], y: [0, 20], xLabel: "sweep k", yLabel: "largest difference", height: 190 });
    stage.append(h("figure", {}, chart.element, gap.element, legend([PALETTE.BLUE, "starts with values 0"], [PALETTE.ORANGE, "starts with your values"], [PALETTE.GREY, "γᵏ times the first difference"])));
    return ({ discount, first, second, sweep }) => {
      const [blue, orange] = [[0, 0], [first, second]].map((start) => sweepsFrom(model, discount, start, SWEEPS));
      const gaps = blue.map((values, k) => apart(values, orange[k]));
      const bound = gaps.map((_, k) => gaps[0] * discount ** k);
      const points = (series) => series.map((value, k) => [k, value]);
      const mark = (picture) => svg("line", { x1: picture.X(sweep), x2: picture.X(sweep), y1: picture.Y(picture === gap ? 0 : -20), y2: picture.Y(20), stroke: PALETTE.VERMILION, "stroke-width": 1.5 });
      chart.put(
        "Values of state 0 from two starts", mark(chart),
        chart.line(points(blue.map(([value]) => value)), { stroke: PALETTE.BLUE }),
        chart.line(points(orange.map(([value]) => value)), { stroke: PALETTE.ORANGE }),
      );
      gap.put(
        "Largest difference of the two, and its bound", mark(gap),
        gap.line(points(bound), { stroke: PALETTE.GREY, "stroke-width": 6, "stroke-opacity": 0.5 }),
        gap.line(points(gaps), { stroke: PALETTE.GREEN }),
      );
      const close = bound.findIndex((size) => size <= 0.01 * gaps[0]);
      return [
        `After ${sweep} sweeps: blue ${number(blue[sweep][0])}, orange ${number(orange[sweep][0])} in state 0.`,
        `Largest difference over both states: ${number(gaps[sweep], 3)}. The bound is ${number(bound[sweep], 3)}.`, "",
        close < 0 ? `The bound does not fall to a hundredth of the first difference within ${SWEEPS} sweeps.` : `From sweep ${close} on, the bound is at most a hundredth of the first difference.`,
      ].join("\n");
    };
  },
});
