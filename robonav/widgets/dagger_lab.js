// DAgger by hand: the robot drives, the reader takes over where it errs, and the robot learns from the corrections.

const FIRST_CORRECTED = 600_000; // the robot is corrected in the worlds of this seed and on; training and tests have small ones
const MAPS_TO_CORRECT = 400;
const LEARNING = { sizes: [12, 8, CHOICES], seed: 0, regularisation: 0.1, iterations: 300 };
const [BACK, LONG] = [5, 120]; // seconds
const [DRIVING_PACE, SLOWEST] = [12, 100]; // steps a second; milliseconds a step where the reader steers
const BASES = ["one demonstration of the expert", "my demonstrations"];

// ---- The episode ----------------------------------------------------------------------------------------------------

/** An episode that robot and reader drive together, and that can be taken back. @param {World} first */
export function sharedEpisode(first) {
  const start = { world: first, pose: startPose(first), outcome: "running" };
  const moments = [{ ...start, sensing: sense(first, start.pose) }];
  const steps = []; // {pose, sensing, action, by: "robot", "reader" or "reflex"}
  const now = () => moments.at(-1);
  const reflexNow = () => reflex(now().sensing, SPEED);
  return {
    moments, steps, now,
    /** Whether robot or reader is asked: something is near, and the robot is not blocked. */
    asks: () => now().outcome === "running" && reflexNow() < 0,
    go: (action, by) => {
      const { world, pose, sensing, outcome } = now();
      if (outcome !== "running") return;
      const own = reflexNow();
      const taken = own < 0 ? action : own;
      const next = advance(world, pose, steps.length, taken, SPEED);
      steps.push({ pose, sensing, action: taken, by: own < 0 ? by : "reflex" });
      moments.push({ ...next, sensing: sense(next.world, next.pose) });
    },
    /** Takes some seconds back. */
    back: (seconds) => {
      const left = Math.max(0, steps.length - seconds);
      steps.length = left;
      moments.length = left + 1;
    },
    /** What the reader did, as a demonstration to learn from. @returns {Demonstration} */
    corrections: () => ({ world: first, speed: SPEED, outcome: now().outcome, steps: steps.filter(({ by }) => by === "reader") }),
  };
}

/** The first map from a number on in which a policy fails, or null. */
export function nextFailure(policy, from) {
  for (let map = from; map < MAPS_TO_CORRECT; map += 1) {
    const [world] = randomWorlds(1, { seed: FIRST_CORRECTED + map, obstacles: 10 });
    if (rollout(policy, world, { speed: SPEED, maxSteps: 200 }).outcome !== "arrived") return { map, world };
  }
  return null;
}

// ---- In the page ----------------------------------------------------------------------------------------------------

