// Q-learning lab: the reader sets reward, exploration and learning, and a robot learns from nothing, in the page.

const METHOD_WORDS = { nnql: "NNQL", online: "online Q-learning", dqn: "double DQN" };
const BLOCK = 30; // episodes in which successes are counted, as in Fig. 4.4
const OUTCOME_COLOURS = { arrived: PALETTE.BLUE, collided: PALETTE.VERMILION, "out of steps": PALETTE.PURPLE };
const ENDINGS = { arrived: "arrived", collided: "collided", "out of steps": "never ended" };

// ---- What can be set ------------------------------------------------------------------------------------------------

/**
 * @typedef {object} Field a number that the reader sets
 * @property {string} key its name in the settings
 * @property {number} [part] its place, if the setting is a list of numbers
 * @property {string} label
 * @property {number} least
 * @property {number} most
 * @property {number} step
 * @property {boolean} [positive] whether it must be greater than `least`
 */
const pair = (key, label, limits) => ["start", "end"].map((end, part) => ({ key, part, label: `${label}, ${end}`, ...limits }));

/** @type {Record<string, Field[]>} */
export const NUMBERS = {
  exploration: pair("temperature", "temperature", { least: 0, positive: true, most: 100, step: 0.01 }),
  learning: [
    { key: "discount", label: "discount", least: 0, most: 1, step: 0.05 },
    ...pair("learningRate", "learning rate", { least: 0, positive: true, most: 1, step: 0.05 }),
    ...pair("gradientStep", "step of gradient descent", { least: 0, positive: true, most: 10, step: 0.05 }),
    { key: "passes", label: "passes through the pairs", least: 1, most: 20, step: 1 },
    { key: "hidden", label: "hidden units", least: 1, most: 32, step: 1 },
  ],
  robot: [
    { key: "obstacles", label: "obstacles that stand still", least: 0, most: 40, step: 1 },
    { key: "moving", label: "obstacles that move", least: 0, most: 30, step: 1 },
    { key: "speed", label: "speed of the robot (m/s)", least: 0.5, most: 4, step: 0.5 },
    { key: "episodes", label: "episodes", least: 1, most: 2000, step: 10 },
    { key: "seed", label: "seed of the random numbers", least: 0, most: 999999999, step: 1 },
  ],
};
const WHOLE = ["passes", "hidden", "obstacles", "moving", "episodes", "seed"];
const rewardField = (part, label) => ({ key: "rewards", part, label: `reward for ${label}`, least: -10, most: 10, step: 0.1 });

/** @type {Record<string, {key: string, label: string, options: [any, string][]}>} */
const CHOICES = {
  evading: { key: "mustMoveAway", label: "staying away is rewarded", options: [[false, "if nothing comes a metre nearer"], [true, "only if everything gets farther away"]] },
  method: { key: "method", label: "method", options: [["nnql", "NNQL: all pairs of the episode"], ["online", "online: the latest pair alone"], ["dqn", "double DQN: replay, Adam"]] },
  rescale: { key: "rescale", label: "Q comes into [0, 1]", options: [["shift", "shifted and divided"], ["clip", "clipped"]] },
  inputs: { key: "inputs", label: "target's sector", options: [["number", "a number, 1 to 9"], ["signed", "right to left, -1 to 1"], ["one-hot", "nine inputs, one of them 1"], ["sine-cosine", "sine and cosine"], ["raw", "a number; no input is scaled"]] },
};

const EXPLORATION_HINT = "The higher the temperature, the more random the actions. It falls from the start to the end of the training.";
const LEARNING_HINT = "The discount γ says how much a reward counts that comes a step later. The learning rate α says how far a value moves to its new estimate. "
  + "The step of gradient descent σ says how far the weights then move, in each of several passes through the pairs of state and values. Both are multiplied by the same factor in every episode, from start to end.";
