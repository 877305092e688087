// A learned reward in the reader's hands: where it is high, what each weight says, and what a robot does that follows it.

const CHOICES = 5; // the actions that are learned
const STEPS = 200; // seconds after which an episode is given up
const DEPTHS = [1, 2];
const PATIENCE = 5; // seconds of reflexes that looking ahead follows, until the next decision
const CELLS = 44; // of the picture of the reward, a side
const PLACES = 41; // places of the slider, from -1 to 1 of the largest weight

// ---- The reward -----------------------------------------------------------------------------------------------------

/** r(s, a) = theta_a . (phi(s), 1) of every action, Eq. (5.2) with the blocks of Eq. (5.5). */
export function rewardsOf(theta, phi) {
  const width = phi.length + 1;
  return Array.from({ length: CHOICES }, (_, a) => {
    let sum = theta[a * width + width - 1];
    for (let j = 0; j < width - 1; j += 1) sum += theta[a * width + j] * phi[j];
    return sum;
  });
}

/** The value below which a share of some numbers lie, as NumPy interpolates it. */
export function percentile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  const at = share * (sorted.length - 1);
  const below = Math.floor(at);
  return sorted[below] + (at - below) * ((sorted[below + 1] ?? sorted[below]) - sorted[below]);
}

/** How a reward judges the expert's decisions: the size of a large one, and how often the expert's action is its best. */
export function judged(theta, { inputs, actions, width }) {
  let agreed = 0;
  const sizes = [...actions].map((action, m) => {
    const r = rewardsOf(theta, inputs.subarray(m * width, (m + 1) * width));
    agreed += largest(r) === action ? 1 : 0;
    return Math.abs(r[action]);
  });
  return { scale: percentile(sizes, 0.95), accuracy: agreed / actions.length };
}

/** A reward in [0, 1], with 1/2 where it was 0. */
const unit = (r, scale) => (scale > 0 ? (Math.min(Math.max(r / scale, -1), 1) + 1) / 2 : 0.5);

// ---- Following it ---------------------------------------------------------------------------------------------------

/**
 * The value of each action, `depth` decisions ahead: (1 - discount) r + discount times the largest value that
 * follows, in [0, 1]. The value of a collision is 0, that of an arrival is 1, and that of a state farther ahead is 1/2.
 */
export function valuesAhead(plan, { world, pose, step, sensing }, depth) {
  const r = rewardsOf(plan.theta, encode(plan.encoder, sensing));
  if (depth === 1 && plan.depth === 1) return r;
  return r.map((reward, action) => {
    let now = { ...advance(world, pose, step, action, plan.speed), step: step + 1 };
    for (let waited = 0; waited < PATIENCE; waited += 1) {
      if (now.outcome !== "running") break;
      const seen = sense(now.world, now.pose);
      const own = reflex(seen, plan.speed);
      if (own < 0) {
        now = { ...now, sensing: seen };
        break;
      }
      now = { ...advance(now.world, now.pose, now.step, own, plan.speed), step: now.step + 1 };
    }
    const ended = { arrived: 1, collided: 0 }[now.outcome];
    const rest = ended ?? (now.sensing && depth > 1 ? Math.max(...valuesAhead(plan, now, depth - 1)) : 0.5);
    return (1 - plan.discount) * unit(reward, plan.scale) + plan.discount * rest;
  });
}

/** A whole episode: every pose, and how it ended. */
export function episodeOf(plan, first) {
  let now = { world: first, pose: startPose(first), step: 0, outcome: "running" };
  const poses = [now.pose];
  const worlds = [now.world];
  while (now.outcome === "running" && now.step < STEPS) {
    const sensing = sense(now.world, now.pose);
    const own = reflex(sensing, plan.speed);
    const action = own < 0 ? largest(valuesAhead(plan, { ...now, sensing }, plan.depth)) : own;
    now = { ...advance(now.world, now.pose, now.step, action, plan.speed), step: now.step + 1 };
    poses.push(now.pose);
    worlds.push(now.world);
  }
  return { poses, worlds, outcome: now.outcome };
}

// ---- In the page ----------------------------------------------------------------------------------------------------

const TRIES = {
  "as it was learned": (theta) => theta,
  "all weights 0": (theta) => theta.map(() => 0),
  "weights of dangers and walls 0": (theta, kinds) => theta.map((weight, i) => (["danger", "wall"].includes(kinds[i % kinds.length]) ? 0 : weight)),
  "weights of the target 0": (theta, kinds) => theta.map((weight, i) => (kinds[i % kinds.length] === "target" ? 0 : weight)),
  "opposite sign of all weights": (theta) => theta.map((weight) => -weight),
};

