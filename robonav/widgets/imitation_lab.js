// Imitation lab: a robot learns from the reader's demonstrations, in the page, and is tested in new maps.

const SOURCES = ["my demonstrations", "the expert's demonstrations", "both"];
const HIDDEN = [1, 2, 4, 8, 16, 32];
const DECAYS = [0, 0.01, 0.03, 0.1, 0.3, 1, 3, 10];
const ITERATIONS = [1, 3, 10, 30, 100, 300, 1000];
const OBSTACLES = [10, 20, 30];
const FEW = 25; // of the expert's demonstrations, as on the page
const NO_STEP = "These demonstrations have no step with something in range, so there is nothing to learn from.";
const NO_DEMONSTRATION = "There is nothing to learn from: drive a few maps in the playground, or choose the expert's demonstrations.";
/** What is said while the expert's demonstrations are learned from because the reader has none that arrived. */
const withoutOwn = (kept) => {
  if (kept) return `They are the expert's: none of your ${kept} ${kept === 1 ? "demonstration" : "demonstrations"} has arrived yet.`;
  const apart = location.protocol === "file:" ? " Some browsers, such as Firefox, keep the demonstrations of each page on a disk apart: press Download all where you drive, and load the file here." : "";
  return `They are the expert's: no demonstration of yours is kept here.${apart}`;
};

const ALWAYS_STRAIGHT = "Your robot always goes straight on. Drive more maps, turn earlier, or choose a smaller λ.";
const PYTHON_BEGINS_ANEW = "The robots of Python begin with random weights: choose these under “begin with”.";
const ROOM = 700; // pixels from which on the settings are open at first
const MOST_ROBOTS = 6; // of the reader's, that stay in the table
const LITTLE = 0.05; // a share of the maps: by so little a robot that has learned something is not better than straight on

