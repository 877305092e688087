// What a ring of sectors and a picture show of the same surroundings, for a robot that one moves and turns.

/** The least distance in each of some equal sectors around the robot. Sector 0 looks ahead; they go round counter-clockwise. */
export function ringRanges(world, { x, y, heading }, sectors) {
  const [ranges, width] = [new Array(sectors).fill(ROBOT.range), (2 * Math.PI) / sectors];
  const put = (sector, distance) => see(ranges, modulo(sector, sectors), distance);
  const towards = (dx, dy, distance) => put(Math.floor((Math.atan2(dy, dx) - heading) / width + 0.5), distance);
  const rays = ranges.map((_, k) => [Math.cos(heading + (k + 0.5) * width), Math.sin(heading + (k + 0.5) * width)]);
  /** Lets the sectors on both sides of each ray see what the ray meets at a distance. */
  const along = (distanceOn) => rays.forEach(([rx, ry], k) => {
    const distance = distanceOn(rx, ry);
    put(k, distance);
    put(k + 1, distance);
  });
  const walls = [[-x, 0], [world.size - x, 0], [0, -y], [0, world.size - y]];
  walls.forEach(([dx, dy]) => towards(dx, dy, Math.hypot(dx, dy)));
  along((rx, ry) => boxEntry(x - world.size / 2, y - world.size / 2, rx, ry, world.size / 2, world.size / 2)[1]);
  for (const { circle, x: ox, y: oy, a, b, turned } of world.obstacles) {
    const [dx, dy, c, s] = [ox - x, oy - y, Math.cos(turned), Math.sin(turned)];
    if (circle) {
      if (Math.hypot(dx, dy) <= a) return ranges.fill(0);
      towards(dx, dy, Math.hypot(dx, dy) - a);
      along((rx, ry) => {
        const [ahead, across] = [dx * rx + dy * ry, dx * ry - dy * rx];
        return ahead > 0 && Math.abs(across) <= a ? ahead - Math.sqrt(a * a - across * across) : Infinity;
      });
    } else {
      const [px, py] = [-(c * dx + s * dy), -(c * dy - s * dx)]; // the robot in the rectangle's frame
      const [nx, ny] = [clamp(px, -a, a) - px, clamp(py, -b, b) - py];
      if (nx === 0 && ny === 0) return ranges.fill(0);
      towards(c * nx - s * ny, s * nx + c * ny, Math.hypot(nx, ny));
      along((rx, ry) => {
        const [enter, leave] = boxEntry(px, py, c * rx + s * ry, c * ry - s * rx, a, b);
        return enter >= 0 && enter <= leave ? enter : Infinity;
      });
    }
  }
  return ranges.map(micrometres);
}

/** The cells [row, column] of a picture whose middles are in an obstacle or beyond the border; row 0 is farthest ahead, column 0 farthest left. */
export function coveredCells(world, { x, y, heading }, cells) {
  const [c, s, width] = [Math.cos(heading), Math.sin(heading), (2 * ROBOT.range) / cells];
  const covered = [];
  for (let row = 0; row < cells; row += 1) {
    for (let column = 0; column < cells; column += 1) {
      const [forward, left] = [ROBOT.range - (row + 0.5) * width, ROBOT.range - (column + 0.5) * width];
      if (forward * forward + left * left > ROBOT.range * ROBOT.range) continue;
      const [px, py] = [x + c * forward - s * left, y + s * forward + c * left];
      const beyond = px < 0 || py < 0 || px > world.size || py > world.size;
      if (beyond || world.obstacles.some((o) => holdsPoint(o, px - o.x, py - o.y))) covered.push([row, column]);
    }
  }
  return covered;
}

/** Whether an obstacle holds a point that is (dx, dy) away from its middle. */
function holdsPoint({ circle, a, b, turned }, dx, dy) {
  if (circle) return dx * dx + dy * dy <= a * a;
  const [c, s] = [Math.cos(turned), Math.sin(turned)];
  return Math.abs(c * dx + s * dy) <= a && Math.abs(c * dy - s * dx) <= b;
}

const [CELLS, PIXELS] = [32, 8]; // of a side of the picture, and of a cell on the page

export default explorable({
  controls: () => ({
    sectors: segments({ label: "sectors", options: [9, 18, 36, 72], value: 9 }),
    heading: range({ label: "heading", from: 0, to: 355, step: 5, value: 0, text: (value) => `${value}°` }),
  }),
  start: ({ pose: [x, y] }) => ({ x, y }),
  draw({ given: { world }, stage, act }) {
    let now = null;
    const side = CELLS * PIXELS;
    const board = mapForRobot(world, () => now, (place) => act((state) => Object.assign(state, place)));
    const picture = svg("svg", { viewBox: `0 0 ${side} ${side}`, role: "img", width: side, height: side });
    stage.append(
      h("figure", {}, board.canvas, h("p", { class: "told" }, "Drag the robot, touch where it should be, or use the arrow keys.")),
      h("figure", {}, picture, h("p", { class: "told" }, "The picture of 32 × 32 cells: the robot is in the middle and heads upwards.")),
    );
    return ({ x, y, heading, sectors }) => {
      now = { x, y, heading: (heading * Math.PI) / 180 };
      const ranges = ringRanges(world, now, sectors);
      const covered = coveredCells(world, now, CELLS);
      board.begin(world.size);
      world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.target(world.target);
      board.sectors(now, ranges);
      board.robot(now);
      set(board.canvas, { "aria-label": `Map. The robot is at ${number(x, 1)}, ${number(y, 1)} and heads ${heading} degrees. Arrow keys move it by a metre.` });
      set(picture, { "aria-label": `Picture in which ${covered.length} cells are dark.` });
      picture.replaceChildren(
        svg("circle", { cx: side / 2, cy: side / 2, r: side / 2, fill: "none", stroke: PALETTE.BLUE }),
        ...covered.map(([row, column]) => svg("rect", { x: column * PIXELS, y: row * PIXELS, width: PIXELS, height: PIXELS, fill: PALETTE.OBSTACLE })),
        svg("path", { d: `M ${side / 2} ${side / 2 - 12} l 7 18 h -14 Z`, fill: PALETTE.ROBOT }),
      );
      const free = ranges.filter((range) => range >= ROBOT.range).length;
      const ahead = ranges[0] < ROBOT.range ? `reads ${number(ranges[0])} m` : "is free";
      return [
        `The sector ahead, ${number(360 / sectors, 0)}° wide, ${ahead}.`,
        `${free} of ${sectors} sectors are free, together ${number((free * 360) / sectors, 0)}° of 360°.`,
        `The picture has ${covered.length} dark cells.`,
      ].join("\n");
    };
  },
});