function render({ model, el }) {
  const { expert, book, trial } = model.get("data");
  const rivals = [{ ...book, name: "the book's robot" }, STRAIGHT];
  const baselines = rivals.map((rival) => ({ name: rival.name, outcomes: [], colour: PALETTE.GREY }));
  const experts = replayed(expert);
  let [base, corrected, robots, now] = [0, [], [], null];
  let [episode, map, hands, running, timer, planner] = [null, -1, false, false, null, computerExpert()];

  const mine = () => keptDemonstrations().filter(({ outcome }) => outcome === "arrived");
  const dataset = () => [...(base === 0 ? experts.slice(0, 1) : mine()), ...corrected];
  const count = () => corrected.flatMap(effective).length;

  // Driving
  const board = mapCanvas({ tabindex: 0, role: "application" });
  const told = h("p", { class: "status told", role: "status" });
  const paint = () => {
    const { world, pose, sensing } = episode.now();
    board.begin(world.size);
    world.obstacles.forEach((o) => board.obstacle(o));
    board.start(world.start);
    board.target(world.target);
    board.sectors(pose, sensing.ranges);
    episode.steps.forEach(({ by }, k) => {
      const [a, b] = [episode.moments[k].pose, episode.moments[k + 1].pose];
      board.line([[a.x, a.y], [b.x, b.y]], by === "reader" ? PALETTE.ORANGE : PALETTE.BLUE, by === "reader" ? 3.5 : 1.8);
    });
    board.robot(pose);
  };
  const show = (hint = "") => {
    const { outcome } = episode.now();
    const own = episode.steps.filter(({ by }) => by === "reader").length;
    const ended = {
      arrived: own ? `Arrived, with ${own} ${own === 1 ? "correction" : "corrections"} of yours. Correct another map, or train. Your corrections last until you leave the page or change what the robot first learns from.` : "Arrived without you.",
      collided: `It collided. Go back ${BACK} seconds and take over.`,
    }[outcome];
    const driving = hands ? (episode.asks() ? "You steer: the robot waits for you." : "You steer, and the reflex moves the robot.") : running ? (episode.steps.length > LONG ? "It may be going in circles: take over." : `The robot drives. Press ${whatSteers()} to take over.`) : "The robot will fail in this map. Press Drive, and take over before it does.";
    told.textContent = `Map ${map + 1}, ${episode.steps.length} s. ${hint || (ended ?? driving)}`;
    board.canvas.setAttribute("aria-label", told.textContent);
    play.textContent = running ? "Pause" : hands ? "Give it back" : "Drive";
    play.disabled = outcome !== "running";
    back.disabled = episode.steps.length === 0 || outcome === "arrived";
    for (const button of [ask, ...wheel.children]) button.disabled = outcome !== "running";
    paint();
  };
  const pause = () => {
    clearTimeout(timer);
    running = false;
  };
  let saved = null; // the episode whose corrections are in the data already
  const finish = () => {
    if (episode === null || saved === episode) return;
    saved = episode;
    const kept = episode.corrections();
    if (kept.steps.length) corrected.push(kept);
    tell();
  };
  /** One second: the robot's, or the reflex's while the reader steers. */
  const tick = () => {
    const robot = robots[0].policy;
    episode.go(hands ? 0 : consult(robot, episode.now().sensing).action, "robot");
    if (episode.now().outcome !== "running") {
      pause();
      if (episode.now().outcome === "arrived") finish();
    } else if (running || !episode.asks()) timer = setTimeout(tick, hands ? SLOWEST : 1000 / DRIVING_PACE);
    show();
  };
  const steer = (action) => {
    if (episode.now().outcome !== "running") return;
    pause();
    hands = true;
    episode.go(action, "reader");
    if (episode.now().outcome === "arrived") finish();
    else if (episode.now().outcome === "running" && !episode.asks()) timer = setTimeout(tick, SLOWEST);
    show();
  };
  board.canvas.addEventListener("keydown", (event) => {
    const action = keyAction(event);
    if (action === null) return;
    event.preventDefault();
    steer(action);
  });
  const wheel = steeringButtons({ label: "Take over and steer, a second at a time", take: steer, back: false });
  const forgetPads = watchPads((action) => episode && action < CHOICES && steer(action));
  const play = h("button", { type: "button", class: "main", click: () => {
    if (running) pause();
    else {
      [hands, running] = [false, true];
      clearTimeout(timer);
      timer = setTimeout(tick);
    }
    show();
  } }, "Drive");
  const back = h("button", { type: "button", click: () => {
    pause();
    episode.back(BACK);
    hands = true;
    show();
  } }, `Back ${BACK} s`);
  const ask = h("button", { type: "button", click: () => {
    pause();
    const { world, pose } = episode.now();
    show(episode.asks() ? `The computer expert would take ${actionName(planner(world, pose, SPEED))} here.` : "The robot's reflex decides here, and not the policy.");
  } }, "Ask the expert");
  const choose = () => {
    pause();
    finish();
    const found = nextFailure(robots[0].policy, map + 1);
    stage.hidden = found === null;
    if (!found) return;
    [episode, map, hands, planner] = [sharedEpisode(found.world), found.map, false, computerExpert()];
    show();
  };
  const next = h("button", { type: "button", click: choose }, "Next map where it fails");
  const stage = h("div", { class: "stage", hidden: true }, board.canvas, wheel, told, h("div", { class: "row tools" }, play, back, ask, next));

  // Learning
  const table = ranking();
  const showTable = () => table.show([...(now ? [now] : []), ...robots, ...baselines.filter(({ outcomes }) => outcomes.length)], { ...trial, obstacles: 10 });
  const panel = trainingPanel({
    source: model.get("_esm"), title: "Learn from the demonstrations and your corrections, and test the robot in new maps", action: "Train", unit: "iterations", total: () => LEARNING.iterations,
    lines: [{ name: "cost", label: "cost J", note: COST_NOTE }, { name: "accuracy", label: "accuracy (%)", note: ACCURACY_NOTE, colour: PALETTE.GREEN, low: 0, high: 100, text: (value) => value.toFixed(0) }],
    beside: stage,
    begin: () => {
      finish();
      const examples = examplesFrom(dataset());
      if (examples.m === 0) return "There is nothing to learn from: drive a few maps in the playground, or begin with the expert's demonstration.";
      const known = baselines.every(({ outcomes }) => outcomes.length === trial.maps);
      if (!known) for (const each of baselines) each.outcomes = [];
      const begun = base === 0 ? "one demonstration of the expert" : `${mine().length} of my demonstrations`;
      const number = nextNumber("DAgger, robot", [...keptRobots(), ...robots.map(({ name }) => ({ name: `DAgger, ${name}` }))].map(({ name }) => name));
      const { regularisation, iterations, seed } = LEARNING;
      now = {
        name: `robot ${number}: ${begun}${count() ? `, ${count()} corrections` : ""}`, outcomes: [], colour: PALETTE.BLUE,
        about: `Learned by DAgger from ${begun} and ${count()} corrections, ${examples.m} steps in all: λ ${regularisation}, at most ${iterations} iterations, initial weights from seed ${seed}.`,
        made: { first: BASES[base], corrections: count(), steps: examples.m, regularisation, iterations, seed },
      };
      return { job: imitate, argument: { ...LEARNING, examples, network: null, encoder: ENCODER, rivals: known ? [] : rivals, trial: { ...trial, obstacles: 10 } } };
    },
    live: (news) => {
      for (const { outcomes } of news) {
        if (!outcomes) continue;
        now.outcomes.push(outcomes[0]);
        outcomes.slice(1).forEach((outcome, k) => baselines[k].outcomes.push(outcome));
      }
      showTable();
    },
    done: (network) => {
      robots = [{ ...now, policy: { network, encoder: ENCODER } }, ...robots];
      const warning = keepRobot({ name: `DAgger, ${now.name}`, network, encoder: ENCODER, method: "dagger", about: now.about, made: now.made });
      now = null;
      showTable();
      choose();
      if (inSight(panel.button)) requestAnimationFrame(() => stage.scrollIntoView({ block: "nearest" }));
      const [last, before] = robots.map(({ outcomes }) => percent(rateOf(outcomes).rate));
      const sentence = before === undefined ? `Your robot arrives in ${last} % of the new maps. Now watch it, and correct it.` : `It arrives in ${last} % of the new maps. Before this training it arrived in ${before} %.`;
      return `${sentence} ${warning}`.trim();
    },
    cancelled: () => {
      now = null;
      showTable();
      return "This robot is dropped; your corrections and the robots in the table stay.";
    },
  });
  const first = choice({ label: "the robot first learns from", options: BASES, change: (index) => {
    panel.cancel();
    pause();
    [base, corrected, robots, episode, map] = [index, [], [], null, -1];
    stage.hidden = true;
    showTable();
    tell();
  } });

  const about = h("p", { class: "about" });
  const tell = () => (about.textContent = `The robot learns from ${BASES[base]}, ${dataset().flatMap(effective).length} steps in all, ${count()} of them corrections.`);

  const kernel = roundsPanel(model);
  asWidget(el, "DAgger lab", "imitation", "dagger-lab");
  el.replaceChildren(h("div", { class: "row" }, first.element), about, panel.element, table.element, kernel.element);
  showTable();
  tell();
  return () => {
    forgetPads();
    panel.cancel();
    kernel.cancel();
    pause();
  };
}

