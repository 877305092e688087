// Learning runs in every setting: curves to step through and to lay over one another, and a training of one's own.

const FRAMES = 100;
const [WIDE, HIGH] = [330, 184]; // of a chart, pixels
const [LEFT, RIGHT, TOP, BOTTOM] = [54, WIDE - 10, 30, HIGH - 24];
const DRAWN = { run: PALETTE.BLUE, kept: PALETTE.INK, live: PALETTE.VERMILION };

/** Curves as Python packed them, by measure. */
export const curvesOf = (packed) => Object.fromEntries(Object.entries(packed).map(([name, curve]) => [name, {
  seeds: curve.seeds,
  ...Object.fromEntries(["steps", "mean", "low", "high"].map((part) => [part, [...unpack(curve[part]).values]])),
}]));

/** The index of the last value taken at or before a step. */
export const lastBefore = ({ steps }, step) => Math.max(0, steps.findLastIndex((at) => at <= step + 1e-9));

/** A number in three digits, whole ones whole. */
export const digits = (value) => (Number.isInteger(value) ? String(value) : Math.abs(value) >= 100 ? value.toFixed(0) : String(Number(value.toPrecision(3))));

/** What a curve says at a step: "0.912", or with several seeds "83.1 (81 to 85)". */
export function reading(curve, step) {
  const at = lastBefore(curve, step);
  const [mean, low, high] = [curve.mean[at], curve.low[at], curve.high[at]].map(digits);
  return curve.seeds > 1 ? `${mean} (${low} to ${high})` : mean;
}

/** One measure over the steps, for the run of the setting, one that is kept, and one that is being trained. */
function chart({ label, step, last, highest, lowest, touch }) {
  const x = (at) => LEFT + ((RIGHT - LEFT) * at) / last;
  const y = (value) => BOTTOM - ((BOTTOM - TOP) * (value - lowest)) / (highest - lowest || 1);
  const text = (content, attributes) => svg("text", { "font-size": 12, ...attributes }, content);
  const element = svg("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, width: WIDE, height: HIGH, role: "img" });
  const mark = svg("line", { y1: TOP, y2: BOTTOM, stroke: PALETTE.INK, "stroke-dasharray": "3 3" });
  const lines = Object.fromEntries(Object.entries(DRAWN).map(([which, stroke]) => [which, {
    band: svg("path", { fill: stroke, "fill-opacity": 0.2 }),
    line: svg("path", { fill: "none", stroke, "stroke-width": which === "kept" ? 1.5 : 2.2, "stroke-dasharray": which === "kept" ? "6 4" : null }),
    dot: svg("circle", { r: 4.5, fill: stroke }),
  }]));
  const drawn = ["kept", "run", "live"].map((which) => lines[which]);
  element.append(
    svg("path", { d: `M${LEFT} ${TOP}V${BOTTOM}H${RIGHT}`, fill: "none", stroke: PALETTE.INK }),
    ...drawn.map(({ band }) => band), mark, ...drawn.map(({ line }) => line), ...drawn.map(({ dot }) => dot),
    text(digits(highest), { x: LEFT - 6, y: TOP + 5, "text-anchor": "end" }), text(digits(lowest), { x: LEFT - 6, y: BOTTOM, "text-anchor": "end" }),
    text("0", { x: LEFT, y: BOTTOM + 16, "text-anchor": "middle" }), text(digits(last), { x: RIGHT, y: BOTTOM + 16, "text-anchor": "end" }),
    text(step, { x: (LEFT + RIGHT) / 2, y: BOTTOM + 16, "text-anchor": "middle", class: "quiet" }),
    text(label, { x: 2, y: 14, class: "quiet" }),
  );
  const point = (event) => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = element.getBoundingClientRect();
    touch((((event.clientX - box.left) / box.width) * WIDE - LEFT) / (RIGHT - LEFT));
  };
  element.addEventListener("pointerdown", point);
  element.addEventListener("pointermove", point);

  const path = (steps, values) => steps.map((at, i) => `${i ? "L" : "M"}${x(Math.min(at, last)).toFixed(1)} ${y(values[i]).toFixed(1)}`).join("");
  /** Draws a curve in one of the three places, or nothing there. */
  const draw = (which, curve) => {
    const { band, line, dot } = lines[which];
    line.setAttribute("d", curve ? path(curve.steps, curve.mean) : "");
    const around = curve && curve.seeds > 1 ? `${path(curve.steps, curve.high)}${path([...curve.steps].reverse(), [...curve.low].reverse()).replace("M", "L")}Z` : "";
    band.setAttribute("d", around);
    dot.setAttribute("visibility", "hidden");
  };
  /** Puts the marks at a step. */
  const at = (step_, curves) => {
    set(mark, { x1: x(step_), x2: x(step_) });
    for (const [which, curve] of Object.entries(curves)) {
      if (!curve) continue;
      const i = lastBefore(curve, step_);
      set(lines[which].dot, { cx: x(Math.min(curve.steps[i], last)), cy: y(curve.mean[i]), visibility: which === "live" ? "hidden" : "visible" });
    }
    element.setAttribute("aria-label", `${label} over the training; at ${step} ${Math.round(step_)}: ${reading(curves.run, step_)}`);
  };
  return { element, draw, at };
}