const ADAM_STEP = [0.003, 0.003]; // the steps of the other methods are too large for DQN
const SET_BY_WEIGHTS = ["inputs", "hidden"]; // settings that come with the weights that a training begins with
/** Whether a method takes no notice of a setting. */
const idle = (method, { key, part = 0 }) => method === "dqn" && (["learningRate", "passes", "rescale"].includes(key) || (key === "gradientStep" && part === 1));

const read = (settings, { key, part }) => (part === undefined ? settings[key] : settings[key][part]);
const written = (settings, { key, part }, value) => ({
  ...settings, [key]: part === undefined ? value : settings[key].map((old, i) => (i === part ? value : old)),
});

/** What is wrong with a number, in one sentence, or nothing. @param {Field} field @param {number} value */
export function complaint({ key, label, least, most, positive }, value) {
  const name = label[0].toUpperCase() + label.slice(1);
  if (!Number.isFinite(value)) return `${name} must be a number.`;
  if (WHOLE.includes(key) && !Number.isInteger(value)) return `${name} must be a whole number, got ${value}.`;
  if (value < least || value > most || (positive && value === least)) {
    return `${name} must be ${positive ? `greater than ${least} and at most ${most}` : `from ${least} to ${most}`}, got ${value}.`;
  }
  return "";
}

/**
 * What differs between two settings, in words: "discount 0.7 instead of 0.6".
 * @param {{label: string}[]} rewards a field for each row @param {(field: {key: string, part?: number}) => boolean} unused whether a setting plays no part
 */
export function differences(settings, other, rewards, unused = () => false) {
  const shown = (field, from) => signed(read(from, field));
  const named = ({ key, options }, from) => options.find(([value]) => value === from[key])[1];
  return [
    ...[...rewards, ...Object.values(NUMBERS).flat()].filter((field) => !unused(field) && read(settings, field) !== read(other, field))
      .map((field) => `${field.label} ${shown(field, settings)} instead of ${shown(field, other)}`),
    ...Object.values(CHOICES).filter((list) => !unused(list) && settings[list.key] !== other[list.key]).map((list) => `${list.label}: ${named(list, settings)}`),
  ];
}

const MOST_CHANGES = 3; // that the name of a robot says
const counted = (count, one, more = `${one}s`) => `${count} ${count === 1 ? one : more}`;
const signed = (number) => String(number).replace("-", "−");
/** What a setting that is not the book's is called in the name of a robot. */
const SHORT = {
  mustMoveAway: (value) => (value ? "evading is moving away" : "evading is staying away"),
  obstacles: (count) => counted(count, "obstacle"),
  moving: (count) => `${count} moving`,
  speed: (pace) => `${pace} m/s`,
  inputs: (name) => `inputs ${name}`,
  hidden: (units) => `${units} hidden`,
  episodes: (count) => counted(count, "episode"),
  learningRate: (ends) => `learning rate ${course(ends)}`,
  discount: (value) => `discount ${value}`,
  gradientStep: (ends) => `step ${course(ends)}`,
  temperature: (ends) => `temperature ${course(ends)}`,
  rescale: (name) => (name === "clip" ? "Q clipped" : "Q shifted"),
  passes: (count) => counted(count, "pass", "passes"),
};
/** A schedule in short. @param {[number, number]} ends */
const course = ([start, end]) => (start === end ? String(start) : `${start} to ${end}`);

/** The book's settings for a method. @param {LearningSettings} book */
const bookSettings = (book, method) => ({ ...book, method, gradientStep: method === "dqn" ? ADAM_STEP : book.gradientStep });

/**
 * What a robot's name says of its settings: what is not the book's, in short.
 * @param {LearningSettings} settings @param {LearningSettings} book @param {{before: string, after: string}[]} table of the rewards
 */
