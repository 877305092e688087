// Training as the reader sees it: one button that starts and cancels, a bar, and curves that grow.

/** A curve that grows to the right, with the run before it in grey. */
function liveCurve({ name, label, note = "", colour = PALETTE.BLUE, low = 0, high = null, text = (value) => value.toPrecision(3) }, unit) {
  const [width, height] = [340, 150];
  const [left, right, top, bottom] = [50, width - 10, 25, height - 38];
  const line = svg("path", { fill: "none", stroke: colour, "stroke-width": 2.2, "stroke-linejoin": "round" });
  const before = svg("path", { fill: "none", stroke: PALETTE.GREY, "stroke-width": 1.5, "stroke-opacity": 0.6 });
  const [upper, lower, last] = [top + 4, bottom + 4, bottom + 16].map((y, i) =>
    svg("text", { x: i < 2 ? left - 6 : right, y, "text-anchor": "end", "font-size": 12, class: i < 2 ? "y-tick" : "x-tick" }));
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label, class: "chart" },
    ...axes({ left, right, top, bottom, xLabel: unit, yLabel: label }), before, line, upper, lower, last);
  const element = h("figure", {}, picture, note && h("p", { class: "label" }, note));
  let [points, old, total] = [[], [], 1];

  const draw = () => {
    const values = points.length + old.length ? [...points, ...old].map(([, y]) => y) : [0, 1];
    const [least, most] = [low ?? Math.min(...values), high ?? Math.max(...values, low === null ? -Infinity : 1e-12)];
    const end = Math.max(total, ...old.slice(-1).map(([x]) => x));
    const place = ([x, y]) => `${(left + ((right - left) * x) / end).toFixed(1)} ${(bottom - ((bottom - top) * (y - least)) / (most - least || 1)).toFixed(1)}`;
    const path = (series) => {
      const every = Math.ceil(series.length / 400);
      const kept = series.filter((_, i) => i % every === 0 || i === series.length - 1);
      return kept.length ? `M${kept.map(place).join("L")}` : "";
    };
    line.setAttribute("d", path(points));
    before.setAttribute("d", path(old));
    upper.textContent = text(most);
    lower.textContent = text(least);
    last.textContent = String(end);
    const now = points.at(-1);
    picture.setAttribute("aria-label", now ? `${label}: ${text(points[0][1])} at first, ${text(now[1])} after ${now[0]}` : label);
  };
  return {
    element,
    /** A new run to so many steps; the last one stays, in grey. */
    begin: (steps) => {
      if (points.length > 1) old = points;
      [points, total] = [[], steps];
      draw();
    },
    add: (news) => {
      for (const item of news) {
        if (item[name] === undefined || item[name] === null) continue;
        if (points.length > 0 && item.at < points.at(-1)[0]) [points, old] = [[], points]; // the next robot begins
        points.push([item.at, item[name]]);
      }
      draw();
    },
    now: () => points.at(-1)?.[1],
  };
}

/**
 * A button that starts a job and cancels it, its progress, and a curve for each measure.
 * @param {{source: string, title?: string, action: string, busy?: string, unit: string, total: () => number,
 *   lines: {name: string, label: string, note?: string, colour?: string, low?: number, high?: number, text?: (value: number) => string}[],
 *   begin: () => {job: Job, argument: any} | string, live?: (news: any[]) => void, done: (result: any) => string | void,
 *   cancelled?: () => string | void, beside?: Element | null}} options
 *   source: `model.get("_esm")`; title: what the button starts; busy: a sentence while the job runs; total: how long the
 *   axes are at first; each item of a job's `live` is {at, [name]: value}; a line's note says what it shows;
 *   begin: gives the job, or a sentence that says why there is none; done: may give a sentence to say at the end;
 *   cancelled: may say what is kept of a job that was cancelled; otherwise nothing is; beside: a picture of what is
 *   learned, which stands next to the curves, or above them on a narrow screen
 */
export function trainingPanel({ source, title = "", action, busy = "It learns.", unit, total, lines, begin, live = () => {}, done, cancelled = () => {}, beside = null }) {
  const curves = lines.map((each) => liveCurve(each, unit));
  const fill = h("div", { class: "fill" });
  const bar = h("div", { class: "progress", role: "progressbar", "aria-label": action, "aria-valuemin": 0, "aria-valuemax": 100, "aria-valuenow": 0 }, fill);
  const said = h("p", { class: "status", role: "status" });
  const left = h("p", { class: "label left" });
  let [running, announced, began, frame, waiting] = [null, 0, 0, 0, []];

  const show = (steps, of) => {
    const percent = Math.floor((100 * steps) / Math.max(1, of));
    fill.style.width = `${percent}%`;
    set(bar, { "aria-valuenow": percent, "aria-valuetext": `${steps} of ${of}` });
    const gone = (performance.now() - began) / 1000;
    left.textContent = steps < of ? timeLeft(gone, steps / of) : "";
    if (percent >= announced + 25 && percent < 100) {
      announced = percent;
      said.textContent = `${percent} % done.`;
    }
  };
  const draw = () => {
    frame = 0;
    for (const each of curves) each.add(waiting);
    waiting = [];
  };
  const rest = (sentence) => {
    running = null;
    left.textContent = "";
    if (frame) cancelAnimationFrame(frame);
    draw();
    button.textContent = action;
    button.classList.remove("stops");
    said.textContent = sentence;
  };
  const start = () => {
    const task = begin();
    if (typeof task === "string") {
      said.textContent = task;
      return;
    }
    announced = 0;
    began = performance.now();
    show(0, 1);
    for (const each of curves) each.begin(total());
    button.textContent = "Cancel";
    button.classList.add("stops");
    said.textContent = busy;
    running = startJob(source, task.job, task.argument, {
      progress: show,
      live: (news) => {
        waiting.push(...news);
        frame ||= requestAnimationFrame(draw);
        live(news);
      },
      done: (result) => {
        show(1, 1);
        rest(`Done in ${((performance.now() - began) / 1000).toFixed(1)} s.`);
        const sentence = done(result);
        if (sentence) said.textContent += ` ${sentence}`;
      },
      error: (sentence) => {
        show(0, 1);
        rest(sentence);
      },
    });
  };
  const cancel = () => {
    if (!running) return;
    running.cancel();
    rest("");
    said.textContent = `Cancelled. ${cancelled() ?? "Nothing of this run is kept."}`;
  };
  const button = h("button", { type: "button", class: "main", click: () => {
    if (running) return cancel();
    element.scrollIntoView({ block: "nearest" }); // what is learned is below the button
    return start();
  } }, action);
  const element = h("div", { class: "training", role: "group", "aria-label": title || action },
    h("div", { class: "row tools" }, button, h("div", { class: "grow" }, title && h("p", { class: "label" }, title), bar, left)), said,
    h("div", { class: beside ? "seen" : "" }, ...(beside ? [beside] : []), h("div", { class: "row curves" }, ...curves.map((each) => each.element))));
  return { element, button, start, cancel, running: () => running !== null, now: () => curves.map((each) => each.now()) };
}
