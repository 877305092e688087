// A grid with values and arrows: what planners and learners did on it, step by step and side by side.

const CELL = 64; // pixels
const MOVES = [[0, -1], [1, 0], [0, 1], [-1, 0]]; // across and down, of the actions up, right, down, left
const WORDS = ["up", "right", "down", "left"];
const [PALE, DARK, STRENGTH] = ["#F3F4F5", "#1F2328", 0.6]; // as plots/mdp.py has them

const parts = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** The colour of a value, given as a share of the strongest, -1 to 1: blue where positive, red where negative. */
export function colourOf(share) {
  const full = parts(share > 0 ? PALETTE.BLUE : PALETTE.VERMILION);
  const mixed = parts(PALE).map((pale, i) => Math.round(pale + STRENGTH * Math.min(Math.abs(share), 1) * (full[i] - pale)));
  return `rgb(${mixed.join(", ")})`;
}

/** A value in few letters, with a minus sign that is one. */
export function short(value) {
  const size = Math.abs(value);
  const digits = size >= 99.5 ? 0 : size >= 9.95 ? 1 : 2;
  return `${value < 0 && Number(size.toFixed(digits)) > 0 ? "−" : ""}${size.toFixed(digits)}`;
}

/** The state beside another one: where the arrow keys move the mark. Walls are stepped over, borders hold. */
export function beside(cells, state, [across, down]) {
  const [row, column] = cells[state];
  const ahead = cells
    .map(([r, c], s) => [s, (r - row) * down + (c - column) * across, (r - row) * across, (c - column) * down])
    .filter(([, distance, ...aside]) => distance > 0 && aside.every((off) => off === 0))
    .sort((one, other) => one[1] - other[1]);
  return ahead.length ? ahead[0][0] : state;
}

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

/** One picture: the grid of one method. */
function panel({ layout, wall, name, mark }) {
  const [rows, columns] = [layout.rows.length, layout.rows[0].length];
  const [width, height] = [columns * CELL, rows * CELL];
  const middle = ([row, column]) => [(column + 0.5) * CELL, (row + 0.5) * CELL];
  const ends = new Set(layout.ends);
  const element = svg("svg", { viewBox: `-2 -2 ${width + 4} ${height + 4}`, width: width + 4, height: height + 4, role: "img" });
  const base = element.appendChild(svg("g", {}));
  base.append(svg("rect", { width, height, fill: wall }));
  const cells = layout.cells.map((place, state) => {
    const [row, column] = place;
    const [x, y] = middle(place);
    const box = svg("rect", {
      x: column * CELL, y: row * CELL, width: CELL, height: CELL, stroke: PALETTE.INK, "stroke-width": 0.8, class: "cell",
      click: () => mark(state),
    });
    const arrow = svg("path", { d: "M0 15V-11M-6 -5L0 -14L6 -5", fill: "none", stroke: DARK, "stroke-width": 2.4, transform: `translate(${x} ${y - 9})` });
    const text = svg("text", { x, y: y + 25, "text-anchor": "middle", "font-size": 14, style: `fill: ${DARK}` });
    base.append(box, arrow, text);
    if (ends.has(state)) {
      const reward = layout.rewards[state];
      arrow.remove();
      base.append(svg("rect", { x: x - 26, y: y - 26, width: 52, height: 52, fill: "none", stroke: DARK, "stroke-width": 2, class: "still" }));
      set(text, { y: y + 6, "font-size": 18 });
      text.textContent = `${reward < 0 ? "−" : reward > 0 ? "+" : ""}${Math.abs(reward)}`;
    } else if (layout.rows[row][column] !== ".") {
      base.append(svg("text", { x: x - 25, y: y - 18, "font-size": 12, style: `fill: ${DARK}` }, layout.rows[row][column]));
    }
    return { box, arrow, text, fixed: ends.has(state) };
  });
  const path = element.appendChild(svg("path", { fill: "none", stroke: PALETTE.ORANGE, "stroke-width": 4, "stroke-linejoin": "round", class: "still" }));
  const chosen = element.appendChild(svg("rect", { width: CELL - 4, height: CELL - 4, fill: "none", stroke: PALETTE.VERMILION, "stroke-width": 4, class: "still" }));

  const show = ({ values, policy, said, walk }, strongest, marked) => {
    cells.forEach(({ box, arrow, text, fixed }, state) => {
      box.setAttribute("fill", fixed ? PALE : colourOf(values[state] / strongest));
      if (fixed) return;
      const [x, y] = middle(layout.cells[state]);
      arrow.setAttribute("transform", `translate(${x} ${y - 9}) rotate(${90 * policy[state]})`);
      text.textContent = short(values[state]);
    });
    path.setAttribute("d", walk.map((state, i) => `${i ? "L" : "M"}${middle(layout.cells[state]).join(" ")}`).join(""));
    const [row, column] = layout.cells[marked];
    set(chosen, { x: column * CELL + 2, y: row * CELL + 2 });
    element.setAttribute("aria-label", `${name}: ${said}`);
  };
  return { element, show };
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
  const pictures = h("div", { class: "row grids", role: "group", tabindex: 0 });
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
      picture: panel({ layout, wall: data.wall, name: one.name, mark }),
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
  pictures.addEventListener("keydown", (event) => {
    const direction = ["ArrowUp", "ArrowRight", "ArrowDown", "ArrowLeft"].indexOf(event.key);
    if (direction < 0) return;
    event.preventDefault();
    mark(beside(layout.cells, marked, MOVES[direction]));
  });

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