export function nameOf(settings, book, table, begun = "") {
  const usual = bookSettings(book, settings.method);
  const rows = table.map((row, part) => ({ ...row, part })).filter(({ part }) => settings.rewards[part] !== usual.rewards[part]);
  const rewards = rows.length > 2 ? [`${rows.length} rewards changed`]
    : rows.map(({ before, after, part }) => `${before} to ${after} ${signed(usual.rewards[part])} → ${signed(settings.rewards[part])}`);
  const others = Object.entries(SHORT).filter(([key]) => !idle(settings.method, { key }) && !(begun && SET_BY_WEIGHTS.includes(key)) && String(settings[key]) !== String(usual[key]))
    .map(([key, say]) => say(settings[key]));
  const changes = [...rewards, ...others];
  const left = changes.length - MOST_CHANGES;
  const shown = left > 1 ? [...changes.slice(0, MOST_CHANGES), `${left} more changes`] : changes;
  return [settings.method, ...(begun ? [`on from ${shortName(begun)}`] : []), ...(shown.length > 0 ? shown : ["the book's settings"]), `seed ${settings.seed}`].join(", ");
}

/** The form: all settings, in groups that open and close. */
function settingsForm({ table, open, first, change }) {
  let [settings, begun] = [first, false];
  const [fields, lists] = [[], []];
  const numberInput = (field, attributes = {}) => {
    const input = h("input", { type: "number", step: field.step, min: field.least, max: field.most, "aria-label": field.label, ...attributes });
    fields.push({ field, input });
    input.addEventListener("change", () => {
      const wrong = complaint(field, input.valueAsNumber);
      input.toggleAttribute("data-wrong", wrong !== "");
      input.setAttribute("aria-invalid", String(wrong !== ""));
      if (wrong === "") settings = written(settings, field, input.valueAsNumber);
      change();
    });
    return input;
  };
  const labelled = (field) => h("label", {}, h("span", {}, field.label), numberInput(field));
  const list = (name) => {
    const { key, label, options } = CHOICES[name];
    const one = choice({ label, options: options.map(([, text]) => text), change: (index) => {
      settings = { ...settings, [key]: options[index][0] };
      if (key === "method") put(byMethod(settings.method));
      change();
    } });
    lists.push(() => {
      one.move(options.findIndex(([value]) => value === settings[key]));
      one.element.querySelector("select").disabled = unused({ key });
    });
    return one.element;
  };
  /** The settings with another method, which may need other steps. */
  const byMethod = (method) => bookSettings({ ...settings, gradientStep: first.gradientStep }, method);
  const unused = (field) => idle(settings.method, field) || (begun && SET_BY_WEIGHTS.includes(field.key));
  const hints = (text) => h("p", { class: "told" }, text);
  const row = (...children) => h("div", { class: "row" }, ...children);
  const group = (name, title, ...children) => h("details", { open: open.includes(name) }, h("summary", {}, title), ...children);
  const rewardFields = table.map(({ before, after, condition }, part) => rewardField(part, `${before} to ${after}${condition ? `, ${condition}` : ""}`));
  const rewards = h("div", { class: "rewards" }, ...table.map(({ before, after, condition }, part) =>
    h("label", {}, h("span", {}, `${before} → ${after}`, h("small", {}, condition)), numberInput(rewardFields[part]))));
  const element = h("div", { class: "settings" },
    group("reward", "Reward: Table 4.1", rewards, row(list("evading"))),
    group("exploration", "Exploration", hints(EXPLORATION_HINT), row(...NUMBERS.exploration.map(labelled))),
    group("learning", "Learning", hints(LEARNING_HINT), row(list("method"), list("rescale"), list("inputs"), ...NUMBERS.learning.map(labelled))),
    group("robot", "Robot and maps", row(...NUMBERS.robot.map(labelled))));
  /** Puts other settings into the form. */
  const put = (other) => {
    settings = other;
    for (const { field, input } of fields) {
      input.value = String(read(settings, field));
      input.disabled = unused(field);
      input.removeAttribute("data-wrong");
      input.setAttribute("aria-invalid", "false");
    }
    lists.forEach((fill) => fill());
  };
  /** What is wrong with the form, in one sentence, or nothing; with `focus` the first wrong field gets the focus. */
  const wrong = ({ focus = true } = {}) => {
    const found = fields.find(({ field, input }) => complaint(field, input.valueAsNumber) !== "");
    if (!found) return "";
    if (!focus) return complaint(found.field, found.input.valueAsNumber);
    const group_ = found.input.closest("details");
    if (group_) group_.open = true;
    found.input.focus();
    return complaint(found.field, found.input.valueAsNumber);
  };
  /** A training that begins with a robot's weights has its inputs and hidden units, and goes on by its method if that is one of these. */
  const begin = (robot) => {
    begun = robot !== null;
    const known = CHOICES.method.options.some(([method]) => method === robot?.method);
    put(known && robot.method !== settings.method ? byMethod(robot.method) : settings);
  };
  put(first);
  return { element, put, wrong, begin, settings: () => settings, changes: (other = first) => differences(settings, other, rewardFields, unused) };
}

