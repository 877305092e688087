// A grid with values and arrows: what planners and learners did on it, step by step and side by side.

/** The frames of a replay; a replay that is over stays at its end. */
export function framesOf(run, states) {
  const [values, policies] = [unpack(run.values).values, unpack(run.policies).values];
  const last = run.said.length - 1;
  return {
    last,
    at: (frame) => {
      const f = Math.min(frame, last);
      const part = (array) => array.subarray(f * states, (f + 1) * states);
      return { values: part(values), policy: part(policies), said: run.said[f], trajectory: run.trajectories[f] ?? [] };
    },
  };
}

function render({ model, el }) {
  const data = model.get("data");
  const chosen = data.controls.map(({ value }) => value);
  let layout = null;
  let replays = [];
  let marked = 0;
  let strongest = 1;
  let time = null;

  const status = h("p", { class: "status", role: "status" });
  const pictures = h("div", { class: "row grids", role: "group" });
  const place = h("div", {});
  const settings = data.controls.map(({ label, options, value }, which) =>
    choice({ label, options, value, change: (index) => { chosen[which] = index; offer(); } }));

  /** What is at the marked cell. */
  function here(frame) {
    const [row, column] = layout.cells[marked];
    const where = `Row ${row + 1}, column ${column + 1}`;
    if (layout.ends.includes(marked)) return `${where}: the episode ends here. Arriving earns ${String(layout.rewards[marked]).replace("-", "−")} on top of the step.`;
    const each = replays.map(({ run, frames }) => {
      const { values, policy } = frames.at(frame);
      return `${short(values[marked])} and ${WORDS[policy[marked]]} by ${run.name}`;
    });
    return `${where}: ${each.join("; ")}.`;
  }

  function show() {
    const frame = time.frame();
    replays.forEach((replay) => {
      const at = replay.frames.at(frame);
      replay.caption.textContent = at.said;
      replay.picture.show(at, strongest, marked);
    });
    status.textContent = here(frame);
  }

  const mark = (state) => {
    marked = state;
    show();
  };

  /** Another grid or setting: its replays in new pictures. */
  function load(nextLayout, run, { atEnd = false } = {}) {
    time?.stop();
    if (layout !== nextLayout) marked = Math.max(0, nextLayout.cells.findIndex(([r, c]) => nextLayout.rows[r][c] === "S"));
    layout = nextLayout;
    replays = run.map((one) => ({
      run: one, frames: framesOf(one, layout.cells.length), caption: h("p", { class: "told" }),
      picture: gridPicture({ layout, name: one.name, mark }),
    }));
    const finals = replays.flatMap(({ frames }) => [...frames.at(frames.last).values]);
    strongest = Math.max(1e-9, ...finals.map(Math.abs));
    pictures.replaceChildren(...replays.map(({ run: { name }, picture, caption }) =>
      h("figure", { class: "grow" }, h("figcaption", {}, name), picture.element, caption)));
    const count = Math.max(...replays.map(({ frames }) => frames.last)) + 1;
    time = player({ label: "step", count, text: (frame) => `${frame} of ${count - 1}`, change: () => show(), interval: 350 });
    place.replaceChildren(time.element);
    if (atEnd) time.go(count - 1);
    else show();
  }

  function offer() {
    const index = data.controls.reduce((sum, { options }, which) => sum * options.length + chosen[which], 0);
    load(data.grids[chosen[0]], data.runs[index]);
  }

  pictures.setAttribute("aria-label", "Grids; arrow keys move the mark from cell to cell");
  marksByKeys(pictures, { cells: () => layout.cells, marked: () => marked, mark });

  const learner = learning({ model, learners: data.learners, rows: () => data.grids[chosen[0]].rows, load });
  const workshop = editor({ model, offered: data.solves, rows: () => layout.rows, choices: () => chosen.slice(1).map((at, i) => data.controls[i + 1].options[at]), load });
  asWidget(el, "Grid lab", "grid-lab");
  el.replaceChildren(
    h("div", { class: "row" }, ...settings.filter((_, which) => data.controls[which].options.length > 1).map(({ element }) => element)), place, pictures, status, workshop, learner.element,
  );
  offer();
  return () => {
    learner.cancel();
    time.stop();
  };
}

const LEARNING = { // the sliders of a training, with their choices and the first of them
  episodes: { label: "episodes", options: [20, 50, 100, 200, 500, 1000, 2000, 5000], value: 4 },
  learning_rate: { label: "learning rate α", options: [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1], value: 3 },
  epsilon: { label: "exploring ε", options: [0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 1], value: 4 },
  discount: { label: "discount γ", options: [0.5, 0.8, 0.9, 0.95, 0.99, 1], value: 5 },
  slip: { label: "probability to slip", options: [0, 0.05, 0.1, 0.2, 0.4], value: 0 },
  seed: { label: "seed of the random numbers", options: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9], value: 0 },
};

/** Learning in Python on a map that the reader writes; it stays hidden until a kernel says that it is there. */
function learning({ model, learners, rows, load }) {
  if (learners.length === 0) return { element: h("div", {}), cancel: () => {} };
  let learner = 0;
  const settings = Object.fromEntries(Object.entries(LEARNING).map(([name, { options, value }]) => [name, options[value]]));
  const sliders = Object.entries(LEARNING).map(([name, { label, options, value }]) =>
    slider({ label, count: options.length, value, text: (at) => String(options[at]), change: (at) => (settings[name] = options[at]) }).element);
  const method = choice({ label: "method", options: learners, change: (index) => (learner = index) });
  const text = h("textarea", { rows: rows().length + 1, cols: 2 * rows()[0].length + 2, spellcheck: "false" });
  text.value = rows().map((row) => [...row].join(" ")).join("\n");
  return kernelPanel({
    model, title: "Learn on a map of your own in Python", unit: "episode", total: () => settings.episodes,
    lines: [{ name: "earned", label: "mean return", low: null, text: (value) => value.toPrecision(3) }],
    controls: [h("label", {}, h("span", {}, "map: . free, # wall, S start, G goal, X pit, ~ ice"), text), method.element, ...sliders],
    request: () => ({ text: text.value, learner: learners[learner], settings }),
    done: ({ grid, run, sentence }) => {
      load(grid, run, { atEnd: true });
      return sentence;
    },
  });
}

/** A map to write and solve; it stays hidden until a kernel says that it is there. */
function editor({ model, offered, rows, choices, load }) {
  const text = h("textarea", { rows: 7, cols: 24, spellcheck: "false", "aria-label": "Map: . free, # wall, S start, G goal, X pit, ~ ice" });
  const answer = h("p", { class: "status", role: "status" });
  const solve = () => model.send({ ask: "solve", text: text.value, choices: choices() });
  const element = h(
    "details", { hidden: true },
    h("summary", {}, "Draw a map of your own"),
    h("p", { class: "told" }, ". free   # wall   S start   G goal   X pit   ~ ice"),
    text, h("div", {}, h("button", { type: "button", click: solve }, "Solve")), answer,
  );
  element.addEventListener("toggle", () => { if (element.open && !text.value) text.value = rows().join("\n"); });
  model.on("msg:custom", (message) => {
    if (message.kernel) element.hidden = !offered;
    if (message.error && message.run === undefined) answer.textContent = message.error;
    if (message.grid) {
      answer.textContent = "";
      load(message.grid, message.run);
    }
  });
  try {
    model.send({ ask: "kernel" });
  } catch {
    // A page without a kernel: the map cannot be solved, and the editor stays hidden.
  }
  return element;
}

export default { render };
