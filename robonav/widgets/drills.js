// Drills: questions with new numbers each time, judged at once, and what the reader has mastered, kept in the browser.

/**
 * @typedef {{right: boolean, hint: string}} Verdict
 * @typedef {{text: string, picture: string, asked: any, explanation: string}} Question as Python's `as_json` writes it
 * @typedef {{streak: number, right: number, wrong: number, due: string}} Record_ right answers in a row, all answers, next day
 */

// ---- Judging: the twin of robonav/drills/question.py ------------------------------------------------------------------

const RIGHT = { right: true, hint: "" };
const wrongWith = (hint) => ({ right: false, hint: hint ?? "" });
const flat = (table) => table.flat();
const SLACK = 1e-7; // pages hold numbers with eight decimals
const near = (number, answer, tolerance) => Math.abs(number - answer) <= tolerance + SLACK;

/** How many decimals an answer needs: rounding to so many stays within the tolerance. 0 if none, or if it is exact. */
function decimalsNeeded(tolerance) {
  const count = Math.ceil(-Math.log10(2 * tolerance));
  return count > 0 && count < 9 ? count : 0;
}

/** A number of decimals in words. */
const inWords = (count) => `${["one", "two", "three", "four"][count - 1] ?? count} decimal${count > 1 ? "s" : ""}`;

/** Whether a number that is not right is the right one, rounded to fewer decimals than it needs. */
function roundedTooFar(given, answer, tolerance) {
  const isRounded = (k) => {
    const scaled = given * 10 ** k;
    return Math.abs(scaled - Math.round(scaled)) < 1e-6 && Math.abs(given - answer) <= 0.5 * 10 ** -k + 1e-9;
  };
  const first = Math.abs(answer) >= 1 ? 0 : 1; // 1 is no rounded probability
  for (let k = first; k < decimalsNeeded(tolerance); k += 1) if (given !== 0 && isRounded(k)) return true;
  return false;
}

const tooFar = (tolerance) => `This is rounded too far: give ${inWords(decimalsNeeded(tolerance))}.`;

const JUDGES = {
  number({ answer, tolerance, wrong }, given) {
    const is = (number) => near(number, given, tolerance);
    if (is(answer)) return RIGHT;
    const rounded = roundedTooFar(given, answer, tolerance) ? tooFar(tolerance) : "";
    return wrongWith(wrong.find(([, number]) => is(number))?.[0] ?? rounded);
  },
  choice: ({ right, hints }, given) => (given === right ? RIGHT : wrongWith(hints[given])),
  place: ({ right, hints }, given) => (right.includes(given) ? RIGHT : wrongWith(hints[given])),
  order({ before, hint }, given) {
    if (given.every((step, k) => step === k)) return RIGHT;
    const broken = before.find(([i, j]) => given.indexOf(i) > given.indexOf(j));
    return wrongWith(broken ? broken[2] : hint);
  },
  table({ answer, tolerance, wrong }, given) {
    const is = (a, b) => near(a, b, tolerance);
    const [own, right] = [flat(given), flat(answer)];
    const equals = (cells) => own.every((number, k) => is(number, cells[k]));
    const makesItsMistakes = (cells) => {
      const mistaken = own.filter((_, k) => !is(cells[k], right[k]));
      return mistaken.length > 0 && own.every((number, k) => is(cells[k], right[k]) || is(number, cells[k]));
    };
    if (equals(right)) return RIGHT;
    const isRounded = own.every((number, k) => is(number, right[k]) || roundedTooFar(number, right[k], tolerance));
    const hint = (agrees) => wrong.find(([, table]) => agrees(flat(table)))?.[0];
    return wrongWith(hint(equals) ?? (isRounded ? tooFar(tolerance) : hint(makesItsMistakes)));
  },
};

/** Whether an answer is right, and the hint of a usual mistake. @returns {Verdict} */
export const judge = (asked, given) => JUDGES[asked.kind](asked, given);

/** The number that a reader typed, with a point or a comma; NaN if it is none. */
export function typed(text) {
  const number = text.trim().replace(",", ".").replace("−", "-");
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(number) ? Number(number) : NaN;
}

// ---- Questions as they are stored ---------------------------------------------------------------------------------------

/** A text as pages show it: a formula, whose parts have spaces between them, stands in an element of its own. */
const withFormulas = (text) => text.replace(/\\\(.*?\\\)( \\\(.*?\\\))*/gs, '<span class="math inline">$&</span>');

/**
 * Questions as Python's `as_json` makes them, from what `packed` of the book's extension wrote.
 * A text such as "@3" stands for the fourth of the shared texts, and formulas have no elements around them.
 */
export function unpacked(value, texts) {
  if (typeof value === "string") return withFormulas(value.startsWith("@") ? texts[value.slice(1)] : value);
  if (Array.isArray(value)) return value.map((one) => unpacked(one, texts));
  if (value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, unpacked(one, texts)]));
}

// ---- Memory: what is mastered, and when it comes back -----------------------------------------------------------------

