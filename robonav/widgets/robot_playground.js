// Robot playground: the simulator in the reader's hands. Move things, pick who drives, or drive yourself.

const ME = { name: "you", decide: null, picture: null };
const PACES = [1, 2, 3, 5, 8, 12, 20, 40]; // steps a second

/** What a network's inputs are called: sensors, the target's sector V, whether it is seen I, wall flags. */
export const inputsOf = ({ sensors, walls, target }) =>
  [...sensors.map(String), ...TARGETS[target](1).map(() => "V"), "I", ...(walls ? sensors.map((sensor) => `wall ${sensor}`) : [])];

// ---- What stands beside it ------------------------------------------------------------------------------------------

/** The nine readings as a table. */
function readings() {
  const rows = Array.from({ length: ROBOT.sensors }, (_, k) => {
    const cells = [h("td", {}), h("td", {}), h("td", {})];
    return { element: h("tr", {}, h("th", { scope: "row" }, String(k + 1)), ...cells), cells };
  });
  const element = h("table", { class: "readings" },
    h("caption", {}, "What the sensors read"),
    h("thead", {}, h("tr", {}, ...["sensor", "range (m)", "danger", "sees"].map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, ...rows.map((row) => row.element)));
  const show = ({ ranges, walls }) => rows.forEach(({ cells }, k) => {
    const near = ranges[k] < ROBOT.range;
    cells[0].textContent = ranges[k].toFixed(2);
    cells[1].textContent = String(degreeOfDanger(ranges[k]));
    cells[2].textContent = near ? (walls[k] ? "wall" : "obstacle") : "nothing";
  });
  return { element, show };
}

/** Fields that say and change where the chosen thing is: the keyboard's way to drag. */
function inspector({ episode, selected, select, changed, removed }) {
  const list = h("select", { "aria-label": "Thing to change", change: () => select(list.value === "robot" || list.value === "target" ? list.value : Number(list.value)) });
  const fields = h("span", { class: "fields" });
  let shown = [];
  /** A number of the world; `read` and `write` are given the world. */
  const field = (label, step, read, write) => {
    const input = h("input", { type: "number", step, change: () => {
      if (Number.isFinite(input.valueAsNumber)) changed((world) => write(world, input.valueAsNumber));
      fill();
    } });
    const fill = () => (input.value = metres(read(episode().world)));
    shown.push(() => document.activeElement !== input && fill());
    return h("label", {}, h("span", {}, label), input);
  };
  const place = (find) => [0, 1].map((axis) => field(`${"xy"[axis]} (m)`, 1, (world) => find(world)[axis],
    (world, value) => (find(world)[axis] = clamp(value, 0, world.size))));
  const property = (item, label, step, key, { scale = 1, least = 0, most } = {}) => field(label, step,
    ({ obstacles }) => obstacles[item][key] * scale,
    ({ obstacles, size }, value) => (obstacles[item][key] = clamp(value, least, most ?? size) / scale));
  const sides = (item, circle) => circle ? [property(item, "radius (m)", 0.5, "a", { least: 0.5 })] : [
    property(item, "length (m)", 0.5, "a", { scale: 2, least: 1 }), property(item, "width (m)", 0.5, "b", { scale: 2, least: 1 }),
    property(item, "turned (°)", 10, "turned", { scale: 180 / Math.PI, least: -360, most: 360 })];
  /** The values that the fields show, but for the one that is being typed in. */
  const update = () => shown.forEach((fill) => fill());
  /** The list of things, and the fields of the one that is chosen. */
  const show = () => {
    const { obstacles } = episode().world;
    const name = selected();
    const options = [["robot", "robot (start)"], ["target", "target"], ...obstacles.map((o, m) => [String(m), `${o.circle ? "circle" : "rectangle"} ${m + 1}`])];
    list.replaceChildren(...options.map(([value, text]) => h("option", { value, selected: value === String(name) }, text)));
    shown = [];
    if (name === "target") fields.replaceChildren(...place((world) => world.target));
    else if (name === "robot") fields.replaceChildren(...place((world) => world.start));
    else fields.replaceChildren(
      property(name, "x (m)", 1, "x"), property(name, "y (m)", 1, "y"), ...sides(name, obstacles[name].circle),
      property(name, "speed (m/s)", 0.1, "speed", { most: 2 }),
      h("button", { type: "button", click: () => removed(name) }, "Remove"));
    update();
  };
  return { element: h("fieldset", { class: "inspector" }, h("legend", {}, "Change a thing (or drag it in the map)"), list, fields), show, update };
}

/** A policy that can drive here, with the picture of its network. */
const ready = (policy) => ({
  ...policy,
  decide: driver(policy),
  picture: policy.network ? networkPicture(policy.network.sizes, {
    inputs: inputsOf(policy.encoder),
    outputs: ROBOT.actions.slice(0, policy.network.sizes.at(-1)),
    label: "The network that drives: inputs, hidden units, and a value for each action",
  }) : null,
});

function render({ model, el }) {
  const { worlds, policies, speeds, training } = model.get("data");
  const theBooks = policies.map((policy) => ready(policy.network ? unpacked(policy) : policy));
  let [trained, brought] = [[], []]; // robots that the reader trained and this browser keeps, and those from files
  const everybody = () => [...theBooks, ...trained, ...brought, ME];
  let episode = makeEpisode(worlds[0].world, 2);
  let [who, selected, pace, running, t, last, frame] = [theBooks[0], "robot", 4, false, 1, 0, 0];
  let [mapNumber, alone] = [null, true]; // of the reader's maps; whether the reader alone has driven since the start
  let [others, company, leader] = [[], null, theBooks[0]]; // starts and targets of further robots; who drives them, or null; the last policy of robot 1
  const mine = () => who === ME;
  const several = () => others.length > 0;

  const status = h("p", { class: "status", role: "status" });
  const tally = h("p", { class: "tally", role: "status" });
  const values = h("div", { class: "values" });
  const table = readings();
  const picture = h("div", {});

  const choose = (name) => {
    selected = name;
    inspect.show();
    paint();
  };
  const board = episodeMap({
    episode: () => episode, selected: () => selected, grabbed: choose,
    moved: (name, point) => {
      if (name !== "robot" || episode.step === 0) mapNumber = null;
      const [px, py] = point.map((value) => clamp(value, 0, episode.world.size));
      if (name === "robot") {
        if (episode.step > 0) return;
        episode.edit((w) => (w.start = [px, py]));
      } else if (name === "target") episode.edit((w) => (w.target = [px, py]));
      else episode.edit((w) => Object.assign(w.obstacles[name], { x: px, y: py }));
      refresh();
    },
  });
  const inspect = inspector({
    episode: () => episode, selected: () => selected, select: choose,
    changed: (act) => {
      mapNumber = null;
      episode.edit(act);
      refresh();
    },
    removed: (name) => {
      mapNumber = null;
      episode.edit((w) => w.obstacles.splice(name, 1));
      choose("robot");
      refresh();
    },
  });

  const paint = () => board.draw(t);
  const seen = () => episode.seenBy(episode.robots[0]);
  /** Everything but the map, which is drawn for itself many times a second. */
  function refresh() {
    const { sensing, outcome, step, speed, robots } = episode;
    table.show(sensing);
    const own = reflex(sensing, speed);
    const thought = mine() ? null : who.decide(seen());
    if (thought?.z) {
      values.replaceChildren(...[...thought.z].map((z, k) => h("span", { class: k === thought.action ? "chosen" : "" }, `${ROBOT.actions[k]} ${sigmoid(z).toFixed(2)}`)));
      who.picture.show(who.network, thought.activations);
    } else values.replaceChildren(h("span", {}, mine() ? howToSteer() : "a rule, no network"));
    const will = turnsToTarget(own) && coast.checked && mine() ? (step > 0 ? "nothing in range: it goes on by itself" : `press ${whatSteers()}, and it sets off`)
      : turnsToTarget(own) ? "nothing in range: its reflex turns it to the target" : own === ROBOT.backward ? "blocked ahead: its reflex steps back"
      : thought ? `it takes ${ROBOT.actions[thought.action]}, ${actionName(thought.action)}` : "it waits for you";
    const seconds = episode.steps.length;
    const ended = { arrived: `Arrived after ${seconds} s.`, collided: `Collided after ${seconds} s.` }[outcome];
    const said = ended ?? `${seconds} s, target in sector ${sensing.region}${sensing.seen ? ", seen" : ""}; ${will}.`;
    status.textContent = several() ? `Robot 1: ${said}` : said;
    tally.textContent = several() ? `${step} s, ${robots.length} robots: ${tallyWords(tallyOf(robots))}.` : "";
    board.canvas.setAttribute("aria-label", `Map, ${episode.world.obstacles.length} obstacles${several() ? `, ${robots.length} robots` : ""}. Robot${several() ? " 1" : ""} at ${metres(episode.pose.x)}, ${metres(episode.pose.y)}. ${status.textContent}${several() ? ` ${tally.textContent}` : ""}`);
    save.disabled = several() || episode.steps.length === 0;
    inspect.update();
    paint();
  }
  /** Whether the reader drives and the reflex decides: nothing is near, or the robot is blocked. */
  const coasting = () => mine() && !episode.over() && (episode.outcome !== "running" // the others finish without the reader
    || (coast.checked && episode.step > 0 && reflex(episode.sensing, episode.speed) >= 0));
  /** What the policy of the further robots chooses for one of them. */
  const choiceOf = (robot) => (robot.outcome === "running" ? (company ?? leader).decide(episode.seenBy(robot)).action : 0);
  const act = (chosen) => {
    if (episode.over()) return;
    if (t < 1) t = 1;
    alone &&= mine() && !several();
    episode.goAll([chosen ?? 0, ...episode.robots.slice(1).map(choiceOf)]);
    t = running || mine() ? 0 : 1;
    if (episode.over()) {
      pause();
      if (alone) keep();
    }
    refresh();
    if (t < 1) wake();
  };
  const next = () => act(mine() ? 0 : who.decide(seen()).action);
  function tick(time) {
    frame = 0;
    t = Math.min(1, t + (Math.min(time - last, 100) / 1000) * PACES[pace]);
    last = time;
    if (t >= 1 && (coasting() || (running && !mine()))) next();
    paint();
    if (t < 1 || running) wake();
  }
  const wake = () => {
    if (frame) return;
    last = performance.now();
    frame = requestAnimationFrame(tick);
  };
  const pause = () => {
    running = false;
    play.textContent = "Drive";
  };
  const play = h("button", { type: "button", class: "main", click: () => {
    if (running) return pause();
    if (episode.over()) begin();
    running = true;
    play.textContent = "Pause";
    refresh();
    return wake();
  } }, "Drive");
  const begin = () => {
    episode.reset();
    alone = true;
  };
  const reset = () => {
    pause();
    begin();
    t = 1;
    refresh();
    inspect.show();
  };
  const record = () => ({ world: episode.base, speed: episode.speed, steps: episode.steps, outcome: episode.outcome, map: mapNumber });
  const save = h("button", { type: "button", click: () => saveFile("my-demonstration.npz", demonstrationsFile([record()])) }, "Download this demonstration");
  const [mineKept, myRobots] = [demonstrationsList(), robotsList()];
  const keep = () => {
    mineKept.say(...keptWords(keepDemonstrations([record()]), { training, next: h("button", { type: "button", click: newMap }, "Drive the next map") }));
  };
  const note = h("span", { role: "status" });
  const upload = h("input", { type: "file", accept: ".safetensors", "aria-label": "Weights to drive with", change: async () => {
    const [file] = upload.files;
    if (!file) return;
    try {
      const name = distinctName(file.name, everybody().map((other) => other.name));
      brought.push(ready({ ...unpacked(weightsFromFile(await file.arrayBuffer())), name }));
      fill();
      pick(brought.at(-1));
      note.textContent = `${name} drives now.`;
    } catch (error) {
      note.textContent = error.message;
    }
    upload.value = "";
  } });

  const list = h("select", { "aria-label": "who drives", change: () => pick(everybody()[list.selectedIndex]) });
  /** Puts everybody who can drive on the list, by its present name; a robot that is kept no longer leaves it. */
  const fill = () => {
    trained = keptRobots().reverse().map((robot) => Object.assign(trained.find(({ id }) => id === robot.id) ?? ready(robot), { name: robot.name }));
    const own = [...trained, ...brought].map(({ name }) => h("option", {}, name));
    list.replaceChildren(
      ...theBooks.map(({ name }) => h("option", {}, name)),
      ...(own.length ? [h("optgroup", { label: "robots of yours" }, ...own)] : []), h("option", {}, ME.name));
    list.selectedIndex = everybody().indexOf(who);
    if (list.selectedIndex < 0) pick(theBooks[0]);
  };
  const pick = (chosen) => {
    who = chosen;
    if (!mine()) leader = who;
    list.selectedIndex = everybody().indexOf(who);
    picture.replaceChildren(...(who.picture ? [who.picture.element] : []));
    play.disabled = play.hidden = mine();
    pause();
    refresh();
    if (!mine()) return;
    board.canvas.focus({ preventScroll: true });
    cockpit.scrollIntoView({ block: "nearest" });
  };
  const go = (world, number = null) => {
    const cleared = clearedFor(world, others);
    const left = world.obstacles.length - cleared.obstacles.length;
    episode = makeEpisode(cleared, episode.speed, others);
    [selected, mapNumber] = ["robot", left ? null : number];
    room.textContent = left ? `Left out: ${left} obstacle${left > 1 ? "s" : ""} on a start or a target.` : "";
    reset();
  };
  /** Puts so many robots on the map. */
  const gather = (count) => {
    others = crossing(count, episode.world.size).slice(1);
    friends.element.hidden = !several();
    go(episode.base, mapNumber);
  };
  const room = h("span", { role: "status" });
  const crowd = slider({ label: "robots on the map", count: MOST_ROBOTS, text: (step) => String(step + 1), change: (step) => gather(step + 1) });
  const friends = choice({ label: "who drives the others", options: ["the policy of robot 1", ...theBooks.map(({ name }) => name)], change: (index) => (company = theBooks[index - 1] ?? null) });
  friends.element.hidden = true;
  const where = choice({ label: "world", options: [...worlds.map(({ name }) => name), "a map of yours"], change: (index) => (index < worlds.length ? go(worlds[index].world) : newMap()) });
  const newMap = () => {
    const number = nextMap(keptDemonstrations());
    where.move(worlds.length);
    go(ownMap(number), number);
    mineKept.say(`Map ${number}. Bring the robot to the circle without touching anything: press ${whatSteers()}. Left and right are the robot's. While nothing is near, it goes on by itself; then it waits for you.`);
    pick(ME);
  };
  const coast = h("input", { type: "checkbox", checked: true, change: () => {
    mineKept.say(coast.checked ? "The robot goes on by itself while nothing is near." : "The robot waits for you in every second.");
    if (coasting()) wake();
  } });
  const fast = choice({ label: "speed", options: speeds.map((speed) => `${speed} m/s`), value: speeds.indexOf(2), change: (index) => { episode.speed = speeds[index]; refresh(); } });
  const rate = slider({ label: "steps a second", count: PACES.length, value: pace, text: (step) => String(PACES[step]), change: (step) => (pace = step) });
  const add = (circle) => () => {
    const { size } = episode.world;
    episode.edit((w) => w.obstacles.push({ circle, x: size / 2, y: size / 2, a: 3, b: circle ? 0 : 2, turned: 0, speed: 0, heading: 0.7 }));
    choose(episode.world.obstacles.length - 1);
    refresh();
  };
  board.canvas.addEventListener("keydown", (event) => {
    const action = keyAction(event);
    if (action === null) return;
    event.preventDefault();
    steer(action);
  });
  /** The reader takes the wheel. */
  const steer = (action) => {
    if (!mine()) pick(ME);
    if (!coasting()) act(action);
  };
  const wheel = steeringButtons({ label: "Drive yourself, a step at a time", take: steer });
  const cockpit = h("div", { class: "cockpit" }, board.canvas, wheel, status, tally, mineKept.said);
  const forgetPads = watchPads((action) => mine() && steer(action), () => (mine() && episode.outcome === "running" && episode.step > 0) || newMap());

  asWidget(el, "Robot playground", "robot-playground");
  el.replaceChildren(
    h("div", { class: "row tools" }, where.element, h("label", {}, h("span", {}, "who drives"), list), fast.element, h("button", { type: "button", class: "main", click: newMap }, "Drive a new map yourself")),
    h("div", { class: "row tools" }, crowd.element, friends.element, room),
    h("div", { class: "row" },
      h("div", { class: "grow" }, cockpit,
        h("div", { class: "row tools" }, play, h("button", { type: "button", click: () => { pause(); next(); } }, "One step"), h("button", { type: "button", click: reset }, "Back to the start"), rate.element),
        h("label", { class: "check" }, coast, h("span", {}, "when I drive, the robot goes on by itself while nothing is near"))),
      h("div", { class: "grow side" }, h("p", { class: "label" }, "What the driver thinks of each action"), values, picture, table.element)),
    h("div", { class: "row tools" },
      h("button", { type: "button", click: add(true) }, "Add a circle"), h("button", { type: "button", click: add(false) }, "Add a rectangle"), save,
      h("label", { class: "file" }, h("span", {}, "drive with weights of your own"), upload), note),
    mineKept.element, myRobots.element,
    inspect.element);
  fill();
  pick(who);
  inspect.show();
  const forgetRobots = watchRobots(fill);
  return () => {
    pause();
    cancelAnimationFrame(frame);
    forgetPads();
    forgetRobots();
    mineKept.end();
    myRobots.end();
  };
}

export default { render };
