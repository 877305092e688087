// Robots that the reader has trained: kept in the browser, so that other pages can try them. Needs files.js.

const ROBOTS = browserStore("robonav.robot.", { what: "your robots", advice: "Delete some robots, or download them." });

/**
 * @typedef {{name: string, network: Network, encoder: Encoder, temperature?: number}} KeptRobot
 */

/** A name that no robot has yet: the given one, or with the next number behind it. @param {string} name @param {string[]} taken */
export function distinctName(name, taken) {
  const rest = taken.filter((other) => other.startsWith(name)).map((other) => other.slice(name.length));
  const numbers = rest.map((end) => (end === "" ? 1 : Number(/^ \((\d+)\)$/.exec(end)?.[1] ?? 0)));
  const last = Math.max(0, ...numbers);
  return last ? `${name} (${last + 1})` : name;
}

/** Keeps a robot, with a number behind a name that another has; returns a sentence where the browser would not keep it. @param {KeptRobot} robot */
export function keepRobot({ name, network: { sizes, weights, biases }, encoder, temperature = 0 }) {
  const plain = { sizes, weights: weights.map((part) => [...part]), biases: biases.map((part) => [...part]) };
  return ROBOTS.keep([JSON.stringify({ name: distinctName(name, keptRobots().map((robot) => robot.name)), network: plain, encoder, temperature })]);
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

/** Deletes some robots. @param {string[]} ids */
export const deleteRobots = (ids) => ROBOTS.remove(ids);

/** Calls a function whenever the robots change; returns a function that ends this. */
export const watchRobots = (listener) => ROBOTS.watch(listener);
