// Too fast for its sensors: a robot that turns when something is near, at every speed.

const [STARTS, STEPS] = [40, 400];

/** Forty episodes that differ in where they start by a part of one step: the path and the end of each. */
export function episodes(world, { speed, turnAt }) {
  return Array.from({ length: STARTS }, (_, k) => {
    const first = { ...world, start: [world.start[0] + (k * speed) / STARTS, world.start[1]] };
    let [pose, outcome] = [startPose(first), "running"];
    const path = [[pose.x, pose.y]];
    for (let step = 0; step < STEPS && outcome === "running"; step += 1) {
      const seen = sense(first, pose);
      const own = reflex(seen, speed);
      const chosen = seen.ranges[0] < turnAt ? 2 : 0;
      ({ pose, outcome } = advance(first, pose, step, own < 0 ? chosen : own, speed));
      path.push([pose.x, pose.y]);
    }
    return { path, outcome };
  });
}

export default explorable({
  controls: ({ speed, turnAt }) => ({
    speed: range({ label: "speed", from: 1, to: 9, step: 0.5, value: speed, text: (value) => `${value} m/s` }),
    turnAt: segments({ label: "turns when something ahead is nearer than", options: [4, 6, 8, 10].map((metres) => [metres, `${metres} m`]), value: turnAt }),
  }),
  draw({ given: { world }, stage }) {
    const board = mapCanvas({ role: "img" });
    stage.append(h("figure", {}, board.canvas, legend([PALETTE.BLUE, "arrives"], [PALETTE.VERMILION, "collides"])));
    return ({ speed, turnAt }) => {
      const all = episodes(world, { speed, turnAt });
      const hits = all.filter(({ outcome }) => outcome === "collided").length;
      board.begin(world.size);
      world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.target(world.target);
      all.forEach(({ path, outcome }) => board.line(path, outcome === "collided" ? PALETTE.VERMILION : PALETTE.BLUE, 1));
      set(board.canvas, { "aria-label": `Forty episodes past one obstacle; ${hits} collide` });
      return [
        `${hits} of ${STARTS} episodes collide.`, "",
        `In one second the robot goes ${speed} m, and it senses once a second. So it may notice the obstacle as late as ${number(Math.max(0, turnAt - speed), 1)} m away.`,
      ].join("\n");
    };
  },
});
