// A reward is a direction: turn it, and see how far the expert leads.

/** The lead of the expert over the best of the others in a direction, in degrees. */
export function leadAt(expert, others, degrees) {
  const theta = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
  const along = ([x, y]) => x * theta[0] + y * theta[1];
  const values = others.map(along);
  const rival = largest(values);
  return { lead: along(expert) - values[rival], rival };
}

/** The point nearest to another one on the segment between two points. */
function nearestBetween([x0, y0], [x1, y1], [x, y]) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const share = Math.max(0, Math.min(1, (dx * (x - x0) + dy * (y - y0)) / (dx * dx + dy * dy || 1)));
  return [x0 + share * dx, y0 + share * dy];
}

/** The widest lead of all directions: from the hull's nearest point to the expert. This point lies between two of the others. */
export function widestLead(expert, others) {
  const nearest = others.flatMap((one) => others.map((other) => nearestBetween(one, other, expert)));
  const towards = nearest.map(([x, y]) => (Math.atan2(expert[1] - y, expert[0] - x) * 180) / Math.PI);
  const leads = towards.map((degrees) => leadAt(expert, others, degrees).lead);
  const best = largest(leads);
  return { lead: leads[best], degrees: towards[best] };
}

export default explorable({
  controls: ({ expert }) => ({
    degrees: range({ label: "direction of the reward", from: 0, to: 355, step: 5, value: 0, text: (value) => `${value}°` }),
    x: range({ label: "expert, feature 1", from: -3, to: 3, step: 0.1, value: expert[0], text: (value) => number(value, 1) }),
    y: range({ label: "expert, feature 2", from: -3, to: 3, step: 0.1, value: expert[1], text: (value) => number(value, 1) }),
  }),
  draw({ given: { others }, stage }) {
    const chart = plot({ x: [-3.5, 3.5], y: [-3.5, 3.5], xLabel: "feature 1", yLabel: "feature 2", width: 360, height: 360 });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.GREY, "other policies"], [PALETTE.ORANGE, "the expert"], [PALETTE.BLUE, "the reward, and lines of equal return"])));
    return ({ degrees, x, y }) => {
      const expert = [x, y];
      const { lead, rival } = leadAt(expert, others, degrees);
      const best = widestLead(expert, others);
      const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
      const inside = (point) => point.every((value) => Math.abs(value) <= 3.5);
      const across = ([px, py], dashes) => {
        const points = Array.from({ length: 401 }, (_, k) => [px - (k - 200) * 0.05 * s, py + (k - 200) * 0.05 * c]).filter(inside);
        return chart.line(points, { stroke: PALETTE.BLUE, "stroke-width": 1.3, "stroke-dasharray": dashes });
      };
      const dot = ([px, py], fill, r = 5) => svg("circle", { cx: chart.X(px), cy: chart.Y(py), r, fill });
      chart.put(
        `The reward points to ${degrees} degrees; the expert's margin is ${lead.toFixed(2)}`,
        across(expert, "6 4"), across(others[rival], "2 4"),
        chart.line([[0, 0], [1.6 * c, 1.6 * s]], { stroke: PALETTE.BLUE, "stroke-width": 4 }),
        ...others.map((point) => dot(point, PALETTE.GREY)), dot(expert, PALETTE.ORANGE, 7),
      );
      return [
        lead > 0 ? `The expert's margin is ${number(lead, 3)}.` : `The expert has no margin: the return of another policy is larger by ${number(-lead, 3)}.`, "",
        best.lead <= 0.0005 ? "The expert has a margin in no direction, because it lies inside the hull of the others."
          : lead > 0.99 * best.lead ? "This is nearly the largest possible margin." : `The largest margin of all directions is ${number(best.lead, 3)}.`,
      ].join("\n");
    };
  },
});