const KEY = "robonav-drills";
export const MASTERED = 3; // right answers in a row
export const DAYS = [1, 3, 7, 21, 60]; // until a mastered drill comes back, growing with each right answer

const NEW = { streak: 0, right: 0, wrong: 0, due: "" };
const day = (date) => date.toISOString().slice(0, 10);

/** What is known of a drill after one more answer. @returns {Record_} */
export function answered(record, right, today = new Date()) {
  const { streak, right: rights, wrong: wrongs } = record ?? NEW;
  if (!right) return { streak: 0, right: rights, wrong: wrongs + 1, due: day(today) };
  const wait = streak + 1 < MASTERED ? 0 : DAYS[Math.min(streak + 1 - MASTERED, DAYS.length - 1)];
  return { streak: streak + 1, right: rights + 1, wrong: wrongs, due: day(new Date(today.getTime() + wait * 864e5)) };
}

/** Whether a drill was begun and should be answered again by this day. */
export const isDue = (record, today = new Date()) => Boolean(record) && record.due <= day(today);

/** The drills of a list that are due: those that have waited longest first, and of equally late ones the first of the list. */
export function dueDrills(names, records, today = new Date()) {
  const due = names.filter((name) => isDue(records[name], today));
  return due.sort((a, b) => records[a].due.localeCompare(records[b].due));
}

/** In words, that no drill of a list is due. */
export function nothingDue(names, records) {
  const [next] = names.flatMap((name) => records[name]?.due ?? []).sort();
  return next
    ? `Nothing is due today. The next drill comes back on ${next}.`
    : "Nothing is due today, because you have not tried any drill yet.";
}

/** What is known of all drills by name; nothing if the browser keeps nothing. */
export function remembered() {
  try {
    return JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    return {};
  }
}

/** Keeps what is known; says whether that was possible. */
export function remember(records) {
  try {
    localStorage.setItem(KEY, JSON.stringify(records));
    return true;
  } catch {
    return false;
  }
}

/** In words, what is known of a drill. */
export function standing(record) {
  if (!record) return "not tried yet";
  if (record.streak >= MASTERED) return `mastered; comes back on ${record.due}`;
  return record.streak ? `${record.streak} right in a row; ${MASTERED} are mastered` : "not mastered yet";
}

// ---- The ways to answer -----------------------------------------------------------------------------------------------

/** An element whose content is HTML of the book's own. */
const rich = (tag, text, attributes = {}) => {
  const element = h(tag, attributes);
  element.innerHTML = text;
  return element;
};

/** A field for a number. */
const numberField = (label) =>
  h("input", { type: "text", inputmode: "decimal", autocomplete: "off", "aria-label": label, size: 8 });

/**
 * How many decimals the numbers of an answer need, in words. Empty where the question says it, or all numbers are whole.
 * @param {Question} question
 */
export function decimals({ text, asked: { answer, tolerance, wrong } }) {
  const numbers = [answer, ...wrong.map(([, number]) => number)].flat(2);
  const count = decimalsNeeded(tolerance);
  return text.includes("decimal") || numbers.every(Number.isInteger) || count === 0 ? "" : `(${inWords(count)})`;
}

/**
 * Each kind of answer: its element, and `read()`, which gives the answer or a sentence about what is missing.
 * @type {Record<string, (question: Question, name: string) => {element: Element, read: () => any}>}
 */
