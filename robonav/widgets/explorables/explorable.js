// Shared by all explorables: a frame with a question on top, controls, pictures, live text and a Reset button.

/**
 * @typedef {Record<string, any>} State what the controls say, by name, and what `start` adds
 * @typedef {{element: Element, value?: any, show?: (value: any, state: State) => void}} Control
 * @typedef {(hand: {put: (value: any) => void, act: (change: (state: State) => void) => void}) => Control} MakeControl
 */

// ---- Controls -------------------------------------------------------------------------------------------------------

/** A slider over numbers. @returns {MakeControl} */
export const range = ({ label, from, to, step = 1, value, text = String }) => ({ put }) => {
  const number = (k) => Number((from + k * step).toFixed(10));
  const stepOf = (at) => Math.round((at - from) / step);
  const { element, move } = slider({
    label, count: stepOf(to) + 1, value: stepOf(value), text: (k) => text(number(k)), change: (k) => put(number(k)),
  });
  return { element, value, show: (at) => move(stepOf(at)) };
};

/** A group of radio buttons that looks like one button in parts; `options` are values, or pairs of a value and its text. */
export const segments = ({ label, options, value = null }) => ({ put }) => {
  const name = `s${Math.random().toString(36).slice(2)}`; // radio buttons of one name exclude each other in the whole page
  const pairs = options.map((option) => (Array.isArray(option) ? option : [option, String(option)]));
  const inputs = pairs.map(([own]) => h("input", { type: "radio", name, change: () => put(own) }));
  const element = h(
    "fieldset", { class: "segments" }, h("legend", {}, label),
    h("div", {}, ...pairs.map(([, text], k) => h("label", {}, inputs[k], text))),
  );
  return { element, value, show: (at) => inputs.forEach((input, k) => (input.checked = pairs[k][0] === at)) };
};

/** A field for a number; what is outside its limits is brought to the nearest of them. */
export const field = ({ label, from, to, step = 1, value }) => ({ put }) => {
  const input = h("input", { type: "number", min: from, max: to, step, "aria-label": label });
  input.addEventListener("change", () => {
    const number = Number(input.value);
    put(Number.isFinite(number) && input.value !== "" ? Math.min(to, Math.max(from, number)) : value);
  });
  return { element: h("label", {}, h("span", {}, label), input), value, show: (at) => (input.value = String(at)) };
};

/** A button that changes the state. */
export const press = ({ label, act: change, off = () => false }) => ({ act }) => {
  const element = h("button", { type: "button", click: () => act(change) }, label);
  return { element, show: (_, state) => (element.disabled = off(state)) };
};

// ---- The guess ------------------------------------------------------------------------------------------------------

const TRY = "Now try it. Then ask whether your guess was right.";
const TRIED = "Ask when you have seen enough.";

/**
 * What the reader guesses before moving anything, and what is said about it: nothing but "try it" until something was moved and
 * the reader asks, or opens the answer below.
 * @param {{guesses: string[], right: string, because: string}} data
 */
function guessing({ guesses, right, because }) {
  let [guess, moved, judged] = [null, false, false];
  const told = h("span", { class: "told", role: "status" });
  const ask = h("button", { type: "button", click: () => judge() }, "Was my guess right?");
  const say = () => {
    ask.disabled = guess === null || !moved;
    told.textContent = judged ? verdict() : guess === null ? "" : moved ? TRIED : TRY;
  };
  const verdict = () => {
    if (guess === null) return `The answer is “${right}”. ${because}`;
    return guess === right ? `Your guess “${guess}” is right. ${because}` : `Your guess “${guess}” is not right; “${right}” is. ${because}`;
  };
  const judge = () => {
    judged = true;
    say();
  };
  const options = segments({ label: "Your guess, before you try", options: guesses })({
    put: (value) => {
      guess = value;
      say();
    },
  });
  say();
  const move = () => {
    moved = true;
    if (!judged) say();
  };
  return { element: h("div", { class: "row guess" }, options.element, ask, told), move, judge };
}

/**
 * Calls back when the reader opens the answer, which a page folds directly below. The whole document is watched, since
 * a widget may be drawn before it is put into its page. Returns how to stop.
 */
function whenAnswered(element, call) {
  const opened = ({ target }) => {
    if (target.open && target.previousElementSibling?.contains(element)) call();
  };
  document.addEventListener("toggle", opened, true); // the event does not bubble
  return () => document.removeEventListener("toggle", opened, true);
}

// ---- The frame ------------------------------------------------------------------------------------------------------

/**
 * A widget from its controls, the rest of its state, and a function that draws.
 * @param {object} parts
 * @param {(given: any) => Record<string, MakeControl>} parts.controls by the name under which the state holds their value
 * @param {(given: any) => State} [parts.start] what else the state holds at first
 * @param {(tools: {given: any, stage: Element, act: (change: (state: State) => void) => void}) => (state: State) => string} parts.draw
 *   fills the stage; returns a function that shows a state there and says in words what can be seen
 */
