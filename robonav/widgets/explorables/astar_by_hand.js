// A* on a small grid: choose which open node to expand, or let a rule choose.

const RULES_OF = {
  F: ({ G, H }) => [G + H, H],
  G: ({ G }) => [G, 0],
  H: ({ H }) => [H, 0],
};
const near = 1e-9;

/** The search before its first step: `points` are places, `steps` the neighbours that each may go to. */
export function newSearch({ points, start, target }) {
  const H = points.map(([x, y]) => Math.hypot(x - points[target][0], y - points[target][1]));
  return { H, G: points.map((_, k) => (k === start ? 0 : Infinity)), parent: points.map(() => -1), open: [start], closed: [] };
}

/** Expand an open node: its neighbours are reached, or reached more cheaply. */
export function expand(search, { points, steps }, node) {
  search.open = search.open.filter((other) => other !== node);
  search.closed.push(node);
  for (const next of steps[node]) {
    if (search.closed.includes(next)) continue;
    const tentative = search.G[node] + Math.hypot(points[next][0] - points[node][0], points[next][1] - points[node][1]);
    if (tentative < search.G[next] - near) {
      search.G[next] = tentative;
      search.parent[next] = node;
      if (!search.open.includes(next)) search.open.push(next);
    }
  }
}

/** The open node that a rule takes next. */
export function nextOf(search, { points }, rule) {
  const key = (k) => [...RULES_OF[rule]({ G: search.G[k], H: search.H[k] }), ...points[k]];
  const before = (one, other) => {
    const [p, q] = [key(one), key(other)];
    const at = p.findIndex((value, i) => Math.abs(value - q[i]) > near);
    return at >= 0 && p[at] < q[at];
  };
  return search.open.reduce((best, k) => (best < 0 || before(k, best) ? k : best), -1);
}

/** Nodes from the start to a node. */
export function pathTo(search, node) {
  const path = [];
  for (let k = node; k >= 0; k = search.parent[k]) path.unshift(k);
  return path;
}

const over = (search, { target }) => search.closed.at(-1) === target || search.open.length === 0;

export default explorable({
  controls: (given) => {
    const step = (state) => {
      if (!over(state.search, given)) expand(state.search, given, nextOf(state.search, given, state.rule));
    };
    return {
      rule: segments({ label: "rule for the buttons", options: [["F", "least F = G + H"], ["G", "least G"], ["H", "least H"]], value: "F" }),
      next: press({ label: "Expand the next by this rule", act: step, off: ({ search }) => over(search, given) }),
      all: press({ label: "Run to the end", act: (state) => { while (!over(state.search, given)) step(state); }, off: ({ search }) => over(search, given) }),
    };
  },
  start: (given) => ({ search: newSearch(given), marked: 0 }),
  draw({ given, stage, act }) {
    const { points, size, obstacles, start, target } = given;
    const SCALE = 360 / size;
    const [X, Y] = [(x) => 4 + x * SCALE, (y) => 4 + (size - y) * SCALE];
    const picture = svg("svg", { viewBox: "0 0 368 368", width: 368, height: 368, role: "img", class: "search" });
    const holder = h("div", { role: "group", tabindex: 0, "data-keys": "ArrowRight Enter", "aria-label": "Open nodes. Left and right arrows go from one to the next, Enter expands it." }, picture);
    stage.append(h("figure", {}, holder, h("p", { class: "told" }, "Touch an open node to expand it."),
      legend([PALETTE.SKY, "open, with its F"], [PALETTE.INK, "expanded"], [PALETTE.BLUE, "path"])));
    const choose = (node) => act(({ search }) => over(search, given) || (search.open.includes(node) && expand(search, given, node)));
    let now = null;
    holder.addEventListener("keydown", (event) => {
      const by = { ArrowRight: 1, ArrowLeft: -1, Enter: 0 }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      if (by === 0) choose(now.search.open[now.marked % Math.max(1, now.search.open.length)]);
      else act((state) => (state.marked = (state.marked + by + state.search.open.length) % Math.max(1, state.search.open.length)));
    });
    return (state) => {
      now = state;
      const { search, marked, rule } = state;
      const ended = over(search, given);
      const cursor = document.activeElement === holder ? search.open[marked % Math.max(1, search.open.length)] : -1;
      const walls = obstacles.map(({ circle, x, y, a, b, turned }) => circle
        ? svg("circle", { cx: X(x), cy: Y(y), r: a * SCALE, fill: PALETTE.OBSTACLE })
        : svg("rect", {
          x: X(x - a), y: Y(y + b), width: 2 * a * SCALE, height: 2 * b * SCALE, fill: PALETTE.OBSTACLE,
          transform: `rotate(${(-180 * turned) / Math.PI} ${X(x)} ${Y(y)})`, // upwards is negative in the picture
        }));
      const nodes = points.map(([x, y], k) => {
        const [open, closed] = [search.open.includes(k), search.closed.includes(k)];
        const box = svg("circle", {
          cx: X(x), cy: Y(y), r: open ? 19 : closed ? 8 : 3.5, fill: open ? PALETTE.SKY : PALETTE.INK, "fill-opacity": open ? 0.45 : closed ? 0.9 : 0.5,
          stroke: k === cursor ? PALETTE.VERMILION : "none", "stroke-width": 3, ...(open ? { class: "touchable", click: () => choose(k) } : {}), ...(k === start ? { "data-touch": "" } : {}),
        });
        const words = open ? svg("text", { x: X(x), y: Y(y) + 4.5, "text-anchor": "middle", "font-size": 13, style: "pointer-events: none" }, number(search.G[k] + search.H[k], 1)) : "";
        return [box, words];
      }).flat().filter(Boolean);
      const [tx, ty] = points[target];
      const path = pathTo(search, ended ? target : search.closed.at(-1) ?? start);
      picture.replaceChildren(
        svg("rect", { x: 4, y: 4, width: 360, height: 360, fill: "none", stroke: PALETTE.OBSTACLE, "stroke-width": 2 }), ...walls,
        svg("circle", { cx: X(tx), cy: Y(ty), r: 23, fill: "none", stroke: PALETTE.TARGET, "stroke-width": 2.5 }),
        svg("polyline", { points: path.map((k) => `${X(points[k][0])},${Y(points[k][1])}`).join(" "), fill: "none", stroke: PALETTE.BLUE, "stroke-width": 3 }), ...nodes,
      );
      set(picture, { "aria-label": `Search on a grid: ${search.closed.length} nodes expanded, ${search.open.length} open` });
      const best = nextOf(search, given, rule);
      const told = (k) => `G = ${number(search.G[k], 1)}, H = ${number(search.H[k], 1)}, F = ${number(search.G[k] + search.H[k], 1)}`;
      return [
        `${search.closed.length} ${search.closed.length === 1 ? "node" : "nodes"} expanded, ${search.open.length} open.`,
        ended
          ? Number.isFinite(search.G[target]) ? `The target is reached: the path is ${number(search.G[target], 1)} m long.` : "There is no path."
          : `The open node with the least ${rule} has ${told(best)}.`,
        ...(search.closed.length ? [`The last one expanded had ${told(search.closed.at(-1))}.`] : []),
      ].join("\n");
    };
  },
});
