// A robot that knows the plan of its corridor, but not its place in it: it moves, it senses, and its belief follows.

/**
 * @typedef {{states: number, kinds: number, transition: (action: number) => ArrayLike<number>,
 *   likelihood: (action: number, observation: number) => number[]}} Pomdp transitions row by row, one row a state
 * @typedef {{prior: Float64Array, likelihood: number[], belief: Float64Array, probability: number}} Update
 */

const [LEFT, RIGHT, STAY] = [0, 1, 2];
const SAID = ["moved left", "moved right", "stayed"];

/** The model that Python packed. @returns {Pomdp} */
export function pomdpOf({ transitions, observations }) {
  const [T, Z] = [unpack(transitions), unpack(observations)];
  const [, states, kinds] = Z.shape;
  return {
    states,
    kinds,
    transition: (action) => T.values.subarray(action * states * states, (action + 1) * states * states),
    likelihood: (action, observation) =>
      Array.from({ length: states }, (_, s) => Z.values[(action * states + s) * kinds + observation]),
  };
}

/** The belief after an action, before anything is sensed: the sum over s of b(s) T(s, a, s'). */
export function predict(belief, transition) {
  const prior = new Float64Array(belief.length);
  belief.forEach((share, s) => {
    for (let next = 0; next < prior.length; next += 1) prior[next] += share * transition[s * prior.length + next];
  });
  return prior;
}

/** Eq. (2.18): predict, weigh each state by how likely it makes what was observed, and scale to a sum of one. @returns {Update} */
export function update(pomdp, belief, action, observation) {
  const prior = predict(belief, pomdp.transition(action));
  const likelihood = pomdp.likelihood(action, observation);
  const joint = prior.map((share, s) => share * likelihood[s]);
  const probability = joint.reduce((sum, share) => sum + share, 0);
  if (!(probability > 0)) throw new Error(`observation ${observation} has probability zero after action ${action}`);
  return { prior, likelihood, belief: joint.map((share) => share / probability), probability };
}

/** How uncertain a belief is, in bits. */
export const entropy = (belief) => belief.reduce((sum, share) => (share > 0 ? sum - share * Math.log2(share) : sum), 0);

/** Numbers in [0, 1) that depend on the seed alone: the same run for the same seed. */
export function numbersFrom(seed) {
  let count = 0;
  return () => {
    count += 1;
    let x = Math.imul(seed + 1, 0x9e3779b9) ^ Math.imul(count, 0x85ebca6b);
    x = Math.imul(x ^ (x >>> 16), 0x7feb352d);
    x = Math.imul(x ^ (x >>> 15), 0x846ca68b);
    return ((x ^ (x >>> 16)) >>> 0) / 2 ** 32;
  };
}

/** The index that a number in [0, 1) falls on, each index as wide as its probability. */
export function draw(probabilities, number) {
  let left = number;
  const found = probabilities.findIndex((probability) => (left -= probability) < 0);
  return found >= 0 ? found : probabilities.findLastIndex((probability) => probability > 0);
}

/** What an action brings about: where the robot truly is then, what it senses there, and what it believes. */
export function act(pomdp, { place, belief }, action, random) {
  const { states, kinds } = pomdp;
  const next = draw(pomdp.transition(action).subarray(place * states, (place + 1) * states), random());
  const senses = Array.from({ length: kinds }, (_, kind) => pomdp.likelihood(action, kind)[next]);
  const observation = draw(senses, random());
  return { place: next, action, observation, ...update(pomdp, belief, action, observation) };
}

/** A robot that knows nothing, somewhere. */
export function lost(pomdp, random) {
  const belief = new Float64Array(pomdp.states).fill(1 / pomdp.states);
  return { place: draw(belief, random()), belief };
}

const [CELL, TOP, BASE] = [30, 18, 150]; // pixels: a cell's width, the top and the foot of the bars

