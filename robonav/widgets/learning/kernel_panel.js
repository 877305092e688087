// Training in the kernel's Python, as the reader sees it: the panel of trainings in the page, with Python to do the work.

/** Bytes as a text of letters, which a message to the kernel can hold. @param {Uint8Array} bytes */
export function base64Of(bytes) {
  const parts = [];
  for (let at = 0; at < bytes.length; at += 8192) parts.push(String.fromCharCode(...bytes.subarray(at, at + 8192)));
  return btoa(parts.join(""));
}

/**
 * A training in Python (`kernel_training.py`). There is nothing of it until a kernel says that it is there.
 * @param {{model: any, title: string, action?: string, unit: string, total: () => number, controls?: Element[], lines: object[],
 *   request: () => object | string, live?: (news: any[]) => void, done?: (result: any) => string | void}} options
 *   action: what the button says; request: what Python is asked for, or a sentence that says why nothing is asked; the others as in `trainingPanel`
 */
export function kernelPanel({ model, title, action = "Train in Python", unit, total, controls = [], lines, request, live = () => {}, done = (sentence) => sentence }) {
  let [number, inbox, wake] = [0, [], () => {}];
  /** A job that Python does: what Python says becomes its steps. */
  async function* pythonTraining(asked) {
    inbox = [];
    number += 1;
    model.send({ ask: "train", run: number, ...asked });
    for (;;) {
      while (inbox.length === 0) await new Promise((go) => (wake = go));
      const message = inbox.shift();
      if (message.error) throw new Error(message.error);
      if ("ended" in message) return message.ended;
      if (message.cancelled) throw new Error("Cancelled.");
      const { done: steps, total: of, live: news = [undefined] } = message;
      for (const item of news) yield { done: steps, total: of, live: item };
    }
  }
  const panel = trainingPanel({
    source: null, title: `Python: ${title}`, action, unit, total, lines, live, done,
    begin: () => {
      const asked = request();
      return typeof asked === "string" ? asked : { job: pythonTraining, argument: asked };
    },
    cancelled: () => {
      model.send({ ask: "cancel" });
      return "Python drops this run and keeps the one before.";
    },
  });
  const fieldset = h("fieldset", { class: "kernel" }, h("legend", {}, title), h("div", { class: "row tools" }, ...controls), panel.element);
  const element = h("div", {});
  model.on("msg:custom", (message) => {
    if (message.kernel) element.replaceChildren(fieldset);
    if (message.run !== number) return;
    inbox.push(message);
    wake();
  });
  try {
    model.send({ ask: "kernel" });
  } catch {
    // A page without a kernel has only the training in the page.
  }
  return { element, cancel: panel.cancel };
}

/** A list of how many robots are trained, each with a seed of its own. */
export function numberOfRobots(options = [1, 4, 16]) {
  const list = choice({ label: "robots, each with a seed of its own", options: options.map(String), value: 1, change: () => {} });
  return { element: list.element, value: () => options[list.element.querySelector("select").selectedIndex] };
}
