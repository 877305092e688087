// One episode in the page: its state and steps, and a map on which things are dragged. Needs simulator.js and maps.js.

const copyWorld = (world) => ({ ...world, start: [...world.start], target: [...world.target], obstacles: world.obstacles.map((o) => ({ ...o })) });
const between = (a, b, t) => a + (b - a) * t;
const metres = (value) => Number(value.toFixed(1));

/** A policy with the network that Python packed. */
export const unpacked = (policy) => ({ ...policy, network: networks(policy.network)() });

/** What a policy does in an episode: its action and, for a network, what it computed on the way. */
export const driver = (policy) => (policy.rule ? ({ sensing }) => ({ action: RULES[policy.rule](sensing) })
  : ({ sensing, world, step }) => consult(policy, sensing, gumbel(world.key, step)));

// ---- The episode: state and steps, no drawing -----------------------------------------------------------------------

/** An episode that can be stepped, reset and edited. */
export function makeEpisode(first, speed) {
  const episode = { base: copyWorld(first), speed };
  episode.reset = () => {
    Object.assign(episode, { world: copyWorld(episode.base), pose: startPose(episode.base), step: 0, outcome: "running", steps: [] });
    episode.before = { pose: episode.pose, obstacles: episode.world.obstacles };
    episode.path = [episode.pose];
    episode.sensing = sense(episode.world, episode.pose);
  };
  /** One step; `chosen` is the policy's action, which the reflexes may overrule. */
  episode.go = (chosen, reflexes = true) => {
    if (episode.outcome !== "running") return;
    const own = reflexes ? reflex(episode.sensing, episode.speed) : -1;
    const action = own < 0 ? chosen : own;
    episode.steps.push({ pose: episode.pose, sensing: episode.sensing, action });
    episode.before = { pose: episode.pose, obstacles: episode.world.obstacles };
    const { world, pose, outcome } = advance(episode.world, episode.pose, episode.step, action, episode.speed);
    Object.assign(episode, { world, pose, outcome, step: episode.step + 1 });
    episode.path.push(pose);
    episode.sensing = sense(world, pose);
  };
  /** Change the world now and for the next start. */
  episode.edit = (change) => {
    change(episode.base);
    if (episode.step === 0) episode.reset();
    else {
      change(episode.world);
      episode.before = { pose: episode.pose, obstacles: episode.world.obstacles };
      episode.sensing = sense(episode.world, episode.pose);
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

  /** The moment at part t of the way from the last step's beginning to now. */
  const draw = (t) => {
    const { world, pose, before, path, sensing, outcome } = episode();
    const obstacles = world.obstacles.map((o, m) => {
      const old = before.obstacles[m] ?? o;
      return { ...o, x: between(old.x, o.x, t), y: between(old.y, o.y, t) };
    });
    const turn = Math.atan2(Math.sin(pose.heading - before.pose.heading), Math.cos(pose.heading - before.pose.heading));
    const now = { x: between(before.pose.x, pose.x, t), y: between(before.pose.y, pose.y, t), heading: before.pose.heading + turn * Math.min(1, 3 * t) };
    board.begin(world.size);
    obstacles.forEach((o, m) => board.obstacle(o, { marked: selected() === m }));
    board.start(world.start);
    board.target(world.target, selected() === "target");
    board.sectors(now, t >= 1 ? sensing.ranges : sense({ ...world, obstacles }, now).ranges);
    board.line([...path.slice(0, -1), now].map(({ x, y }) => [x, y]), outcome === "collided" ? PALETTE.VERMILION : PALETTE.BLUE);
    board.robot(now);
  };
  return { canvas, draw };
}