// ---- What is computed, in the worker --------------------------------------------------------------------------------

/** The policies that are tried in new maps, by name. */
function contestants(network, encoder, settings, { book, temperatures }) {
  const [mine, temperature] = [{ network, encoder }, temperatures[settings.method]];
  return {
    "your robot": mine,
    [`your robot at T = ${temperature}`]: { ...mine, temperature },
    "the book's NNQL": { ...book, network: networks(book.network)() },
    "straight on": { rule: "straight" },
  };
}

/**
 * Learn, and then test the robot in new maps: a job for the worker. Its steps say what happened in each episode, and in each map.
 * @param {{settings: LearningSettings, start?: {network: Network, encoder: Encoder} | null,
 *   trial: {seed: number, maps: number, book: object, temperatures: Record<string, number>}}} job `start`: what the training begins with
 */
export function* learnAndTest({ settings, start = null, trial }) {
  const total = settings.episodes + trial.maps;
  let [network, arrived, shares] = [null, 0, []]; // of a block: the arrivals, and the shares of targets out of [0, 1]
  for (const ended of neuralQLearning(settings, { start })) {
    if (!ended) {
      yield;
      continue;
    }
    const { network: learning, episode, world, path, outcome, changes, outside } = ended;
    [network, arrived] = [learning, arrived + (outcome === "arrived" ? 1 : 0)];
    if (outside !== null) shares.push(outside);
    const ends = (episode + 1) % BLOCK === 0;
    const [first, second] = changes.map(({ absolute }) => absolute);
    const beyond = ends && shares.length > 0 ? (100 * shares.reduce((sum, share) => sum + share, 0)) / shares.length : null;
    yield { done: episode + 1, total, live: { at: episode + 1, successes: ends ? arrived : null, first, second, beyond, episode: { world, path, outcome } } };
    if (ends) [arrived, shares] = [0, []];
  }
  const policies = Object.entries(contestants(network, start?.encoder ?? encoderOf(settings), settings, trial));
  const keys = worldKeysOf(trial.maps, trial.seed);
  const { speed, maxSteps, direction, obstacles, moving } = settings;
  for (let i = 0; i < trial.maps; i += 1) {
    const world = drawWorld(keys[i], { obstacles, moving, ...NNQL_ENDS });
    const found = policies.map(([, policy]) => rollout(policy, world, { speed, maxSteps, direction }));
    const outcomes = Object.fromEntries(policies.map(([name], k) => [name, found[k].outcome]));
    yield { done: settings.episodes + i + 1, total, live: { test: { world, path: found[0].poses.map(({ x, y }) => [x, y]), outcome: found[0].outcome, outcomes } } };
  }
  const { sizes, weights, biases } = network;
  return { sizes, weights: weights.map((part) => [...part]), biases: biases.map((part) => [...part]) };
}

// ---- Pictures -------------------------------------------------------------------------------------------------------

/** A world's obstacles after so many seconds. @param {World} world */
function obstaclesAt(world, seconds) {
  if (world.obstacles.every(({ speed }) => speed === 0)) return world.obstacles;
  let { obstacles } = world;
  for (let step = 0; step < seconds; step += 1) obstacles = drift({ ...world, obstacles }, step);
  return obstacles;
}

