// What the labs of chapter 3 share: examples from demonstrations, learning and driving new maps, the robots' rates, a map to watch.

const [CHOICES, SPEED, MOST_STEPS] = [5, 2, 500];
const ENCODER = { sensors: [1, 2, 3, 4, 5, 6, 7, 8, 9], walls: false, target: "sine-cosine" };
const INPUTS = ENCODER.sensors.length + 3; // with sine and cosine of the target's sector, and whether it is seen
const STRAIGHT = { name: "always straight on", rule: "straight" };

// ---- What is learned from -------------------------------------------------------------------------------------------

/**
 * The expert's demonstrations from one to before another, replayed from their actions in the worlds of a seed.
 * @param {{seed: number, obstacles: number, actions: string[]}} expert a digit a step
 * @returns {Demonstration[]}
 */
export function replayed({ seed, obstacles, actions }, from = 0, to = actions.length) {
  return worldKeysOf(to, seed).slice(from).map((key, i) => {
    const world = drawWorld(key, { obstacles });
    const episode = makeEpisode(world, SPEED);
    for (const action of actions[from + i]) episode.go(Number(action), false);
    return { world, speed: SPEED, steps: episode.steps, outcome: episode.outcome };
  });
}

/** Inputs and labels of the steps to learn from, Eqs. (3.29) and (3.30). @param {Demonstration[]} demonstrations @returns {Examples} */
export function examplesFrom(demonstrations, encoder = ENCODER) {
  const pairs = demonstrations.flatMap(effective);
  return examplesOf(pairs.map(({ sensing }) => encode(encoder, sensing)), pairs.map(({ action }) => Array.from({ length: CHOICES }, (_, k) => (k === action ? 1 : 0))));
}

// ---- What is computed, in the worker --------------------------------------------------------------------------------

/**
 * Algorithm 3, and then new maps: learn a network from examples, and let it and its rivals drive.
 * @param {{examples: Examples | null, network: Network | null, start?: Network | null, sizes: number[], seed: number, regularisation: number,
 *   iterations: number, encoder: Encoder, rivals: object[], trial: {seed: number, maps: number, obstacles: number}}} task
 *   a `network` drives as it is; `null` learns one from the examples, and begins with `start` or with random weights
 */
export function* imitate({ examples, network, start = null, sizes, seed, regularisation, iterations, encoder, rivals, trial }) {
  const steps = network ? 0 : iterations;
  const total = steps + trial.maps;
  let learned = network;
  if (!network) {
    learned = start ? flattened(start) : randomNetwork(sizes, defaultRng(seed)); // 1
    const cost = costFunction("cross-entropy", learned.sizes, examples, regularisation);
    let at = 0;
    for (const iterate of lbfgs(cost, learned.parameters, iterations)) { // 7
      yield { done: at, total, live: { at, cost: iterate.cost, accuracy: 100 * iterate.accuracy } };
      at += 1;
    }
  }
  const policies = [{ network: learned, encoder }, ...rivals.map((rival) => (rival.network ? { ...rival, network: networks(rival.network)() } : rival))]; // 8
  const worlds = randomWorlds(trial.maps, trial);
  for (let map = 0; map < trial.maps; map += 1) {
    const episodes = policies.map((policy) => rollout(policy, worlds[map], { speed: SPEED, maxSteps: MOST_STEPS }));
    const path = episodes[0].poses.map(({ x, y }) => [x, y]);
    yield { done: steps + map + 1, total, live: { map, path, outcomes: episodes.map(({ outcome }) => outcome) } };
  }
  return { sizes: learned.sizes, weights: learned.weights.map((part) => [...part]), biases: learned.biases.map((part) => [...part]) };
}

// ---- What the reader sees -------------------------------------------------------------------------------------------

/** What the two curves of a training by demonstrations show. */
export const COST_NOTE = "How far the outputs of the network are from the demonstrated actions, with the penalty on large weights.";
export const ACCURACY_NOTE = "How many of the demonstrated steps the network decides as the demonstrator did.";

const percent = (share) => (100 * share).toFixed(1);

/** How often some maps were crossed. @param {string[]} outcomes */
export function rateOf(outcomes) {
  const arrived = outcomes.filter((outcome) => outcome === "arrived").length;
  const [low, high] = wilsonInterval(arrived, Math.max(1, outcomes.length));
  return { maps: outcomes.length, arrived, rate: arrived / Math.max(1, outcomes.length), low, high };
}

/** Whether two robots end alike in every one of the same maps. */
export const sameOutcomes = ({ outcomes: one }, { outcomes: other }) => one.length === other.length && one.every((outcome, map) => outcome === other[map]);

/** A bar from 0 to 1 with an interval. */
function rateBar({ rate, low, high }, colour) {
  const [width, height] = [150, 16];
  const x = (share) => 1 + (width - 2) * share;
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, "aria-hidden": "true", class: "rate" },
    svg("rect", { x: 1, y: 1, width: width - 2, height: height - 2, fill: "none", stroke: PALETTE.GREY, "stroke-opacity": 0.5 }),
    svg("rect", { x: 1, y: 1, width: (width - 2) * rate, height: height - 2, fill: colour, "fill-opacity": 0.75 }),
    svg("path", { d: `M${x(low)} 4V12M${x(low)} 8H${x(high)}M${x(high)} 4V12`, stroke: "var(--ink)", "stroke-width": 1.6, fill: "none" }));
}

