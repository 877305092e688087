// The tiger: each straight line is a plan, and the best plan for a belief is the highest line over it.

/** The belief that the tiger is left after it was heard `more` times more often on the left than on the right. */
export const beliefAfter = (more, accuracy) => 1 / (1 + ((1 - accuracy) / accuracy) ** more);

/** The best plan at a belief: its place among the vectors and its value. */
export function bestPlan(vectors, belief) {
  const values = vectors.map(([left, right]) => belief * left + (1 - belief) * right);
  const at = largest(values);
  return { at, value: values[at] };
}

const ACTIONS = ["listen", "open left", "open right"];

export default explorable({
  controls: ({ accuracies, plans }) => ({
    more: range({ label: "heard more often on the left than on the right", from: -4, to: 4, value: 0, text: (value) => `${number(value, 0)} times` }),
    accuracy: segments({ label: "listening is right in", options: accuracies.map((share, k) => [k, `${Math.round(100 * share)} %`]), value: Math.min(1, accuracies.length - 1) }),
    steps: range({ label: "steps to go", from: 1, to: plans[0].length, value: Math.min(8, plans[0].length) }),
  }),
  draw({ given, stage }) {
    const colours = [PALETTE.BLUE, PALETTE.GREEN, PALETTE.ORANGE];
    const holder = h("figure", {});
    stage.append(holder);
    return ({ more, accuracy, steps }) => {
      const { vectors, actions } = given.plans[accuracy][steps - 1];
      const belief = beliefAfter(more, given.accuracies[accuracy]);
      const edge = Array.from({ length: 401 }, (_, k) => bestPlan(vectors, k / 400));
      const values = edge.map(({ value }) => value);
      const [low, high] = [Math.floor(Math.min(...values) / 10 - 0.6) * 10, Math.ceil(Math.max(...values) / 10) * 10];
      const chart = plot({ x: [0, 1], y: [low, high], xLabel: "belief that the tiger is left", yLabel: "value" });
      const { at, value } = bestPlan(vectors, belief);
      const clip = ([left, right], k) => {
        const points = Array.from({ length: 201 }, (_, i) => [i / 200, (i / 200) * left + (1 - i / 200) * right]).filter(([, y]) => y >= low && y <= high);
        return chart.line(points, { stroke: colours[actions[k]], "stroke-width": 1, "stroke-opacity": 0.5 });
      };
      const thick = colours.flatMap((stroke, action) => {
        const along = edge.flatMap((best, i) => (actions[best.at] === action ? [[i / 400, best.value]] : []));
        return along.length ? [chart.line(along, { stroke, "stroke-width": 4 })] : [];
      });
      chart.put(
        `Value over the belief. At ${belief.toFixed(2)} it is best to ${ACTIONS[actions[at]]}.`,
        ...vectors.map(clip), ...thick,
        svg("line", { x1: chart.X(belief), x2: chart.X(belief), y1: chart.Y(low), y2: chart.Y(high), stroke: PALETTE.VERMILION, "stroke-dasharray": "4 3" }),
        svg("circle", { cx: chart.X(belief), cy: chart.Y(value), r: 6, fill: PALETTE.VERMILION }),
      );
      holder.replaceChildren(chart.element, legend(...ACTIONS.map((name, k) => [colours[k], name]), [PALETTE.VERMILION, "the belief now"]));
      const sure = edge.findIndex((best, k) => k > 200 && actions[best.at] === 2);
      return [
        `Belief that the tiger is left: ${number(belief, 3)}.`,
        `Best: ${ACTIONS[actions[at]]}. Value: ${number(value)}.`, "",
        sure < 0 ? "With this setting no belief is sure enough to open a door." : `It opens the right door from a belief of ${number(sure / 400)} on.`,
        `Plans that are best for some belief: ${new Set(edge.map((best) => best.at)).size}.`,
      ].join("\n");
    };
  },
});