/** Draws a world and the path of a robot through it, up to a second, with a dot each second. */
function drawPath(board, { world, path, outcome }, { second = path.length - 1, dots = true } = {}) {
  const gone = path.slice(0, second + 1);
  board.begin(world.size);
  obstaclesAt(world, second).forEach((o) => board.obstacle(o));
  board.start(world.start);
  board.target(world.target);
  board.line(gone, OUTCOME_COLOURS[outcome], dots ? 1.8 : 6);
  if (dots) board.dots(gone.flat(), 0, gone.length, { colour: OUTCOME_COLOURS[outcome], radius: 2 });
  const [[x0, y0], [x1, y1]] = second > 0 ? gone.slice(-2) : [world.start, world.target];
  board.robot({ x: gone.at(-1)[0], y: gone.at(-1)[1], heading: Math.atan2(y1 - y0, x1 - x0) });
}

/** How the robots did in the new maps. @param {Record<string, string>[]} outcomes how each map ended for each of them */
export function trialRows(outcomes) {
  return Object.keys(outcomes[0] ?? {}).map((name) => {
    const count = (end) => outcomes.filter((ended) => ended[name] === end).length;
    const arrived = count("arrived");
    const [low, high] = wilsonInterval(arrived, outcomes.length);
    return { name, n: outcomes.length, arrived, rate: (100 * arrived) / outcomes.length, low: 100 * low, high: 100 * high, collided: count("collided"), endless: count("out of steps") };
  });
}

function trialTable() {
  const body = h("tbody", {});
  const heads = ["robot", "arrives (%)", "95 % interval", "collides", "never ends"];
  const caption = h("caption", {}, "");
  const element = wide("How the robots did in the new maps", h("table", { class: "results" }, caption, h("thead", {}, h("tr", {}, ...heads.map((text) => h("th", { scope: "col" }, text)))), body));
  element.hidden = true;
  const show = (outcomes, maps, before) => {
    element.hidden = outcomes.length === 0;
    const rows = trialRows(outcomes);
    if (before) rows.splice(2, 0, { ...before, name: "the run before" });
    caption.textContent = `${outcomes.length === maps ? maps : `${outcomes.length} of ${maps}`} new maps, the same for every robot and every run`;
    body.replaceChildren(...rows.map(({ name, rate, low, high, collided, endless }) =>
      h("tr", {}, h("th", { scope: "row" }, name), ...[rate.toFixed(1), `${low.toFixed(1)} to ${high.toFixed(1)}`, collided, endless].map((value) => h("td", {}, String(value))))));
  };
  return { element, show };
}

// ---- In the page ----------------------------------------------------------------------------------------------------

const FIG_42 = [0, 19, 49, 99, 149, 199, 249, 299].map((episode) => episode / 299);
const VIEWS = ["the episodes of the training", "new maps where it failed", "new maps that it crossed"];
const LINES = [
  { name: "successes", label: "arrivals in 30", note: "How many of the last 30 episodes arrived.", colour: PALETTE.GREEN, high: BLOCK, text: String },
  { name: "first", label: "change of W(1)", note: "How much the weights between inputs and hidden units changed in an episode: the sum of the absolute changes.", text: (value) => value.toFixed(0) },
  { name: "second", label: "change of W(2)", note: "The same for the weights between hidden units and outputs.", colour: PALETTE.ORANGE, text: (value) => value.toFixed(0) },
  { name: "beyond", label: "targets out of [0, 1] (%)", note: "How many targets of the last 30 episodes do not fit into the outputs, and are shifted or clipped. DQN's outputs have no bounds.", colour: PALETTE.VERMILION, low: 0, high: 100, text: (value) => value.toFixed(0) },
];

