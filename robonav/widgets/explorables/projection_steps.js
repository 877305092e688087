// The projection method, one policy at a time.

/** The point nearest to the expert on the segment from the mixture to the new policy. */
export function projected([mx, my], [px, py], [ex, ey]) {
  const [dx, dy] = [px - mx, py - my];
  const along = (dx * (ex - mx) + dy * (ey - my)) / (dx * dx + dy * dy || 1);
  const share = Math.max(0, Math.min(1, along));
  return [mx + share * dx, my + share * dy];
}

/** The policy that is best for the reward from the mixture to the expert. */
export const answerTo = (points, mixture, expert) =>
  largest(points.map(([x, y]) => x * (expert[0] - mixture[0]) + y * (expert[1] - mixture[1])));

/** The mixtures after 0, 1, 2, ... policies. */
export function mixtures(points, expert, first, count) {
  const [all, taken] = [[points[first]], [first]];
  for (let k = 0; k < count; k += 1) {
    const next = answerTo(points, all.at(-1), expert);
    taken.push(next);
    all.push(projected(all.at(-1), points[next], expert));
  }
  return { all, taken };
}

const MOST = 20;

export default explorable({
  controls: ({ expert, names, least, most }) => ({
    policies: range({ label: "policies found after the first", from: 0, to: MOST, value: 0 }),
    x: range({ label: `expert, ${names[0]}`, from: least, to: most, step: 0.05, value: expert[0], text: (value) => number(value) }),
    y: range({ label: `expert, ${names[1]}`, from: least, to: most, step: 0.05, value: expert[1], text: (value) => number(value) }),
  }),
  draw({ given: { points, first, names, least, most }, stage }) {
    const margin = 0.15 * (most - least);
    const axis = [least - margin, most + margin];
    const chart = plot({ x: axis, y: axis, xLabel: names[0], yLabel: names[1], width: 360, height: 360 });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.GREY, "policies"], [PALETTE.ORANGE, "the expert"], [PALETTE.GREEN, "the mixture"], [PALETTE.BLUE, "the reward"])));
    return ({ policies, x, y }) => {
      const expert = [x, y];
      const { all, taken } = mixtures(points, expert, first, MOST);
      const distances = all.map(([mx, my]) => Math.hypot(x - mx, y - my));
      const now = all[policies];
      const dot = ([px, py], fill, r = 5) => svg("circle", { cx: chart.X(px), cy: chart.Y(py), r, fill });
      chart.put(
        `After ${policies} policies the mixture is ${distances[policies].toFixed(2)} from the expert`,
        ...points.map((point) => dot(point, PALETTE.GREY, 4)),
        chart.line([now, expert], { stroke: PALETTE.BLUE, "stroke-width": 3 }),
        ...(policies > 0 ? [chart.line([all[policies - 1], points[taken[policies]]], { stroke: PALETTE.GREEN, "stroke-dasharray": "5 4" })] : []),
        dot(points[taken[policies]], PALETTE.GREEN, 7), dot(now, PALETTE.GREEN, 6), dot(expert, PALETTE.ORANGE, 7),
      );
      const near = distances.findIndex((distance) => distance <= 0.1);
      return [
        `Distance of the mixture to the expert: ${number(distances[policies], 3)}.`,
        near < 0 ? "It will not come within 0.1, because no mixture of these policies is so close to the expert." : policies >= near ? "It is within 0.1." : "It is not yet within 0.1.", "",
        "Each new policy is the best one for the latest reward. The mixture moves towards it, to the point nearest to the expert.",
      ].join("\n");
    };
  },
});