/** The corridor with doors and robot, below bars of belief, with the prediction as outlines and the likelihood between. */
function picture(cells) {
  const width = CELL * cells.length + 44;
  const left = (place) => 40 + CELL * place;
  const element = svg("svg", { viewBox: `0 0 ${width} 232`, width, height: 232, role: "img" });
  const say = (x, y, text, more = {}) => svg("text", { x, y, "font-size": 12, "text-anchor": "middle", ...more }, text);
  const columns = [...cells].map((letter, place) => {
    const x = left(place);
    const column = {
      likelihood: svg("rect", { x: x + 1, y: BASE + 6, width: CELL - 2, height: 12, fill: PALETTE.GREEN }),
      belief: svg("rect", { x: x + 3, width: CELL - 6, fill: PALETTE.BLUE }),
      prior: svg("path", { fill: "none", stroke: PALETTE.ORANGE, "stroke-width": 2 }),
      text: say(x + CELL / 2, 0, ""),
    };
    element.append(
      svg("rect", { x, y: BASE + 30, width: CELL, height: 34, fill: "none", stroke: PALETTE.INK }),
      ...(letter === "D" ? [svg("rect", { x: x + 8, y: BASE + 36, width: CELL - 16, height: 28, fill: PALETTE.ORANGE })] : []),
      say(x + CELL / 2, BASE + 78, String(place), { class: "quiet" }),
      column.likelihood, column.belief, column.prior, column.text,
    );
    return column;
  });
  const robot = svg("path", { d: "M0 -9L8 8L-8 8Z", fill: PALETTE.ROBOT, stroke: "var(--surface)", "stroke-width": 1.5 });
  const top = say(36, TOP + 8, "", { "text-anchor": "end", class: "quiet" });
  element.append(
    svg("path", { d: `M38 ${TOP}V${BASE}H${width - 4}`, fill: "none", stroke: PALETTE.INK }),
    top, say(36, BASE, "0", { "text-anchor": "end", class: "quiet" }), robot,
  );

  /** The last update, and where the robot is (null: not to be shown). */
  const show = ({ belief, prior, likelihood }, place) => {
    const highest = Math.max(...belief, ...(prior ?? []));
    const scale = [0.1, 0.25, 0.5, 1].find((limit) => highest <= limit + 1e-9);
    const height = (share) => ((BASE - TOP - 12) * share) / scale;
    const strongest = Math.max(...(likelihood ?? [1]));
    columns.forEach((column, s) => {
      const [x, tall] = [left(s), height(belief[s])];
      set(column.belief, { y: (BASE - tall).toFixed(2), height: tall.toFixed(2) });
      set(column.text, { y: (BASE - tall - 4).toFixed(2) });
      column.text.textContent = belief[s] >= 0.005 ? String(Math.round(100 * belief[s])) : "";
      set(column.prior, { d: prior ? `M${x + 1} ${(BASE - height(prior[s])).toFixed(2)}h${CELL - 2}` : "" });
      set(column.likelihood, { "fill-opacity": likelihood ? (likelihood[s] / strongest).toFixed(3) : 0 });
    });
    top.textContent = `${100 * scale} %`;
    set(robot, { transform: `translate(${left(place ?? 0) + CELL / 2} ${BASE + 48})`, visibility: place === null ? "hidden" : "visible" });
    const likely = [...belief.keys()].sort((a, b) => belief[b] - belief[a]).slice(0, 3);
    element.setAttribute("aria-label", `Corridor of ${cells.length} cells, doors in ${[...cells.matchAll(/D/g)].map(({ index }) => index).join(", ")}. ` +
      `Belief: ${likely.map((s) => `cell ${s} ${(100 * belief[s]).toFixed(0)} %`).join(", ")}`);
  };
  return { element, show };
}

function render({ model, el }) {
  const { corridors, sensors, wheels, transitions, observations, seed } = model.get("data");
  const chosen = { corridor: 0, sensor: 0, wheel: 0 };
  let [run, pomdp, random, drawing] = [seed, null, null, null];
  let history = [];

  const status = h("p", { class: "status", role: "status" });
  const stage = h("div", { class: "stage" });
  const button = (label, act_) => h("button", { type: "button", click: act_ }, label);
  const undo = button("Undo", () => { if (history.length > 1) history.pop(); show(); });
  const reveal = h("input", { type: "checkbox", change: () => show() });
  const key = (colour, text) => h("span", { style: `--mark: ${colour}` }, text);
  const setting = (name, label, options) =>
    choice({ label, options, change: (index) => { chosen[name] = index; begin(); } }).element;

  /** A robot that knows nothing, in the corridor that is chosen. */
  function begin() {
    pomdp = pomdpOf({
      transitions: transitions[chosen.corridor][chosen.wheel],
      observations: observations[chosen.corridor][chosen.sensor],
    });
    random = numbersFrom(run);
    history = [lost(pomdp, random)];
    drawing = picture(corridors[chosen.corridor].cells);
    stage.replaceChildren(drawing.element);
    show();
  }

  function go(action) {
    history.push(act(pomdp, history.at(-1), action, random));
    show();
  }

  function show() {
    const now = history.at(-1);
    drawing.show(now, reveal.checked ? now.place : null);
    undo.disabled = history.length === 1;
    const best = largest(now.belief);
    const seen = pomdp.kinds === 1 ? "sensed nothing, as always" : `saw a ${["wall", "door"][now.observation]} (chance ${(100 * now.probability).toFixed(1)} %)`;
    const what = history.length === 1
      ? "Step 0: the robot knows the plan, not its place."
      : `Step ${history.length - 1}: the robot ${SAID[now.action]} and ${seen}.`;
    const where = reveal.checked ? ` It is in cell ${now.place}.` : "";
    status.textContent = `${what} Likeliest cell ${best} with ${(100 * now.belief[best]).toFixed(1)} %; uncertainty ${entropy(now.belief).toFixed(2)} bits.${where}`;
  }

  const keys = (event) => {
    const action = { ArrowLeft: LEFT, ArrowRight: RIGHT, ArrowDown: STAY }[event.key];
    if (action === undefined) return;
    event.preventDefault();
    go(action);
  };
  set(stage, { tabindex: 0, role: "group", "aria-label": "The corridor. Arrow keys move the robot left and right; down stays and senses.", keydown: keys });

  el.classList.add("robonav", "belief-lab");
  el.replaceChildren(
    h("div", { class: "row" },
      setting("corridor", "corridor", corridors.map(({ name }) => name)),
      setting("sensor", "door sensor", sensors),
      setting("wheel", "wheels", wheels)),
    stage,
    h("div", { class: "legend", "aria-hidden": "true" },
      key(PALETTE.ORANGE, "after the move"), key(PALETTE.GREEN, "how well each cell explains what was seen"),
      key(PALETTE.BLUE, "belief, in per cent")),
    h("div", { class: "row" },
      button("← Left", () => go(LEFT)), button("Stay and sense", () => go(STAY)), button("Right →", () => go(RIGHT)),
      undo, button("New run", () => { run += 1; begin(); }),
      h("label", { class: "check" }, reveal, " show the robot")),
    status,
  );
  begin();
}

export default { render };