/** A map to look back on a run: its episodes, or the new maps that it drove, second by second. */
function lookBack() {
  const board = mapCanvas({ role: "img", "aria-label": "Map" });
  const told = h("p", { class: "told" });
  const [controls, seconds] = [h("fieldset", { class: "viewer", "aria-label": "Look back" }), h("div", {})];
  let [listTime, stepTime] = [null, null];
  const stop = () => [listTime, stepTime].forEach((time) => time?.stop());
  const show = (episode, sentence, second = episode.path.length - 1) => {
    told.textContent = sentence;
    drawPath(board, episode, { second });
    board.canvas.setAttribute("aria-label", `Map with the path of the robot. ${sentence}`);
  };
  /** Before there is something to look back on: the controls keep their place, and do nothing. */
  const hide = () => {
    stop();
    controls.disabled = true;
  };
  /** Opens a list of episodes, at one of them. */
  const open = (run, view, at = 0) => {
    stop();
    controls.disabled = false;
    const list = view === 0 ? run.episodes : run.tests.filter(({ outcome }) => (outcome === "arrived") === (view === 2));
    const name = view === 0 ? "episode" : "map";
    const text = (frame) => (list.length === 0 ? "none" : `${frame + 1} of ${list.length}, ${ENDINGS[list[frame].outcome]} after ${list[frame].path.length - 1} s`);
    const see = (frame) => {
      stepTime?.stop();
      seconds.replaceChildren();
      if (list.length === 0) {
        seconds.replaceChildren(player({ label: "second", count: 1, text: () => "none", change: () => {} }).element);
        told.textContent = `There are no ${VIEWS[view]}.`;
        return;
      }
      const [episode, sentence] = [list[frame], `${name[0].toUpperCase()}${name.slice(1)} ${text(frame)}.`];
      const last = episode.path.length - 1;
      stepTime = player({ label: "second", count: last + 1, value: last, interval: 60, text: (second) => `${second} of ${last}`, change: (second) => show(episode, sentence, second) });
      seconds.replaceChildren(stepTime.element);
      show(episode, sentence);
    };
    const first = clamp(at, 0, Math.max(list.length - 1, 0));
    const which = choice({ label: "look at", options: VIEWS, value: view, change: (index) => open(run, index) });
    listTime = player({ label: name, count: Math.max(list.length, 1), value: first, interval: view === 0 ? 120 : 700, text, change: see });
    controls.replaceChildren(which.element, listTime.element, seconds);
    see(first);
  };
  open({ episodes: [], tests: [] }, 0);
  hide();
  return { element: h("div", {}, board.canvas, told, controls), show, open, hide };
}

const WAITING = "an episode that is still to come";

/** Eight episodes of a run as small maps, as in Fig. 4.2. */
function snapshots(pick) {
  const all = FIG_42.map((share) => {
    const small = mapCanvas({ "aria-hidden": "true" });
    const title = h("span", {}, " ");
    const one = { share, small, title, at: -1 };
    one.element = h("button", { type: "button", disabled: true, "aria-label": WAITING, click: () => pick(one.at) }, small.canvas, title);
    return one;
  });
  const clear = () => all.forEach((one) => {
    one.at = -1;
    set(one.element, { "aria-label": WAITING });
    one.element.disabled = true;
  });
  const show = ({ episodes, settings }) => all.forEach((one) => {
    const at = Math.round(one.share * (settings.episodes - 1));
    if (!episodes[at] || one.at === at) return;
    drawPath(one.small, episodes[at], { dots: false });
    one.title.textContent = `${at + 1}: ${ENDINGS[episodes[at].outcome]}`;
    one.element.removeAttribute("aria-label"); // from here on its text names it
    one.element.disabled = false;
    one.at = at;
  });
  return { element: h("div", { class: "snapshots", role: "group", "aria-label": "Eight episodes of the training" }, ...all.map(({ element }) => element)), clear, show };
}

/** Where a way to go wrong shows, and what is compared once it is cured. */
const COMPARED = {
  maps: "your robot with the row “the run before”",
  training: "the arrivals with the grey curve of the run before",
  targets: "the targets out of [0, 1] with the grey curve of the run before",
  nothing: "your robot with the row “the run before”: the two hardly differ",
};

