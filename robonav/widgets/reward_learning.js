// Learn a reward from demonstrations, look at it as a map, and train another robot for it. Needs learning/nirl.js and a training panel.

const HEAT_CELL = 2; // metres
const HEAT_SHADES = 5; // on either side of 0
const PYTHON_METHODS = { nirl: "NIRL", apprenticeship: "apprenticeship learning", "relative-entropy": "relative entropy", scirl: "SCIRL" };
const METHOD_NAMES = Object.values(PYTHON_METHODS);
const LITTLE_LEAD = 5; // per cent of the maps: by so little a robot that has learned something is not better than straight on
const ENOUGH = 60; // iterations after which the demonstrations are to blame for a poor robot
const MORE_ITERATIONS = "Few iterations were made: let it learn for more.";
const NO_DECISION = "Your demonstrations hold no decision to learn from: drive some maps with obstacles in the playground first.";
const ACTION_NAMES = ROBOT.actions.slice(0, 5);

/** The job: a reward and a policy from decisions, or with `reward` a policy alone. */
export function* rewardJob({ inputs, actions, settings, seed, reward }) {
  const run = nirl({ inputs: inputs.map((row) => Float64Array.from(row)), actions }, settings, seed, reward);
  for (;;) {
    const step = run.next();
    if (step.done) {
      const { network, theta, iteration, balanced } = step.value;
      return { network: { sizes: network.sizes, weights: network.weights.map((w) => w.slice()), biases: network.biases.map((b) => b.slice()) }, theta, iteration, balanced };
    }
    if (!step.value) {
      yield;
      continue;
    }
    const { iteration, iterations, margin, balanced, arrived, theta } = step.value;
    yield { done: iteration, total: iterations, live: { at: iteration, margin, balanced: 100 * balanced, arrived: 100 * arrived, theta } };
  }
}

/**
 * The job of the page: a reward and a policy, and then the policy in new maps beside others. Its result is a reward job's;
 * that it is there already is said before the maps are driven.
 */
export function* learnAndTry({ learning, trial }) {
  const run = rewardJob(learning);
  let step = run.next();
  for (; !step.done; step = run.next()) yield step.value && { ...step.value, total: step.value.total + trial.count };
  const found = step.value;
  const { iterations, encoder } = learning.settings;
  yield { done: iterations, total: iterations + trial.count, live: { found } };
  const policies = [{ network: found.network, encoder }, ...trial.policies];
  for (const { done, live } of trialsJob({ ...trial, policies })) yield { done: iterations + done, total: iterations + trial.count, live: { tried: live } };
  return found;
}

/** The cells of a map where a reward decides, and what a robot that faces the target perceives in each: something is in range, and nothing is hit. */
export function mapCells(world, { encoder }) {
  const cells = [];
  for (let y = HEAT_CELL / 2; y < world.size; y += HEAT_CELL) {
    for (let x = HEAT_CELL / 2; x < world.size; x += HEAT_CELL) {
      const pose = { x, y, heading: Math.atan2(world.target[1] - y, world.target[0] - x) };
      const sensing = sense(world, pose);
      const nearest = Math.min(...sensing.ranges);
      if (nearest >= ROBOT.collision && nearest < ROBOT.range) cells.push({ x, y, input: encode(encoder, sensing) });
    }
  }
  return cells;
}

/** The reward of an action in each cell of a map, or with action -1 the largest of all actions. */
export function rewardMap(theta, cells, action) {
  return cells.map(({ x, y, input }) => {
    const rewards = ACTION_NAMES.map((_, a) => rewardAt(theta, input, a));
    return { x, y, reward: action < 0 ? Math.max(...rewards) : rewards[action] };
  });
}

/** The mean reward over the cells of a map. */
export const meanReward = (cells) => cells.reduce((sum, { reward }) => sum + reward, 0) / Math.max(1, cells.length);

/** The weights of a reward, a row an action. */
const rowsOf = (theta) => ACTION_NAMES.map((_, a) => [...theta].slice((a * theta.length) / ACTION_NAMES.length, ((a + 1) * theta.length) / ACTION_NAMES.length));

