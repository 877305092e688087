// The drills of a page, and the page of progress. A drill's questions are a script of their own, loaded when it is opened.

const waiting = new Map();

/** Called by the script of a drill. */
globalThis.robonavDrill = (name, questions, texts) => waiting.get(name)?.(unpacked(questions, texts));

/** The questions of a drill, by a script, since a page that was opened from disk may load nothing else. */
function load(name, address) {
  return new Promise((resolve, reject) => {
    waiting.set(name, resolve);
    document.head.append(h("script", { src: address, error: () => reject(new Error(address)) }));
  });
}

/** Draws the drill of an element when it is opened for the first time. */
function open(element, told) {
  const { drill: name, source } = element.dataset;
  const place = element.querySelector(".drill-place");
  load(name, source)
    .then((questions) => drawDrill(place, { name, questions, told }))
    .catch(() => place.replaceChildren("The questions of this drill are missing beside the page."));
}

/** How many drills of a list are mastered, due and new. */
function summary(names) {
  const records = names.map((name) => remembered()[name]);
  const mastered = records.filter((record) => record?.streak >= MASTERED).length;
  const due = records.filter((record) => isDue(record)).length;
  return `${mastered} of ${names.length} mastered, ${due} due today.`;
}

/** Lists the drills that are due, each with a link that opens it on this page. */
function listDue(place, drills) {
  const records = remembered();
  const titles = new Map(drills.map((element) => [element.dataset.drill, element.querySelector("summary").firstChild.textContent]));
  const names = [...titles.keys()];
  const items = dueDrills(names, records).map((name) =>
    h("li", {}, h("a", { href: `#drill-${name}` }, titles.get(name)), ` (${standing(records[name])})`));
  place.replaceChildren(items.length > 0 ? h("ul", {}, ...items) : h("p", {}, nothingDue(names, records)));
}

document.addEventListener("DOMContentLoaded", () => {
  const drills = [...document.querySelectorAll("details.drill")];
  const tell = () => {
    for (const element of drills) {
      const record = remembered()[element.dataset.drill];
      element.querySelector(".drill-standing").textContent = standing(record);
      element.classList.toggle("mastered", record?.streak >= MASTERED);
      element.classList.toggle("due", isDue(record));
    }
    for (const list of document.querySelectorAll(".drills-summary")) {
      list.textContent = summary(list.dataset.drills.split(" "));
    }
    for (const place of document.querySelectorAll(".drills-due")) listDue(place, drills);
  };
  for (const element of drills) {
    const unfolded = () => {
      if (!element.open) return; // folded again at once: one event for both
      element.removeEventListener("toggle", unfolded);
      open(element, tell);
    };
    element.addEventListener("toggle", unfolded);
  }
  const unfoldLinked = () => {
    const linked = document.getElementById(location.hash.slice(1));
    if (drills.includes(linked)) linked.open = true;
  };
  unfoldLinked();
  addEventListener("hashchange", unfoldLinked);
  tell();
  addEventListener("pageshow", tell); // the reader comes back to a page that was kept as it was
  addEventListener("storage", tell); // a question was answered in another tab
});
