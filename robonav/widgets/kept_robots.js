// Robots that the reader has trained: kept in the browser, so that other pages can try them, train them on, and list them. Needs files.js.

const ROBOTS = browserStore("robonav.robot.", { what: "your robots", advice: "Delete some robots, or download them." });
const LEARNING_OUTPUTS = 5; // the actions that are learned

/**
 * @typedef {{name: string, network: Network, encoder: Encoder, method?: string, temperature?: number, about?: string, made?: Record<string, any>}} KeptRobot
 *   about: how it was trained, in whole sentences; made: the same as numbers and names, for a file
 */

/** A name that no robot has yet: the given one, or with the next number behind it. @param {string} name @param {string[]} taken */
export function distinctName(name, taken) {
  const rest = taken.filter((other) => other.startsWith(name)).map((other) => other.slice(name.length));
  const numbers = rest.map((end) => (end === "" ? 1 : Number(/^ \((\d+)\)$/.exec(end)?.[1] ?? 0)));
  const last = Math.max(0, ...numbers);
  return last ? `${name} (${last + 1})` : name;
}

/** The number of the next robot: one more than the largest in names such as "robot 3: ...". @param {string} kind @param {string[]} names */
export function nextNumber(kind, names) {
  const numbers = names.map((name) => (name.startsWith(`${kind} `) ? parseInt(name.slice(kind.length + 1), 10) || 0 : 0));
  return 1 + Math.max(0, ...numbers);
}

/** A robot's name in that of another: what stands before its colon, or its first letters. @param {string} name */
export function shortName(name) {
  const [first] = name.split(":");
  return first.length > 24 ? `${first.slice(0, 23)}…` : first;
}

/** A network as the browser keeps it. @param {Network} network */
const plain = ({ sizes, weights, biases }) => ({ sizes: [...sizes], weights: weights.map((part) => [...part]), biases: biases.map((part) => [...part]) });

/** Keeps a robot, with a number behind a name that another has; returns a sentence where the browser would not keep it. @param {KeptRobot} robot */
export function keepRobot({ name, network, encoder, method = "own", temperature = 0, about = "", made = {} }) {
  const robot = { name: distinctName(name, keptRobots().map((other) => other.name)), network: plain(network), encoder, method, temperature, about, made };
  return ROBOTS.keep([JSON.stringify(robot)]);
}

/** The robot in a text, or null where it holds none. */
function robotOfText(text) {
  try {
    const robot = JSON.parse(text);
    const { sizes, weights } = robot.network;
    return weights.length === sizes.length - 1 && sizes[0] === encoderSize(robot.encoder) ? robot : null;
  } catch {
    return null;
  }
}

/** All robots, the oldest first. @returns {(KeptRobot & {id: string})[]} */
export const keptRobots = () => ROBOTS.all().map(([id, text]) => ({ id, ...robotOfText(text) })).filter(({ network }) => network);

/** Gives a kept robot another name. @param {KeptRobot & {id: string}} robot @param {string} name */
export function renameRobot({ id, ...robot }, name) {
  const others = keptRobots().filter((other) => other.id !== id).map((other) => other.name);
  return ROBOTS.put(id, JSON.stringify({ ...robot, name: others.includes(name) ? distinctName(name, others) : name }));
}

/** Deletes some robots. @param {string[]} ids */
export const deleteRobots = (ids) => ROBOTS.remove(ids);

/** Brings back a robot that was deleted. @param {KeptRobot & {id: string}} robot */
export const bringBackRobot = ({ id, ...robot }) => ROBOTS.put(id, JSON.stringify(robot));

/** Calls a function whenever the robots change; returns a function that ends this. */
export const watchRobots = (listener) => ROBOTS.watch(listener);

/** A robot as a file of weights that says how it was made. @param {KeptRobot} robot */
export const robotFile = ({ name, about = "", made = {}, method = "own", ...policy }) => weightsFile({ ...policy, method }, { name, about, ...made });

// ---- Seen by the reader ---------------------------------------------------------------------------------------------

const LONGEST_NAME = 120; // letters