const FORMS = {
  number(question) {
    const { unit } = question.asked;
    const field = numberField("Your answer");
    return {
      element: h("label", { class: "number" }, "Your answer: ", field, unit ? ` ${unit} ` : " ", decimals(question)),
      read: () => (Number.isNaN(typed(field.value)) ? "Type a number, such as 0.25." : { answer: typed(field.value) }),
    };
  },
  choice({ asked }, name) {
    const inputs = asked.options.map((_, k) => h("input", { type: "radio", name, value: k }));
    const labels = asked.options.map((option, k) => h("label", {}, inputs[k], rich("span", option)));
    return {
      element: h("fieldset", {}, h("legend", {}, "Choose one"), ...labels),
      read() {
        const chosen = inputs.findIndex((input) => input.checked);
        return chosen < 0 ? "Choose an answer." : { answer: chosen };
      },
    };
  },
  place() {
    const said = h("p", { class: "chosen", role: "status" }, "Click on a place in the picture, or move to it with Tab and press Enter.");
    let chosen = null;
    const choose = (group, groups) => {
      chosen = group.dataset.place;
      for (const one of groups) one.setAttribute("aria-pressed", String(one === group));
      said.textContent = `You chose ${chosen}.`;
    };
    const wire = (picture) => {
      const groups = [...picture.querySelectorAll(".place")];
      for (const group of groups) {
        set(group, { tabindex: 0, role: "button", "aria-pressed": "false", "aria-label": group.dataset.place });
        group.addEventListener("click", () => choose(group, groups));
        group.addEventListener("keydown", (event) => {
          if (event.key !== "Enter" && event.key !== " ") return;
          event.preventDefault();
          choose(group, groups);
        });
      }
    };
    return { element: said, wire, read: () => (chosen === null ? "Choose a place in the picture." : { answer: chosen }) };
  },
  order({ asked }) {
    const order = disordered(asked.steps.length);
    const list = h("ol", { class: "steps" });
    const texts = asked.steps.map((step, k) => rich("span", step, { "data-step": k })); // made once: formulas stay typeset
    const move = (k, by) => {
      const to = k + by;
      if (to < 0 || to >= order.length) return;
      [order[k], order[to]] = [order[to], order[k]];
      draw();
      list.children[to].querySelector(by < 0 ? ".up" : ".down").focus();
    };
    const draw = () =>
      list.replaceChildren(
        ...order.map((step, k) =>
          h("li", {},
            h("button", { type: "button", class: "up", "aria-label": `Move step ${k + 1} up`, click: () => move(k, -1) }, "↑"),
            h("button", { type: "button", class: "down", "aria-label": `Move step ${k + 1} down`, click: () => move(k, 1) }, "↓"),
            texts[step]),
        ),
      );
    draw();
    return { element: list, read: () => ({ answer: [...order] }) };
  },
  table(question) {
    const { asked } = question;
    const fields = asked.rows.map(() => asked.columns.map((_, j) => numberField(`column ${j + 1}`)));
    const head = h("tr", {}, h("td"), ...asked.columns.map((column) => rich("th", column, { scope: "col" })));
    const rows = asked.rows.map((row, i) =>
      h("tr", {}, rich("th", row, { scope: "row" }), ...fields[i].map((field) => h("td", {}, field))),
    );
    return {
      element: h("div", { class: "scroll" }, h("table", {}, h("tbody", {}, head, ...rows)), decimals(question)),
      read() {
        const answer = fields.map((row) => row.map((field) => typed(field.value)));
        return answer.flat().some(Number.isNaN) ? "Type a number into each cell." : { answer };
      },
    };
  },
};

/** The same things in a random order. */
function shuffled(things) {
  const mixed = [...things];
  for (let k = mixed.length - 1; k > 0; k -= 1) {
    const other = Math.floor(Math.random() * (k + 1));
    [mixed[k], mixed[other]] = [mixed[other], mixed[k]];
  }
  return mixed;
}

/** Steps 0, 1, ... in a random order that is not the right one. */
function disordered(count) {
  const right = Array.from({ length: count }, (_, k) => k);
  const order = shuffled(right);
  return order.every((step, k) => step === k) ? [...order.slice(1), order[0]] : order;
}

// ---- A drill ----------------------------------------------------------------------------------------------------------

const typeset = (element) => globalThis.MathJax?.typesetPromise?.([element]);

/**
 * Draws a drill into a place: question after question.
 * @param {HTMLElement} place
 * @param {{name: string, questions: Question[], told?: () => void}} drill `told` is called after each answer that counts
 */
export function drawDrill(place, { name, questions, told = () => {} }) {
  const turn = shuffled(questions.map((_, k) => k));
  const state = h("p", { class: "standing" });
  const body = h("div");
  place.replaceChildren(body, state);
  const stand = () => (state.textContent = `This drill: ${standing(remembered()[name])}.`);

  const ask = (k) => {
    const index = turn[k % turn.length];
    const question = questions[index];
    const form = FORMS[question.asked.kind](question, `${name}-${k}`);
    const verdict = h("p", { class: "verdict", role: "status" });
    const picture = rich("div", question.picture, { class: "picture" });
    form.wire?.(picture);
    let counted = false; // the first answer to a question counts
    const count = (right) => {
      if (counted) return;
      counted = true;
      const records = remembered();
      const kept = remember({ ...records, [name]: answered(records[name], right) });
      if (kept) stand();
      else state.textContent = "This browser keeps nothing, so what you master is not remembered.";
      told();
    };
    const explain = () => {
      count(false);
      solution.hidden = false;
      show.disabled = true;
      check.disabled = true;
    };
    const submit = (event) => {
      event.preventDefault();
      const read = form.read();
      if (typeof read === "string") {
        verdict.textContent = read;
        verdict.className = "verdict";
        return;
      }
      const { right, hint } = judge(question.asked, read.answer);
      count(right);
      verdict.className = `verdict ${right ? "right" : "wrong"}`;
      verdict.innerHTML = right ? "Right." : `No. ${hint || "Try again, or look at the solution."}`;
      if (right) explain();
      typeset(verdict);
    };
    const check = h("button", { type: "submit" }, "Check");
    const show = h("button", { type: "button", click: explain }, "Show the solution");
    const next = h("button", { type: "button", click: () => ask(k + 1) }, "Next question");
    const solution = h("div", { class: "solution", hidden: true }, rich("p", question.explanation));
    const asked = h("form", { submit, class: "asked", "data-question": index },
      rich("p", question.text), ...(question.picture ? [picture] : []), form.element,
      h("div", { class: "buttons" }, check, show, next), verdict, solution);
    body.replaceChildren(asked);
    typeset(asked);
    if (k > 0) asked.querySelector("input, button, [tabindex]")?.focus({ preventScroll: true });
  };
  stand();
  ask(0);
}
