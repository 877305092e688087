// Key points: the reader marks points on a map, a smooth path is laid through them, and the robot follows it (section 5.5.5.2).

const [SPACING, LOOKAHEAD] = [0.25, 1.5]; // as in robonav/lfd/human_expert.py: metres, and steps
const [SPEED, MOST_STEPS, PACE] = [2, 500, 14]; // m/s, seconds, steps a second
const GRAB = 3; // metres from a key point, or from the path, at which a pointer holds it

const apart = ([x, y], [u, v]) => Math.sqrt((x - u) * (x - u) + (y - v) * (y - v));

// ---- The path -------------------------------------------------------------------------------------------------------

/** Second derivatives at the knots of the natural cubic spline through some values: a tridiagonal system. */
function naturalCurvature(knots, values) {
  const last = knots.length - 1;
  const gap = (k) => knots[k + 1] - knots[k];
  const slope = (k) => (values[k + 1] - values[k]) / gap(k);
  const [ratio, right] = [[0], [0]];
  for (let k = 1; k < last; k += 1) { // forward elimination
    const pivot = 2 * (gap(k - 1) + gap(k)) - gap(k - 1) * ratio[k - 1];
    ratio.push(gap(k) / pivot);
    right.push((6 * (slope(k) - slope(k - 1)) - gap(k - 1) * right[k - 1]) / pivot);
  }
  const curvature = new Array(last + 1).fill(0);
  for (let k = last - 1; k > 0; k -= 1) curvature[k] = right[k] - ratio[k] * curvature[k + 1];
  return curvature;
}

/**
 * A natural cubic spline through points, with one point about every 25 cm, and where in it each given point lies. The
 * parameter grows by the square root of the distance from point to point, as in `spline_through` of human_expert.py.
 * @param {number[][]} points @returns {{path: number[][], knots: number[]}}
 */
export function smoothPath(points) {
  const gaps = points.slice(1).map((point, k) => apart(points[k], point));
  const knots = gaps.reduce((sums, gap) => [...sums, sums.at(-1) + Math.sqrt(gap)], [0]);
  const axes = [0, 1].map((axis) => {
    const values = points.map((point) => point[axis]);
    return { values, curvature: naturalCurvature(knots, values) };
  });
  const [path, places] = [[], []];
  gaps.forEach((gap, k) => {
    const count = Math.max(2, Math.round(gap / SPACING));
    const width = knots[k + 1] - knots[k];
    places.push(path.length);
    for (let i = 0; i < count; i += 1) {
      const b = i / count;
      const a = 1 - b;
      path.push(axes.map(({ values, curvature }) => a * values[k] + b * values[k + 1]
        + ((a * a * a - a) * curvature[k] + (b * b * b - b) * curvature[k + 1]) * width * width / 6));
    }
  });
  places.push(path.length);
  path.push([...points.at(-1)]);
  return { path, knots: places };
}

/** The distance from each point of a path to the nearest obstacle or border. @param {World} world */
export const pathClearance = (world, path) => path.map(([x, y]) => sweptClearance(world, world.obstacles, x, y, x, y));

// ---- The robot that follows it --------------------------------------------------------------------------------------

/** Pure pursuit with five actions: the one that brings the robot nearest to a point a step and a half ahead on the path. */
export function pathFollower(path) {
  let passed = 0; // the robot never turns back
  return ({ x, y, heading }, speed) => {
    const rest = path.slice(passed);
    const along = rest.reduce((sums, point, k) => (k ? [...sums, sums[k - 1] + apart(rest[k - 1], point)] : [0]), []);
    const away = rest.map((point) => apart(point, [x, y]));
    const nearest = away.indexOf(Math.min(...away));
    passed += nearest;
    const ahead = along.findIndex((length) => length >= along[nearest] + LOOKAHEAD * speed);
    const goal = rest[ahead < 0 ? rest.length - 1 : ahead];
    const left = ROBOT.turns.slice(0, 5).map((turn) => apart([x + speed * Math.cos(heading + turn), y + speed * Math.sin(heading + turn)], goal));
    return left.indexOf(Math.min(...left));
  };
}