/** The weights as a picture: a row an action, a column a feature. */
function weightPicture(features, pick) {
  const [cell, left, top] = [17, 40, 4];
  const width = left + cell * features.length + 4;
  const element = svg("svg", { viewBox: `0 0 ${width} ${top + 5 * cell + 4}`, width, height: top + 5 * cell + 4, role: "img", class: "weights" });
  const boxes = Array.from({ length: CHOICES }, (_, a) => {
    element.append(svg("text", { x: left - 4, y: top + a * cell + 13, "text-anchor": "end", "font-size": 11 }, ROBOT.actions[a]));
    return features.map((_, j) => element.appendChild(svg("rect", {
      x: left + j * cell, y: top + a * cell, width: cell - 1, height: cell - 1, stroke: PALETTE.INK, "stroke-width": 0.4, click: () => pick(a, j),
    })));
  });
  const mark = element.appendChild(svg("rect", { fill: "none", stroke: PALETTE.ORANGE, "stroke-width": 2.5, "pointer-events": "none" }));
  const show = (theta, strongest, [action, feature]) => {
    boxes.forEach((row, a) => row.forEach((box, j) => {
      const share = theta[a * features.length + j] / strongest;
      set(box, { fill: share >= 0 ? PALETTE.BLUE : PALETTE.VERMILION, "fill-opacity": Math.min(Math.abs(share), 1).toFixed(3) });
    }));
    set(mark, { x: left + feature * cell - 1, width: cell + 1, y: top + (action < CHOICES ? action : 0) * cell - 1, height: (action < CHOICES ? 1 : CHOICES) * cell + 1 });
    element.setAttribute("aria-label", `Weights of the reward: ${features.length} features for each of ${CHOICES} actions; ${features[feature].name} is marked`);
  };
  return { element, show };
}

/** Bars of what the reward says of each action. */
const bars = (r) => r.map((reward, a) => h("span", { class: a === largest(r) ? "chosen" : "" }, `${ROBOT.actions[a]} ${reward.toFixed(3).replace("-", "−")}`));

