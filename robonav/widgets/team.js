// Several robots on one map: where they begin, what stands in their way there, and how they fare. Needs simulator.js.

export const MOST_ROBOTS = 16;
const INSET = 10; // metres from the border to the starts
const ROOM = 2; // metres that a start and a target have around them

/** A number's binary digits mirrored at the point: 0, 1/2, 1/4, 3/4, 1/8, ... @param {number} number */
function radicalInverse(number) {
  let mirrored = 0;
  for (let [left, half] = [number, 0.5]; left > 0; [left, half] = [Math.floor(left / 2), half / 2]) mirrored += half * (left % 2);
  return mirrored;
}

/**
 * Starts and targets of robots that cross in the middle, as `robonav.robot.team.crossing` places them.
 * @returns {{start: number[], target: number[]}[]}
 */
export function crossing(robots, size) {
  const side = size - 2 * INSET;
  const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map((corner) => corner.map((part) => INSET + side * part));
  return Array.from({ length: robots }, (_, k) => {
    const around = 4 * radicalInverse(k);
    const [edge, along] = [Math.floor(around), around % 1];
    const start = corners[edge].map((from, axis) => from + along * (corners[(edge + 1) % 4][axis] - from));
    return { start, target: start.map((place) => size - place) };
  });
}

/** A world without the obstacles that stand on a start or a target of its further robots. @param {World} world @returns {World} */
export const clearedFor = (world, others) => ({ ...world, obstacles: world.obstacles.filter((o) =>
  others.every(({ start, target }) => [start, target].every(([x, y]) => sweptDistance(o, o, x, y, x, y) >= ROOM))) });

/** How many robots have arrived, have collided, and are still on their way. @param {Robot[]} robots */
export function tallyOf(robots) {
  const count = (is) => robots.filter(is).length;
  const [arrived, collided, met] = [({ outcome }) => outcome === "arrived", ({ outcome }) => outcome === "collided", (robot) => robot.met].map(count);
  return { arrived, collided, met, running: robots.length - arrived - collided };
}

/** The tally in words. */
export const tallyWords = ({ arrived, collided, met, running }) =>
  [`${arrived} arrived`, `${collided} collided${collided ? ` (${met} with a robot)` : ""}`, ...(running ? [`${running} on the way`] : [])].join(", ");
