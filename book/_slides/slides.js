// Starts a deck: chooses the lecture of 45 or 90 minutes, fits every slide, and shares the keyboard with live figures.

const query = new URLSearchParams(location.search);
const long = query.has("long");
const SMALLEST = 0.3;
const LARGEST = [["figure, .animated", 1], [".math, pre, .admonition, table", 1.35], [".points", 1.3]];
const SHARES = [0.26, 0.32, 0.38, 0.44, 0.5, 0.56, 0.62]; // of a slide's width, for the controls of a live figure
const [SMALLEST_PICTURE, LARGEST_PICTURE] = [0.45, 2.2];
const ROOM_TO_SAY = 40; // pixels below the controls of a live figure, for what it will say

/** Shows what belongs to the lecture, and on the first slide where the other one is. */
function choose() {
  if (!long) document.querySelectorAll("section[data-long]").forEach((slide) => slide.remove());
  for (const slide of document.querySelectorAll("section[data-minutes]")) {
    if (long) slide.dataset.minutes = slide.dataset.minutesLong;
    slide.dataset.timing = 60 * slide.dataset.minutes;
    slide.querySelector(".notes .minutes").textContent = `${slide.dataset.minutes} min.`;
  }
  const minutes = [...document.querySelectorAll("section[data-minutes]")]
    .reduce((sum, slide) => sum + Number(slide.dataset.minutes), 0);
  const other = document.createElement("a");
  other.href = long ? location.pathname : `${location.pathname}?long`;
  other.textContent = long ? "the short lecture" : "the long lecture";
  document.querySelector(".versions")?.append(`${document.body.dataset.book} · ${minutes} minutes · `, other);
}

/** Whether all columns of a slide's content lie within a height and its body's width, at a size. */
function fits(content, height, size) {
  content.style.zoom = size;
  if (content.getBoundingClientRect().height > height + 1 || content.scrollWidth > content.clientWidth + 1) return false;
  return [...content.querySelectorAll(":scope > div, .math, pre, .live, table, figure")]
    .every((part) => part.scrollWidth <= part.clientWidth + 1 || part.closest("mjx-container, svg"));
}

/** Draws the content of a slide as large as fits, up to the size at which its kind is read well. */
function fit(body) {
  const content = body.querySelector(".fit");
  if (!content || !body.clientHeight) return;
  const height = body.clientHeight;
  let [low, high] = [SMALLEST, LARGEST.find(([kind]) => content.querySelector(kind))?.[1] ?? 1];
  if (fits(content, height, high)) return;
  for (let step = 0; step < 8; step += 1) {
    const middle = (low + high) / 2;
    if (fits(content, height, middle)) low = middle;
    else high = middle;
  }
  content.style.zoom = low;
}

// ---- Live figures: controls and words at the left, pictures at the right, as large as the slide allows ----------------

const PICTURE = "canvas, svg[viewBox]";
const SEEN = ".pictures, .plane, .grids, .curves, .charts, .legend, .viewer, .scroll, table, figure, canvas, svg";
const PAGE_ONLY = ".my-demonstrations, .kept, .file, .kernel, .snapshots, .readings, .hint"; // downloads, and what a lecturer says

/** Whether something holds a picture, and not only the sign on a button or what is folded. */
const pictured = (part) => part.matches(".pictures") || part.querySelector(".pictures") !== null || [part, ...part.querySelectorAll(PICTURE)]
  .some((found) => found.matches(PICTURE) && !found.closest("button, details, label, .snapshots"));

/** Yields the parts of a live figure from top to bottom, each with whether it is looked at. A row of both comes apart. */
function* partsOf(place) {
  for (const part of [...place.children]) {
    const whole = part.matches(SEEN) || [...part.children].every((inner) => inner.matches("figure"));
    if (!pictured(part)) yield [part, part.matches(".legend, .viewer, .scroll:has(table)")];
    else if (whole) yield [part, true];
    else if (part.hidden) part.classList.add("page-only"); // an experiment for after this one
    else yield* partsOf(part);
  }
}

/** Lets what a fold holds lie over the slide, above the summary if there is no room below. */
function openOver(fold) {
  const { bottom } = fold.closest(".body").getBoundingClientRect();
  if ([...fold.children].some((part) => part.getBoundingClientRect().bottom > bottom)) fold.classList.add("upwards");
}

/** Lays a live figure out for a wide, low slide, and leaves away what belongs to the page only. */
function arrange(widget) {
  const [hand, eye] = ["hand", "eye"].map((name) => Object.assign(document.createElement("div"), { className: name }));
  for (const part of widget.querySelectorAll(PAGE_ONLY)) part.classList.add("page-only");
  for (const button of widget.querySelectorAll("button")) {
    if (button.textContent.startsWith("Download")) button.classList.add("page-only");
  }
  for (const fold of widget.querySelectorAll("details")) {
    fold.open = false;
    fold.name = "folds"; // one at a time
    fold.addEventListener("toggle", () => openOver(fold));
  }
  for (const [part, seen] of [...partsOf(widget)]) {
    if (!part.matches(".title, .question")) (seen ? eye : hand).append(part);
  }
  for (const rest of widget.children) if (!rest.matches(".question")) rest.classList.add("page-only");
  widget.append(hand, eye);
  widget.classList.add("arranged");
}

/** Draws the pictures of a live figure at a size; says whether they fit into their column and above a line. */
function picturesFit(eye, bottom, size) {
  eye.style.setProperty("--size", size);
  const { right } = eye.getBoundingClientRect();
  return [eye, ...eye.querySelectorAll(".pictures, .pictures *, figure, table, .curves, .row, svg, canvas")]
    .map((part) => part.getBoundingClientRect())
    .every((part) => part.bottom <= bottom + 1 && part.right <= right + 1);
}

