// Two searches for a way through one map, side by side, node by node.

const FRAMES = 100;
const NAMES = { actions: "modified A*", grid: "grid A*" };
const COLOURS = { actions: PALETTE.ORANGE, grid: PALETTE.SKY };

/** A search as Python packed it: the places of its nodes in the order of their expansion, and the way, in metres. */
export function searchOf({ visited, points, ...told }) {
  const way = unpack(points);
  return {
    ...told,
    visited: Float64Array.from(unpack(visited).values, (centimetres) => centimetres / 100),
    points: Array.from({ length: way.shape[0] }, (_, k) => [way.values[2 * k], way.values[2 * k + 1]]),
  };
}

/** Nodes expanded at a frame of 0..FRAMES by searches of which the longest expands `most`: slow at first. */
export const nodesAt = (frame, most) => Math.ceil(most * (frame / FRAMES) ** 2);

/** What a search has come to after so many nodes. */
export function progressOf({ expanded, found, length }, nodes) {
  if (nodes < expanded) return `${nodes} nodes, still searching`;
  return found ? `done after ${expanded} nodes: ${length.toFixed(1)} m` : `${expanded} nodes, and no way found`;
}

/** One search: its map and what it has come to. */
function panel(world, search) {
  const board = mapCanvas({ role: "img" });
  const caption = h("p", { class: "told" });
  const { visited, points, expanded, found, kind } = search;
  const show = (nodes) => {
    const shown = Math.min(nodes, expanded);
    const fresh = Math.max(0, shown - Math.ceil(shown / 20));
    board.begin(world.size);
    board.dots(visited, 0, fresh, { colour: COLOURS[kind], radius: 1.6, alpha: 0.5 });
    board.dots(visited, fresh, shown, { colour: COLOURS[kind], radius: 2.4 });
    world.obstacles.forEach((o) => board.obstacle(o));
    board.start(world.start);
    board.target(world.target);
    if (nodes >= expanded && found) {
      board.line(points, PALETTE.BLUE, 3);
      if (kind === "actions") board.dots(points.flat(), 0, points.length, { colour: PALETTE.BLUE, radius: 2.6 });
    }
    caption.textContent = progressOf(search, nodes);
    board.canvas.setAttribute("aria-label", `${NAMES[kind]}: ${caption.textContent}`);
  };
  return { canvas: board.canvas, place: board.place, show, element: h("figure", { class: "grow" }, h("figcaption", {}, NAMES[kind]), board.canvas, caption) };
}

/** The searches' results, one row each. */
function results(searches, speed) {
  const row = ({ kind, found, length, steps, expanded }) => h("tr", {}, h("th", { scope: "row" }, NAMES[kind]),
    ...[found ? length.toFixed(1) : "none", expanded, steps === null ? "needs a driver" : found ? `${steps} actions, ${steps} s` : "none"]
      .map((text) => h("td", {}, String(text))));
  return h("table", { class: "results" },
    h("thead", {}, h("tr", {}, ...["search", "length (m)", "nodes", `to drive at ${speed} m/s`].map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, ...searches.map(row)));
}

function render({ model, el }) {
  const data = model.get("data");
  const chosen = data.controls.map(({ value }) => value);
  const pictures = h("div", { class: "row" });
  const table = h("div", { class: "scroll" });
  const place = h("div", {});
  let [world, panels, time] = [null, [], null];

  function load(nextWorld, packed) {
    time?.stop();
    world = nextWorld;
    const searches = packed.map(searchOf);
    const most = Math.max(...searches.map(({ expanded }) => expanded));
    panels = searches.map((search) => panel(world, search));
    pictures.replaceChildren(...panels.map(({ element }) => element));
    table.replaceChildren(results(searches, data.speed));
    const show = (frame) => panels.forEach((one) => one.show(nodesAt(frame, most)));
    time = player({
      label: "nodes expanded", count: FRAMES + 1, value: FRAMES, interval: 60,
      text: (frame) => `${nodesAt(frame, most)} of ${most}`, change: show,
    });
    place.replaceChildren(time.element);
    workshop.watch(panels);
    show(FRAMES);
  }

  const offer = () => {
    const index = data.controls.reduce((sum, { options }, which) => sum * options.length + chosen[which], 0);
    load(data.worlds[chosen[0]], data.runs[index]);
  };
  const settings = data.controls.map(({ label, options, value }, which) =>
    choice({ label, options, value, change: (index) => { chosen[which] = index; offer(); } }));

  const workshop = targets({ model, chosen: () => chosen, size: () => world.size, load: (target, run) => load({ ...world, target }, run) });
  asWidget(el, "Search lab", "search-lab");
  el.replaceChildren(h("div", { class: "row" }, ...settings.map(({ element }) => element)), place, pictures, table, workshop.element);
  offer();
  return () => time.stop();
}

/** Another target, by a touch on a map or by numbers; it stays hidden until a kernel says that it is there. */
function targets({ model, chosen, size, load }) {
  const note = h("p", { class: "status", role: "status" });
  const field = (name) => h("input", { type: "number", min: 0, step: 1, "aria-label": `target ${name} (m)`, value: 50 });
  const [x, y] = [field("x"), field("y")];
  let there = false;
  const search = () => {
    note.textContent = "Searching …";
    model.send({ ask: "search", chosen: chosen(), target: [x.valueAsNumber, y.valueAsNumber] });
  };
  const element = h("fieldset", { hidden: true },
    h("legend", {}, "Put the target elsewhere: touch a map, or say where"),
    h("label", {}, h("span", {}, "x (m)"), x), " ", h("label", {}, h("span", {}, "y (m)"), y), " ",
    h("button", { type: "button", click: search }, "Search"), note);
  const watch = (panels) => panels.forEach(({ canvas, place }) => canvas.addEventListener("click", (event) => {
    if (!there) return;
    const at = place(event).map((value) => Math.round(Math.min(Math.max(value, 0), size())));
    [x.value, y.value] = at.map(String);
    search();
  }));
  model.on("msg:custom", (message) => {
    if (message.kernel) [there, element.hidden] = [true, false];
    if (message.error) note.textContent = message.error;
    if (message.run) {
      note.textContent = "";
      load(message.target, message.run);
    }
  });
  try {
    model.send({ ask: "kernel" });
  } catch {
    // A page without a kernel: nothing more can be searched, and the fields stay hidden.
  }
  return { element, watch };
}

export default { render };
