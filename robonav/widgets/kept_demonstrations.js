// The reader's own demonstrations: kept in the browser, listed, deleted, downloaded and loaded. Needs files.js, random.js, worlds.js.

const FIRST_MAP = 500_000; // the reader's map n is the world of the seed FIRST_MAP + n; training and tests have small seeds

/** The map of a number that readers drive. @returns {World} */
export const ownMap = (number, obstacles = 10) => randomWorlds(1, { obstacles, seed: FIRST_MAP + number })[0];

/** The steps to learn from: something in range, and one of the five learned actions. @param {Demonstration} demonstration */
export const effective = ({ steps }) => steps.filter(({ sensing, action }) => action < 5 && sensing.ranges.some((distance) => distance < ROBOT.range));

// ---- Demonstrations as text -------------------------------------------------------------------------------------------------

/** A demonstration as a short text. @param {Demonstration & {map?: number}} demonstration */
export function demonstrationText({ world, speed, steps, outcome, map = null }) {
  const bits = (flags) => flags.reduce((sum, flag, k) => sum + (flag ? 2 ** k : 0), 0);
  return JSON.stringify({
    world, speed, outcome, map,
    actions: steps.map(({ action }) => action),
    poses: steps.map(({ pose }) => [pose.x, pose.y, pose.heading]),
    ranges: steps.map(({ sensing }) => sensing.ranges),
    walls: steps.map(({ sensing }) => bits(sensing.walls)),
    regions: steps.map(({ sensing }) => sensing.region),
    seen: steps.map(({ sensing }) => (sensing.seen ? 1 : 0)),
  });
}

/** The demonstration in a text, or null where it holds none. */
export function demonstrationOfText(text) {
  try {
    const { actions, poses, ranges, walls, regions, seen, ...demonstration } = JSON.parse(text);
    const steps = actions.map((action, k) => ({
      pose: { x: poses[k][0], y: poses[k][1], heading: poses[k][2] },
      sensing: { ranges: ranges[k], walls: Array.from({ length: 9 }, (_, s) => (walls[k] & (2 ** s)) > 0), region: regions[k], seen: seen[k] === 1 },
      action,
    }));
    return demonstration.world.obstacles && demonstration.outcome in OUTCOME_CODES ? { ...demonstration, steps } : null;
  } catch {
    return null;
  }
}

// ---- The store ------------------------------------------------------------------------------------------------------

// The key is older than the name: readers have demonstrations under it.
const KEPT_DEMONSTRATIONS = browserStore("robonav.drive.", { what: "your demonstrations", advice: "Delete some demonstrations, or download them." });

/** All demonstrations, the oldest first. @returns {(Demonstration & {id: string, map: number | null})[]} */
export const keptDemonstrations = () => KEPT_DEMONSTRATIONS.all().map(([id, text]) => ({ id, ...demonstrationOfText(text) })).filter(({ steps }) => steps);

/** What tells demonstrations apart: speed, target, and each pose and action. @param {Demonstration} demonstration */
const mark = ({ speed, world, steps }) => JSON.stringify([speed, world.target, steps.map(({ pose, action }) => [pose.x.toFixed(6), pose.y.toFixed(6), action])]);

/**
 * Keeps the demonstrations that are not kept yet.
 * @param {Demonstration[]} demonstrations
 * @returns {{added: number, warning: string}} how many are new, and a sentence where the browser would not keep them
 */
export function keepDemonstrations(demonstrations) {
  const marks = new Set(keptDemonstrations().map(mark));
  const fresh = demonstrations.filter((demonstration) => !marks.has(mark(demonstration)) && marks.add(mark(demonstration)));
  return { added: fresh.length, warning: fresh.length ? KEPT_DEMONSTRATIONS.keep(fresh.map(demonstrationText)) : "" };
}

/** Deletes some demonstrations. @param {string[]} ids */
export const deleteDemonstrations = (ids) => KEPT_DEMONSTRATIONS.remove(ids);

/** Calls a function whenever the demonstrations change, in this page or another; returns a function that ends this. */
export const watchDemonstrations = (listener) => KEPT_DEMONSTRATIONS.watch(listener);

/** The number of the next map to drive: one more than the largest that was driven. */
export const nextMap = (demonstrations) => 1 + Math.max(0, ...demonstrations.map(({ map }) => map ?? 0));

// ---- What makes demonstrations poor examples ----------------------------------------------------------------------

const FEW_DEMONSTRATIONS = 3; // as many as the pages recommend at first
const FEW_STEPS = 6; // steps of a demonstration to learn from
const WANDERING = 1.5; // times the straight line
const TURNS = 0.2; // share of turns among the steps to learn from

