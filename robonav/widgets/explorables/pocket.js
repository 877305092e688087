// A pocket in the way of a robot that remembers nothing.

const STEPS = 300;

/** The world with a pocket that opens towards the start: metres deep, and wide inside. */
export function withPocket(world, { depth, width }) {
  const wall = (x, y, a, b) => ({ circle: false, x, y, a: a / 2, b: b / 2, turned: 0, speed: 0, heading: 0 });
  const side = width / 2 + 1;
  const arms = depth > 0 ? [wall(60 - depth / 2, 50 + side, depth, 2), wall(60 - depth / 2, 50 - side, depth, 2)] : [];
  return { ...world, obstacles: [wall(60, 50, 2, width + 4), ...arms] };
}

/** An episode of the rule that turns to the side with more room, on a robot that knows the direction of its target. */
export function episodeInPocket(world, speed = 2) {
  let [pose, outcome] = [startPose(world), "running"];
  const path = [[pose.x, pose.y]];
  for (let step = 0; step < STEPS && outcome === "running"; step += 1) {
    const seen = sense(world, pose);
    const own = reflex(seen, speed, "exact"); // with the other reflex the robot gets out of some deeper pockets
    ({ pose, outcome } = advance(world, pose, step, own < 0 ? RULES["freer-side"](seen) : own, speed));
    path.push([pose.x, pose.y]);
  }
  return { path, outcome };
}

export default explorable({
  controls: () => ({
    depth: range({ label: "depth of the pocket", from: 0, to: 20, value: 2, text: (value) => `${value} m` }),
    width: range({ label: "width of the pocket", from: 8, to: 24, step: 2, value: 12, text: (value) => `${value} m` }),
  }),
  draw({ given, stage }) {
    const board = mapCanvas({ role: "img" });
    stage.append(h("figure", {}, board.canvas));
    return ({ depth, width }) => {
      const world = withPocket(given.world, { depth, width });
      const { path, outcome } = episodeInPocket(world);
      board.begin(world.size);
      world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.start(world.start);
      board.target(world.target);
      board.line(path, outcome === "arrived" ? PALETTE.BLUE : PALETTE.VERMILION);
      const said = { arrived: `It arrives after ${path.length - 1} s.`, collided: `It collides after ${path.length - 1} s.`, running: `After ${STEPS} s it is still going to and fro.` }[outcome];
      set(board.canvas, { "aria-label": `A pocket ${depth} m deep and ${width} m wide. ${said}` });
      return `${said}\n\nThe rule: go straight ahead unless something is nearer than 6 m ahead; then turn by 60° to the side with more room.`;
    };
  },
});