/** The robots that have driven the new maps, with their rates. */
function ranking() {
  const body = h("tbody", {});
  const caption = h("caption", {});
  const heads = ["robot", "arrives (%)", "95 % interval", "from 0 to 100 %"];
  const element = wide("How often each robot arrives", h("table", { class: "results" }, caption, h("thead", {}, h("tr", {}, ...heads.map((text) => h("th", { scope: "col" }, text)))), body));
  const show = (robots, { maps, obstacles }) => {
    element.hidden = robots.length === 0;
    caption.textContent = `The same ${maps} maps with ${obstacles} obstacles for every robot. No demonstration was made in them.`;
    body.replaceChildren(...robots.map(({ name, outcomes, colour }) => {
      const found = rateOf(outcomes);
      const count = found.maps < maps ? ` (${found.maps} of ${maps} maps)` : "";
      return h("tr", {}, h("th", { scope: "row" }, `${name}${count}`), h("td", {}, found.maps ? percent(found.rate) : "…"),
        h("td", {}, found.maps ? `${percent(found.low)} to ${percent(found.high)}` : "…"), h("td", {}, rateBar(found, colour)));
    }));
  };
  return { element, show };
}

/** One of the new maps, and a robot that drives it. */
function viewer({ world, robots, maps }) {
  const board = mapCanvas({ role: "img" });
  const still = globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches;
  let [map, robot, episode, frame, began] = [0, 0, null, 0, 0];
  const paint = (poses, colour) => {
    const first = world(map);
    board.begin(first.size);
    first.obstacles.forEach((o) => board.obstacle(o));
    board.start(first.start);
    board.target(first.target);
    board.line(poses.map(({ x, y }) => [x, y]), colour);
    board.robot(poses.at(-1));
  };
  const colours = { arrived: PALETTE.BLUE, collided: PALETTE.VERMILION, "out of steps": PALETTE.PURPLE };
  const load = () => {
    cancelAnimationFrame(frame);
    const list = robots();
    robot = Math.min(robot, list.length - 1);
    if (robot < 0) return;
    episode = rollout(list[robot].policy, world(map), { speed: SPEED, maxSteps: MOST_STEPS });
    paint(episode.poses, colours[episode.outcome]);
    const said = `${list[robot].name}, map ${map + 1}: ${episode.outcome} after ${episode.poses.length - 1} s.`;
    told.textContent = said;
    board.canvas.setAttribute("aria-label", said);
  };
  const told = h("p", { class: "status", role: "status" });
  const track = slider({ label: "map", count: maps, text: (at) => String(at + 1), change: (at) => { map = at; load(); } });
  const who = h("select", { "aria-label": "robot to watch", change: () => { robot = who.selectedIndex; load(); } });
  const go = (at) => {
    map = at;
    track.move(at);
    load();
  };
  const fails = h("button", { type: "button", click: () => {
    const { outcomes } = robots()[robot];
    const next = outcomes.findIndex((outcome, at) => at > map && outcome !== "arrived");
    const first = outcomes.findIndex((outcome) => outcome !== "arrived");
    if (first < 0) told.textContent = "It arrives in every map.";
    else go(next < 0 ? first : next);
  } }, "Next map where it fails");
  const watch = h("button", { type: "button", click: () => {
    if (!episode) return;
    cancelAnimationFrame(frame);
    began = performance.now();
    const step = (time) => {
      const at = Math.min(episode.poses.length, 1 + Math.max(0, Math.floor((time - began) / 50)));
      paint(episode.poses.slice(0, at), colours[episode.outcome]);
      if (at < episode.poses.length) frame = requestAnimationFrame(step);
    };
    if (still) load();
    else frame = requestAnimationFrame(step);
  } }, "Watch it drive");
  const element = h("div", { class: "viewer", hidden: true }, told, board.canvas,
    h("div", { class: "row tools" }, h("label", {}, h("span", {}, "robot to watch"), who), track.element, watch, fails));
  return {
    element,
    /** While the maps are driven: the one that was driven just now. */
    flash: (at, path) => {
      element.hidden = false;
      map = at;
      if (!still || at % 50 === 0) paint(path.map(([x, y], k) => ({ x, y, heading: k > 0 ? Math.atan2(y - path[k - 1][1], x - path[k - 1][0]) : 0 })), PALETTE.BLUE);
    },
    update: () => {
      const list = robots();
      element.hidden = list.length === 0;
      who.replaceChildren(...list.map(({ name }) => h("option", {}, name)));
      robot = 0;
      if (list.length) go(Math.max(0, list[0].outcomes.findIndex((outcome) => outcome !== "arrived")));
    },
    end: () => cancelAnimationFrame(frame),
  };
}
