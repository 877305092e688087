// One episode in the page: its state and steps, and a map on which things are dragged. Needs simulator.js and maps.js.

const copyWorld = (world) => ({ ...world, start: [...world.start], target: [...world.target], obstacles: world.obstacles.map((o) => ({ ...o })) });
const between = (a, b, t) => a + (b - a) * t;
const COLOURS = ["BLUE", "ORANGE", "GREEN", "PURPLE", "SKY", "VERMILION"].map((name) => PALETTE[name]); // of several robots, in turn
const metres = (value) => Number(value.toFixed(1));

/** A policy with the network that Python packed. */
export const unpacked = (policy) => ({ ...policy, network: networks(policy.network)() });

/** What a policy does in an episode: its action and, for a network, what it computed on the way. */
export const driver = (policy) => (policy.rule ? ({ sensing }) => ({ action: RULES[policy.rule](sensing) })
  : ({ sensing, world, step }) => consult(policy, sensing, gumbel(world.key, step)));

// ---- The episode: state and steps, no drawing -----------------------------------------------------------------------

/** The robots of an episode at its start: the first is the world's own, each other one has a start and a target. */
const robotsAtStart = ({ start, target, key }, others) => [{ start, target }, ...others].map((ends, r) => ({
  ...ends, pose: startPose(ends), before: startPose(ends), key: [key[0], (key[1] ^ Math.imul(r, 0x9e3779b9)) >>> 0],
  outcome: "running", met: false, path: [startPose(ends)], steps: [],
}));

/**
 * An episode that can be stepped, reset and edited. What is told of "the" robot is told of the first one.
 * @param {World} first @param {number} speed @param {{start: number[], target: number[]}[]} others further robots on the map
 */
export function makeEpisode(first, speed, others = []) {
  const episode = { base: copyWorld(first), speed };
  for (const name of ["pose", "outcome", "steps", "path", "sensing"]) {
    Object.defineProperty(episode, name, { enumerable: true, get: () => episode.robots[0][name] });
  }
  const look = () => {
    for (const robot of episode.robots) robot.sensing = sense(worldAround(episode.world, episode.robots, robot), robot.pose);
  };
  episode.reset = () => {
    const world = copyWorld(episode.base);
    Object.assign(episode, { world, before: world.obstacles, step: 0, robots: robotsAtStart(world, others) });
    look();
  };
  episode.over = () => episode.robots.every(({ outcome }) => outcome !== "running");
  /** What a policy asks for when it drives a robot. */
  episode.seenBy = ({ sensing, key }) => ({ sensing, world: { key }, step: episode.step });
  /** One step of all robots; `chosen` are the policies' actions, which the reflexes may overrule. */
  episode.goAll = (chosen, reflexes = true) => {
    if (episode.over()) return;
    const { robots, speed: fast } = episode;
    const actions = robots.map(({ sensing }, r) => {
      const own = reflexes ? reflex(sensing, fast) : -1;
      return own < 0 ? chosen[r] : own;
    });
    episode.before = episode.world.obstacles;
    const after = advanceTeam(episode.world, robots, episode.step, actions, fast);
    episode.robots = after.robots.map((robot, r) => {
      const { pose, sensing, outcome } = robots[r];
      if (outcome !== "running") return { ...robot, before: pose };
      robot.path.push(robot.pose);
      robot.steps.push({ pose, sensing, action: actions[r] });
      return { ...robot, before: pose };
    });
    Object.assign(episode, { world: after.world, step: episode.step + 1 });
    look();
  };
  /** One step of the only robot. */
  episode.go = (chosen, reflexes = true) => episode.goAll([chosen], reflexes);
  /** Change the world now and for the next start. */
  episode.edit = (change) => {
    change(episode.base);
    if (episode.step === 0) episode.reset();
    else {
      change(episode.world);
      episode.before = episode.world.obstacles;
      episode.robots.forEach((robot) => (robot.before = robot.pose));
      episode.robots[0].target = episode.world.target;
      look();
    }
  };
  episode.reset();
  return episode;
}

// ---- The map ----------------------------------------------------------------------------------------------------------

export function episodeMap({ episode, selected, grabbed, moved }) {
  const board = mapCanvas({ tabindex: 0, role: "application" });
  const { canvas, place } = board;

  const thingAt = ([x, y]) => {
    const { world, pose } = episode();
    if (Math.hypot(x - pose.x, y - pose.y) < 4) return "robot";
    if (Math.hypot(x - world.target[0], y - world.target[1]) < 4) return "target";
    const distances = world.obstacles.map((o) => Math.hypot(x - o.x, y - o.y) - Math.max(o.a, o.b, 2));
    const nearest = distances.indexOf(Math.min(...distances));
    return nearest >= 0 && distances[nearest] <= 0 ? nearest : null;
  };
  let dragging = null;
  canvas.addEventListener("pointerdown", (event) => {
    dragging = thingAt(place(event));
    if (dragging === null) return;
    grabbed(dragging);
    canvas.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => dragging !== null && moved(dragging, place(event)));
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (dragging = null));
  holdFinger(canvas, (touch) => thingAt(place(touch)) !== null);

  const poseAt = ({ pose, before }, t) => {
    const turn = Math.atan2(Math.sin(pose.heading - before.heading), Math.cos(pose.heading - before.heading));
    return { x: between(before.x, pose.x, t), y: between(before.y, pose.y, t), heading: before.heading + turn * Math.min(1, 3 * t) };
  };
  /** Whether a robot of several has left the map. */
  const hasLeft = ({ outcome, before, pose }, t) => outcome !== "running" && (t >= 1 || before === pose);
  const drawWay = ({ path }, now, colour, width) => board.line([...path.slice(0, -1), now].map(({ x, y }) => [x, y]), colour, width);
  /** A robot of several: its way, and itself, or a cross where it collided. */
  const drawOneOfSeveral = (robot, t, colour, width) => {
    const now = poseAt(robot, t);
    drawWay(robot, now, colour, width);
    if (!hasLeft(robot, t)) board.robot(now, colour);
    else if (robot.outcome === "collided") board.cross(now, colour);
  };
  /** The moment at part t of the way from the last step's beginning to now. */
  const draw = (t) => {
    const { world, before, robots, sensing, outcome } = episode();
    const obstacles = world.obstacles.map((o, m) => {
      const old = before[m] ?? o;
      return { ...o, x: between(old.x, o.x, t), y: between(old.y, o.y, t) };
    });
    const now = poseAt(robots[0], t);
    const around = () => worldAround({ ...world, obstacles }, robots.map((robot) => ({ ...robot, pose: poseAt(robot, t) })), robots[0]);
    board.begin(world.size);
    obstacles.forEach((o, m) => board.obstacle(o, { marked: selected() === m }));
    robots.slice(1).forEach((robot, k) => {
      const colour = COLOURS[(k + 1) % COLOURS.length];
      board.start(robot.start, colour);
      board.target(robot.target, false, colour);
      drawOneOfSeveral(robot, t, colour, 1.2);
    });
    board.start(world.start);
    board.target(world.target, selected() === "target");
    const way = outcome === "collided" ? PALETTE.VERMILION : PALETTE.BLUE;
    if (robots.length > 1 && hasLeft(robots[0], t)) {
      drawOneOfSeveral(robots[0], t, way);
      return;
    }
    board.sectors(now, t >= 1 ? sensing.ranges : sense(around(), now).ranges);
    drawWay(robots[0], now, way);
    board.robot(now);
  };
  return { canvas, draw };
}
