// The polar histogram of VFH+ for a robot that one moves, and the direction that it chooses.

/** All that VFH+ computes at a pose. */
export function lookAround(world, pose, settings) {
  const seen = sense(world, pose);
  const histogram = polarHistogram(seen, settings);
  const free = freeBins(histogram, settings.threshold);
  return { seen, histogram, free, bearing: chosenBearing(histogram, targetBearing(seen), settings) };
}

/** How many openings, groups of free bins side by side, there are between 90 degrees to the right and to the left. */
export function openings(free) {
  const ahead = Array.from({ length: 37 }, (_, k) => free[(k + 54) % 72]); // from -90 to 90 degrees
  return ahead.filter((isFree, k) => isFree && !ahead[k - 1]).length;
}

export default explorable({
  controls: () => ({
    heading: range({ label: "heading", from: 0, to: 350, step: 10, value: 0, text: (value) => `${value}°` }),
    clearance: range({ label: "clearance", from: 0.5, to: 3, step: 0.1, value: 1, text: (value) => `${value} m` }),
    threshold: range({ label: "threshold", from: 0.1, to: 1.5, step: 0.1, value: 0.3 }),
  }),
  start: ({ pose: [x, y] }) => ({ x, y }),
  draw({ given: { world }, stage, act }) {
    let now = null;
    const board = mapForRobot(world, () => now, (place) => act((state) => Object.assign(state, place)));
    const bars = plot({ x: [-180, 180], y: [0, 3], xLabel: "degrees (left is +)", yLabel: "obstacle", xTicks: [-180, -90, 0, 90, 180] });
    stage.append(h("figure", {}, board.canvas, h("p", { class: "told" }, "Drag the robot, touch where it should be, or use the arrow keys.")), h("figure", {}, bars.element));
    return ({ x, y, heading, clearance, threshold }) => {
      now = { x, y, heading: (heading * Math.PI) / 180 };
      const { seen, histogram, free, bearing } = lookAround(world, now, { clearance, threshold, halfWidth: 0, wide: 16, keep: 0.2 });
      board.begin(world.size);
      world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.target(world.target);
      board.sectors(now, seen.ranges);
      board.robot(now);
      if (bearing !== null) {
        const way = now.heading + bearing;
        board.line([[x, y], [x + 8 * Math.cos(way), y + 8 * Math.sin(way)]], PALETTE.VERMILION, 3);
      }
      const shapes = histogram.map((value, b) => {
        const from = (BIN_BEARINGS[b] * 180) / Math.PI - 2.5;
        const top = Math.min(value, 3);
        return svg("rect", {
          x: bars.X(Math.max(from, -180)), y: bars.Y(top), width: bars.X(5) - bars.X(0) - 0.5, height: bars.Y(0) - bars.Y(top),
          fill: free[b] ? PALETTE.GREEN : PALETTE.ORANGE,
        });
      });
      const count = openings(free);
      const degrees = bearing === null ? null : Math.round((bearing * 180) / Math.PI);
      const side = degrees === 0 ? "straight ahead" : `${Math.abs(degrees)}° to the ${degrees > 0 ? "left" : "right"}`;
      const choice = bearing === null ? "Nothing is free: the robot steps back." : `It goes ${side}, where the red line points.`;
      bars.put(
        `Polar histogram with ${count} openings. ${choice}`, ...shapes,
        bars.line([[-180, threshold], [180, threshold]], { stroke: PALETTE.VERMILION }),
        bearing === null ? svg("g", {}) : bars.line([[degrees, 0], [degrees, 3]], { stroke: PALETTE.VERMILION, "stroke-dasharray": "4 4" }),
      );
      set(board.canvas, { "aria-label": `Map. The robot is at ${number(x, 1)}, ${number(y, 1)} and heads ${heading} degrees. Arrow keys move it by a metre.` });
      return `Between 90° to the right and 90° to the left there ${count === 1 ? "is 1 opening" : `are ${count} openings`}, in which the bars stay below the threshold.\n\n${choice}`;
    };
  },
});
