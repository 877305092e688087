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
    const keys = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const clampTo = (value) => Math.min(world.size - 1, Math.max(1, Number(value.toFixed(1))));
    const put = (x, y) => act((state) => Object.assign(state, { x: clampTo(x), y: clampTo(y) }));
    const board = mapCanvas({ tabindex: 0, role: "application", "data-keys": "ArrowLeft ArrowUp", "data-touch": "" });
    const cells = ["sensor", "metres", "danger"].map((name) => [h("th", { scope: "row" }, name), ...Array.from({ length: ROBOT.sensors }, () => h("td", {}))]);
    cells[0].slice(1).forEach((cell, k) => (cell.textContent = String(k + 1)));
    stage.append(h("figure", {}, board.canvas, h("p", { class: "told" }, "Drag the robot, touch where it should be, or use the arrow keys.")),
      h("table", { class: "results" }, h("tbody", {}, ...cells.map((row) => h("tr", {}, ...row)))));
    let [now, dragging] = [null, false];
    const near = ([x, y]) => Math.hypot(x - now.x, y - now.y) < 3;
    board.canvas.addEventListener("pointerdown", (event) => {
      dragging = near(board.place(event));
      if (dragging) board.canvas.setPointerCapture(event.pointerId);
    });
    board.canvas.addEventListener("pointermove", (event) => dragging && put(...board.place(event)));
    for (const end of ["pointerup", "pointercancel"]) board.canvas.addEventListener(end, () => (dragging = false));
    board.canvas.addEventListener("click", (event) => near(board.place(event)) || put(...board.place(event)));
    board.canvas.addEventListener("keydown", (event) => {
      if (!keys[event.key]) return;
      event.preventDefault();
      put(now.x + keys[event.key][0], now.y + keys[event.key][1]);
    });
    holdFinger(board.canvas, (touch) => near(board.place(touch)));
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
