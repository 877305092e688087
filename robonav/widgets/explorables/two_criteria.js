// Methods as points: how often they arrive, and a second criterion. A method is beaten if another one is better in both.

/** Places of the methods that are better than the one at `k` in both criteria. */
export const better = (points, k) => points.flatMap(([x, y], at) => (x > points[k][0] && y > points[k][1] ? [at] : []));

/** Both criteria of each method, in per cent: success, and the second one. */
export const pointsOf = ({ methods }, worlds, second) => methods.map(({ values }) => [values[worlds].success, values[worlds][second]]);

const SECOND = [["short ways", "short ways (SPL)"], ["no collision", "no collision"]];

export default explorable({
  controls: ({ worlds, methods }) => ({
    worlds: segments({ label: "obstacles", options: worlds, value: worlds[1] }),
    second: segments({ label: "second criterion", options: SECOND, value: "short ways" }),
    method: range({ label: "method", from: 0, to: methods.length - 1, value: 0, text: (k) => methods[k].name }),
  }),
  draw({ given, stage }) {
    const figure = h("figure", {});
    stage.append(figure, legend([PALETTE.BLUE, "no method beats it in both"], [PALETTE.GREY, "beaten in both"], [PALETTE.VERMILION, "the chosen method"]));
    return ({ worlds, second, method }) => {
      const points = pointsOf(given, worlds, second);
      const lowest = (axis) => 10 * Math.floor(Math.min(...points.map((point) => point[axis])) / 10);
      const chart = plot({ x: [lowest(0), 100], y: [lowest(1), 100], xLabel: "episodes that arrive (%)", yLabel: `${SECOND.find(([own]) => own === second)[1]} (%)` });
      figure.replaceChildren(chart.element);
      const names = (places) => places.map((k) => given.methods[k].name).join(", ");
      const front = given.methods.flatMap((_, k) => (better(points, k).length ? [] : [k]));
      const dot = (k, colour, r) => svg("circle", { cx: chart.X(points[k][0]), cy: chart.Y(points[k][1]), r, fill: colour });
      chart.put(
        `Not beaten in both criteria: ${names(front)}`,
        ...points.map((_, k) => dot(k, front.includes(k) ? PALETTE.BLUE : PALETTE.GREY, 6)),
        dot(method, PALETTE.VERMILION, 4),
      );
      const above = better(points, method);
      const { name } = given.methods[method];
      return [
        `${name}: ${number(points[method][0], 1)} % arrive, ${second}: ${number(points[method][1], 1)} %.`,
        above.length ? `Better in both: ${names(above)}.` : `No method is better than ${name} in both.`,
        `Not beaten by any: ${names(front)}.`,
      ].join("\n");
    };
  },
});