/** A list of ways to go wrong, each with what to watch and its cure. */
function faults(presets, first, form, tell) {
  const about = h("p", { class: "told" });
  const apply = (index, cured) => {
    const { seed, episodes, obstacles, moving, speed } = presets[index].settings;
    form.put(cured ? { ...first, seed, episodes, obstacles, moving, speed } : presets[index].settings);
    tell();
    cure.disabled = cured;
    about.textContent = cured ? `${presets[index].cure} Press Train, and compare ${COMPARED[presets[index].shows]}.` : presets[index].watch;
  };
  let chosen = 0;
  const which = choice({ label: "what goes wrong", options: presets.map(({ name }) => name), change: (index) => apply((chosen = index), false) });
  const cure = h("button", { type: "button", click: () => apply(chosen, true) }, "Cure it");
  apply(0, false);
  return [h("div", { class: "row presets" }, which.element, cure), about];
}

const ANEW_IN_PYTHON = "The robots of Python begin with random weights: choose these under “begin with”.";

/** Several robots in the kernel's Python, with the settings of the page. */
function severalRobots({ model, form, start }) {
  const robots = numberOfRobots();
  return kernelPanel({
    model, title: "The same settings in Python: several robots", unit: "robot", total: robots.value, controls: [robots.element],
    lines: [
      { name: "last", label: "arrivals, last 100", note: "How many of the last 100 episodes of a robot arrived.", high: 100, text: (value) => value.toFixed(0) },
      { name: "maps", label: "new maps (%)", note: "How many new maps a robot crosses.", colour: PALETTE.GREEN, high: 100, text: (value) => value.toFixed(0) },
    ],
    request: () => form.wrong() || (start.value() ? ANEW_IN_PYTHON : { settings: form.settings(), robots: robots.value() }),
  });
}

