// What nine sensors read, for a robot that one moves and turns.

/** What the robot at a pose reads, and how dangerous each reading is (Table 3.1). */
export function readings(world, pose) {
  const { ranges, walls, region } = sense(world, pose);
  return { ranges, walls, region, degrees: ranges.map(degreeOfDanger) };
}

export default explorable({
  controls: () => ({
    left: press({ label: "Turn 40° left", act: (state) => (state.heading = (state.heading + 40) % 360) }),
    right: press({ label: "Turn 40° right", act: (state) => (state.heading = (state.heading + 320) % 360) }),
    heading: range({ label: "heading", from: 0, to: 350, step: 10, value: 40, text: (value) => `${value}°` }),
  }),
  start: ({ pose: [x, y] }) => ({ x, y }),
  draw({ given: { world }, stage, act }) {
    let now = null;
    const board = mapForRobot(world, () => now, (place) => act((state) => Object.assign(state, place)));
    const cells = ["sensor", "metres", "danger"].map((name) => [h("th", { scope: "row" }, name), ...Array.from({ length: ROBOT.sensors }, () => h("td", {}))]);
    cells[0].slice(1).forEach((cell, k) => (cell.textContent = String(k + 1)));
    stage.append(h("figure", {}, board.canvas, h("p", { class: "told" }, "Drag the robot, touch where it should be, or use the arrow keys.")),
      h("table", { class: "results" }, h("tbody", {}, ...cells.map((row) => h("tr", {}, ...row)))));
    return ({ x, y, heading }) => {
      now = { x, y, heading: (heading * Math.PI) / 180 };
      const read = readings(world, now);
      board.begin(world.size);
      world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.target(world.target);
      board.sectors(now, read.ranges);
      board.robot(now);
      read.ranges.forEach((metres, k) => {
        cells[1][k + 1].textContent = metres < ROBOT.range ? number(metres, 1) : String(ROBOT.range);
        cells[2][k + 1].textContent = String(read.degrees[k]);
      });
      const nearest = Math.min(...read.ranges);
      const at = read.ranges.indexOf(nearest);
      set(board.canvas, { "aria-label": `Map. The robot is at ${number(x, 1)}, ${number(y, 1)} and heads ${heading} degrees. Arrow keys move it by a metre.` });
      return nearest < ROBOT.range
        ? `Sensor ${at + 1} reads least: ${number(nearest, 1)} m, ${read.walls[at] ? "to the border of the map" : "to an obstacle"}, degree of danger ${read.degrees[at]}. The target is in sector ${read.region}.`
        : `Nothing is within ${ROBOT.range} m: all sensors read ${ROBOT.range} m. The target is in sector ${read.region}.`;
    };
  },
});
