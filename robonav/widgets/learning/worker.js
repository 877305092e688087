// Long computations beside the page: in a Web Worker made from the widget's own text, or else in slices on the page.

/**
 * @typedef {{done: number, total: number, live?: any}} Step how much is done, of how much, and what to show of it
 * @typedef {(argument: any) => Iterator<Step | undefined> | AsyncIterator<Step | undefined>} Job a generator function that
 *   stands at the top of a file; its argument, its steps and what it returns are numbers, texts, arrays and plain objects.
 *   It yields nothing where no step is done yet and the page may answer.
 * @typedef {{progress?: (done: number, total: number) => void, live?: (news: any[]) => void, done?: (result: any) => void,
 *   error?: (sentence: string) => void}} Listeners
 */

const PAUSE = 40; // milliseconds between two messages to the page
const SLICE = 12; // milliseconds of work on the page before it may answer a touch

/** Runs a job to its end; `tell` gets messages now and then, `rest` is awaited between slices. Stops where `ended()`. */
async function carryOut(job, argument, tell, { slice = PAUSE, rest = null, ended = () => false }) {
  try {
    const steps = job(argument);
    let [news, last, told] = [[], null, performance.now()];
    const report = () => {
      if (last) tell({ progress: [last.done, last.total], live: news });
      [news, told] = [[], performance.now()];
    };
    for (;;) {
      let step = steps.next();
      if (typeof step.then === "function") step = await step;
      if (step.done) {
        report();
        tell({ done: step.value });
        return;
      }
      last = step.value ?? last;
      if (step.value?.live !== undefined) news.push(step.value.live);
      if (performance.now() - told < slice) continue;
      report();
      if (rest) await rest();
      if (ended()) return;
    }
  } catch (error) {
    tell({ error: error.message });
  }
}

/** What the worker does: it waits for the argument of its job. */
export function answer(job) {
  globalThis.onmessage = ({ data }) => carryOut(job, data, (message) => globalThis.postMessage(message), {});
}

/**
 * A worker that knows everything the widget does, or null where the browser gives none. It is a script and no module,
 * without exports, because Chromium runs no module from a page that was opened from disk.
 */
function makeWorker(source, job) {
  if (typeof Worker === "undefined" || typeof source !== "string") return null;
  try {
    const script = source.replace(/^export (default )?/gm, "");
    const url = URL.createObjectURL(new Blob([script, `\nanswer(${job.name});`], { type: "text/javascript" }));
    const worker = new Worker(url);
    worker.forget = () => URL.revokeObjectURL(url);
    return worker;
  } catch {
    return null;
  }
}

/**
 * Starts a job.
 * @param {string} source the widget's whole text: `model.get("_esm")`
 * @param {Job} job
 * @param {any} argument
 * @param {Listeners} listeners
 * @returns {{cancel: () => void}}
 */
export function startJob(source, job, argument, { progress = () => {}, live = () => {}, done = () => {}, error = () => {} }) {
  let over = false;
  const tell = (message) => {
    if (over) return;
    if (message.progress) progress(...message.progress);
    if (message.live?.length) live(message.live);
    if (!("done" in message || "error" in message)) return;
    over = true;
    if ("error" in message) error(message.error);
    else done(message.done);
  };
  const onPage = () => {
    const rest = () => new Promise((go) => setTimeout(go));
    rest().then(() => over || carryOut(job, argument, tell, { slice: SLICE, rest, ended: () => over }));
  };
  const worker = makeWorker(source, job);
  let heard = false;
  const end = () => {
    worker?.terminate();
    worker?.forget();
  };
  if (worker) {
    worker.onmessage = ({ data }) => {
      heard = true;
      tell(data);
      if (over) end();
    };
    worker.onerror = (event) => {
      event.preventDefault();
      end();
      if (heard) tell({ error: "The computation broke off." });
      else if (!over) onPage();
    };
    worker.postMessage(argument);
  } else onPage();
  return {
    cancel: () => {
      over = true;
      end();
    },
  };
}
