// Shared by all widgets; joined in front of each, so that a page loads one module. Plain JavaScript with JSDoc types.

/**
 * @typedef {{shape: number[], dtype: string, data: string}} Packed an array as Python's `packed` writes it
 * @typedef {{sizes: number[], weights: Packed[], biases: Packed[]}} PackedNetwork
 * @typedef {{sizes: number[], weights: ArrayLike<number>[], biases: ArrayLike<number>[]}} Network weights row by row
 */

// ---- Elements -------------------------------------------------------------------------------------------------------

/** Gives an element attributes (functions become listeners) and children. */
function furnish(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value !== null && value !== false) element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

/** An HTML element: `h("button", {type: "button", click: stop}, "Stop")`. */
export const h = (tag, attributes = {}, ...children) => furnish(document.createElement(tag), attributes, children);

/** An SVG element. */
export const svg = (tag, attributes = {}, ...children) =>
  furnish(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

/** Changes some attributes. */
export const set = (element, attributes) => furnish(element, attributes, []);

/** Makes an element a widget: its classes, and its name for a screen reader. */
export function asWidget(el, name, ...classes) {
  el.classList.add("robonav", ...classes);
  set(el, { role: "group", "aria-label": name });
}

/** Lets a finger drag where `holds` says so of its touch; elsewhere it scrolls the page. */
export function holdFinger(element, holds) {
  element.addEventListener("touchstart", (event) => holds(event.touches[0]) && event.preventDefault(), { passive: false });
}

/** Whether an element is on the screen, at least in part. */
export function inSight(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return bottom > 0 && top < globalThis.innerHeight;
}

// ---- Numbers --------------------------------------------------------------------------------------------------------

const TYPES = { float64: Float64Array, float32: Float32Array, int32: Int32Array, uint16: Uint16Array, uint8: Uint8Array };

/** The array that Python packed. @param {Packed} array */
export function unpack({ shape, dtype, data }) {
  const bytes = Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
  return { shape, values: new TYPES[dtype](bytes.buffer) };
}

/**
 * A function that gives the networks of a packed stack by index, or the only one.
 * @param {PackedNetwork} stack
 * @returns {(index?: number) => Network}
 */
export function networks({ sizes, weights, biases }) {
  const cut = ({ values }, length) => (index) => values.subarray(index * length, (index + 1) * length);
  const weightsAt = weights.map((packed, l) => cut(unpack(packed), sizes[l] * sizes[l + 1]));
  const biasesAt = biases.map((packed, l) => cut(unpack(packed), sizes[l + 1]));
  return (index = 0) => ({ sizes, weights: weightsAt.map((at) => at(index)), biases: biasesAt.map((at) => at(index)) });
}

/** Eq. (3.4). */
export const sigmoid = (z) => 1 / (1 + Math.exp(-z));

/**
 * Forward propagation, Eq. (3.3): the activations of every layer, the input first, and the sums of the last.
 * @param {Network} network
 * @param {ArrayLike<number>} x
 */
export function propagate({ sizes, weights, biases }, x) {
  const activations = [Float64Array.from(x)];
  let z = new Float64Array(0);
  for (let l = 0; l < weights.length; l += 1) {
    const [inputs, outputs, a] = [sizes[l], sizes[l + 1], activations[l]];
    z = new Float64Array(outputs);
    for (let i = 0; i < outputs; i += 1) {
      let sum = biases[l][i];
      for (let j = 0; j < inputs; j += 1) sum += weights[l][i * inputs + j] * a[j];
      z[i] = sum;
    }
    activations.push(z.map(sigmoid));
  }
  return { activations, z };
}

/** Probabilities in proportion to the exponentials of scores; the largest is subtracted first, so that none overflows. */
export function softmax(scores) {
  const highest = scores.reduce((most, score) => Math.max(most, score), -Infinity);
  const weights = Array.from(scores, (score) => Math.exp(score - highest));
  const sum = weights.reduce((total, weight) => total + weight, 0);
  return weights.map((weight) => weight / sum);
}

/** The place of the largest value, the first of equals. */
export const largest = (values) => values.reduce((best, value, i) => (value > values[best] ? i : best), 0);

// ---- Controls -------------------------------------------------------------------------------------------------------

/** A short note below a control, or nothing. */
export const hintBelow = (hint) => (hint ? [h("small", { class: "hint" }, hint)] : []);

/** A labelled slider over the steps 0..count-1; `text(step)` says where it stands; `hint` says what it means. */
export function slider({ label, hint = "", count, value = 0, text, change }) {
  const shown = h("output", { "aria-hidden": "true" });
  const input = h("input", { type: "range", min: 0, max: count - 1, step: 1, "aria-label": label });
  const move = (step) => {
    input.value = String(step);
    shown.textContent = text(step);
    input.setAttribute("aria-valuetext", text(step));
  };
  input.addEventListener("input", () => {
    move(Number(input.value));
    change(Number(input.value));
  });
  move(value);
  return { element: h("label", {}, h("span", {}, `${label}: `, shown), input, ...hintBelow(hint)), move };
}

/** A labelled list to choose one of; `hint` says what it means. */
export function choice({ label, hint = "", options, value = 0, change }) {
  const select = h("select", { "aria-label": label, change: () => change(select.selectedIndex) });
  options.forEach((option) => select.append(h("option", {}, option)));
  select.selectedIndex = value;
  return { element: h("label", {}, h("span", {}, label), select, ...hintBelow(hint)), move: (index) => (select.selectedIndex = index) };
}

const ICONS = {
  first: "M6 5h2.5v14H6zM20 5v14L9.5 12z",
  back: "M17 5v14L7 12z",
  play: "M7 4v16l13-8z",
  pause: "M6 5h4v14H6zM14 5h4v14h-4z",
  next: "M7 5v14l10-7z",
};
const icon = (name) => svg("svg", { viewBox: "0 0 24 24", "aria-hidden": "true" }, svg("path", { d: ICONS[name] }));

/** Steps through frames 0..count-1: to the start, back, play, on, and a slider. */
export function player({ label, count, value = 0, text, change, interval = 150 }) {
  let frame = value;
  let timer = null;
  const go = (step) => {
    frame = Math.max(0, Math.min(count - 1, step));
    track.move(frame);
    change(frame);
  };
  const stop = () => {
    clearInterval(timer);
    timer = null;
    play.replaceChildren(icon("play"));
    play.setAttribute("aria-label", "Play");
  };
  const start = () => {
    if (frame === count - 1) go(0);
    timer = setInterval(() => (frame === count - 1 ? stop() : go(frame + 1)), interval);
    play.replaceChildren(icon("pause"));
    play.setAttribute("aria-label", "Pause");
  };
  const button = (name, say, act) => h("button", { type: "button", "aria-label": say, click: act }, icon(name));
  const step = (by) => () => {
    stop();
    go(frame + by);
  };
  const play = button("play", "Play", () => (timer === null ? start() : stop()));
  const track = slider({ label, count, value, text, change: (at) => { stop(); go(at); } });
  const element = h(
    "div", { class: "player", role: "group", "aria-label": label },
    button("first", "To the start", step(-count)), button("back", "One back", step(-1)), play,
    button("next", "One on", step(1)), track.element,
  );
  return { element, go, stop, frame: () => frame };
}

const LONG_JOB = 2; // seconds: how long a job lasts at least, for the time that is left to be shown

/** How long a job may still take, in words, once it is known that it takes long. @param {number} gone seconds @param {number} share */
export function timeLeft(gone, share) {
  const all = gone / share;
  const rest = Math.round(all - gone);
  if (gone < 0.5 || share <= 0 || all < LONG_JOB || rest < 1) return "";
  return rest < 100 ? `about ${rest} s left` : `about ${Math.round(rest / 60)} min left`;
}

/** A place for something wide, which scrolls sideways where it does not fit, and says so. */
export function wide(label, ...children) {
  const element = h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label }, ...children);
  const look = () => element.toggleAttribute("data-cut", element.scrollWidth > element.clientWidth + 1);
  if (globalThis.ResizeObserver) {
    const watch = new ResizeObserver(look);
    watch.observe(element);
    for (const child of children) watch.observe(child);
  }
  return element;
}

