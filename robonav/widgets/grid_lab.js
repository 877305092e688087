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
      return { values: part(values), policy: part(policies), said: run.said[f], walk: run.walks[f] ?? [] };
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
  function load(nextLayout, run) {
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
    show();
  }

  function offer() {
    const index = data.controls.reduce((sum, { options }, which) => sum * options.length + chosen[which], 0);
    load(data.grids[chosen[0]], data.runs[index]);
  }

  pictures.setAttribute("aria-label", "Grids; arrow keys move the mark from cell to cell");
  marksByKeys(pictures, { cells: () => layout.cells, marked: () => marked, mark });

  const workshop = editor({ model, rows: () => layout.rows, choices: () => chosen.slice(1).map((at, i) => data.controls[i + 1].options[at]), load });
  el.classList.add("robonav", "grid-lab");
  el.replaceChildren(
    h("div", { class: "row" }, ...settings.map(({ element }) => element)), place, pictures, status, workshop,
  );
  offer();
  return () => time.stop();
}

/** A map to write and solve; it stays hidden until a kernel says that it is there. */
function editor({ model, rows, choices, load }) {
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
    if (message.kernel) element.hidden = false;
    if (message.error) answer.textContent = message.error;
    if (message.run) {
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
