// Starts a deck: chooses the lecture of 45 or 90 minutes, fits every slide, and shares the keyboard with live figures.

const query = new URLSearchParams(location.search);
const long = query.has("long");
const SMALLEST = 0.3;
const LARGEST = [[".live", 1.6], ["figure, .animated", 1], [".math, pre, .admonition, table", 1.35], [".points", 1.3]];
const READABLE = 0.66; // a live figure that would be smaller scrolls instead
const ROOM_TO_GROW = 0.9; // of the height, for a live figure that will say more

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
function fit(body, room = 1) {
  const content = body.querySelector(".fit");
  if (!content || !body.clientHeight) return;
  body.classList.remove("scrolls");
  const height = body.getBoundingClientRect().height * room;
  let [low, high] = [SMALLEST, LARGEST.find(([kind]) => content.querySelector(kind))?.[1] ?? 1];
  if (fits(content, height, high)) return;
  for (let step = 0; step < 7; step += 1) {
    const middle = (low + high) / 2;
    if (fits(content, height, middle)) low = middle;
    else high = middle;
  }
  const scrolls = low < READABLE && Boolean(content.querySelector(".live"));
  body.classList.toggle("scrolls", scrolls);
  content.style.zoom = scrolls ? READABLE : low;
}

/** Makes a live figure smaller when its content grows, after an answer for instance. */
function watch(body) {
  const content = body.querySelector(".fit");
  const grown = new ResizeObserver(() => {
    if (body.classList.contains("scrolls")) return;
    if (content.getBoundingClientRect().height > body.getBoundingClientRect().height + 1) fit(body);
  });
  grown.observe(content);
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
  await Reveal.initialize({
    width: 1280, height: 720, margin: 0, minScale: 0.1, maxScale: 4, center: false, hash: true, transition: "none",
    slideNumber: "c/t", viewDistance: 1000, mobileViewDistance: 1000, keyboardCondition: () => !focused(),
    pdfMaxPagesPerSlide: 1, pdfSeparateFragments: false, navigationMode: "linear", controlsTutorial: false,
    totalTime: 60 * (long ? 90 : 45), plugins: [RevealNotes],
  });
  document.addEventListener("keydown", beforeFigures, true);
  Reveal.on("slidechanged", () => document.activeElement?.closest("section") && document.activeElement.blur());
  const bodies = [...document.querySelectorAll(".body")];
  for (const body of bodies) fit(body, body.querySelector(".live") ? ROOM_TO_GROW : 1);
  if (!Reveal.isPrintView?.()) bodies.filter((body) => body.querySelector(".live, details")).forEach(watch);
  document.documentElement.dataset.ready = "";
}

addEventListener("load", start);