function render({ model, el }) {
  const data = model.get("data");
  const { step, measures } = data;
  const chosen = data.controls.map(({ value }) => value);
  const every = data.runs.map(curvesOf);
  const place = () => data.controls.reduce((sum, { options }, which) => sum * options.length + chosen[which], 0);
  const last = Math.max(...every.flatMap((run) => Object.values(run).map(({ steps }) => steps.at(-1))));
  const said = () => chosen.map((at, which) => `${data.controls[which].label} ${data.controls[which].options[at]}`).join(", ");
  const name = `${step[0].toUpperCase()}${step.slice(1)}`;
  let [run, kept, live] = [every[place()], null, null];

  const stepAt = (frame) => Math.round((last * frame) / FRAMES);
  const charts = measures.map(({ name: measure, label }) => {
    const curves = every.map((one) => one[measure]);
    const [low, high] = [Math.min(...curves.flatMap((curve) => curve.low)), Math.max(...curves.flatMap((curve) => curve.high))];
    return chart({ label, step, last, lowest: Math.min(0, low), highest: high, touch: (share) => { time.stop(); time.go(Math.round(share * FRAMES)); } });
  });
  const status = h("p", { class: "status", role: "status" });
  const comparison = h("p", { class: "told" });

  function show() {
    const now = stepAt(time.frame());
    charts.forEach((one, i) => {
      const measure = measures[i].name;
      one.at(now, { run: run[measure], kept: kept?.run[measure], live: live?.[measure] });
    });
    const told = (curves) => measures.map(({ name: measure, label }) => `${label} ${reading(curves[measure], now)}`).join("; ");
    status.textContent = `${name} ${now}: ${told(run)}.`;
    comparison.textContent = kept ? `Kept (dashed; ${kept.said}): ${told(kept.run)}.` : "";
  }
  const draw = () => {
    drop.disabled = kept === null;
    charts.forEach((one, i) => {
      const measure = measures[i].name;
      one.draw("run", run[measure]);
      one.draw("kept", kept?.run[measure]);
      one.draw("live", live?.[measure]);
    });
    show();
  };

  const time = player({ label: step, count: FRAMES + 1, value: FRAMES, interval: 50, text: (frame) => `${stepAt(frame)} of ${last}`, change: () => show() });
  const settings = data.controls.map(({ label, options, value }, which) =>
    choice({ label, options, value, change: (index) => {
      chosen[which] = index;
      [run, live] = [every[place()], null];
      draw();
    } }));
  const keep = h("button", { type: "button", click: () => { kept = { run, said: said() }; draw(); } }, "Keep to compare");
  const drop = h("button", { type: "button", click: () => { kept = null; draw(); } }, "Drop what is kept");

  const workshop = trainer({ model, choices: () => chosen.map((at, which) => data.controls[which].options[at]), live: (curves) => { live = curves; draw(); } });
  asWidget(el, "Training lab", "training-lab");
  el.replaceChildren(
    h("div", { class: "row settings" }, ...settings.map(({ element }) => element), keep, drop), time.element,
    status, comparison, h("div", { class: "charts" }, ...charts.map(({ element }) => element)), workshop,
  );
  draw();
  return () => time.stop();
}

/** Train, watch, cancel; it stays hidden until a kernel says that it is there. */
function trainer({ model, choices, live }) {
  const bar = h("progress", { value: 0, max: 1, "aria-label": "Training done" });
  const note = h("span", { role: "status" });
  let began = 0;
  const begin = h("button", { type: "button", click: () => {
    running(true);
    live(null);
    bar.value = 0;
    began = performance.now();
    note.textContent = "Training …";
    model.send({ ask: "train", choices: choices() });
  } }, "Train");
  const cancel = h("button", { type: "button", disabled: true, click: () => model.send({ ask: "cancel" }) }, "Cancel");
  const running = (is) => [begin.disabled, cancel.disabled] = [is, !is];
  const element = h("fieldset", { hidden: true },
    h("legend", {}, "Train here and now, in the setting chosen above"), h("div", { class: "row" }, begin, cancel, bar, note));
  model.on("msg:custom", (message) => {
    if (message.kernel) element.hidden = false;
    if (message.live) {
      bar.value = message.done / message.total;
      const left = message.done < message.total ? timeLeft((performance.now() - began) / 1000, bar.value) : "";
      note.textContent = `${message.done} of ${message.total}${left && `, ${left}`}`;
      live(curvesOf(message.live.at(-1)));
    }
    const end = message.ended ?? message.error ?? (message.cancelled ? "Cancelled. The curves so far stay until you choose another setting." : "");
    if (end) {
      note.textContent = end;
      running(false);
    }
  });
  try {
    model.send({ ask: "kernel" });
  } catch {
    // A page without a kernel: nothing can be trained, and the buttons stay hidden.
  }
  return element;
}

export default { render };
