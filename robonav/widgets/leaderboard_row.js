// The reader's robot on the leaderboard: its episodes in the frozen worlds, beside the methods of the book.

/**
 * A job: one policy in the frozen worlds of every setting; yields how many arrived in each so far.
 * @param {{policy: Policy, settings: Conditions[], seeds: number[], worlds: number}} argument
 */
export function* boardJob({ policy, settings, seeds, worlds }) {
  const arrived = settings.map(() => 0);
  const total = settings.length * seeds.length * worlds;
  let done = 0;
  for (const [k, conditions] of settings.entries()) {
    for (const seed of seeds) {
      for (const world of randomWorlds(worlds, { seed, ...conditions })) {
        if (rollout(policy, world, conditions).outcome === "arrived") arrived[k] += 1;
        done += 1;
        if (done % 10 === 0) yield { done, total, live: { at: done, setting: k, arrived: [...arrived] } };
      }
    }
  }
  return arrived;
}

function render({ model, el }) {
  const { settings, methods, seeds, worlds, playground } = model.get("data");
  const source = model.get("_esm");
  let brought = [];
  const robots = () => [...keptRobots().reverse(), ...brought];
  const note = h("p", { class: "status", role: "status" });
  const percent = (rate) => `${Math.round(100 * rate)}`;
  const mine = settings.map(() => h("td", {}, ""));
  const head = h("th", { scope: "row" }, "your robot");
  const table = wide("Your robot beside the methods of the book",
    h("table", { class: "results" },
      h("caption", {}, "Episodes that arrive, in per cent"),
      h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "method"), ...settings.map(({ name }) => h("th", { scope: "col" }, name)))),
      h("tbody", {}, h("tr", { class: "mine" }, head, ...mine),
        ...methods.map(({ name, rates }) => h("tr", {}, h("th", { scope: "row" }, name), ...rates.map((rate) => h("td", {}, rate.toFixed(0))))))));
  const which = h("select", { "aria-label": "robot" });
  const fill = () => {
    const [found, chosen] = [robots(), which.value];
    which.replaceChildren(...found.map(({ id, name }) => h("option", { value: id, selected: id === chosen }, name)));
    which.disabled = found.length === 0;
    if (found.length === 0) which.append(h("option", {}, "none yet"));
    tell();
  };
  which.addEventListener("change", () => tell());
  const about = h("p", { class: "about" });
  /** The seeds of the worlds that are chosen: the first set, or all. */
  const seedsChosen = () => (sets.element.querySelector("select").selectedIndex === 0 ? seeds.slice(0, 1) : seeds);
  const tell = () => {
    const per = worlds * seedsChosen().length;
    const robot = robots()[which.selectedIndex];
    about.textContent = `${robot?.about ? `${robot.about} ` : ""}${settings.length} settings with ${per.toLocaleString("en")} worlds each: the robot drives ${(per * settings.length).toLocaleString("en")} episodes.`;
  };
  const sets = choice({ label: "worlds of each setting", options: [`${worlds} (the first set)`, `${worlds * seeds.length} (all sets)`], change: tell });
  const upload = h("input", { type: "file", accept: ".safetensors", "aria-label": "Weights of a robot", change: async () => {
    const [file] = upload.files;
    if (!file) return;
    try {
      const { network, encoder, temperature } = weightsFromFile(await file.arrayBuffer());
      const name = distinctName(file.name, robots().map((other) => other.name));
      brought.push({ id: `file ${name}`, name, network: networks(network)(), encoder, temperature });
      fill();
      which.selectedIndex = robots().length - 1;
      note.textContent = `${name} is ready to be tried.`;
    } catch (error) {
      note.textContent = error.message;
    }
    upload.value = "";
  } });
  const myRobots = robotsList();
  let each = worlds;
  const show = (arrived, until) => arrived.forEach((count, k) => {
    mine[k].textContent = k < until ? percent(count / each) : "";
    if (k < until) mine[k].title = `95 % interval: ${wilsonInterval(count, each).map(percent).join(" to ")}`;
  });
  const panel = trainingPanel({
    source, title: "Drive the frozen worlds of every setting", busy: "It drives.", action: "Try this robot in the frozen worlds", unit: "episode", total: () => settings.length * each, lines: [],
    begin: () => {
      const robot = robots()[which.selectedIndex];
      if (!robot) return "There is no robot yet: train one on a page of chapter 3, 4 or 5, or choose a file of weights.";
      const chosen = seedsChosen();
      each = worlds * chosen.length;
      head.textContent = robot.name;
      show(settings.map(() => 0), 0);
      return { job: boardJob, argument: { policy: robot, settings: settings.map(({ conditions }) => conditions), seeds: chosen, worlds } };
    },
    live: (news) => show(news.at(-1).arrived, news.at(-1).setting),
    cancelled: () => "The settings that were finished stay in the table.",
    done: (arrived) => {
      show(arrived, arrived.length);
      const first = arrived.map((count, k) => {
        const [low, high] = wilsonInterval(count, each).map(percent);
        return `${settings[k].name}: ${percent(count / each)} % [${low}, ${high}]`;
      });
      return `${each} episodes a setting. ${first.slice(0, 3).join("; ")}.`;
    },
  });
  const forget = watchRobots(fill);
  asWidget(el, "Your robot on the leaderboard");
  el.replaceChildren(
    h("div", { class: "row tools" }, h("label", {}, h("span", {}, "robot"), which), sets.element,
      h("label", { class: "file" }, h("span", {}, "or weights from a file"), upload)),
    about, note, panel.element, h("div", { class: "board" }, table), myRobots.element,
    h("p", {}, h("a", { class: "call", href: playground }, "Train a robot of your own")));
  fill();
  return () => {
    forget();
    myRobots.end();
    panel.cancel();
  };
}

export default { render };