function render({ model, el }) {
  const { table, open, first, usual, thesis, presets, trial } = model.get("data");
  let maps = trial.numbers[0];
  let [run, before, frame] = [null, null, 0];

  const note = h("p", { class: "note", role: "status" });
  const setting = h("p", { class: "told" });
  const tell = () => {
    note.textContent = form.wrong({ focus: false });
    const changes = form.changes();
    const begun = start.value();
    const begins = begun ? ` It begins with the weights of ${begun.name}, and with the temperature and the steps of the form.` : "";
    setting.textContent = note.textContent ? "" : `${changes.length > 0 ? `Changed: ${changes.join("; ")}.` : "Nothing is changed."}${begins} After its training the robot is tested in ${maps} new maps.`;
  };
  const form = settingsForm({ table, open, first, change: () => tell() });
  const start = beginning({ change: () => {
    form.begin(start.value());
    tell();
  } });
  /** Other settings in the form, with the reader's own seed and number of episodes. */
  const put = (settings) => {
    const { seed, episodes } = form.settings();
    form.put({ ...settings, seed, episodes });
    tell();
  };
  const button = (text, settings) => h("button", { type: "button", click: () => put(settings) }, text);

  const map = lookBack();
  const small = snapshots((at) => map.open(run, 0, at));
  const results = trialTable();
  const count = choice({ label: "afterwards, test in", options: trial.numbers.map((number) => `${number} new maps`), change: (index) => {
    maps = trial.numbers[index];
    tell();
  } });
  const save = h("button", { type: "button", disabled: true, click: () => saveFile("my-nnql.safetensors", robotFile(run.robot)) }, "Download the weights");

  const paint = () => {
    frame = 0;
    const { episodes, tests, settings } = run;
    small.show(run);
    results.show(tests.map(({ outcomes }) => outcomes), run.maps, before);
    const latest = tests.at(-1) ?? episodes.at(-1);
    if (latest && panel.running()) {
      map.show(latest, tests.length > 0 ? `New map ${tests.length} of ${run.maps}.` : `Episode ${episodes.length} of ${settings.episodes}, ${ENDINGS[latest.outcome]}.`);
    }
  };
  const ended = () => {
    cancelAnimationFrame(frame);
    paint();
    save.disabled = !run.network;
    if (run.episodes.length > 0) map.open(run, 0, run.episodes.length - 1);
  };
  const panel = trainingPanel({
    source: model.get("_esm"), title: "Learn by trial and reward, and drive new maps", action: "Train", unit: "episode", total: () => form.settings().episodes, lines: LINES,
    begin: () => {
      const wrong = form.wrong();
      if (wrong !== "") {
        note.textContent = ""; // it is said once, below the button
        return wrong;
      }
      if (run?.network) [before] = trialRows(run.tests.map(({ outcomes }) => outcomes));
      run = { settings: form.settings(), changed: form.changes(bookSettings(usual, form.settings().method)), start: start.value(), maps, episodes: [], tests: [], network: null };
      map.hide();
      small.clear();
      results.show([], maps);
      save.disabled = true;
      return { job: learnAndTest, argument: { settings: run.settings, start: run.start, trial: { ...trial, maps } } };
    },
    live: (news) => {
      for (const { episode, test } of news) {
        if (episode) run.episodes.push(episode);
        if (test) run.tests.push(test);
      }
      frame ||= requestAnimationFrame(paint);
    },
    done: (network) => {
      run.network = network;
      const { settings, changed, start: begun } = run;
      run.robot = {
        ...learned(run), name: nameOf(settings, usual, table, begun?.name), temperature: trial.temperatures[settings.method],
        about: aboutRun(run), made: { ...settings, changed, ...(begun ? { begun: begun.name } : {}) },
      };
      const warning = keepRobot(run.robot);
      ended();
      return `${verdict(run)} ${warning}`.trim();
    },
    cancelled: () => {
      ended();
      return "What the robot learned is dropped; its episodes so far stay below, to be looked at.";
    },
    beside: map.element,
  });

  const kernel = severalRobots({ model, form, start });

  panel.element.firstElementChild.after(setting, note); // below Train, which must not move away from under a finger

  asWidget(el, "Q-learning lab", "q-learning-lab");
  el.replaceChildren(
    ...(presets.length > 0 ? faults(presets, first, form, tell) : []), form.element, start.element,
    h("div", { class: "row tools" }, count.element, button("The thesis's settings", thesis), button("The book's settings", first)),
    panel.element, results.element, small.element, h("div", { class: "row tools" }, save),
    kernel.element);
  tell();
  const world = trainingWorlds(first)(0);
  map.show({ world, path: [world.start], outcome: "arrived" }, "The first map of the training.");
  return () => {
    panel.cancel();
    kernel.cancel();
    start.end();
    map.hide();
    cancelAnimationFrame(frame);
  };
}

/** The network of a run, and what it reads; a network of raw inputs becomes one of scaled inputs, which has the same outputs. */
export function learned({ network, settings, start = null }) {
  const { sensors, walls, target, raw = false } = start?.encoder ?? encoderOf(settings);
  const [inputs, scale] = [network.sizes[0], [...sensors.map(() => 7), 9]];
  const first = network.weights[0].map((weight, k) => (raw ? weight * (scale[k % inputs] ?? 1) : weight));
  return { network: { ...network, weights: [first, ...network.weights.slice(1)] }, encoder: { sensors, walls, target }, method: settings.method };
}

/** How a robot was made, in whole sentences. */
function aboutRun({ settings: { method, episodes, seed }, changed, start }) {
  const differs = changed.length > 0 ? `Not as in the book: ${changed.join("; ")}.` : "The settings are the book's.";
  return `Learned by ${METHOD_WORDS[method]} from ${counted(episodes, "episode")}, ${start ? `beginning with the weights of ${start.name}, ` : ""}seed ${seed}. ${differs}`;
}

/** What came of a run, in one sentence. */
function verdict({ tests }) {
  const { n, arrived, rate, low, high } = trialRows(tests.map(({ outcomes }) => outcomes))[0];
  return `Your robot crosses ${arrived} of ${n} new maps: ${rate.toFixed(1)} %, 95 % interval ${low.toFixed(1)} to ${high.toFixed(1)}.`;
}

export default { render };
