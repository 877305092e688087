// A network of two inputs: what it answers all over the plane, for every setting that the page has trained.

const EDGE = 340; // of the picture, in pixels
const REACH = 40; // pixels around the probe in which a finger takes hold of it

/** Red, green and blue of a colour such as #0072B2. */
const rgb = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** The answers over the square as a picture: blue for no, orange for yes, paler the less sure, dark where they change. */
export function field(network, extent, resolution) {
  const [no, yes, edge] = [PALETTE.BLUE, PALETTE.ORANGE, PALETTE.INK].map(rgb);
  const middle = (index) => ((index + 0.5) / resolution - 0.5) * 2 * extent;
  const answers = Float64Array.from({ length: resolution * resolution }, (_, at) =>
    propagate(network, [middle(at % resolution), -middle(Math.floor(at / resolution))]).activations.at(-1)[0]);
  const pixels = new Uint8ClampedArray(4 * answers.length);
  answers.forEach((answer, at) => {
    const changes = [1, resolution].some((on) => at + on < answers.length && (on > 1 || (at + 1) % resolution > 0) &&
      answer > 0.5 !== answers[at + on] > 0.5);
    pixels.set(changes ? [...edge, 255] : [...(answer > 0.5 ? yes : no), Math.abs(answer - 0.5) * 2 * 140], 4 * at);
  });
  return pixels;
}

/** The two ends inside the square of the line w1 x1 + w2 x2 + b = 0; null if it passes the square by. */
export function crossing(w1, w2, b, extent) {
  const size = Math.hypot(w1, w2);
  if (size === 0) return null;
  const [normal, distance] = [[w1 / size, w2 / size], -b / size];
  let [from, to] = [-Infinity, Infinity]; // along the line, from its point nearest to the middle
  for (const axis of [0, 1]) {
    const [start, slope] = [distance * normal[axis], axis === 0 ? -normal[1] : normal[0]];
    if (slope === 0 && Math.abs(start) > extent) return null;
    if (slope === 0) continue;
    const [one, other] = [(-extent - start) / slope, (extent - start) / slope];
    from = Math.max(from, Math.min(one, other));
    to = Math.min(to, Math.max(one, other));
  }
  const at = (t) => [distance * normal[0] - t * normal[1], distance * normal[1] + t * normal[0]];
  return from < to ? [at(from), at(to)] : null;
}

/** The plane with examples, answers, the lines of the hidden units, and a probe that the reader moves. */
function plane({ extent, change }) {
  const resolution = 110;
  const canvas = h("canvas", { width: resolution, height: resolution, "aria-hidden": "true" });
  const overlay = svg("svg", { viewBox: `0 0 ${EDGE} ${EDGE}`, role: "img", "aria-label": "Examples, the network's answers and the lines of its hidden units" });
  const [lines, points] = [overlay.appendChild(svg("g", {})), overlay.appendChild(svg("g", {}))];
  const probe = overlay.appendChild(svg("g", {},
    svg("circle", { r: 9, fill: "none", stroke: PALETTE.VERMILION, "stroke-width": 3 }),
    svg("path", { d: "M-14 0H14M0 -14V14", stroke: PALETTE.VERMILION, "stroke-width": 1.5 })));
  const pixel = ([x, y]) => [((x / extent + 1) / 2) * EDGE, ((1 - y / extent) / 2) * EDGE];
  const touch = (event) => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = overlay.getBoundingClientRect();
    const inside = (value) => Math.max(-extent, Math.min(extent, value));
    change([
      inside((((event.clientX - box.left) / box.width) * 2 - 1) * extent),
      inside((1 - ((event.clientY - box.top) / box.height) * 2) * extent),
    ]);
  };
  overlay.addEventListener("pointerdown", touch);
  overlay.addEventListener("pointermove", touch);
  holdFinger(overlay, ({ clientX, clientY }) => {
    const box = probe.getBoundingClientRect();
    return Math.hypot(clientX - box.left - box.width / 2, clientY - box.top - box.height / 2) < REACH;
  });

  const examples = ({ x, y }) => {
    points.replaceChildren(...x.map((place, i) => {
      const [cx, cy] = pixel(place);
      return y[i] > 0.5
        ? svg("path", { d: `M${cx - 3.5} ${cy - 3.5}l7 7m0 -7l-7 7`, stroke: PALETTE.ORANGE, "stroke-width": 2 })
        : svg("circle", { cx, cy, r: 3.2, fill: PALETTE.BLUE });
    }));
  };
  const show = (network, at) => {
    canvas.getContext("2d").putImageData(new ImageData(field(network, extent, resolution), resolution), 0, 0);
    lines.replaceChildren(...Array.from({ length: network.sizes[1] }, (_, i) => {
      const ends = crossing(network.weights[0][2 * i], network.weights[0][2 * i + 1], network.biases[0][i], extent);
      if (!ends) return svg("g", {});
      const [[x1, y1], [x2, y2]] = ends.map(pixel);
      return svg("line", { x1, y1, x2, y2, stroke: PALETTE.INK, "stroke-width": 1.2, "stroke-dasharray": "5 4" });
    }));
    probe.setAttribute("transform", `translate(${pixel(at).map((v) => v.toFixed(1)).join(" ")})`);
  };
  return { element: h("div", { class: "plane" }, canvas, overlay), examples, show };
}