function render({ model, el }) {
  const { expert, book, trial, playground } = model.get("data");
  const replays = []; // of the expert's demonstrations, as many as were needed so far
  const experts = (count) => {
    if (replays.length < count) replays.push(...replayed(expert, replays.length, count));
    return replays.slice(0, count);
  };
  const rivals = [{ ...book, name: "the book's robot" }, STRAIGHT];
  let settings = { source: 0, count: 1, hidden: 8, regularisation: 0.1, iterations: 300, seed: 0, obstacles: 10 };
  let robots = []; // {name, outcomes, colour, policy}: the reader's, the latest first
  let finished = 0; // the number of the robot that was trained last, also of one that left the table
  let baselines = rivals.map((rival) => ({ name: rival.name, outcomes: [], colour: PALETTE.GREY, policy: rival.network ? { ...rival, network: networks(rival.network)() } : rival }));
  let [worlds, now] = [null, null];
  const inMaps = () => ({ ...trial, obstacles: settings.obstacles });
  const world = (map) => (worlds ??= randomWorlds(trial.maps, inMaps()))[map];

  // What is learned from
  const mine = () => keptDemonstrations().filter(({ outcome }) => outcome === "arrived");
  const total = () => (settings.source === 1 ? 0 : mine().length) + (settings.source === 0 ? 0 : expert.actions.length);
  const chosen = () => {
    const own = settings.source === 1 ? [] : mine().slice(0, settings.count);
    return settings.source === 0 ? own : [...own, ...experts(Math.min(settings.count, total()) - own.length)];
  };
  const about = h("p", { class: "about" });
  const plan = h("p", { class: "about" });
  const source = choice({ label: "learn from", options: SOURCES, change: (index) => { settings.source = index; settings.count = index === 1 ? FEW : Infinity; refresh(); } });
  const place = h("div", {});
  /** What the robot will learn from, how, and what then. */
  const tell = () => {
    const [own, kept] = [mine(), keptDemonstrations()];
    const { count, hidden, regularisation, iterations, seed, obstacles } = settings;
    const begun = begin.value();
    const learner = begun ? `The network of ${begun.name}` : `A network with ${hidden} hidden ${hidden === 1 ? "unit" : "units"}`;
    plan.textContent = `${learner} learns from the demonstrations in at most ${iterations} ${iterations === 1 ? "iteration" : "iterations"}, with λ = ${regularisation}${begun ? "" : ` and initial weights from seed ${seed}`}. `
      + `Then the robot is tested in ${trial.maps} new maps with ${obstacles} obstacles.`;
    for (const field of [controls[0].element.querySelector("select"), seeds.element.querySelector("input")]) field.disabled = begun !== null;
    if (own.length === 0 && settings.source !== 1) {
      about.replaceChildren("None of your demonstrations has arrived yet. Drive a few maps in the ", h("a", { href: playground }, "playground"), ", or learn from the expert's demonstrations.");
      return;
    }
    const steps = chosen().flatMap(effective).length;
    const lost = settings.source === 1 ? 0 : kept.length - own.length;
    const missing = settings.source === 0 ? FEW_DEMONSTRATIONS - own.length : 0;
    about.textContent = `${count} ${count === 1 ? "demonstration" : "demonstrations"} with ${steps} steps to learn from: steps with something in range. `
      + (missing > 0 ? `Three are enough for a first robot: bring it to its target in ${WORDS[missing]} more ${missing === 1 ? "map" : "maps"}. ` : "")
      + (lost ? `${lost} of your demonstrations did not arrive and ${lost === 1 ? "is" : "are"} left out.` : "")
      + (settings.source === 1 && own.length === 0 ? withoutOwn(kept.length) : "");
  };
  const refresh = () => {
    const all = total();
    settings.count = Math.max(1, Math.min(settings.count, all));
    const count = slider({
      label: "demonstrations to learn from", count: Math.max(1, all), value: settings.count - 1, text: (at) => (all ? `${at + 1} of ${all}` : "none"),
      change: (at) => { settings.count = at + 1; tell(); },
    });
    place.replaceChildren(count.element);
    tell();
  };
  const list = (label, hint, options, key) => choice({ label, hint, options: options.map(String), value: options.indexOf(settings[key]), change: (index) => { settings[key] = options[index]; if (key === "obstacles") otherMaps(); tell(); } });
  const controls = [
    list("hidden units", "The size of the network.", HIDDEN, "hidden"),
    list("strength of regularisation λ", "The larger it is, the smaller the weights stay.", DECAYS, "regularisation"),
    list("steps of learning: iterations of L-BFGS", "L-BFGS is a method that lowers the cost fast.", ITERATIONS, "iterations"),
    list("obstacles in the new maps", "", OBSTACLES, "obstacles"),
  ];
  const seeds = slider({ label: "initial weights drawn with seed", count: 10, text: String, change: (at) => { settings.seed = at; tell(); } });
  const begin = beginning({ change: () => tell() });

  // What comes out
  const table = ranking();
  const everybody = () => [...(now ? [now] : []), ...robots, ...baselines.filter(({ outcomes }) => outcomes.length)];
  const showTable = () => table.show(everybody(), inMaps());
  const view = viewer({ world, robots: () => [...robots, ...baselines.filter(({ outcomes }) => outcomes.length === trial.maps)], maps: trial.maps });
  const otherMaps = () => {
    panel.cancel();
    [robots, worlds] = [[], null];
    for (const each of baselines) each.outcomes = [];
    download.disabled = true;
    showTable();
    view.update();
  };
  const live = (news) => {
    const driven = news.filter(({ map }) => map !== undefined);
    for (const { outcomes } of driven) {
      now.outcomes.push(outcomes[0]);
      outcomes.slice(1).forEach((outcome, k) => baselines[k].outcomes.push(outcome));
    }
    if (driven.length === 0) return;
    view.flash(driven.at(-1).map, driven.at(-1).path);
    showTable();
  };
  const task = (robot) => {
    const known = baselines.every(({ outcomes }) => outcomes.length === trial.maps);
    if (!known) for (const each of baselines) each.outcomes = [];
    now = { outcomes: [], colour: PALETTE.BLUE, encoder: ENCODER, network: null, start: null, examples: null, number: finished, keep: keepRobot, advise: () => "", ...robot };
    const { encoder, network, start, examples } = now;
    const { hidden, seed, regularisation, iterations } = settings;
    return { job: imitate, argument: {
      examples, network, start, sizes: [INPUTS, hidden, CHOICES], seed, regularisation, iterations, encoder, rivals: known ? [] : rivals, trial: inMaps(),
    } };
  };
  /** The robot that the settings train: its name, and how it is made, in words and as data. */
  const described = (begun, steps) => {
    const { source: from, count, hidden, regularisation, iterations, seed } = settings;
    const number = Math.max(finished + 1, nextNumber("robot", keptRobots().map(({ name }) => name)));
    const what = [`${count} of my demonstrations`, `${count} of the expert's demonstrations`, `${count} demonstrations of both`][from];
    const begins = begun ? `on from ${shortName(begun.name)}` : `${hidden} hidden`;
    return {
      number, name: `robot ${number}: ${what}, ${begins}, λ ${regularisation}`,
      about: `Learned by imitation from ${what}, with ${steps} steps to learn from: λ ${regularisation}, at most ${iterations} iterations, `
        + (begun ? `beginning with the weights of ${begun.name}.` : `${hidden} hidden units, initial weights from seed ${seed}.`),
      made: { source: SOURCES[from], demonstrations: count, steps, regularisation, iterations, ...(begun ? { begun: begun.name } : { hidden, seed }) },
    };
  };
  let brought = null; // a robot from a file or from Python, to be tried
  const panel = trainingPanel({
    source: model.get("_esm"), title: "Learn a policy from the demonstrations, and test it in new maps", action: "Train", unit: "iterations", total: () => settings.iterations,
    beside: view.element, lines: [
      { name: "cost", label: "cost J", note: COST_NOTE },
      { name: "accuracy", label: "accuracy (%)", note: ACCURACY_NOTE, colour: PALETTE.GREEN, low: 0, high: 100, text: (value) => value.toFixed(0) },
    ],
    begin: () => {
      if (brought) {
        const file = brought;
        brought = null;
        return task(file);
      }
      const [learned, begun] = [chosen(), begin.value()];
      const encoder = begun?.encoder ?? ENCODER;
      const examples = examplesFrom(learned, encoder);
      if (examples.m === 0) return learned.length ? NO_STEP : NO_DEMONSTRATION;
      return task({ ...described(begun, examples.m), encoder, examples, start: begun?.network ?? null, advise: settings.source === 0 ? () => adviceOn(learned, keptDemonstrations()) : () => "" });
    },
    live,
    done: (network) => {
      const { name, about, made, encoder, number, keep, advise } = now;
      robots = [{ ...now, examples: null, policy: { network, encoder } }, ...robots].slice(0, MOST_ROBOTS);
      finished = Math.max(finished, number);
      const warning = keep({ name, network, encoder, method: "lfd", about, made });
      now = null;
      download.disabled = release.hidden = false;
      showTable();
      view.update();
      const [own, straight] = [robots[0], baselines[1]].map(({ outcomes }) => rateOf(outcomes).rate);
      const advice = sameOutcomes(robots[0], baselines[1]) ? ALWAYS_STRAIGHT : own < straight + LITTLE ? advise() : "";
      return [`${robots[0].made.source === SOURCES[1] ? "This robot" : "Your robot"} arrives in ${percent(own)} % of the maps, one that always goes straight on in ${percent(straight)} %.`, advice, warning].filter(Boolean).join(" ");
    },
    cancelled: () => {
      now = null;
      if (baselines.some(({ outcomes }) => outcomes.length < trial.maps)) for (const each of baselines) each.outcomes = [];
      showTable();
      return "This robot is dropped; those in the table stay.";
    },
  });
  const several = numberOfRobots();
  let [best, python] = [null, null]; // the robot of Python with the least cost, and how it is made
  const tryBest = h("button", { type: "button", disabled: true, click: () => tryNetwork(best) }, "Let the best robot of Python drive in the page");
  const kernel = kernelPanel({
    model, title: "The same settings in Python: several robots", unit: "iterations", total: () => settings.iterations, controls: [several.element, tryBest],
    lines: [
      { name: "cost", label: "mean cost J", note: `${COST_NOTE} The mean over the robots.` },
      { name: "accuracy", label: "mean accuracy (%)", note: `${ACCURACY_NOTE} The mean over the robots.`, colour: PALETTE.GREEN, low: 0, high: 100, text: (value) => value.toFixed(0) },
    ],
    request: () => {
      const learnedFrom = chosen();
      if (learnedFrom.flatMap(effective).length === 0) return learnedFrom.length ? NO_STEP : NO_DEMONSTRATION;
      if (begin.value()) return PYTHON_BEGINS_ANEW;
      python = described(null, learnedFrom.flatMap(effective).length);
      const { hidden, regularisation, iterations, seed, obstacles } = settings;
      return { robots: several.value(), demonstrations: base64Of(demonstrationsFile(learnedFrom)), settings: { hidden, regularisation, iterations, seed, obstacles } };
    },
    done: ({ sentence, policy }) => {
      best = { ...policy, ...python, number: finished, name: `trained in Python: ${python.name.split(": ")[1]}`, about: `The best of several robots of Python. ${python.about}` };
      tryBest.disabled = false;
      return sentence;
    },
  });

  const note = h("span", { role: "status" });
  /** Lets a network that was not trained in the page drive the new maps. */
  const tryNetwork = (robot) => {
    brought = { ...robot, network: networks(robot.network)() };
    note.textContent = "";
    panel.cancel();
    panel.start();
  };
  const release = h("p", { hidden: true }, h("a", { href: playground }, "Let your robot drive in the playground"), ", on maps that you change while it drives.");
  const download = h("button", { type: "button", disabled: true, click: () => {
    const [{ policy, name, about, made }] = robots;
    saveFile("my-robot.safetensors", robotFile({ ...policy, name, about, made, method: "lfd" }));
  } }, "Download the latest robot's weights");
  const upload = h("input", { type: "file", accept: ".safetensors", "aria-label": "Weights to try", change: async () => {
    const [file] = upload.files;
    if (!file) return;
    try {
      const { network, encoder } = weightsFromFile(await file.arrayBuffer());
      const keep = () => ""; // it is in the file
      tryNetwork({ network, encoder, name: distinctName(file.name, robots.map(({ name }) => name)), about: "", made: { file: file.name }, keep });
    } catch (error) {
      note.textContent = error.message;
    }
    upload.value = "";
  } });

  settings.source = mine().length ? 0 : 1;
  settings.count = settings.source === 0 ? Infinity : FEW;
  source.move(settings.source);
  refresh();
  showTable();
  asWidget(el, "Imitation lab", "imitation", "imitation-lab");
  const kept = demonstrationsList();
  el.replaceChildren(
    h("div", { class: "row" }, source.element, place), about,
    h("details", { open: (globalThis.innerWidth ?? Infinity) >= ROOM }, h("summary", {}, "How it learns"), h("div", { class: "row" }, ...controls.map(({ element }) => element), seeds.element), begin.element, plan),
    panel.element, table.element,
    release,
    h("div", { class: "row tools" }, download, h("label", { class: "file" }, h("span", {}, "try weights from a file (safetensors)"), upload), note),
    kept.element, kept.said, kernel.element);
  let had = mine().length > 0;
  const unwatch = watchDemonstrations(() => {
    const has = mine().length > 0;
    if (settings.source === 1 && has && !had && robots.length === 0) source.move((settings.source = 0));
    had = has;
    refresh();
  });
  return () => {
    panel.cancel();
    kernel.cancel();
    view.end();
    kept.end();
    begin.end();
    unwatch();
  };
}

export default { render };