// ---- Pictures -------------------------------------------------------------------------------------------------------

/**
 * A network as circles and lines, as in Fig. 3.1: lines as thick as their weights, blue where positive and red where
 * negative; units as full as they are active.
 */
export function networkPicture(sizes, { inputs, outputs, width = 420, height = 400, label }) {
  const last = sizes.length - 1;
  const [left, right, gap] = [58, width - 92, height / (Math.max(...sizes) + 1)];
  const radius = Math.min(13, gap * 0.42);
  const place = (l, unit) => {
    const count = sizes[l] + (l < last ? 1 : 0);
    return [left + ((right - left) * l) / last, height / 2 + (unit - (count - 1) / 2) * gap];
  };
  const lines = svg("g", {});
  const edges = sizes.slice(0, -1).map((size, l) =>
    Array.from({ length: sizes[l + 1] }, (_, i) =>
      Array.from({ length: size + 1 }, (__, j) => {
        const [[x1, y1], [x2, y2]] = [place(l, j), place(l + 1, i + (l + 1 < last ? 1 : 0))];
        return lines.appendChild(svg("line", { x1, y1, x2, y2 }));
      }),
    ),
  );
  const marks = svg("g", {});
  const units = sizes.map((size, l) =>
    Array.from({ length: size }, (_, unit) => {
      const [cx, cy] = place(l, unit + (l < last ? 1 : 0));
      marks.append(svg("circle", { cx, cy, r: radius, fill: "var(--pst-color-background, var(--jp-layout-color0, #fff))" }));
      return marks.appendChild(svg("circle", { cx, cy, r: radius, stroke: PALETTE.INK, "stroke-width": 1.2 }));
    }),
  );
  for (let l = 0; l < last; l += 1) {
    const [cx, cy] = place(l, 0);
    marks.append(svg("circle", { cx, cy, r: radius, fill: PALETTE.OBSTACLE }));
    marks.append(svg("text", { x: cx - radius - 5, y: cy + 4, "text-anchor": "end", "font-size": 12 }, "+1"));
  }
  inputs.forEach((name, j) => {
    const [x, y] = place(0, j + 1);
    marks.append(svg("text", { x: x - radius - 5, y: y + 4, "text-anchor": "end", "font-size": 12 }, name));
  });
  const bars = outputs.map((name, k) => {
    const [x, y] = place(last, k);
    const bar = svg("rect", { x: x + radius + 5, y: y - radius, height: 2 * radius, rx: 2, fill: PALETTE.SKY, opacity: 0.55 });
    const text = svg("text", { x: x + radius + 9, y: y + 4, "font-size": 12 });
    marks.append(bar, text);
    return { name, bar, text };
  });
  const element = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label, class: "network" }, lines, marks);

  /** @param {Network} network @param {Float64Array[]} activations */
  const show = (network, activations) => {
    edges.forEach((rows, l) => {
      const [weights, biases, inputCount] = [network.weights[l], network.biases[l], sizes[l]];
      const strongest = Math.max(1e-12, ...weights.map(Math.abs), ...biases.map(Math.abs));
      rows.forEach((row, i) =>
        row.forEach((line, j) => {
          const weight = j === 0 ? biases[i] : weights[i * inputCount + j - 1];
          const strength = Math.abs(weight) / strongest;
          set(line, {
            stroke: weight >= 0 ? PALETTE.BLUE : PALETTE.VERMILION,
            "stroke-width": (0.2 + 3 * strength).toFixed(2),
            "stroke-opacity": (0.1 + 0.9 * strength).toFixed(2),
          });
        }),
      );
    });
    units.forEach((layer, l) =>
      layer.forEach((unit, i) => {
        const active = Math.max(0, Math.min(1, l === 0 ? Math.abs(activations[l][i]) : activations[l][i]));
        set(unit, { fill: PALETTE.SKY, "fill-opacity": active.toFixed(3) });
      }),
    );
    const answers = activations[last];
    const chosen = answers.length > 1 ? largest(answers) : -1;
    bars.forEach(({ name, bar, text }, k) => {
      set(bar, { width: (answers[k] * 70).toFixed(1) });
      set(text, { "font-weight": k === chosen ? 700 : 400 });
      text.textContent = `${name} ${answers[k].toFixed(2)}`;
    });
  };
  return { element, show };
}