/** Every robot of the reader: to see how it was trained, to rename, download and delete; what was deleted can be brought back. */
export function robotsList() {
  const heading = h("summary", {});
  const list = h("ul", { class: "robots", "aria-label": "Your robots" });
  const told = h("span", { role: "status" });
  let [renamed, deleted] = ["", null]; // the robot whose name is being changed, and the one that can be brought back
  const say = (sentence, robot = null) => {
    told.textContent = sentence;
    deleted = robot;
    undo.hidden = robot === null;
  };
  const undo = h("button", { type: "button", hidden: true, click: () => {
    const robot = deleted;
    say(`${robot.name} is back. ${bringBackRobot(robot)}`.trim());
    heading.focus();
  } }, "Undo");
  /** The name of a robot, or a field for another one. */
  const named = (robot) => {
    if (renamed !== robot.id) return [h("b", {}, robot.name)];
    const end = () => {
      renamed = "";
      show();
      list.querySelector(`[data-id="${robot.id}"] button`)?.focus();
    };
    const field = h("input", { type: "text", value: robot.name, maxlength: LONGEST_NAME, "aria-label": `new name of ${robot.name}`, keydown: ({ key }) => key === "Escape" && end() });
    const form = h("form", { class: "row", submit: (event) => {
      event.preventDefault();
      const name = field.value.trim();
      if (name === "") return say("A robot needs a name.");
      say(name === robot.name ? "" : renameRobot(robot, name) || `${robot.name} has a new name.`);
      return end();
    } }, field, h("button", { type: "submit" }, "Save the name"), h("button", { type: "button", click: end }, "Cancel"));
    return [form];
  };
  const item = (robot) => {
    const button = (verb, click) => h("button", { type: "button", "aria-label": `${verb} ${robot.name}`, click }, verb);
    return h("li", { "data-id": robot.id }, ...named(robot), h("p", { class: "label" }, robot.about || "Nothing is noted of its training."),
      ...(renamed === robot.id ? [] : [h("div", { class: "row" },
        button("Rename", () => {
          renamed = robot.id;
          show();
          list.querySelector("input").focus();
        }),
        button("Download", () => saveFile(`${robot.name.replace(/[^\w.-]+/g, "-").slice(0, 60)}.safetensors`, robotFile(robot))),
        button("Delete", () => {
          deleteRobots([robot.id]);
          say(`${robot.name} is deleted. `, robot);
          undo.focus();
        }))]));
  };
  const show = () => {
    const robots = keptRobots().reverse();
    heading.textContent = `My robots (${robots.length})`;
    list.replaceChildren(...robots.map(item));
    list.hidden = robots.length === 0;
  };
  show();
  const none = "A robot that you train on a page of chapter 3, 4 or 5 is kept in this browser and listed here.";
  const element = h("details", { class: "my-robots" }, heading, h("p", { class: "label" }, none), list, h("p", { class: "heard" }, told, undo));
  return { element, end: watchRobots(show) };
}

const FRESH = "random weights";

/**
 * What a training begins with: random weights, those of a robot that the reader has trained, or those in a file.
 * @param {{change: () => void}} options `change` is called at each choice
 * @returns {{element: Element, value: () => KeptRobot | null, end: () => void}} `value` is null for random weights
 */
export function beginning({ change }) {
  let [brought, chosen] = [[], null]; // from files, and what the training begins with
  const told = h("span", { role: "status" });
  const list = h("select", { "aria-label": "begin with", change: () => {
    chosen = list.selectedIndex > 0 ? robots()[list.selectedIndex - 1] : null;
    change();
  } });
  const robots = () => [...brought, ...keptRobots().reverse().filter(({ network }) => network.sizes.at(-1) === LEARNING_OUTPUTS)];
  const fill = () => {
    const all = robots();
    list.replaceChildren(h("option", {}, FRESH), ...all.map(({ name }) => h("option", {}, name)));
    list.disabled = all.length === 0;
    const at = chosen ? all.findIndex(({ id }) => id === chosen.id) : -1;
    list.selectedIndex = at + 1;
    if (!chosen || at >= 0) return;
    chosen = null; // it was deleted
    change();
  };
  const upload = h("input", { type: "file", accept: ".safetensors", "aria-label": "Weights to begin with", change: async () => {
    const [file] = upload.files;
    if (!file) return;
    try {
      const { network, ...about } = weightsFromFile(await file.arrayBuffer());
      const outputs = network.sizes.at(-1);
      if (outputs !== LEARNING_OUTPUTS) throw new Error(`The network in ${file.name} has ${outputs} outputs, and a robot that learns chooses among ${LEARNING_OUTPUTS} actions.`);
      const name = distinctName(file.name, robots().map((other) => other.name));
      chosen = { ...about, id: `file ${name}`, name, network: plain(networks(network)()) };
      brought = [chosen, ...brought];
      told.textContent = `The training begins with ${name}.`;
      fill();
      change();
    } catch (error) {
      told.textContent = error.message;
    }
    upload.value = "";
  } });
  fill();
  const element = h("div", { class: "row tools" }, h("label", {}, h("span", {}, "begin with"), list),
    h("label", { class: "file" }, h("span", {}, "or with weights from a file (safetensors)"), upload), told);
  return { element, value: () => chosen, end: watchRobots(fill) };
}