/** DAgger in Python, where the computer expert corrects the robots, round after round. */
function roundsPanel(model) {
  const settings = { demonstrations: 1, rounds: 4, maps: 5, beta: 0 };
  const robots = numberOfRobots([1, 2, 4]);
  /** A slider over whole numbers from 1. */
  const count = (name, label, most) => slider({
    label, count: most, value: settings[name] - 1, text: (at) => String(at + 1), change: (at) => (settings[name] = at + 1),
  }).element;
  const mixture = slider({
    label: "base p of β, the expert's share of the steps", count: 10, text: (at) => (at / 10).toFixed(1), change: (at) => (settings.beta = at / 10),
    hint: "In round i, each step is the expert's with probability p to the power of i. With 0 the robot drives alone.",
  }).element;
  return kernelPanel({
    model, title: "DAgger in Python: the computer expert corrects", unit: "round", total: () => settings.rounds,
    controls: [count("demonstrations", "demonstrations at first", 25), count("rounds", "rounds", 10), count("maps", "maps in each round", 20), mixture, robots.element],
    lines: [{ name: "arrived", label: "arrived (%)", note: "How many of the new maps the policy of each round crosses, robot after robot.", colour: PALETTE.ORANGE, low: 0, high: 100, text: (value) => value.toFixed(0) }],
    request: () => ({ robots: robots.value(), settings }),
  });
}

export default { render };