/**
 * Axes with their names: the horizontal one's below its numbers, the vertical one's above it, where no height limits it.
 * On slides, letters are larger than a picture expects, and their classes keep words apart.
 */
export function axes({ left, right, top, bottom, xLabel, yLabel, letters = 12 }) {
  const name = (words, place, kind) => svg("text", { ...place, "font-size": letters, class: `quiet ${kind}` }, words);
  return [
    svg("path", { d: `M${left} ${top}V${bottom}H${right}`, fill: "none", stroke: PALETTE.INK }),
    name(xLabel, { x: (left + right) / 2, y: bottom + 10 + 2 * letters, "text-anchor": "middle" }, "x-name"),
    name(yLabel, { x: 2, y: top - letters - 1 }, "y-name"),
  ];
}

/** A curve over frames with a mark at one of them; `ticks` are pairs of a frame and its text. */
export function curve({ values, ticks, label, xLabel, yLabel, width = 420, height = 170 }) {
  const [left, right, top, bottom] = [46, width - 12, 25, height - 38];
  const element = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label, class: "chart" });
  const line = svg("path", { fill: "none", stroke: PALETTE.BLUE, "stroke-width": 2 });
  const mark = svg("circle", { r: 5, fill: PALETTE.VERMILION });
  const upper = svg("text", { x: left - 6, y: top + 4, "text-anchor": "end", "font-size": 12, class: "y-tick" });
  const lower = svg("text", { x: left - 6, y: bottom + 4, "text-anchor": "end", "font-size": 12, class: "y-tick" });
  let scale = (frame) => [left, bottom];
  let shown = values;
  const across = (frame) => left + ((right - left) * frame) / Math.max(1, shown.length - 1);
  element.append(
    ...axes({ left, right, top, bottom, xLabel, yLabel }), line, mark, upper, lower,
    ...ticks.map(([frame, text]) =>
      svg("text", { x: across(frame), y: bottom + 16, "text-anchor": "middle", "font-size": 12, class: "x-tick" }, text)),
  );
  /** Another history in the same picture. */
  const draw = (series) => {
    shown = series;
    const high = Math.max(...series);
    scale = (frame) => [across(frame), bottom - ((bottom - top) * series[frame]) / (high || 1)];
    line.setAttribute("d", series.map((_, frame) => `${frame ? "L" : "M"}${scale(frame).map((v) => v.toFixed(1)).join(" ")}`).join(""));
    upper.textContent = high.toPrecision(3);
    lower.textContent = "0";
  };
  const at = (frame) => {
    const [cx, cy] = scale(frame);
    set(mark, { cx, cy });
  };
  draw(values);
  return { element, draw, at };
}