/** How demonstrations were made: steps to learn from in a demonstration, length over the straight line, and the share of turns among the steps to learn from. */
export function drivingStyle(demonstrations) {
  const total = (numbers) => numbers.reduce((sum, number) => sum + number, 0);
  const direct = total(demonstrations.map(({ world: { start, target } }) => Math.hypot(target[0] - start[0], target[1] - start[1])));
  const steps = demonstrations.flatMap(effective);
  return {
    steps: steps.length / Math.max(1, demonstrations.length),
    length: total(demonstrations.map(({ speed, steps: all }) => speed * all.length)) / Math.max(1, direct),
    turns: steps.filter(({ action }) => action > 0).length / Math.max(1, steps.length),
  };
}

const WORDS = ["none", "one", "two", "three"];

/**
 * What would help a robot that learned from these demonstrations and is no better than one that always goes straight on, in one sentence.
 * @param {Demonstration[]} learned the demonstrations that it learned from @param {Demonstration[]} all all demonstrations of the reader
 */
export function adviceOn(learned, all) {
  const arrived = all.filter(({ outcome }) => outcome === "arrived").length;
  if (learned.length < Math.min(FEW_DEMONSTRATIONS, arrived)) return `It learned from ${WORDS[learned.length]} of your ${arrived} demonstrations that arrived: choose more of them.`;
  if (arrived < FEW_DEMONSTRATIONS) {
    const missing = `bring the robot to its target in ${WORDS[FEW_DEMONSTRATIONS - arrived]} more ${FEW_DEMONSTRATIONS - arrived === 1 ? "map" : "maps"}`;
    return arrived < all.length ? `Only ${arrived} of your ${all.length} demonstrations arrived, and a robot learns from no others: ${missing}.` : `Three demonstrations are enough for a first robot: ${missing}.`;
  }
  const { steps, length, turns } = drivingStyle(learned);
  if (length > WANDERING) return `Your demonstrations are ${length.toFixed(1)} times as long as the straight line, and the robot learned to wander: drive again, and turn only where something is in the way.`;
  if (steps < FEW_STEPS) return `Your demonstrations have only ${Math.round(steps)} steps each with something in range, and the robot learns from no others: drive maps in which obstacles stand in the way.`;
  if (turns < TURNS) return `You turned in only ${Math.round(100 * turns)} % of the steps with something in range, and the robot learned to go straight on: turn as soon as something is in the way.`;
  if (arrived < all.length - arrived) return `More of your demonstrations collided than arrived: drive at a larger distance from the obstacles, and turn earlier.`;
  return "Drive more maps, turn earlier and at a larger distance from the obstacles, and turn alike in like places.";
}

// ---- Seen by the reader ---------------------------------------------------------------------------------------------

const ENDS = { arrived: "arrived", collided: "collided", running: "given up" };

/**
 * What is said after a demonstration: whether it is kept, how many there are, and how a robot is trained on them.
 * @param {{added: number, warning: string}} kept what `keepDemonstrations` returned
 * @param {{what?: string, training: string, next: string | Element}} words what was made, the page that trains, what else there is to do
 */
export function keptWords({ added, warning }, { what = "demonstration", training, next }) {
  const demonstrations = keptDemonstrations();
  const [count, arrived] = [demonstrations.length, demonstrations.filter(({ outcome }) => outcome === "arrived").length];
  const have = count === 1 ? "It is your first." : `You have ${count} now.`;
  const lost = arrived < count ? `A robot learns only from demonstrations that arrive: ${arrived || "none"} so far. ` : "";
  const missing = FEW_DEMONSTRATIONS - arrived;
  const advice = [lost, missing > 0 ? `Bring the robot to its target in ${WORDS[missing]} more ${missing === 1 ? "map" : "maps"}, and you can train one of your own. ` : ""];
  if (warning) return [`${warning} ${have} To train a robot on another page, press Download all, and load the file there.`];
  const kept = added ? `This ${what} is kept.` : `You made exactly this ${what} before, and it is kept.`;
  const train = missing <= 0 ? [h("a", { href: training }, "Train a robot on your demonstrations"), typeof next === "string" ? ", or " : " "] : [];
  if (typeof next !== "string") return [`${kept} ${have} `, ...advice, ...train, next];
  return [`${kept} ${have} `, ...advice, ...train, missing <= 0 ? `${next}.` : `${next[0].toUpperCase()}${next.slice(1)}.`];
}

/** A number of demonstrations, in words. */
const demonstrationsCount = (count) => `${count} ${count === 1 ? "demonstration" : "demonstrations"}`;