/** What a robot's name says of its settings: what is not as usual. @param {NIRLSettings} settings */
export const changesOf = (settings) => [["iterations", (n) => `${n} iterations`], ["obstacles", (n) => `${n} obstacles`], ["inverseTemperature", (n) => `η ${n}`]]
  .filter(([key]) => settings[key] !== NIRL_SETTINGS[key]).map(([key, say]) => `${say(settings[key])}, `).join("");

/** What stands in each column of theta. */
const featureNames = ({ sensors }) => [...sensors.map((s) => `danger in sector ${s}`),
  "target: sine of its direction", "target: cosine of its direction", "target seen", ...sensors.map((s) => `wall in sector ${s}`), "constant"];

function render({ model, el }) {
  const { sets, world, policies, seed, maps } = model.get("data");
  const source = model.get("_esm");
  let [settings, found, shownAction, second] = [{ ...NIRL_SETTINGS, seed: 0 }, null, 0, { obstacles: 10, moving: 10, speed: 2 }];
  let chosen = 0;
  const others = policies.map(({ name, rule, network, encoder }) => ({ name, policy: rule ? { rule } : { network: networks(network)(), encoder } }));
  const number = (label, value, { step = 1, least, most, hint = "" }, change) => {
    const input = h("input", { type: "number", value, step, min: least, max: most, "aria-label": label, change: () => {
      const typed = input.valueAsNumber;
      const right = Number.isFinite(typed) && typed >= least && typed <= most && (step !== 1 || Number.isInteger(typed));
      const sentence = right ? "" : `${label} must be ${step === 1 ? "a whole number" : "a number"} from ${least} to ${most}.`;
      if (right) wrong.delete(label);
      else wrong.set(label, sentence);
      [complain.textContent = ""] = wrong.values();
      input.setAttribute("aria-invalid", String(!right));
      if (right) change(typed);
    } });
    return h("label", {}, h("span", {}, label), input, ...hintBelow(hint));
  };
  const wrong = new Map(); // the sentence on each wrong number
  const complain = h("p", { class: "status", role: "alert" });

  // What was learned, as a picture
  const board = mapCanvas({ role: "img" });
  const drawn = h("p", { class: "label" });
  let places = null; // the map's cells, once there is a reward to draw
  const paint = (theta) => {
    board.begin(world.size);
    let told = "";
    if (theta) {
      places ??= mapCells(world, settings);
      const cells = rewardMap(theta, places, shownAction);
      const mean = meanReward(cells);
      const sizes = cells.map(({ reward }) => Math.abs(reward - mean)).sort((a, b) => a - b);
      const strongest = sizes[Math.floor(0.95 * sizes.length)] || 1;
      told = `They show how far it lies above or below its mean over the map, ${mean.toFixed(2)}.`;
      for (let shade = 1; shade <= HEAT_SHADES; shade += 1) {
        for (const [colour, sign] of [[PALETTE.BLUE, 1], [PALETTE.VERMILION, -1]]) {
          const flat = cells.filter(({ reward }) => Math.min(HEAT_SHADES, Math.ceil((HEAT_SHADES * sign * (reward - mean)) / strongest)) === shade).flatMap(({ x, y }) => [x, y]);
          board.dots(flat, 0, flat.length / 2, { colour, radius: 5, alpha: 0.13 * shade });
        }
      }
    }
    world.obstacles.forEach((o) => board.obstacle(o));
    board.start(world.start);
    board.target(world.target);
    const of = shownAction < 0 ? "the largest reward of the five actions" : `the reward of the action ${ACTION_NAMES[shownAction]}`;
    drawn.textContent = theta ? `The colours show ${of}, for a robot there that faces the target. ${told}` : `Once a reward is learned, colours will show ${of}.`;
    board.canvas.setAttribute("aria-label", theta ? "Map of the learned reward: blue where the reward of the action is above its mean over the map, red where it is below" : "Map without a reward: nothing is learned yet");
  };
  const action = choice({ label: "reward of the action", options: [...ACTION_NAMES, "best of the five"], value: 0, change: (index) => {
    shownAction = index < ACTION_NAMES.length ? index : -1;
    paint(found?.theta);
  } });
  const seen = h("div", {}, board.canvas, drawn, action.element,
    h("p", { class: "legend" }, h("span", { style: `--mark: ${PALETTE.BLUE}` }, "above the mean"), h("span", { style: `--mark: ${PALETTE.VERMILION}` }, "below the mean"),
      h("span", { style: "--mark: transparent; --edge: var(--border)" }, "no colour: nothing is in range, so the reflex decides and no reward is asked")));
  const weightsTable = h("table", { class: "results" });
  const table = wide("Weights of the reward", weightsTable);
  const listed = h("details", { hidden: true }, h("summary", {}, "The weights of the reward"), table);
  const list = (theta) => {
    listed.hidden = false;
    const names = featureNames(settings.encoder);
    const strongest = Math.max(1e-12, ...theta.map(Math.abs));
    const cell = (value) => h("td", { style: `background: color-mix(in srgb, ${value > 0 ? PALETTE.BLUE : PALETTE.VERMILION} ${Math.round((45 * Math.abs(value)) / strongest)}%, transparent)` }, value.toFixed(2));
    weightsTable.replaceChildren(
      h("caption", {}, "Weights of the reward, one column an action"),
      h("thead", {}, h("tr", {}, ...["feature", ...ACTION_NAMES].map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...names.map((name, j) => h("tr", {}, h("th", { scope: "row" }, name), ...ACTION_NAMES.map((_, a) => cell(theta[a * names.length + j]))))));
  };

  // How well a robot does in new maps
  const [results, resultsElsewhere] = [h("div", {}), h("div", { class: "grow" })];
  /** A table of the policies in new maps, in place of the one before; gives a function that fills it, and one that puts the old one back. */
  const trialsTable = (place, where, name) => {
    const before = [...place.childNodes];
    let counted = [];
    const all = [{ name }, ...others];
    const rows = all.map(({ name: title }) => [h("th", { scope: "row" }, title), h("td", {}, "")]);
    const caption = h("caption", {}, "");
    const inNewMaps = h("table", { class: "results" }, caption,
      h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "policy"), h("th", { scope: "col" }, "arrived, with its 95 % interval"))),
      h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row))));
    place.replaceChildren(inNewMaps);
    const show = (counts, n) => {
      caption.textContent = `${n} of ${maps} new maps: ${where.obstacles} standing and ${where.moving} moving obstacles, ${where.speed} m/s`;
      counted = counts;
      counts.forEach((count, k) => {
        const [low, high] = wilsonInterval(count, Math.max(1, n)).map((rate) => Math.round(100 * rate));
        rows[k][1].textContent = n ? `${Math.round((100 * count) / n)} % [${low}, ${high}]` : "…";
      });
    };
    show(all.map(() => 0), 0);
    const rate = (k) => Math.round((100 * counted[k]) / maps);
    const straight = 1 + others.findIndex(({ policy }) => policy.rule === "straight");
    const verdict = () => `It arrives in ${rate(0)} % of ${maps} new maps, one that always goes straight on in ${rate(straight)} %.`;
    const poor = () => rate(0) < rate(straight) + LITTLE_LEAD;
    const putBack = () => place.contains(inNewMaps) && place.replaceChildren(...before);
    return { show, say: (sentence) => (caption.textContent = sentence), verdict, poor, putBack };
  };
  const trialIn = (where) => ({ policies: others.map(({ policy }) => policy), seed, count: maps, conditions: where });
  /** Lets a policy that was learned elsewhere drive the new maps. */
  const tryPolicy = (where, policy, name) => {
    const { show, say } = trialsTable(results, where, name);
    trial = startJob(source, trialsJob, { ...trialIn(where), policies: [policy, ...others.map((other) => other.policy)] }, {
      live: (news) => show(news.at(-1).arrived, news.at(-1).at),
      error: say,
    });
  };
  let trial = null; // of a policy that was learned in Python
  const lines = [
    { name: "margin", label: "margin", low: null, note: "By how much the reward prefers what the demonstrator did to what the policy does." },
    { name: "balanced", label: "balanced accuracy (%)", note: "How many of the demonstrated decisions the policy takes too: the mean of the five actions' shares.", low: 0, high: 100, colour: PALETTE.GREEN },
    { name: "arrived", label: "arrived (%)", note: "How many of the episodes of an iteration arrived.", low: 0, high: 100, colour: PALETTE.ORANGE },
  ].map((line) => ({ ...line, text: (value) => (line.high ? value.toFixed(0) : value.toPrecision(2)) }));

  /** Shows a reward that is there, and lets it be used elsewhere. */
  const show = (reward_) => {
    found = reward_;
    paint(found.theta);
    list(found.theta);
    elsewhere.hidden = false;
    reward.disabled = false;
    weights.disabled = !found.network;
  };
  /** A robot that was trained for a reward: how it was made, in words and as data. */
  const described = ({ iteration, balanced, theta, network }, { method, conditions, seed, rewardFrom = "" }) => {
    const { iterations, inverseTemperature, discount } = settings;
    const { obstacles, moving, speed } = conditions;
    const [name, count] = [names()[chosen], decisions(chosen).actions.length];
    const what = rewardFrom ? `A policy for a given reward (${rewardFrom}).` : `A reward and a policy, learned by ${method} from ${name} with ${count} decisions.`;
    return {
      about: `${what} Of ${iterations} iterations number ${iteration} is kept, which predicts ${rewardFrom ? name : "them"} best. `
        + `Trained among ${obstacles} standing and ${moving} moving obstacles at ${speed} m/s, with inverse temperature ${inverseTemperature} and seed ${seed}.`,
      made: {
        source: name, demonstrations: sets[chosen]?.demonstrations ?? mine().length, decisions: count, iterations, kept: iteration, balanced, obstacles, moving, speed,
        hidden: network.sizes[1], inverseTemperature, discount, seed, reward: rowsOf(theta), ...(rewardFrom ? { rewardFrom } : {}),
      },
    };
  };
  /** Shows a reward that was learned in the page or in Python, and keeps its robot. */
  const learned = (result, title, method) => {
    const [name, conditions] = [`${title}, ${names()[chosen]}`, trained()];
    const robot = { name, network: result.network, encoder: settings.encoder, method: result.method, ...described(result, { method, conditions, seed: settings.seed }) };
    kept = keepRobot(robot);
    show({ ...robot, theta: result.theta, iteration: result.iteration });
  };
  let kept = ""; // what the browser says where it does not keep the robot
  const trained = () => ({ obstacles: settings.obstacles, moving: settings.moving, speed: settings.speed });
  /** A training in the page with the trial of its policy: `accept` is given the reward as soon as it is learned. */
  const training = ({ title, action, lines: drawn, place, name, where, argument, paints, accept, ends, advise = () => "", beside = null }) => {
    let [there, tried] = [false, null];
    return trainingPanel({
      source, title, action, unit: "iteration", total: () => settings.iterations, lines: drawn, beside,
      begin: () => {
        if (complain.textContent) return complain.textContent;
        const { inputs, actions } = decisions(chosen);
        if (actions.length === 0) return NO_DECISION;
        if (place === results) trial?.cancel();
        [there, tried] = [false, trialsTable(place, where(), name)];
        return { job: learnAndTry, argument: { learning: { inputs, actions, ...argument() }, trial: trialIn(where()) } };
      },
      live: (news) => {
        for (const item of news) {
          if (item.found) {
            there = true;
            accept(item.found);
          }
          if (item.tried) tried.show(item.tried.arrived, item.tried.at);
        }
        if (paints && news.at(-1).theta) paint(news.at(-1).theta);
      },
      done: () => [ends(), tried.verdict(), tried.poor() ? advise() : ""].filter(Boolean).join(" "),
      cancelled: () => {
        if (there) return "It had learned already, and stays; not all new maps were driven.";
        tried.putBack();
        if (paints) paint(found?.theta);
        return "Nothing of this run is kept.";
      },
    });
  };

  const learn = training({
    title: "Learn a reward and a policy for it, and drive new maps", action: "Learn the reward", lines, place: results, name: "your robot", paints: true,
    where: trained, argument: () => ({ settings, seed: settings.seed, reward: null }),
    accept: (result) => learned({ ...result, method: "nirl" }, `NIRL, ${changesOf(settings)}seed ${settings.seed}`, "NIRL"),
    ends: () => `The policy of iteration ${found.iteration} has the highest balanced accuracy and is kept. ${kept}`.trim(), beside: seen,
    advise: () => (settings.iterations < ENOUGH ? MORE_ITERATIONS : sets[chosen] ? "" : adviceOn(mine(), keptDemonstrations())),
  });
  let [newRobot, next, keptToo] = [null, null, ""]; // the robot of the other worlds, what it will be, and what the browser says where it does not keep it
  const again = training({
    title: "Learn a policy for the same reward in other worlds, and drive new maps there", action: "Train a new robot for this reward", lines: lines.slice(2), place: resultsElsewhere, name: "the new robot", paints: false,
    where: () => second, argument: () => {
      next = {
        name: `${found.name}, trained with ${second.obstacles} standing and ${second.moving} moving obstacles at ${second.speed} m/s`,
        how: { conditions: second, seed: settings.seed + 1, rewardFrom: found.name },
      };
      return { settings: { ...settings, ...second }, seed: settings.seed + 1, reward: found.theta };
    },
    accept: (result) => {
      newRobot = { name: next.name, network: result.network, encoder: settings.encoder, method: "nirl", ...described(result, next.how) };
      keptToo = keepRobot(newRobot);
      newWeights.disabled = false;
    },
    ends: () => `The new robot is kept. ${keptToo}`.trim(),
  });
  const weights = h("button", { type: "button", disabled: true, click: () => saveFile("my-nirl.safetensors", robotFile(found)) }, "Download the policy");
  const newWeights = h("button", { type: "button", disabled: true, click: () => saveFile("my-nirl-elsewhere.safetensors", robotFile(newRobot)) }, "Download the new robot's policy");
  const reward = h("button", { type: "button", disabled: true, click: () => saveFile("my-reward.npz", rewardFile(found.theta, ACTION_NAMES.length)) }, "Download the reward");
  const note = h("span", { role: "status" });
  const upload = h("input", { type: "file", accept: ".npz", "aria-label": "File of a reward", change: async () => {
    const [file] = upload.files;
    if (!file) return;
    try {
      const theta = await rewardFromFile(await file.arrayBuffer(), [ACTION_NAMES.length, encoderSize(settings.encoder) + 1]);
      learn.cancel();
      show({ name: `reward ${file.name}`, theta, network: null });
      note.textContent = `The map shows the reward in ${file.name}. Below it you can train a robot for it.`;
    } catch (error) {
      note.textContent = error.message;
    }
    upload.value = "";
  } });

  const ready = sets.map(({ inputs, actions }) => {
    const { shape: [rows, width], values } = unpack(inputs);
    return { inputs: Array.from({ length: rows }, (_, t) => values.slice(t * width, (t + 1) * width)), actions: [...unpack(actions).values] };
  });
  /** The reader's demonstrations that arrived: who collides is no expert. */
  const mine = () => keptDemonstrations().filter(({ outcome }) => outcome === "arrived");
  const own = () => decisionsOf(mine().flatMap(effective), settings);
  const decisions = (index) => ready[index] ?? own();
  const names = () => [...sets.map(({ name }) => name), `my own demonstrations (${mine().length})`];
  const from = choice({ label: "demonstrations", options: names(), change: (index) => {
    chosen = index;
    tell();
  } });
  const about = h("p", { class: "about" });
  /** What the chosen demonstrations hold. */
  const tell = () => {
    const all = sets[chosen]?.demonstrations ?? mine().length;
    const count = decisions(chosen).actions.length;
    const lost = sets[chosen] ? 0 : keptDemonstrations().length - mine().length;
    about.textContent = (lost ? `${lost} of your demonstrations did not arrive and ${lost === 1 ? "is" : "are"} left out. ` : "") + (count === 0 ? NO_DECISION
      : `${all} ${all === 1 ? "demonstration" : "demonstrations"} with ${count} ${count === 1 ? "decision" : "decisions"} to learn from: steps with something in range.`);
  };
  const forget = watchDemonstrations(() => {
    from.element.querySelector("option:last-child").textContent = names().at(-1);
    if (!found && mine().length === 1) from.move((chosen = sets.length));
    if (mine().length === 0) from.move((chosen = Math.min(chosen, sets.length - 1)));
    tell();
  });
  if (mine().length > 0) from.move((chosen = sets.length));
  const [robots, python] = [numberOfRobots(), { method: 0, asked: 0, hidden: settings.hidden }];
  const kernel = kernelPanel({
    model, title: "The same settings in Python: four methods, several robots", unit: "iteration", total: () => settings.iterations, lines: lines.slice(1),
    controls: [
      choice({ label: "method", options: METHOD_NAMES, change: (index) => (python.method = index) }).element, robots.element,
      slider({ label: "hidden units", count: 20, value: python.hidden - 1, text: (at) => String(at + 1), change: (at) => (python.hidden = at + 1) }).element,
    ],
    request: () => {
      if (complain.textContent) return complain.textContent;
      const demonstrations = mine();
      if (!ready[chosen] && own().actions.length === 0) return NO_DECISION;
      python.asked = python.method;
      return {
        method: Object.keys(PYTHON_METHODS)[python.asked], robots: robots.value(), set: chosen,
        demonstrations: ready[chosen] ? null : base64Of(demonstrationsFile(demonstrations)),
        settings: { iterations: settings.iterations, obstacles: settings.obstacles, inverseTemperature: settings.inverseTemperature, seed: settings.seed, hidden: python.hidden },
      };
    },
    done: ({ sentence, theta, policy, iteration, balanced }) => {
      const name = METHOD_NAMES[python.asked];
      const network = networks(policy.network)();
      learned({ theta, network, iteration, balanced, method: Object.keys(PYTHON_METHODS)[python.asked] }, `${name} in Python, ${changesOf(settings)}seed ${settings.seed}`, `${name} in Python`);
      tryPolicy(trained(), { network, encoder: settings.encoder }, `${name} in Python, the best of the robots`);
      return sentence;
    },
  });

  const elsewhere = h("div", { hidden: true });
  asWidget(el, "Reward lab: learn a reward from demonstrations");
  el.replaceChildren(
    h("div", { class: "row" }, from.element,
      number("iterations", settings.iterations, { least: 1, most: 1000, hint: "How often the reward is corrected." }, (value) => (settings = { ...settings, iterations: value })),
      number("obstacles in training", settings.obstacles, { least: 0, most: 40 }, (value) => (settings = { ...settings, obstacles: value })),
      number("inverse temperature η", settings.inverseTemperature, { step: 0.5, least: 0, most: 200, hint: "0: actions at random. The larger it is, the more often the robot takes the best action." }, (value) => (settings = { ...settings, inverseTemperature: value })),
      number("seed", 0, { least: 0, most: 1e6, hint: "Another seed draws other random numbers." }, (value) => (settings = { ...settings, seed: value }))),
    about, complain, learn.element,
    h("div", { class: "row" }, h("div", { class: "grow" }, results, listed)),
    h("div", { class: "row tools" }, weights, reward, h("label", { class: "file" }, h("span", {}, "or look at a reward from a file (npz)"), upload), note),
    elsewhere, kernel.element);
  elsewhere.append(
    h("fieldset", { class: "inspector" }, h("legend", {}, "The same reward somewhere else"),
      number("standing obstacles", second.obstacles, { least: 0, most: 40 }, (value) => (second = { ...second, obstacles: value })),
      number("moving obstacles", second.moving, { least: 0, most: 40 }, (value) => (second = { ...second, moving: value })),
      number("speed (m/s)", second.speed, { step: 0.5, least: 1, most: 4 }, (value) => (second = { ...second, speed: value }))),
    again.element, h("div", { class: "row" }, resultsElsewhere), h("div", { class: "row tools" }, newWeights));
  paint(null);
  tell();
  return () => {
    forget();
    learn.cancel();
    again.cancel();
    kernel.cancel();
    trial?.cancel();
  };
}

export default { render };
