// Where the robot's reflexes act, and where the policy decides.

const [SAFE, ASKED, BLOCKED, HIT] = [0, 1, 2, 3];
const STEP = 2; // metres between the places looked at

/** What happens at each place of a map, row by row from below, for a robot that faces the target and sees `sight` metres. */
export function decisions(world, { sight, speed }) {
  const count = world.size / STEP;
  const [tx, ty] = world.target;
  return Array.from({ length: count * count }, (_, i) => {
    const [x, y] = [((i % count) + 0.5) * STEP, (Math.floor(i / count) + 0.5) * STEP];
    const { ranges } = sense(world, { x, y, heading: Math.atan2(ty - y, tx - x) });
    const nearest = Math.min(...ranges);
    if (nearest < ROBOT.collision) return HIT;
    if (nearest >= sight) return SAFE;
    const seen = ranges.map((distance) => (distance < sight ? distance : ROBOT.range));
    return reflex({ ranges: seen }, speed) === ROBOT.backward ? BLOCKED : ASKED;
  });
}

export default explorable({
  controls: ({ worlds, maps, map, speed }) => ({
    map: segments({ label: maps, options: worlds.map(({ name }, k) => [k, name]), value: map }),
    sight: segments({ label: "the sensors see", options: [2, 4, 6, 8, 10].map((metres) => [metres, `${metres} m`]), value: 10 }),
    speed: range({ label: "speed", from: 1, to: 8, value: speed, text: (value) => `${value} m/s` }),
  }),
  draw({ given: { worlds }, stage }) {
    const board = mapCanvas({ role: "img" });
    const colours = [PALETTE.GREEN, PALETTE.SKY, PALETTE.VERMILION];
    stage.append(h("figure", {}, board.canvas, legend([colours[SAFE], "goes to the target by itself"], [colours[ASKED], "the policy decides"], [colours[BLOCKED], "steps back by itself"])));
    return ({ map, sight, speed }) => {
      const world = worlds[map];
      const all = decisions(world, { sight, speed });
      const count = world.size / STEP;
      board.begin(world.size);
      colours.forEach((colour, kind) => {
        const flat = all.flatMap((own, i) => (own === kind ? [((i % count) + 0.5) * STEP, (Math.floor(i / count) + 0.5) * STEP] : []));
        board.dots(flat, 0, flat.length / 2, { colour, radius: 4, alpha: 0.75 });
      });
      world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.start(world.start);
      board.target(world.target);
      if (world.path) board.line(world.path, PALETTE.INK, 2);
      const free = all.filter((kind) => kind !== HIT).length;
      const share = (kind) => number((100 * all.filter((own) => own === kind).length) / free, 1);
      set(board.canvas, { "aria-label": `Map with ${world.obstacles.length} obstacles; the policy decides in ${share(ASKED)} % of its free places` });
      return [
        "Of all places where the robot can stand, facing the target:",
        `it goes to the target by itself in ${share(SAFE)} %,`, `the policy decides in ${share(ASKED)} %,`, `it steps back by itself in ${share(BLOCKED)} %.`,
      ].join("\n");
    };
  },
});
