// Draws the widgets of a page without a kernel. Python wrote each of them into the page: its module, its style and its
// numbers into the page's state, and where it stands into the text. A widget starts when it comes near what is seen, and
// the others follow one by one while the page rests, so that each is there for who jumps, searches, tabs or prints.

/** @typedef {{_esm: string, _css: string, data: any}} WidgetState what Python wrote of one widget */

const NEAR = "100% 0px"; // how far from what is seen a widget starts: one screen above and below

/** What a widget asks its host for. Nobody answers what it sends, since there is no kernel. @param {WidgetState} state */
const modelWithoutKernel = (state) => ({ get: (name) => state[name], on() {}, send() {} });

const styles = new Set();

/** Adds a style sheet to the page, once. @param {string} text */
function addStyle(text) {
  if (styles.has(text)) return;
  styles.add(text);
  document.head.append(Object.assign(document.createElement("style"), { textContent: text }));
}

/** Draws a widget in its place. @param {Element} place @param {WidgetState} state */
async function drawWidget(place, state) {
  const address = URL.createObjectURL(new Blob([state._esm], { type: "text/javascript" }));
  try {
    const { default: widget } = await import(address);
    addStyle(state._css);
    const el = document.createElement("div");
    place.replaceChildren(el); // drawn in its place, where it finds its width and its colours
    widget.render({ model: modelWithoutKernel(state), el });
  } catch (error) {
    place.textContent = "This could not be drawn. A newer browser may be able to.";
    console.error(error);
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** The widgets of the page by their places, which are made. @returns {Map<Element, WidgetState>} */
function widgetsOfPage() {
  const jsonOf = (kind) => [...document.querySelectorAll(`script[type="application/vnd.jupyter.widget-${kind}+json"]`)]
    .map((script) => ({ script, json: JSON.parse(script.textContent) }));
  const models = Object.assign({}, ...jsonOf("state").map(({ json }) => json.state));
  return new Map(jsonOf("view").map(({ script, json }) => {
    const place = Object.assign(document.createElement("div"), { className: "widget-subarea" });
    script.before(place);
    return [place, models[json.model_id].state];
  }));
}

document.addEventListener("DOMContentLoaded", () => {
  const waiting = widgetsOfPage();
  const start = (place) => {
    const state = waiting.get(place);
    waiting.delete(place);
    return state && drawWidget(place, state);
  };
  const startAll = () => [...waiting.keys()].forEach(start);
  if (!globalThis.IntersectionObserver) {
    startAll();
    return;
  }
  const watch = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) start(target);
      if (!waiting.has(target)) watch.unobserve(target);
    }
  }, { rootMargin: NEAR });
  for (const place of waiting.keys()) watch.observe(place);
  const atRest = globalThis.requestIdleCallback // a busy page waits a second at most
    ? (call) => requestIdleCallback(call, { timeout: 1000 })
    : (call) => setTimeout(call, 50);
  const startNext = async () => {
    if (waiting.size === 0) return;
    await start(waiting.keys().next().value);
    atRest(startNext);
  };
  addEventListener("load", () => atRest(startNext));
  addEventListener("beforeprint", startAll);
});
