// The forces of a potential field over a map whose obstacles one moves, and where a robot gets that follows them.

const [STEPS, BETWEEN] = [120, 2.5]; // seconds of the episode, and metres between the arrows

/** The arrows: at each free place the direction of the sum of all forces, for a robot that faces the target. */
export function arrows(world, settings) {
  const count = Math.floor(world.size / BETWEEN);
  return Array.from({ length: count * count }, (_, i) => {
    const [x, y] = [((i % count) + 0.5) * BETWEEN, (Math.floor(i / count) + 0.5) * BETWEEN];
    const heading = Math.atan2(world.target[1] - y, world.target[0] - x);
    const seen = sense(world, { x, y, heading });
    if (Math.min(...seen.ranges) < ROBOT.collision) return null;
    const [ahead, left] = totalForce(seen, settings);
    return { x, y, angle: heading + Math.atan2(left, ahead), size: Math.hypot(ahead, left) };
  }).filter(Boolean);
}

/** An episode of a robot that follows the forces and its velocity. */
export function followForces(world, settings, speed = 2) {
  let [pose, outcome] = [startPose(world), "running"];
  const path = [[pose.x, pose.y]];
  for (let step = 0; step < STEPS && outcome === "running"; step += 1) {
    const seen = sense(world, pose);
    const own = reflex(seen, speed);
    ({ pose, outcome } = advance(world, pose, step, own < 0 ? potentialFieldAction(seen, settings) : own, speed));
    path.push([pose.x, pose.y]);
  }
  return { path, outcome };
}

export default explorable({
  controls: ({ world }) => ({
    chosen: segments({ label: "move the circle", options: world.obstacles.map((_, k) => [k, ["first", "second", "third"][k]]), value: 0 }),
    repulsion: range({ label: "repulsion", from: 0, to: 160, step: 10, value: 80 }),
    inertia: range({ label: "inertia", from: 0, to: 4, step: 0.5, value: 0 }),
  }),
  start: ({ world }) => ({ centres: world.obstacles.map(({ x, y }) => [x, y]) }),
  draw({ given: { world: first }, stage, act }) {
    let now = null;
    const circles = () => now.centres.map(([x, y], k) => ({ x, y, reach: first.obstacles[k].a }));
    const put = (k, { x, y }) => act((state) => {
      state.chosen = k;
      state.centres = state.centres.map((centre, other) => (other === k ? [x, y] : centre));
    });
    const board = mapToMoveOn({ size: first.size, margin: 6 }, circles, () => now.chosen, put);
    stage.append(h("figure", {}, board.canvas, h("p", { class: "told" }, "Drag a circle, or choose one and use the arrow keys.")));
    return (state) => {
      now = state;
      const world = { ...first, obstacles: first.obstacles.map((obstacle, k) => ({ ...obstacle, x: state.centres[k][0], y: state.centres[k][1] })) };
      const settings = { repulsion: state.repulsion, influence: 10, inertia: state.inertia };
      board.begin(world.size);
      arrows(world, settings).forEach(({ x, y, angle, size }) => {
        const [dx, dy] = [Math.cos(angle), Math.sin(angle)];
        const colour = size < 0.35 ? PALETTE.VERMILION : PALETTE.SKY;
        board.line([[x - 0.8 * dx, y - 0.8 * dy], [x + 0.8 * dx, y + 0.8 * dy]], colour, 1.4);
        board.dots([x + 0.8 * dx, y + 0.8 * dy], 0, 1, { colour, radius: 2 });
      });
      world.obstacles.forEach((obstacle, k) => board.obstacle(obstacle, { marked: k === state.chosen }));
      board.start(world.start);
      board.target(world.target);
      const { path, outcome } = followForces(world, settings);
      board.line(path, PALETTE.BLUE, 2.5);
      const places = state.centres.map(([x, y]) => `${number(x, 0)}, ${number(y, 0)}`).join(" and ");
      set(board.canvas, { "aria-label": `Map with circles at ${places}. Arrow keys move the chosen circle by a metre.` });
      const said = { arrived: `The robot arrives after ${path.length - 1} s.`, collided: `The robot collides after ${path.length - 1} s.`, running: `After ${STEPS} s the robot still has not arrived.` }[outcome];
      return `${said}\n\nAn arrow is the direction of the sum of all forces on a robot that faces the target. It is red where the forces nearly cancel.`;
    };
  },
});