function render({ model, el }) {
  const data = model.get("data");
  const { encoder, features, discount, speed, worlds, others } = data;
  const learned = [...unpack(data.theta).values];
  const expert = { inputs: unpack(data.inputs).values, actions: unpack(data.actions).values, width: features.length - 1 };
  const kinds = features.map(({ kind }) => kind);
  const strongest = Math.max(...learned.map(Math.abs));
  let [theta, world, depth, picked, frame, coloured] = [[...learned], worlds[0].world, DEPTHS[0], [CHOICES, 0], 0, 0];
  let [plan, now, before, backdrop, timer, tried] = [null, null, null, null, null, 0];

  const board = mapCanvas({ role: "img" });
  const status = h("p", { class: "status", role: "status" });
  const score = h("p", { class: "told", role: "status" });
  const values = h("div", { class: "values" });
  const place = h("div", {});
  let time = null;

  const weights = weightPicture(features, (action, feature) => { picked = [action, feature]; inspect(); });
  const slide = slider({
    label: "change this weight", count: PLACES, value: 20, text: (step) => `${step >= 20 ? "+" : "−"}${(Math.abs(step - 20) / 20).toFixed(2)} of the largest`,
    change: (step) => {
      const by = ((step - 20) / 20) * strongest;
      const width = features.length;
      const base = begin();
      for (let a = 0; a < CHOICES; a += 1) if (picked[0] === CHOICES || picked[0] === a) theta[a * width + picked[1]] = base[a * width + picked[1]] + by;
      changed();
    },
  });
  const which = choice({ label: "weight of", options: features.map(({ name }) => name), change: (index) => { picked = [picked[0], index]; inspect(); } });
  const whose = choice({ label: "for", options: [...ROBOT.actions.slice(0, CHOICES), "all actions"], value: CHOICES, change: (index) => { picked = [index, picked[1]]; inspect(); } });
  const begin = () => TRIES[Object.keys(TRIES)[tried]](learned, kinds); // what changes are added to
  const restart = () => {
    theta = [...begin()];
    inspect();
    changed();
  };
  const attempts = choice({ label: "begin with the reward", options: Object.keys(TRIES), change: (index) => { tried = index; restart(); } });
  const back = h("button", { type: "button", click: restart }, "Undo all changes");
  const where = choice({ label: "map", options: worlds.map(({ name }) => name), change: (index) => { world = worlds[index].world; changed(); } });
  const ahead = choice({ label: "looks ahead", options: DEPTHS.map((d) => `${d} decision${d > 1 ? "s" : ""}`), change: (index) => { depth = DEPTHS[index]; changed(); } });

  const colours = choice({ label: "colours show the reward of", options: [...ROBOT.actions.slice(0, CHOICES), "the best action"], change: (index) => { [coloured, backdrop] = [index, null]; show(); } });

  /** Another weight in hand: the controls follow. */
  function inspect() {
    which.move(picked[1]);
    whose.move(picked[0]);
    const width = features.length;
    const at = (picked[0] === CHOICES ? 0 : picked[0]) * width + picked[1];
    const base = begin();
    slide.move(Math.max(0, Math.min(PLACES - 1, Math.round(20 + (20 * (theta[at] - base[at])) / strongest))));
    weights.show(theta, strongest, picked);
  }

  /** Another reward, map or depth: run the episode again, and count in the other maps. */
  function changed() {
    const { scale, accuracy } = judged(theta, expert);
    plan = { theta, encoder, discount, speed, depth, scale };
    now = episodeOf(plan, world);
    before = episodeOf({ ...plan, theta: learned, scale: judged(learned, expert).scale }, world);
    weights.show(theta, strongest, picked);
    time?.stop();
    time = player({
      label: "second", count: now.poses.length, value: Math.min(frame || now.poses.length - 1, now.poses.length - 1), interval: 80,
      text: (step) => `${step} of ${now.poses.length - 1}`, change: (step) => { frame = step; show(); },
    });
    place.replaceChildren(time.element);
    backdrop = null;
    show();
    count(accuracy);
  }

  /** How many of the other maps are driven, one at a time, so that the page stays awake. */
  function count(accuracy) {
    clearTimeout(timer);
    const tally = { arrived: 0, collided: 0, running: 0 };
    const agreed = `The reward's best action is the expert's in ${(100 * accuracy).toFixed(1)} % of ${expert.actions.length} decisions.`;
    let done = 0;
    const some = () => {
      tally[episodeOf(plan, others[done]).outcome] += 1;
      done += 1;
      if (done < others.length) timer = setTimeout(some, 0);
      else score.textContent = `${agreed} Of ${done} other maps the robot arrives in ${tally.arrived}, collides in ${tally.collided} and does not arrive in time in ${tally.running}.`;
    };
    score.textContent = `${agreed} Testing in ${others.length} other maps …`;
    timer = setTimeout(some, 300); // first what the eye is on
  }

  /** The reward of an action, or of the best, all over the map for a robot that faces the target; nothing where reflexes decide. */
  function paintReward() {
    backdrop ??= Array.from({ length: CELLS * CELLS }, (_, i) => {
      const [x, y] = [((i % CELLS) + 0.5) / CELLS, (Math.floor(i / CELLS) + 0.5) / CELLS].map((share) => share * world.size);
      const sensing = sense(world, { x, y, heading: Math.atan2(world.target[1] - y, world.target[0] - x) });
      if (sensing.ranges.some((range) => range <= 0) || reflex(sensing, speed) >= 0) return [x, y, null];
      const r = rewardsOf(theta, encode(encoder, sensing));
      return [x, y, (r[coloured] ?? Math.max(...r)) / (plan.scale || 1)];
    });
    backdrop.forEach(([x, y, share]) => share !== null && board.dots([x, y], 0, 1, {
      colour: share >= 0 ? PALETTE.BLUE : PALETTE.VERMILION, radius: 246 / CELLS, alpha: 0.08 + 0.5 * Math.min(Math.abs(share), 1),
    }));
  }

  function show() {
    const step = time.frame();
    const [pose, then] = [now.poses[step], now.worlds[step]];
    const sensing = sense(then, pose);
    const own = reflex(sensing, speed);
    board.begin(world.size);
    paintReward();
    then.obstacles.forEach((o) => board.obstacle(o));
    board.start(world.start);
    board.target(world.target);
    board.line(before.poses.map(({ x, y }) => [x, y]), PALETTE.INK, 1.5);
    board.line(now.poses.slice(0, step + 1).map(({ x, y }) => [x, y]), now.outcome === "collided" ? PALETTE.VERMILION : PALETTE.BLUE, 2.2);
    board.sectors(pose, sensing.ranges);
    board.robot(pose);
    const r = rewardsOf(theta, encode(encoder, sensing));
    values.replaceChildren(...bars(r));
    const ended = { arrived: `arrives after ${now.poses.length - 1} s`, collided: `collides after ${now.poses.length - 1} s`, running: `is still on its way after ${STEPS} s` }[now.outcome];
    const will = turnsToTarget(own) ? "nothing is near, the reflex decides" : own === ROBOT.backward ? "blocked, the reflex steps back" : `the reward's best action is ${ROBOT.actions[largest(r)]}`;
    status.textContent = `With this reward the robot ${ended}. Second ${step}: ${will}.`;
    board.canvas.setAttribute("aria-label", `Map, ${then.obstacles.length} obstacles. ${status.textContent}`);
  }

  const key = (colour, text) => h("span", { style: `--mark: ${colour}` }, text);
  asWidget(el, "Reward lab: change a learned reward", "reward-lab");
  el.replaceChildren(
    h("div", { class: "row" }, where.element, ahead.element, attempts.element, colours.element),
    h("div", { class: "row" },
      h("div", { class: "grow" }, board.canvas, place),
      h("div", { class: "grow side" },
        h("p", { class: "label" }, "The weights, with a row for each action and a column for each feature. Touch one, or choose it below."),
        h("div", { class: "scroll" }, weights.element),
        h("div", { class: "row" }, which.element, whose.element), slide.element, h("div", {}, back),
        h("p", { class: "label" }, "The reward of each action here"), values, status, score,
        h("div", { class: "legend", "aria-hidden": "true" },
          key(PALETTE.BLUE, "positive"), key(PALETTE.VERMILION, "negative"), key(PALETTE.INK, "the path with the reward as learned")))),
  );
  inspect();
  changed();
  return () => {
    clearTimeout(timer);
    time.stop();
  };
}

export default { render };