/** A small picture of a demonstration. @param {Demonstration} demonstration */
export function demonstrationPicture({ world: { size, start, target, obstacles }, steps, outcome }, side = 96) {
  const shapes = obstacles.map(({ circle, x, y, a, b, turned, speed }) => {
    const fill = speed > 0 ? PALETTE.MOVING : PALETTE.OBSTACLE;
    return circle ? svg("circle", { cx: x, cy: y, r: a, fill })
      : svg("rect", { x: -a, y: -b, width: 2 * a, height: 2 * b, fill, transform: `translate(${x} ${y}) rotate(${(turned * 180) / Math.PI})` });
  });
  const path = steps.map(({ pose }) => `${pose.x.toFixed(1)} ${pose.y.toFixed(1)}`);
  if (outcome === "arrived") path.push(`${target[0]} ${target[1]}`);
  const colour = outcome === "collided" ? PALETTE.VERMILION : PALETTE.BLUE;
  return svg("svg", { viewBox: `0 0 ${size} ${size}`, width: side, height: side, "aria-hidden": "true", class: "demonstration-picture" },
    svg("g", { transform: `translate(0 ${size}) scale(1 -1)` }, ...shapes,
      svg("path", { d: path.length ? `M${path.join("L")}` : "", fill: "none", stroke: colour, "stroke-width": 2.2 }),
      svg("circle", { cx: start[0], cy: start[1], r: 2.4, fill: PALETTE.ROBOT }),
      svg("circle", { cx: target[0], cy: target[1], r: 3, fill: "none", stroke: PALETTE.TARGET, "stroke-width": 1.6 })));
}

/** Every demonstration of the reader, to see, delete, download and load; `said` is the line that tells of it, to be placed. */
export function demonstrationsList() {
  const said = h("p", { class: "status kept", role: "status" });
  const heading = h("summary", {});
  const list = h("ul", { class: "demonstrations", "aria-label": "Your demonstrations", tabindex: 0 });
  const told = h("p", { class: "heard", role: "status" }); // beside the buttons and the chooser
  const upload = h("input", { type: "file", accept: ".npz", "aria-label": "File of demonstrations", change: async () => {
    const [file] = upload.files;
    if (!file) return;
    try {
      const demonstrations = await demonstrationsFromFile(await file.arrayBuffer());
      const { added, warning } = keepDemonstrations(demonstrations);
      const known = demonstrations.length - added;
      const sentence = known === 0 ? `${file.name}: ${demonstrationsCount(added)} loaded.`
        : `${file.name} holds ${demonstrationsCount(demonstrations.length)}: ${added || "none"} of them new, ${known} kept already.`;
      told.textContent = `${sentence} ${warning}`.trim();
    } catch (error) {
      told.textContent = error.message;
    }
    upload.value = "";
  } });
  const download = h("button", { type: "button", click: () => {
    const sorts = Map.groupBy ? Map.groupBy(keptDemonstrations(), sort) : keptDemonstrations().reduce((all, demonstration) => all.set(sort(demonstration), [...(all.get(sort(demonstration)) ?? []), demonstration]), new Map());
    sorts.forEach((demonstrations, name) => saveFile(sorts.size === 1 ? "my-demonstrations.npz" : `my-demonstrations-${name}.npz`, demonstrationsFile(demonstrations)));
    if (sorts.size > 1) told.textContent = "A file for each speed: a file of demonstrations has one.";
  } }, "Download all");
  const sort = ({ speed, world }) => `${speed}-m-s${world.size === 100 ? "" : `-${world.size}-m`}`;
  let asked = false;
  const clear = h("button", { type: "button", click: () => {
    if (asked) {
      deleteDemonstrations(keptDemonstrations().map(({ id }) => id));
      told.textContent = "All demonstrations are deleted.";
      return;
    }
    asked = true;
    told.textContent = "This deletes every demonstration that is listed here.";
    clear.textContent = "Press again to delete them all";
  }, blur: () => {
    asked = false;
    clear.textContent = "Delete all";
  } }, "Delete all");
  const show = () => {
    const demonstrations = keptDemonstrations();
    heading.textContent = `My demonstrations (${demonstrations.length})`;
    list.replaceChildren(...demonstrations.map((demonstration, k) => {
      const title = demonstration.map ? `map ${demonstration.map}` : `demonstration ${k + 1}`;
      return h("li", {}, demonstrationPicture(demonstration), h("span", {}, h("b", {}, title), h("br"), `${ENDS[demonstration.outcome]} after ${demonstration.steps.length} s`, h("br"), demonstration.outcome === "arrived" ? `${effective(demonstration).length} steps to learn from` : "left out of learning"),
        h("button", { type: "button", "aria-label": `Delete ${title}`, click: () => {
          deleteDemonstrations([demonstration.id]);
          told.textContent = `${title} is deleted.`;
          list.focus();
        } }, "Delete"));
    }));
    list.hidden = demonstrations.length === 0;
    for (const button of [download, clear]) button.disabled = demonstrations.length === 0;
    asked = false;
    clear.textContent = "Delete all";
  };
  show();
  const element = h("details", { class: "my-demonstrations" }, heading, list,
    h("div", { class: "row tools" }, download, clear, h("label", { class: "file" }, h("span", {}, "load demonstrations (npz)"), upload)), told);
  return { element, said, say: (...words) => said.replaceChildren(...words), end: watchDemonstrations(show) };
}
