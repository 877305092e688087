// The book's first screen: a robot crosses one map after another. Stop it, put obstacles in its way, or steer it yourself.

const STEPS_A_SECOND = 8;
const REST = 1200; // milliseconds between two maps
const PATIENCE = 300; // steps after which the network has lost its way
const [NUDGE, PUSH] = [2, 10]; // metres that an arrow key moves a thing, alone and with Shift

function render({ model, el }) {
  const { policy, about, links, keys, obstacles, speed } = model.get("data");
  const decide = driver(unpacked(policy));
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  let [map, t, last, frame, timer, tally] = [0, 1, 0, 0, 0, { arrived: 0, collided: 0 }];
  let [running, mine] = [!still, false];
  /** Whether the network has driven for so long that it will not arrive, as behind obstacles that the reader put there. */
  const isLost = () => !mine && episode.outcome === "running" && episode.step >= PATIENCE;
  const world = () => drawWorld(keys[map % keys.length], { obstacles });
  let episode = makeEpisode(world(), speed);
  const status = h("p", { class: "status", role: "status" });

  const board = episodeMap({
    episode: () => episode,
    selected: () => queue[0] ?? null,
    grabbed: () => {},
    moved: (name, point) => move(name, point),
  });
  function move(name, point) {
    if (name === "robot") return;
    const [x, y] = point.map((value) => clamp(value, 0, episode.world.size));
    episode.edit((w) => (name === "target" ? (w.target = [x, y]) : Object.assign(w.obstacles[name], { x, y })));
    say();
    board.draw(t);
  }

  // What the arrow keys move: the first of the queue, an obstacle by its number or the target; the robot, where it is empty.
  let queue = [];
  const placeOf = (name) => (name === "target" ? episode.world.target : [episode.world.obstacles[name].x, episode.world.obstacles[name].y]);
  /** The obstacles and the target, the nearest to the robot first. */
  const nearestFirst = () => {
    const distance = (name) => Math.hypot(placeOf(name)[0] - episode.pose.x, placeOf(name)[1] - episode.pose.y);
    return [...episode.world.obstacles.keys(), "target"].sort((one, other) => distance(one) - distance(other));
  };
  const take = (things) => {
    queue = things;
    hold.setAttribute("aria-pressed", String(queue.length > 0));
    say();
    board.draw(t);
  };
  /** A key for the thing that is held; returns whether it meant anything. */
  const keyOfHeld = ({ key, shiftKey }) => {
    const [name, ...others] = queue;
    if (key === "Escape") take([]);
    else if (key === "Enter") take([...others, name]);
    else if (key in MAP_KEYS) move(name, placeOf(name).map((value, axis) => value + MAP_KEYS[key][axis] * (shiftKey ? PUSH : NUDGE)));
    else return false;
    return true;
  };
  const heldWords = () => {
    const [x, y] = placeOf(queue[0]).map((value) => Math.round(value));
    return `${queue[0] === "target" ? "The target" : "An obstacle"}, ${x} m from the left and ${y} m from below. Arrow keys move it, with Shift further. Enter: another one. Escape: let go.`;
  };

  function say() {
    const record = `${tally.arrived} arrived, ${tally.collided} collided.`;
    const now = { arrived: "Arrived.", collided: "Collided.", running: isLost() ? `Not arrived after ${PATIENCE} s.` : mine ? `You steer. ${howToSteer()}` : running ? about : "Stopped." }[episode.outcome];
    status.textContent = queue.length > 0 ? heldWords() : tally.arrived + tally.collided > 0 ? `${now} So far ${record}` : now;
    board.canvas.setAttribute("aria-label", `Map with ${episode.world.obstacles.length} obstacles and a robot. ${status.textContent}`);
    play.textContent = mine ? "Let the network steer" : running ? "Stop" : "Go on";
    wheel.hidden = !mine;
  }
  function step(chosen) {
    if (t < 1) t = 1;
    episode.go(chosen);
    t = 0;
    if (isLost() || (episode.outcome !== "running" && episode.steps.length > 0)) {
      if (!isLost()) tally[episode.outcome] += 1;
      clearTimeout(timer);
      timer = setTimeout(next, REST);
    }
    say();
    wake();
  }
  function next() {
    map += 1;
    episode = makeEpisode(world(), speed);
    t = 1;
    if (queue.length > 0) queue = nearestFirst();
    say();
    board.draw(t);
    if (running && !mine) wake();
  }
  function tick(time) {
    frame = 0;
    t = Math.min(1, t + (Math.min(time - last, 100) / 1000) * STEPS_A_SECOND);
    last = time;
    const driving = () => running && !mine && episode.outcome === "running" && !isLost();
    if (t >= 1 && driving()) step(decide(episode).action);
    board.draw(t);
    if (t < 1 || driving()) wake();
  }
  const wake = () => {
    if (frame) return;
    last = performance.now();
    frame = requestAnimationFrame(tick);
  };
  /** From now on the reader steers, also where the network had lost its way. */
  const takeOver = () => {
    if (isLost()) clearTimeout(timer);
    mine = true;
    take([]);
  };
  const steerBy = (action) => {
    takeOver();
    if (episode.outcome === "running") step(action);
    else say();
  };
  const play = h("button", { type: "button", class: "main", click: () => {
    running = mine || !running;
    mine = false;
    say();
    if (running) wake();
  } });
  const steer = h("button", { type: "button", click: () => {
    takeOver();
    say();
    board.canvas.focus();
  } }, "Steer it yourself");
  const another = h("button", { type: "button", click: () => { clearTimeout(timer); next(); } }, "Another map");
  const hold = h("button", { type: "button", "aria-pressed": "false", hidden: touchOnly(), click: () => {
    take(queue.length > 0 ? [] : nearestFirst());
    if (queue.length > 0) board.canvas.focus();
  } }, "Move an obstacle");
  const wheel = steeringButtons({ label: "Steer, one second at a time", take: steerBy });
  board.canvas.addEventListener("keydown", (event) => {
    if (queue.length > 0) {
      if (keyOfHeld(event)) event.preventDefault();
      return;
    }
    const action = keyAction(event);
    if (action === null) return;
    event.preventDefault();
    steerBy(action);
  });
  const forgetPads = watchPads(steerBy);

  asWidget(el, "A robot that crosses one map after another", "first-screen");
  el.replaceChildren(
    board.canvas,
    h("div", { class: "beside" },
      h("div", { class: "row tools" }, play, steer, another, hold),
      wheel,
      h("p", { class: "calls" }, ...links.map(({ text, page }) => h("a", { class: "call", href: page }, text))),
      status,
      h("p", { class: "hint" }, `Drag an obstacle in front of the robot, or drag the target.${touchOnly() ? "" : " By keyboard: press Move an obstacle."}`)));
  say();
  board.draw(1);
  if (running) wake();
  return () => {
    forgetPads();
    clearTimeout(timer);
    cancelAnimationFrame(frame);
  };
}

export default { render };
