// Beliefs about a state that cannot be seen: their updates, and their picture over a corridor.

/**
 * @typedef {{states: number, kinds: number, transition: (action: number) => ArrayLike<number>,
 *   likelihood: (action: number, observation: number) => number[]}} Pomdp transitions row by row, one row a state
 * @typedef {{prior: Float64Array, likelihood: number[], belief: Float64Array, probability: number}} Update
 */

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
export function corridorPicture(cells, touched = null) {
  const width = CELL * cells.length + 44;
  const left = (place) => 40 + CELL * place;
  const element = svg("svg", { viewBox: `0 0 ${width} 232`, width, height: 232, role: "img" });
  const say = (x, y, text, more = {}) => svg("text", { x, y, "font-size": 14, "text-anchor": "middle", ...more }, text);
  const columns = [...cells].map((letter, place) => {
    const x = left(place);
    const column = {
      likelihood: svg("rect", { x: x + 1, y: BASE + 6, width: CELL - 2, height: 12, fill: PALETTE.GREEN }),
      belief: svg("rect", { x: x + 3, width: CELL - 6, fill: PALETTE.BLUE }),
      prior: svg("path", { fill: "none", stroke: PALETTE.PURPLE, "stroke-width": 2 }),
      text: say(x + CELL / 2, 0, ""),
    };
    element.append(
      svg("rect", { x, y: BASE + 30, width: CELL, height: 34, fill: "none", stroke: PALETTE.INK }),
      ...(letter === "D" ? [svg("rect", { x: x + 8, y: BASE + 36, width: CELL - 16, height: 28, fill: PALETTE.ORANGE })] : []),
      say(x + CELL / 2, BASE + 78, String(place), { class: "quiet" }),
      column.likelihood, column.belief, column.prior, column.text,
    );
    if (touched) {
      const place_ = { x, y: BASE + 30, width: CELL, height: 54, fill: "transparent", class: "touchable", "data-touch": place === 1 };
      element.append(svg("rect", { ...place_, click: () => touched(place) }));
    }
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

