// The robot's network over its training: what its weights became, and what it would do where the reader puts the robot.

const ACTIONS = ["F", "L30", "L60", "R30", "R60"];
const SAID = ["goes forward", "turns left 30°", "turns left 60°", "turns right 30°", "turns right 60°"];
const [SENSORS, WORST] = [9, 7];
const REACH = 110; // of the sensors, in units of the picture

/** The network's inputs for a state of Eq. (3.17): degrees of danger over 7, target sector over 9, target seen. */
export const encode = (state) => state.map((value, j) => (j < SENSORS ? value / WORST : j === SENSORS ? value / SENSORS : value));

/** A place at a distance in the middle of sector 1..9, moved sideways by part of a sector; ahead is up. */
function place(sector, distance, sideways = 0) {
  const angle = ((sector - 1 + sideways) * 2 * Math.PI) / SENSORS;
  return [-distance * Math.sin(angle), -distance * Math.cos(angle)];
}

/** The robot from above with its nine sectors; touching a sector puts an obstacle there, touching outside, the target. */
function dial({ borders, range, change }) {
  const element = svg("svg", { viewBox: "-142 -142 284 284", width: 284, height: 284, role: "img", class: "dial" });
  const wedge = (sector, distance) => {
    const [[x1, y1], [x2, y2]] = [place(sector, distance, -0.5), place(sector, distance, 0.5)];
    return `M0 0L${x1} ${y1}A${distance} ${distance} 0 0 0 ${x2} ${y2}Z`;
  };
  const sectors = Array.from({ length: SENSORS }, (_, i) => ({
    free: element.appendChild(svg("path", { fill: PALETTE.SKY, "fill-opacity": 0.25, stroke: PALETTE.INK, "stroke-width": 0.8 })),
    text: svg("text", { "text-anchor": "middle", "font-size": 12, x: place(i + 1, 84)[0], y: place(i + 1, 84)[1] + 4 }),
  }));
  element.append(
    svg("circle", { r: REACH, fill: "none", stroke: PALETTE.INK, "stroke-dasharray": "3 3" }),
    svg("path", { d: "M0 -11L8 9L-8 9Z", fill: PALETTE.ROBOT }),
    ...sectors.map(({ text }) => text),
  );
  const target = element.appendChild(svg("circle", { r: 9, stroke: PALETTE.TARGET, "stroke-width": 3 }));

  const touch = (event) => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = element.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * 284 - 142;
    const y = ((event.clientY - box.top) / box.height) * 284 - 142;
    const sector = (Math.round((Math.atan2(-x, -y) * SENSORS) / (2 * Math.PI)) + SENSORS) % SENSORS;
    const metres = (Math.hypot(x, y) / REACH) * range;
    if (metres > range * 1.04) change(SENSORS, sector + 1);
    else change(sector, borders.filter((border) => metres < border).length);
  };
  element.addEventListener("pointerdown", touch);
  element.addEventListener("pointermove", touch);

  const show = (state) => {
    sectors.forEach(({ free, text }, i) => {
      const degree = state[i];
      const edges = [range, ...[...borders].reverse(), 0]; // of degrees 0, 1, ..., 7
      const distance = degree === 0 ? range : (edges[degree] + edges[degree + 1]) / 2;
      set(free, {
        d: wedge(i + 1, (distance / range) * REACH),
        fill: degree === 0 ? PALETTE.SKY : PALETTE.ORANGE,
        "fill-opacity": degree === 0 ? 0.15 : 0.25 + degree / 20,
      });
      text.textContent = String(degree);
    });
    const [cx, cy] = place(state[SENSORS], state[SENSORS + 1] ? REACH * 0.6 : REACH + 18);
    set(target, { cx, cy, fill: state[SENSORS + 1] ? PALETTE.TARGET : "none" });
    element.setAttribute("aria-label", `Robot from above. Degrees of danger ${state.slice(0, SENSORS).join(", ")}; target in sector ${state[SENSORS]}`);
  };
  return { element, show };
}