function render({ model, el }) {
  const data = model.get("data");
  const { frames, controls, extent } = data;
  const chosen = controls.map(({ value }) => value);
  let probe = [0.5, 0.5];
  let run = null;
  let picture = null;

  const status = h("p", { class: "status", role: "status" });
  const place = h("div", { class: "grow" });
  const steps = 61;
  const at = (step) => ((step / (steps - 1)) * 2 - 1) * extent;
  const map = plane({ extent, change: (x) => { probe = x; show(); } });
  const probes = [0, 1].map((axis) => slider({
    label: `probe x${"₁₂"[axis]}`, count: steps, text: () => probe[axis].toFixed(2),
    change: (step) => { probe = axis === 0 ? [at(step), probe[1]] : [probe[0], at(step)]; show(); },
  }));
  const history = curve({
    values: frames.map(() => 1), label: "Cost over the training", xLabel: "iteration", yLabel: "cost J",
    ticks: frames.map((iteration, index) => [index, iteration]).filter(([index]) => index % Math.ceil(frames.length / 7) === 0),
  });
  const time = player({
    label: "iteration", count: frames.length, value: frames.length - 1, text: (index) => String(frames[index]), change: () => show(),
  });
  const settings = controls.map(({ label, options, value }, which) => choice({
    label, options, value, change: (index) => { chosen[which] = index; load(); },
  }));

  /** Another setting. */
  function load() {
    take(data.runs[controls.reduce((index, { options }, which) => index * options.length + chosen[which], 0)]);
  }

  /** A training, the examples of its problem, and a network of its size. */
  function take(packedRun) {
    run = {
      networkOf: networks(packedRun.networks),
      costs: [...unpack(packedRun.costs).values],
      accuracies: unpack(packedRun.accuracies).values,
    };
    const sizes = packedRun.networks.sizes;
    picture = networkPicture(sizes, { inputs: ["x₁", "x₂"], outputs: ["h"], width: 380, height: 300, label: `The network: two inputs, ${sizes[1]} hidden units, one answer` });
    place.replaceChildren(picture.element);
    map.examples(data.examples[chosen[0]]);
    history.draw(run.costs);
    show();
  }

  function show() {
    const frame = time.frame();
    const network = run.networkOf(frame);
    const { activations } = propagate(network, probe);
    map.show(network, probe);
    picture.show(network, activations);
    history.at(frame);
    probes.forEach((control, axis) => control.move(Math.round(((probe[axis] / extent + 1) / 2) * (steps - 1))));
    status.textContent =
      `Iteration ${frames[frame]}: cost ${run.costs[frame].toFixed(3)}, ${(100 * run.accuracies[frame]).toFixed(0)} % of the examples right. ` +
      `At the probe (${probe.map((value) => value.toFixed(2)).join(", ")}) the network answers ${activations.at(-1)[0].toFixed(3)}.`;
  }

  const kernel = ownTraining({ model, problem: () => chosen[0], iterations: frames.at(-1), take });
  asWidget(el, "Boundary lab: a network in the plane");
  el.replaceChildren(
    h("div", { class: "row" }, ...settings.map(({ element }) => element)),
    time.element,
    status,
    h("div", { class: "row" }, h("div", { class: "grow" }, map.element, h("div", { class: "probes" }, ...probes.map(({ element }) => element))), place),
    history.element,
    h("p", { class: "label" }, "The cost J says how far the answers of the network are from the labels of all examples. An iteration is one step of the training."),
    kernel.element,
  );
  load();
  return () => {
    time.stop();
    kernel.cancel();
  };
}

const METHODS = ["gradient descent", "L-BFGS"];

/** A training in Python with settings that the page has not trained; the lab then shows it. */
function ownTraining({ model, problem, iterations, take }) {
  const settings = { hidden: 5, step: 1, regularisation: 0.01, seed: 1, spread: 1 };
  let method = METHODS[0];
  /** A slider over some values. */
  const dial = (name, label, values) => slider({
    label, count: values.length, value: values.indexOf(settings[name]), text: (at) => String(values[at]), change: (at) => (settings[name] = values[at]),
  }).element;
  const whole = (from, to) => Array.from({ length: to - from + 1 }, (_, k) => from + k);
  return kernelPanel({
    model, title: "The problem above with other settings, in Python", unit: "iteration", total: () => iterations,
    controls: [
      dial("hidden", "hidden units", whole(1, 20)), choice({ label: "method", options: METHODS, change: (index) => (method = METHODS[index]) }).element,
      dial("step", "step α of gradient descent", [0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100]), dial("regularisation", "regularisation λ", [0, 0.001, 0.01, 0.1, 1, 10]),
      dial("spread", "spread of the first weights", [0, 0.1, 0.3, 1, 3, 10]), dial("seed", "seed", whole(0, 30)),
    ],
    lines: [
      { name: "cost", label: "cost J" },
      { name: "right", label: "right (%)", note: "How many of the examples the network answers rightly.", colour: PALETTE.GREEN, low: 0, high: 100, text: (value) => value.toFixed(0) },
    ],
    request: () => ({ problem: problem(), method, settings }),
    done: ({ sentence, run }) => {
      take(run);
      return sentence;
    },
  });
}

export default { render };
