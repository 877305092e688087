// The book's first screen: a robot crosses one map after another. Stop it, put obstacles in its way, or steer it yourself.

const STEPS_A_SECOND = 8;
const REST = 1200; // milliseconds between two maps
const PATIENCE = 300; // steps after which the network has lost its way

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
    selected: () => null,
    grabbed: () => {},
    moved: (name, point) => {
      if (name === "robot") return;
      const [x, y] = point.map((value) => clamp(value, 0, episode.world.size));
      episode.edit((w) => (name === "target" ? (w.target = [x, y]) : Object.assign(w.obstacles[name], { x, y })));
      say();
      board.draw(t);
    },
  });

  function say() {
    const record = `${tally.arrived} arrived, ${tally.collided} collided.`;
    const now = { arrived: "Arrived.", collided: "Collided.", running: isLost() ? `Not arrived after ${PATIENCE} s.` : mine ? `You steer. ${howToSteer()}` : running ? about : "Stopped." }[episode.outcome];
    status.textContent = tally.arrived + tally.collided > 0 ? `${now} So far ${record}` : now;
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
    say();
    board.draw(t);
    if (running && !mine) wake();
  }
  function tick(time) {
    frame = 0;
    t = Math.min(1, t + (Math.min(time - last, 100) / 1000) * STEPS_A_SECOND);
    last = time;
    const drives = () => running && !mine && episode.outcome === "running" && !isLost();
    if (t >= 1 && drives()) step(decide(episode).action);
    board.draw(t);
    if (t < 1 || drives()) wake();
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
  };
  const take = (action) => {
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
  const wheel = steeringButtons({ label: "Steer, one second at a time", take });
  board.canvas.addEventListener("keydown", (event) => {
    const action = keyAction(event);
    if (action === null) return;
    event.preventDefault();
    take(action);
  });
  const forgetPads = watchPads(take);

  asWidget(el, "A robot that crosses one map after another", "first-screen");
  el.replaceChildren(
    board.canvas,
    h("div", { class: "beside" },
      h("div", { class: "row tools" }, play, steer, another),
      wheel,
      h("p", { class: "calls" }, ...links.map(({ text, page }) => h("a", { class: "call", href: page }, text))),
      status,
      h("p", { class: "hint" }, "Drag an obstacle in front of the robot, or drag the target.")));
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