/** One slider an input. */
function sliders(change) {
  const made = Array.from({ length: SENSORS + 2 }, (_, j) => {
    if (j < SENSORS) return slider({ label: `danger in sector ${j + 1}`, count: WORST + 1, text: String, change: (step) => change(j, step) });
    if (j === SENSORS) return slider({ label: "target in sector", count: SENSORS, text: (step) => String(step + 1), change: (step) => change(j, step + 1) });
    return slider({ label: "target seen", count: 2, text: (step) => (step ? "yes" : "no"), change: (step) => change(j, step) });
  });
  const show = (state) => state.forEach((value, j) => made[j].move(j === SENSORS ? value - 1 : value));
  return { element: h("div", { class: "sliders" }, ...made.map(({ element }) => element)), show };
}

function render({ model, el }) {
  const data = model.get("data");
  const networkOf = networks(data.networks);
  const [costs, accuracies] = [unpack(data.costs).values, unpack(data.accuracies).values];
  const { frames, situations } = data;
  const sizes = data.networks.sizes;
  let state = [...situations[0].state];
  let expert = situations[0].action;

  const picture = networkPicture(sizes, {
    inputs: ["1", "2", "3", "4", "5", "6", "7", "8", "9", "V", "I"], outputs: ACTIONS,
    label: "The network: an input for each sensor, the target's sector V and whether it is seen I; hidden units; five actions",
  });
  const [last, apart] = [frames.length - 1, Math.ceil(frames.length / 6)];
  const history = curve({
    values: [...costs], label: "Cost over the training", xLabel: "iteration", yLabel: "cost J",
    ticks: frames.map((iteration, at) => [at, iteration]).filter(([at]) => at === last || (at % apart === 0 && at <= last - apart / 2)),
  });
  const status = h("p", { class: "status", role: "status" });
  const changed = (j, value) => {
    if (j === SENSORS + 1 || state[j] !== value) expert = null;
    state[j] = value;
    show();
  };
  const robot = dial({ borders: data.borders, range: data.range, change: changed });
  const inputs = sliders(changed);
  const situation = choice({
    label: "a moment of a demonstration", options: situations.map(({ name }) => name),
    change: (index) => {
      state = [...situations[index].state];
      expert = situations[index].action;
      show();
    },
  });
  const time = player({
    label: "iteration", count: frames.length, value: frames.length - 1, text: (at) => `${frames[at]} of ${frames.at(-1)}`, change: () => show(),
  });

  function show() {
    const at = time.frame();
    const network = networkOf(at);
    const { activations, z } = propagate(network, encode(state));
    picture.show(network, activations);
    robot.show(state);
    inputs.show(state);
    history.at(at);
    const action = largest(z);
    const said = expert === null ? "" : action === expert ? ", as the expert did" : `; the expert ${SAID[expert].replace(/^goes/, "went").replace(/^turns/, "turned")}`;
    status.textContent =
      `Iteration ${frames[at]}: cost ${costs[at].toFixed(3)}, ${(100 * accuracies[at]).toFixed(1)} % of the demonstrated moments answered as the expert did. ` +
      `Here the robot ${SAID[action]} (${ACTIONS[action]})${said}.`;
  }

  asWidget(el, "Network lab: inside the network that steers");
  el.replaceChildren(
    time.element,
    h("div", { class: "row" },
      h("div", {}, situation.element, robot.element),
      h("div", { class: "grow" }, picture.element),
    ),
    status,
    h("details", {}, h("summary", {}, "Set the eleven inputs with sliders"), inputs.element),
    history.element,
    h("p", { class: "label" }, "The cost J says how far the outputs of the network are from the expert's actions, over all demonstrated moments. An iteration is one step of the training."),
  );
  show();
  return time.stop;
}

export default { render };