/** A robot in a world on its way along a path; `go` takes one step. @param {World} world */
export function followedEpisode(world, path) {
  const [episode, follow] = [makeEpisode(world, SPEED), pathFollower(path)];
  const go = () => episode.go(reflex(episode.sensing, SPEED) < 0 ? follow(episode.pose, SPEED) : 0);
  return { episode, go, running: () => episode.outcome === "running" && episode.step < MOST_STEPS };
}

// ---- In the page ----------------------------------------------------------------------------------------------------

function render({ model, el }) {
  const { training, seed, obstacles } = model.get("data");
  let [number, world] = [0, null];
  let [points, selected, followed, timer] = [[], -1, null, null];
  let smooth = { path: [], knots: [] };
  let clearances = [];
  const kept = demonstrationsList();

  const board = mapCanvas({ tabindex: 0, role: "application", "aria-roledescription": "map" });
  const told = h("p", { class: "status told", role: "status" });
  const shown = ([x, y]) => `(${x.toFixed(1)}, ${y.toFixed(1)})`;
  const tooNear = () => clearances.findIndex((clearance) => clearance < ROBOT.collision);
  const clear = () => clearances.every((clearance) => clearance >= ROBOT.collision);
  const paint = () => {
    board.begin(world.size);
    world.obstacles.forEach((o) => board.obstacle(o));
    board.start(world.start);
    board.target(world.target);
    board.line(smooth.path, PALETTE.SKY, 3);
    for (let k = 1; k < smooth.path.length; k += 1) {
      if (clearances[k] < ROBOT.collision) board.line(smooth.path.slice(k - 1, k + 1), PALETTE.VERMILION, 6);
    }
    points.forEach((point, k) => board.dots(point, 0, 1, { colour: PALETTE.ORANGE, radius: k === selected ? 8 : 5 }));
    if (!followed) return;
    const { episode } = followed;
    board.line(episode.path.map(({ x, y }) => [x, y]), PALETTE.BLUE);
    board.dots(effective(episode).flatMap(({ pose }) => [pose.x, pose.y]), 0, effective(episode).length, { colour: PALETTE.BLUE, radius: 3 });
    if (followed.running()) board.sectors(episode.pose, episode.sensing.ranges);
    board.robot(episode.pose);
  };
  const say = (...words) => {
    told.replaceChildren(...words);
    board.canvas.setAttribute("aria-label", `Map ${number} with ${obstacles} obstacles, start (10, 10), target (90, 90). Key points: ${points.length ? points.map(shown).join(", ") : "none"}. ${told.textContent}`);
  };
  const length = () => smooth.path.slice(1).reduce((sum, point, k) => sum + apart(smooth.path[k], point), 0);
  const advice = () => {
    const at = tooNear();
    if (at >= 0) return `Near ${shown(smooth.path[at])} the path comes nearer than 1 m to an obstacle or to the border. Move a key point, or add one.`;
    return `The path is ${length().toFixed(1)} m long, and at its narrowest place ${Math.min(...clearances).toFixed(1)} m from an obstacle or the border.`;
  };
  /** Everything, after the points have changed. */
  const refresh = (word = "") => {
    stop();
    followed = null;
    smooth = smoothPath([world.start, ...points, world.target]);
    clearances = pathClearance(world, smooth.path);
    const options = points.map((point, k) => h("option", { selected: k === selected }, `${k + 1}: ${shown(point)}`));
    list.replaceChildren(...(options.length ? options : [h("option", {}, "none yet")]));
    for (const control of [list, remove, clearAll]) control.disabled = points.length === 0;
    follow.disabled = !clear();
    python.textContent = `worlds = random_worlds(1, obstacles=${obstacles}, seed=${seed + number})\nlfd.demonstrate_by_hand(worlds, [[${points.map(shown).join(", ")}]])`;
    python.parentElement.hidden = points.length === 0;
    say(word ? `${word} ` : "", advice());
    paint();
  };

  // Key points
  const decimetres = (point) => point.map((value) => Math.round(10 * Math.min(Math.max(value, 0), world.size)) / 10);
  /** Whether a point may stand at a place of the order: it must differ from its neighbours. */
  const free = (point, at, others) => [others[at - 1] ?? world.start, others[at] ?? world.target].every((other) => apart(point, other) > 0);
  const put = (at, place) => {
    const point = decimetres(place);
    if (!free(point, at, points)) return;
    points.splice(at, 0, point);
    selected = at;
    refresh(`Key point ${at + 1} is at ${shown(point)}.`);
  };
  const move = (at, place) => {
    const point = decimetres(place);
    if (!free(point, at, points.filter((_, k) => k !== at))) return;
    points[at] = point;
    refresh(`Key point ${at + 1} is at ${shown(point)}.`);
  };
  const take = (at) => {
    if (!points[at]) return;
    points.splice(at, 1);
    selected = Math.min(at, points.length - 1);
    refresh("The key point is removed.");
  };
  /** Where in the order a new point belongs: in the piece of the path that it lies on, or else last. */
  const orderOf = (place) => {
    const away = smooth.path.map((point) => apart(point, place));
    const nearest = away.indexOf(Math.min(...away));
    return away[nearest] > GRAB ? points.length : Math.max(0, smooth.knots.findLastIndex((knot) => knot <= nearest));
  };
  const addHalfWay = () => {
    const [x, y] = points.at(-1) ?? world.start;
    put(points.length, [(x + world.target[0]) / 2, (y + world.target[1]) / 2]);
  };
  const pointAt = (place) => points.findIndex((point) => apart(point, place) < GRAB);
  let [dragged, held] = [-1, false];
  board.canvas.addEventListener("pointerdown", (event) => {
    dragged = pointAt(board.place(event));
    held = dragged >= 0;
    if (!held) return;
    selected = dragged;
    board.canvas.setPointerCapture(event.pointerId);
    refresh();
  });
  board.canvas.addEventListener("pointermove", (event) => dragged >= 0 && move(dragged, board.place(event)));
  for (const end of ["pointerup", "pointercancel"]) board.canvas.addEventListener(end, () => (dragged = -1));
  board.canvas.addEventListener("click", (event) => {
    const place = board.place(event);
    if (!held && pointAt(place) < 0) put(orderOf(place), place);
  });
  holdFinger(board.canvas, (touch) => pointAt(board.place(touch)) >= 0);
  board.canvas.addEventListener("keydown", (event) => {
    if (event.key in MAP_KEYS && points[selected]) {
      const step = event.shiftKey ? 5 : 1;
      move(selected, points[selected].map((value, axis) => value + step * MAP_KEYS[event.key][axis]));
    } else if (event.key === "Enter") addHalfWay();
    else if (event.key === "Delete" || event.key === "Backspace") take(selected);
    else if (!(event.key in MAP_KEYS)) return;
    event.preventDefault();
  });
  const list = h("select", { "aria-label": "key point", change: () => {
    selected = list.selectedIndex;
    refresh();
  } });
  const add = h("button", { type: "button", click: addHalfWay }, "Add a key point");
  const remove = h("button", { type: "button", click: () => take(selected) }, "Remove it");
  const clearAll = h("button", { type: "button", click: () => {
    [points, selected] = [[], -1];
    refresh();
  } }, "Remove all");

  // The demonstration
  const still = () => globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches;
  const stop = () => {
    clearTimeout(timer);
    timer = null;
  };
  const ended = () => {
    const { episode } = followed;
    const { step, outcome, steps, base } = episode;
    if (outcome !== "arrived") {
      say(outcome === "collided" ? `The robot collided after ${step} s: ` : `The robot did not arrive within ${step} s: `,
        "where nothing is in range its reflex leaves the path. This demonstration is not kept. Move a key point, and try again.");
      return;
    }
    const kept = keepDemonstrations([{ world: base, speed: SPEED, steps, outcome, map: number }]);
    say(`The robot arrived after ${step} s, with ${effective(episode).length} steps to learn from. `, ...keptWords(kept, { what: "demonstration", training, next: "demonstrate in another map" }));
  };
  const tick = () => {
    do followed.go();
    while (still() && followed.running());
    paint();
    if (followed.running()) timer = setTimeout(tick, 1000 / PACE);
    else ended();
  };
  const follow = h("button", { type: "button", class: "main", click: () => {
    stop();
    followed = followedEpisode(world, smooth.path);
    say("The robot follows the path where something is in range.");
    timer = setTimeout(tick);
  } }, "Let the robot follow the path");
  const another = () => {
    number = Math.max(nextMap(keptDemonstrations()), number + 1);
    [world, points, selected] = [ownMap(number, obstacles), [], -1];
    refresh(`Map ${number}.`);
  };
  const next = h("button", { type: "button", click: another }, "Another map");
  const python = h("pre", {});
  const inPython = h("details", {}, h("summary", {}, "The same demonstration in Python"), python);

  const kernel = expertsPanel(model);
  asWidget(el, "Key points lab", "key-points-lab");
  el.replaceChildren(
    board.canvas, told,
    h("div", { class: "row tools" }, add, h("label", {}, h("span", {}, "key point"), list), remove, clearAll),
    h("div", { class: "row tools" }, follow, next),
    h("p", { class: "quiet" }, "Click or tap the map to add a key point, and drag a key point to move it. With the keyboard, in the map: Enter adds a key point, the arrow keys move the chosen one by 1 m (with Shift by 5 m), Delete removes it."),
    inPython, kept.element, kept.said, kernel.element);
  another();
  return () => {
    stop();
    kept.end();
    kernel.cancel();
  };
}