/** Folds the last controls that do not fit beside the pictures, so that they open over them. Returns whether there was one. */
function foldLast(hand) {
  const rest = [...hand.children].filter((part) => !part.matches(".more, .status, .page-only, .title, details") && part.offsetHeight > 0);
  if (rest.length < 3) return false;
  let more = hand.querySelector(".more");
  if (!more) {
    more = Object.assign(document.createElement("details"), { className: "more upwards", name: "folds" });
    more.append(Object.assign(document.createElement("summary"), { textContent: "More" }));
    hand.append(more);
  }
  more.firstElementChild.after(rest.at(-1));
  return true;
}

/** Gives controls the share of the slide that lets pictures be largest. */
function fitLive(body, room = ROOM_TO_SAY) {
  const widget = body.querySelector(".arranged");
  widget.classList.remove("crowded");
  const [hand, eye] = [widget.querySelector(".hand"), widget.querySelector(".eye")];
  const { bottom, height } = body.getBoundingClientRect();
  const spoken = room * height / body.clientHeight; // the slide may be drawn smaller or larger
  let [best, bestSize] = [SHARES.at(-1), 0];
  const sized = () => {
    let [low, high] = [SMALLEST_PICTURE, LARGEST_PICTURE];
    if (!picturesFit(eye, bottom, low)) return 0;
    for (let step = 0; step < 7; step += 1) {
      const middle = (low + high) / 2;
      if (picturesFit(eye, bottom, middle)) low = middle;
      else high = middle;
    }
    return low;
  };
  for (const share of SHARES) {
    widget.style.setProperty("--share", share);
    if (hand.getBoundingClientRect().bottom > bottom - spoken || hand.scrollWidth > hand.clientWidth + 1) continue;
    const size = sized();
    if (size > bestSize) [best, bestSize] = [share, size];
  }
  if (bestSize === 0 && foldLast(hand)) {
    fitLive(body, room);
    return;
  }
  widget.classList.toggle("crowded", bestSize === 0);
  widget.style.setProperty("--share", best);
  eye.style.setProperty("--size", bestSize || sized() || SMALLEST_PICTURE);
}

/** Fits a slide again when its content grows, after an answer for instance. */
function watch(body) {
  const widget = body.querySelector(".arranged");
  const content = widget ?? body.querySelector(".fit");
  const high = () => (widget ? Math.max(...[".hand", ".eye"].map((part) => widget.querySelector(part).getBoundingClientRect().bottom)) : content.getBoundingClientRect().bottom);
  const grown = new ResizeObserver(() => {
    if (high() > body.getBoundingClientRect().bottom + 1) {
      if (widget) fitLive(body, 0);
      else fit(body);
    }
  });
  for (const part of widget ? widget.querySelectorAll(".hand, .eye") : [content]) grown.observe(part);
}

/** The figure, link or field that has the keyboard. */
const focused = () => document.activeElement?.closest(".live, .animated, details, a, button, input, select, textarea");

/** A presenter's remote control turns the slides also while a figure has the keyboard, and Escape takes it from the figure. */
function beforeFigures(event) {
  if (!focused() || event.altKey || event.ctrlKey || event.metaKey) return;
  if (event.key === "Escape") document.activeElement.blur();
  else if (event.key === "PageDown") Reveal.next();
  else if (event.key === "PageUp") Reveal.prev();
  else return;
  event.preventDefault();
  event.stopPropagation();
}

const drawn = () => [...document.querySelectorAll(".live > script[type$='widget-view+json']")]
  .every(({ parentElement: place }) => place.querySelector(".widget-subarea > * > *"));

const until = (condition, patience) => new Promise((resolve) => {
  const start = performance.now();
  const look = () => (condition() || performance.now() - start > patience ? resolve() : setTimeout(look, 50));
  look();
});

async function start() {
  choose();
  await window.MathJax?.startup?.promise;
  await document.fonts.ready;
  await Promise.all([...document.images].map((image) => image.decode().catch(() => {})));
  await until(drawn, 20_000);
  for (const place of document.querySelectorAll(".live, .animated")) place.dataset.preventSwipe = "";
  const laidOut = new Promise((resolve) => document.querySelector(".reveal").addEventListener("pdf-ready", resolve));
  await Reveal.initialize({
    width: 1280, height: 720, margin: 0, minScale: 0.1, maxScale: 4, center: false, hash: true, transition: "none",
    slideNumber: "c/t", viewDistance: 1000, mobileViewDistance: 1000, keyboardCondition: () => !focused(),
    pdfMaxPagesPerSlide: 1, pdfSeparateFragments: false, navigationMode: "linear", controlsTutorial: false,
    totalTime: 60 * (long ? 90 : 45), plugins: [RevealNotes],
  });
  if (Reveal.isPrintView?.()) await Promise.race([laidOut, new Promise((resolve) => setTimeout(resolve, 5_000))]);
  document.addEventListener("keydown", beforeFigures, true);
  Reveal.on("slidechanged", () => document.activeElement?.closest("section") && document.activeElement.blur());
  const drills = [...document.querySelectorAll(".live details.drill")];
  for (const drill of drills) drill.open = true;
  await until(() => drills.every((drill) => drill.querySelector(".drill-place > *")), 5_000);
  const bodies = [...document.querySelectorAll(".body")];
  for (const widget of document.querySelectorAll(".live .robonav:not(.drill)")) arrange(widget);
  for (const body of bodies) (body.querySelector(".arranged") ? fitLive : fit)(body);
  if (!Reveal.isPrintView?.()) bodies.filter((body) => body.querySelector(".live, details")).forEach(watch);
  document.documentElement.dataset.ready = "";
}

addEventListener("load", start);
