// Answers questions about JavaScript: one line of JSON asks, one line of JSON answers, in order.
//
// A question has the text of a module, the body of a function, and data. The body finds the module's exports as `page`
// and the data as `data`, and may return a promise. The answer is {result}, what the body returns, or {failure}, what
// went wrong.
//
// Each question has a realm of its own: its own globals, its own Math and Array, and the module evaluated anew. It
// shares with other questions only what Node gives by the names below. A timer that it leaves behind ends with it.

import { Console } from "node:console";
import { createInterface } from "node:readline";
import vm from "node:vm";

const FROM_NODE = { atob, Blob, btoa, Buffer, DecompressionStream, performance, process, Response, TextDecoder, TextEncoder, URL };
const console = new Console(process.stderr); // the output is for answers only

function ownTimers() {
  const running = new Set();
  const clear = (timer) => {
    clearTimeout(timer);
    running.delete(timer);
  };
  const start = (action, wait, ...values) => {
    const timer = setTimeout(() => {
      running.delete(timer);
      action(...values);
    }, wait);
    running.add(timer);
    return timer;
  };
  return { setTimeout: start, clearTimeout: clear, clearAll: () => running.forEach(clear) };
}

async function answer({ module, body, data }, { setTimeout, clearTimeout }) {
  // Where Node has this constant, a realm finds its globals as fast as a page does.
  const realm = vm.createContext(vm.constants?.DONT_CONTEXTIFY);
  Object.assign(realm, FROM_NODE, { console, setTimeout, clearTimeout });
  const page = new vm.SourceTextModule(module, { context: realm, identifier: "widget.mjs" });
  await page.link((name) => {
    throw new Error(`The module imports ${name}.`);
  });
  await page.evaluate();
  const asked = `(page, data) => (() => { ${body} })()`;
  const parse = vm.runInContext("JSON.parse", realm);
  const result = await vm.runInContext(asked, realm, "question.mjs")(page.namespace, parse(JSON.stringify(data)));
  return JSON.stringify({ result });
}

let fail = () => {}; // ends the question that is being answered
process.on("uncaughtException", (error) => fail(error)); // in a timer
process.on("unhandledRejection", (error) => fail(error)); // in a promise that nobody waits for
process.on("beforeExit", () => fail(new Error("The question waits for what never comes.")));

for await (const line of createInterface({ input: process.stdin })) {
  process.stdin.unref(); // so that a question with nothing left to run is noticed
  const timers = ownTimers();
  const reply = await new Promise((resolve, reject) => {
    fail = reject;
    answer(JSON.parse(line), timers).then(resolve, reject);
  }).catch((error) => JSON.stringify({ failure: String(error?.stack ?? error) }));
  timers.clearAll();
  process.stdin.ref();
  process.stdout.write(`${reply}\n`);
}