export const explorable = ({ controls, start = () => ({}), draw }) => ({
  render({ model, el }) {
    const { title, question, given: own, kernel, ...answers } = model.get("data");
    const guess = guessing(answers);
    const [tools, pictures] = [h("div", { class: "row" }), h("div", { class: "row" })];
    const said = h("p", { class: "status grow", role: "status" });
    let [shown, again] = [own, () => {}];
    const reset = h("button", { type: "button", click: () => {
      if (shown === own) again();
      else build(own);
      reset.focus(); // it may have been put into its row again
    } }, "Reset");
    /** Makes the controls and pictures for some numbers: those of the page, or some of Python's in their place. */
    const build = (given) => {
      shown = given;
      const stage = h("div", { class: "pictures" });
      const act = (change) => {
        change(state);
        show();
        guess.move();
      };
      const made = Object.entries(controls(given)).map(([name, make]) => [
        name, make({ put: (value) => act((now) => (now[name] = value)), act }),
      ]);
      const first = () => ({ ...Object.fromEntries(made.map(([name, { value }]) => [name, value])), ...start(given) });
      let state = first();
      const picture = draw({ given, stage, act });
      const show = () => {
        made.forEach(([name, control]) => control.show?.(state[name], state));
        said.textContent = picture(state);
      };
      again = () => {
        state = first();
        show();
      };
      tools.replaceChildren(...made.map(([, { element }]) => element), reset);
      pictures.replaceChildren(stage, said);
      show();
    };
    asWidget(el, title, "explorable");
    el.replaceChildren(h("p", { class: "title" }, title), h("p", { class: "question" }, question), guess.element, tools, pictures);
    build(own);
    const unwatch = whenAnswered(el, guess.judge);
    if (!kernel) return unwatch;
    const python = kernelPart({ model, described: kernel, show: (given) => build({ ...own, ...given }) });
    el.append(python.element);
    return () => {
      unwatch();
      python.cancel();
    };
  },
});

// ---- Pictures -------------------------------------------------------------------------------------------------------

/** A number with a minus sign that is one, and no sign for a zero. */
export function number(value, digits = 2) {
  const size = Math.abs(value).toFixed(digits);
  return value < 0 && Number(size) > 0 ? `−${size}` : size;
}

/** A whole number as an exponent. */
export const exponent = (power) => [...String(power)].map((digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit] ?? "⁻").join("");

/** Round numbers between two limits, about `count` of them. */
export function ticks(low, high, count = 5) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((times) => times * power).find((size) => size >= rough * 0.99);
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

/** Axes with room for lines, bars and dots: `X` and `Y` turn numbers into places, `put` replaces what is drawn. */
export function plot({ x: [x0, x1], y: [y0, y1], xLabel, yLabel, width = 400, height = 250, xTicks = ticks(x0, x1), yTicks = ticks(y0, y1) }) {
  const [left, right, top, bottom] = [50, width - 16, 26, height - 42];
  const X = (value) => left + ((right - left) * (value - x0)) / (x1 - x0);
  const Y = (value) => bottom - ((bottom - top) * (value - y0)) / (y1 - y0);
  const tick = (which, place, words) => svg("text", { "font-size": 13, class: `quiet ${which}-tick`, ...place }, words);
  const layer = svg("g", {});
  const element = svg(
    "svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", class: "chart" },
    ...axes({ left, right, top, bottom, xLabel, yLabel, letters: 13 }),
    ...xTicks.map((at) => tick("x", { x: X(at), y: bottom + 17, "text-anchor": "middle" }, number(at, places(xTicks)))),
    ...yTicks.map((at) => tick("y", { x: left - 6, y: Y(at) + 4, "text-anchor": "end" }, number(at, places(yTicks)))),
    layer,
  );
  const put = (label, ...shapes) => {
    set(element, { "aria-label": label });
    layer.replaceChildren(...shapes);
  };
  const line = (points, attributes) =>
    svg("polyline", { points: points.map(([a, b]) => `${X(a).toFixed(1)},${Y(b).toFixed(1)}`).join(" "), fill: "none", "stroke-width": 2.5, ...attributes });
  return { element, X, Y, put, line };
}

/** How many digits behind the point the finest of some numbers needs. */
const places = (values) => Math.max(0, ...values.map((value) => (String(value).split(".")[1] ?? "").length));

/** What the colours mean: pairs of a colour and a text. */
export const legend = (...marks) =>
  h("div", { class: "legend", "aria-hidden": "true" }, ...marks.map(([colour, text]) => h("span", { style: `--mark: ${colour}` }, text)));
