// How near two robots come in one second: both go straight, so that one of them, seen from the other, goes straight, too.

/** When the other robot is nearest, as a share of the second, if it goes from d0 to d1, seen from the first. */
export function nearestMoment([x0, y0], [x1, y1]) {
  const [vx, vy] = [x1 - x0, y1 - y0];
  const squared = vx * vx + vy * vy;
  return squared === 0 ? 0 : Math.min(Math.max(-(x0 * vx + y0 * vy) / squared, 0), 1);
}

/** Its distance at a moment. */
export const distanceAt = ([x0, y0], [x1, y1], t) => Math.hypot(x0 + t * (x1 - x0), y0 + t * (y1 - y0));

const SPEED = 2; // of both robots, in m/s
const APART = 2; // centres that come nearer have collided
const MOMENTS = 40;

export default explorable({
  controls: ({ x, y, heading }) => ({
    x: range({ label: "ahead of the first robot", from: -6, to: 6, step: 0.5, value: x, text: (value) => `${value.toFixed(1)} m` }),
    y: range({ label: "to its left", from: -6, to: 6, step: 0.5, value: y, text: (value) => `${value.toFixed(1)} m` }),
    heading: range({ label: "heading of the second robot", from: 0, to: 345, step: 15, value: heading, text: (value) => `${value}°` }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, 1], y: [0, 9], xLabel: "time in the second", yLabel: "distance of the centres (m)" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "distance"], [PALETTE.ORANGE, "2 m: nearer is a collision"], [PALETTE.VERMILION, "the nearest moment"])));
    return ({ x, y, heading }) => {
      const angle = (heading * Math.PI) / 180;
      const before = [x, y];
      const after = [x + SPEED * Math.cos(angle) - SPEED, y + SPEED * Math.sin(angle)];
      const t = nearestMoment(before, after);
      const nearest = distanceAt(before, after, t);
      const times = Array.from({ length: MOMENTS + 1 }, (_, k) => k / MOMENTS);
      chart.put(
        "Distance over the second",
        chart.line([[0, APART], [1, APART]], { stroke: PALETTE.ORANGE, "stroke-dasharray": "5 4" }),
        chart.line(times.map((time) => [time, distanceAt(before, after, time)]), { stroke: PALETTE.BLUE }),
        svg("circle", { cx: chart.X(t), cy: chart.Y(nearest), r: 6, fill: PALETTE.VERMILION }),
      );
      return [
        `d₀ = (${number(before[0], 1)}, ${number(before[1], 1)}), d₁ = (${number(after[0])}, ${number(after[1])}).`,
        `At the ends the distance is ${number(distanceAt(before, after, 0))} m and ${number(distanceAt(before, after, 1))} m.`,
        `The robots are nearest at t* = ${number(t)}: ${number(nearest)} m. ${nearest < APART ? "They collide." : "They pass."}`,
      ].join("\n");
    };
  },
});
