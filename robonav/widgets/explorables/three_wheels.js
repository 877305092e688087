// How fast three omnidirectional wheels turn for a motion of their base.

const ANGLES = [60, 180, 300].map((degrees) => (degrees * Math.PI) / 180); // where the wheels are, seen from the middle
const RADIUS = 0.2; // of a wheel, in m
const ARM = 0.7; // from the middle of the base to a wheel, in m

/** How fast the wheels turn, in rad/s, for a velocity of the base forward and to the left in m/s, and its turn in rad/s. */
export const wheelSpeeds = (forward, left, turn) =>
  ANGLES.map((angle) => (-Math.sin(angle) * forward + Math.cos(angle) * left + ARM * turn) / RADIUS);

const HALF = 22; // of a bar's width

export default explorable({
  controls: ({ forward, left, turn }) => ({
    forward: range({ label: "forward", from: -2, to: 2, step: 0.25, value: forward, text: (value) => `${value.toFixed(2)} m/s` }),
    left: range({ label: "to the left", from: -2, to: 2, step: 0.25, value: left, text: (value) => `${value.toFixed(2)} m/s` }),
    turn: range({ label: "turn", from: -2, to: 2, step: 0.25, value: turn, text: (value) => `${value.toFixed(2)} rad/s` }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, 4], y: [-30, 30], xLabel: "number of the wheel", yLabel: "speed (rad/s)" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "speed of a wheel; above 0 it drives the base counter-clockwise"])));
    return ({ forward, left, turn }) => {
      const speeds = wheelSpeeds(forward, left, turn);
      chart.put(
        "The speeds of the three wheels",
        chart.line([[0, 0], [4, 0]], { stroke: "currentColor", "stroke-width": 1 }),
        ...speeds.map((speed, k) => {
          const [top, bottom] = [chart.Y(Math.max(speed, 0)), chart.Y(Math.min(speed, 0))];
          return svg("rect", { x: chart.X(k + 1) - HALF, y: top, width: 2 * HALF, height: bottom - top, fill: PALETTE.BLUE });
        }),
      );
      return [
        `Wheel 1, ahead to the left: ${number(speeds[0], 1)} rad/s.`,
        `Wheel 2, behind: ${number(speeds[1], 1)} rad/s.`,
        `Wheel 3, ahead to the right: ${number(speeds[2], 1)} rad/s.`,
      ].join("\n");
    };
  },
});