const EXPERTS = ["the computer expert", "you, by your demonstrations that arrived"];
const NO_DEMONSTRATION = "There is nothing to learn from: let the robot follow a path of yours past some obstacles first.";

/** Robots that Python trains on an expert's demonstrations, to see what makes a good expert. */
function expertsPanel(model) {
  const settings = { demonstrations: 25, margin: 3, caution: 2, slips: 0, hidden: 8, regularisation: 1, iterations: 300, seed: 0 };
  const own = () => keptDemonstrations().filter(({ outcome }) => outcome === "arrived");
  let expert = 0;
  const robots = numberOfRobots([1, 4, 8]);
  /** A slider over the multiples of a step. */
  const dial = (name, label, from, step, count, unit = "") => slider({
    label, count, value: Math.round((settings[name] - from) / step), text: (at) => `${Number((from + at * step).toFixed(2))}${unit}`,
    change: (at) => (settings[name] = Number((from + at * step).toFixed(2))),
  }).element;
  return kernelPanel({
    model, title: "What makes a good expert? Train robots in Python", unit: "iteration", total: () => settings.iterations,
    controls: [
      choice({ label: "who demonstrates", options: EXPERTS, change: (index) => (expert = index) }).element, robots.element,
      dial("demonstrations", "the computer's demonstrations", 5, 5, 20), dial("margin", "its margin", 1, 0.5, 8, " m"),
      dial("caution", "its caution", 0, 0.5, 9), dial("slips", "its actions slip with probability", 0, 0.05, 11),
      dial("regularisation", "regularisation λ", 0, 0.25, 21),
    ],
    lines: [
      { name: "cost", label: "mean cost J", note: "How far the outputs are from the demonstrated actions, with the penalty on large weights." },
      { name: "accuracy", label: "mean accuracy (%)", note: "How many of the demonstrated steps the robots decide as the expert did.", colour: PALETTE.GREEN, low: 0, high: 100, text: (value) => value.toFixed(0) },
    ],
    request: () => {
      if (expert === 1 && own().flatMap(effective).length === 0) return NO_DEMONSTRATION;
      return { robots: robots.value(), settings, demonstrations: expert === 1 ? base64Of(demonstrationsFile(own())) : null };
    },
    done: ({ sentence }) => sentence,
  });
}

export default { render };
