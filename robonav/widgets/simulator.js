// The simulator in the page: robonav/robot/_fast and its team in JavaScript, held to Python by replayed episodes.

/**
 * @typedef {{circle: boolean, x: number, y: number, a: number, b: number, turned: number, speed: number, heading: number}} Obstacle
 *   circle: a is its radius; rectangle: a and b are half its sides, turned in radians
 * @typedef {{size: number, start: number[], target: number[], key: number[], obstacles: Obstacle[]}} World
 * @typedef {{x: number, y: number, heading: number}} Pose
 * @typedef {{ranges: number[], walls: boolean[], region: number, seen: boolean}} Sensing
 * @typedef {{pose: Pose, target: number[], key: number[], outcome: string, met: boolean}} Robot one of several on a map;
 *   met: it has collided with another one
 * @typedef {{sensors: number[], walls: boolean, target: string}} Encoder as robonav.robot.Encoder
 */

export const ROBOT = {
  sensors: 9,
  sector: (40 * Math.PI) / 180,
  range: 10,
  collision: 1,
  arrival: 3,
  actions: ["F", "L30", "L60", "R30", "R60", "B", "to the target", "to the target's sector"],
  turns: [0, 30, 60, -30, -60, 0].map((degrees) => (degrees * Math.PI) / 180),
  backward: 5,
  toTarget: 6,
  toSector: 7,
  direction: "sector", // what the reflex knows of the direction of the target, unless something else is said
  dangerBorders: [3, 7, 11, 15, 20, 25, 30].map((border) => (border * 10) / 30),
};
const [DRIFTING, SENSING, SLIPPING, CHOOSING, ITEMS, TURN_PROBABILITY] = [2, 3, 4, 5, 1024, 0.1];

// ---- Random numbers: the hash of _fast.py -------------------------------------------------------------------------

function mix(word) {
  let x = word >>> 0;
  x = Math.imul(x ^ (x >>> 16), 0x7feb352d) >>> 0;
  x = Math.imul(x ^ (x >>> 15), 0x846ca68b) >>> 0;
  return (x ^ (x >>> 16)) >>> 0;
}

/** A number in [0, 1) from a world's key and a counter. */
export function uniform(key, purpose, step, item, draw) {
  const counter = ((step * ITEMS + item) * 8 + draw) % 4294967296;
  const first = mix((Math.imul(counter, 0x9e3779b9) + key[0]) | 0);
  return mix(((mix(first ^ key[1]) >>> 0) + Math.imul(purpose, 0x632be5ab)) | 0) / 4294967296;
}

/** A standard normal number (Box and Muller 1958). */
function normal(key, purpose, step, item) {
  const radius = Math.sqrt(-2 * Math.log(1 - uniform(key, purpose, step, item, 0)));
  return radius * Math.cos(2 * Math.PI * uniform(key, purpose, step, item, 1));
}

// ---- Geometry -------------------------------------------------------------------------------------------------------

const micrometres = (distance) => Math.floor(distance * 1e6 + 0.5) / 1e6;
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const reachOf = ({ circle, a, b }) => (circle ? a : Math.sqrt(a * a + b * b));
const boxDistance = (x, y, a, b) => Math.hypot(Math.max(Math.abs(x) - a, 0), Math.max(Math.abs(y) - b, 0));

function segmentDistance(x, y, x0, y0, x1, y1) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const length2 = dx * dx + dy * dy;
  const t = length2 === 0 ? 0 : clamp(((x - x0) * dx + (y - y0) * dy) / length2, 0, 1);
  return Math.hypot(x - x0 - t * dx, y - y0 - t * dy);
}

/** Where a line enters and leaves a box about the origin. */
function boxEntry(x, y, dx, dy, a, b) {
  let [enter, leave] = [-Infinity, Infinity];
  for (const [position, direction, half] of [[x, dx, a], [y, dy, b]]) {
    if (direction !== 0) {
      const [t0, t1] = [(-half - position) / direction, (half - position) / direction];
      enter = Math.max(enter, Math.min(t0, t1));
      leave = Math.min(leave, Math.max(t0, t1));
    } else if (Math.abs(position) > half) return [Infinity, -Infinity];
  }
  return [enter, leave];
}

function segmentBoxDistance(x0, y0, x1, y1, a, b) {
  const [enter, leave] = boxEntry(x0, y0, x1 - x0, y1 - y0, a, b);
  if (enter <= leave && enter <= 1 && leave >= 0) return 0;
  let least = Math.min(boxDistance(x0, y0, a, b), boxDistance(x1, y1, a, b));
  for (const sx of [-1, 1]) for (const sy of [-1, 1]) least = Math.min(least, segmentDistance(sx * a, sy * b, x0, y0, x1, y1));
  return least;
}

/** Least distance to one obstacle while the robot and it go straight from their old to their new places. */
function sweptDistance(obstacle, before, x0, y0, x1, y1) {
  const [ax, ay, bx, by] = [x0 - before.x, y0 - before.y, x1 - obstacle.x, y1 - obstacle.y];
  if (obstacle.circle) return segmentDistance(0, 0, ax, ay, bx, by) - obstacle.a;
  const [c, s] = [Math.cos(obstacle.turned), Math.sin(obstacle.turned)];
  return segmentBoxDistance(c * ax + s * ay, c * ay - s * ax, c * bx + s * by, c * by - s * bx, obstacle.a, obstacle.b);
}

/** Least distance to anything during a step. */
export function sweptClearance(world, before, x0, y0, x1, y1) {
  const { size, obstacles } = world;
  let least = Math.min(x1, size - x1, y1, size - y1, x0, size - x0, y0, size - y0);
  obstacles.forEach((obstacle, m) => {
    least = Math.min(least, sweptDistance(obstacle, before[m], x0, y0, x1, y1));
  });
  return Math.max(least, 0);
}

// ---- Sensing --------------------------------------------------------------------------------------------------------

const modulo = (value, by) => ((value % by) + by) % by;
const sectorOf = (forward, left) => modulo(Math.floor(Math.atan2(left, forward) / ROBOT.sector + 0.5), ROBOT.sensors);
/** Number 1 to 9 of the sector that holds a target (dx, dy) away from the robot. */
const targetRegion = (dx, dy, heading) =>
  1 + modulo(Math.floor(micrometres(Math.atan2(dy, dx) - heading) / ROBOT.sector + 0.5), ROBOT.sensors);
const RAYS = Array.from({ length: ROBOT.sensors }, (_, k) => [
  Math.cos((k + 0.5) * ROBOT.sector),
  Math.sin((k + 0.5) * ROBOT.sector),
]);

function see(ranges, sector, distance) {
  if (distance < ranges[sector]) ranges[sector] = distance;
}

function seeOnBorder(ranges, border, distance) {
  see(ranges, border, distance);
  see(ranges, (border + 1) % ROBOT.sensors, distance);
}

function seeCircle(ranges, x, y, radius) {
  const distance = Math.hypot(x, y);
  if (distance <= radius) return ranges.fill(0);
  see(ranges, sectorOf(x, y), distance - radius);
  RAYS.forEach(([rx, ry], k) => {
    const [along, across] = [x * rx + y * ry, x * ry - y * rx];
    const halfChord2 = radius * radius - across * across;
    if (along > 0 && halfChord2 >= 0) seeOnBorder(ranges, k, along - Math.sqrt(halfChord2));
  });
  return ranges;
}

function seeRectangle(ranges, x, y, a, b, turned) {
  const [c, s] = [Math.cos(turned), Math.sin(turned)];
  const [px, py] = [-(c * x + s * y), -(c * y - s * x)];
  if (Math.abs(px) <= a && Math.abs(py) <= b) return ranges.fill(0);
  const [nx, ny] = [clamp(px, -a, a) - px, clamp(py, -b, b) - py];
  see(ranges, sectorOf(c * nx - s * ny, s * nx + c * ny), Math.hypot(nx, ny));
  RAYS.forEach(([rx, ry], k) => {
    const [enter, leave] = boxEntry(px, py, c * rx + s * ry, c * ry - s * rx, a, b);
    if (enter >= 0 && enter <= leave) seeOnBorder(ranges, k, enter);
  });
  return ranges;
}

function senseBorders(size, { x, y, heading }, ranges, walls) {
  const margin = Math.min(x, size - x, y, size - y);
  if (margin >= ROBOT.range) return;
  if (margin <= 0) {
    ranges.fill(0);
    walls.fill(true);
    return;
  }
  const wall = (sector, distance) => {
    if (distance < ranges[sector]) [ranges[sector], walls[sector]] = [distance, true];
  };
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  for (const [distance, nx, ny] of [[x, -1, 0], [size - x, 1, 0], [y, 0, -1], [size - y, 0, 1]]) {
    wall(sectorOf(c * nx + s * ny, c * ny - s * nx), distance);
  }
  RAYS.forEach(([rx, ry], k) => {
    const [, distance] = boxEntry(x - size / 2, y - size / 2, c * rx - s * ry, s * rx + c * ry, size / 2, size / 2);
    wall(k, distance);
    wall((k + 1) % ROBOT.sensors, distance);
  });
}

/**
 * What a robot perceives.
 * @param {World} world
 * @param {Pose} pose
 * @param {number} noise standard deviation, in metres, of an error on every range that sees something
 * @param {number} step seconds since the start, which the error depends on
 * @returns {Sensing}
 */
export function sense(world, pose, noise = 0, step = 0) {
  const ranges = new Array(ROBOT.sensors).fill(ROBOT.range);
  const walls = new Array(ROBOT.sensors).fill(false);
  const [c, s] = [Math.cos(pose.heading), Math.sin(pose.heading)];
  for (const { circle, x, y, a, b, turned } of world.obstacles) {
    const [dx, dy] = [x - pose.x, y - pose.y];
    const near = ROBOT.range + a + b;
    if (dx * dx + dy * dy >= near * near) continue;
    const [forward, left] = [c * dx + s * dy, c * dy - s * dx];
    if (circle) seeCircle(ranges, forward, left, a);
    else seeRectangle(ranges, forward, left, a, b, turned - pose.heading);
  }
  senseBorders(world.size, pose, ranges, walls);
  const rounded = ranges.map((range, k) => {
    const distance = micrometres(range);
    if (noise === 0 || distance >= ROBOT.range) return distance;
    return micrometres(clamp(distance + noise * normal(world.key, SENSING, step, k), 0, ROBOT.range));
  });
  const [tx, ty] = [world.target[0] - pose.x, world.target[1] - pose.y];
  return {
    ranges: rounded,
    walls: walls.map((wall, k) => wall && rounded[k] < ROBOT.range),
    region: targetRegion(tx, ty, pose.heading),
    seen: micrometres(Math.hypot(tx, ty)) <= ROBOT.range,
  };
}

/** Table 3.1: 0, nothing near, to 7, collision. */
export const degreeOfDanger = (distance) => ROBOT.dangerBorders.filter((border) => distance < border).length;

/**
 * What the robot does by itself, or -1: ask the policy.
 * @param {Sensing} sensing
 * @param {number} speed
 * @param {"exact" | "sector"} direction what it knows of the direction of the target where nothing is in range
 */
export function reflex({ ranges }, speed, direction = ROBOT.direction) {
  if (ranges.every((distance) => distance >= ROBOT.range)) return direction === "exact" ? ROBOT.toTarget : ROBOT.toSector;
  return [0, 1, 2, 7, 8].every((k) => ranges[k] < speed + ROBOT.collision) ? ROBOT.backward : -1;
}

// ---- Motion ---------------------------------------------------------------------------------------------------------

const wrap = (angle) => (angle > Math.PI ? angle - 2 * Math.PI : angle <= -Math.PI ? angle + 2 * Math.PI : angle);

/** The obstacles one second later. @returns {Obstacle[]} */
export function drift({ size, key, obstacles }, step) {
  return obstacles.map((obstacle, m) => {
    if (obstacle.speed === 0) return obstacle;
    let { heading } = obstacle;
    if (uniform(key, DRIFTING, step, m, 0) < TURN_PROBABILITY) heading = Math.PI * (2 * uniform(key, DRIFTING, step, m, 1) - 1);
    let x = obstacle.x + obstacle.speed * Math.cos(heading);
    let y = obstacle.y + obstacle.speed * Math.sin(heading);
    const reach = reachOf(obstacle);
    if (x < reach || x > size - reach) {
      x = x < reach ? 2 * reach - x : 2 * (size - reach) - x;
      heading = wrap(Math.PI - heading);
    }
    if (y < reach || y > size - reach) {
      y = y < reach ? 2 * reach - y : 2 * (size - reach) - y;
      heading = -heading;
    }
    return { ...obstacle, x, y, heading };
  });
}

/** The pose at the start, facing the target. @param {World} world @returns {Pose} */
export const startPose = ({ start, target }) => ({
  x: start[0],
  y: start[1],
  heading: Math.atan2(target[1] - start[1], target[0] - start[0]),
});

/** The action that comes of one, when row a of `slip` says how likely a turns into each. */
function slipped(action, slip, key, step) {
  const draw = uniform(key, SLIPPING, step, 0, 0);
  let total = 0;
  for (let other = 0; other < slip[action].length; other += 1) {
    total += slip[action][other];
    if (draw < total) return other;
  }
  return action;
}

/** Whether a command of the reflex turns the robot to its target. */
export const turnsToTarget = (command) => command === ROBOT.toTarget || command === ROBOT.toSector;

/** The heading of a robot that turns to its target: to the target itself, or to the middle of the target's sector. */
function turnedToTarget(command, { x, y, heading }, target) {
  const [dx, dy] = [target[0] - x, target[1] - y];
  if (command === ROBOT.toTarget) return Math.atan2(dy, dx);
  return wrap(heading + ROBOT.sector * (targetRegion(dx, dy, heading) - 1));
}

/** Where a command takes a robot in a second, if it goes on its way to the end. @returns {Pose} */
function destination({ pose, target, key }, step, command, speed, slip) {
  const straight = turnsToTarget(command) ? 0 : command;
  const action = slip ? slipped(straight, slip, key, step) : straight;
  const facing = turnsToTarget(command) ? turnedToTarget(command, pose, target) : pose.heading;
  const heading = wrap(facing + ROBOT.turns[action]);
  const length = action === ROBOT.backward ? -speed : speed;
  return { x: pose.x + length * Math.cos(heading), y: pose.y + length * Math.sin(heading), heading };
}

/** A robot as the others sense it and meet it. @param {Pose} pose @returns {Obstacle} */
const bodyOf = ({ x, y }) => ({ circle: true, x, y, a: ROBOT.collision, b: 0, turned: 0, speed: 0, heading: 0 });
const isOnMap = ({ outcome }) => outcome === "running";
const othersOnMap = (robots, robot) => robots.filter((other) => other !== robot && isOnMap(other));

/**
 * The world as one of several robots senses it: its own target, and the others that are on the map as circles.
 * @param {World} world @param {Robot[]} robots @param {Robot} robot one of them
 * @returns {World}
 */
export const worldAround = (world, robots, robot) =>
  ({ ...world, target: robot.target, key: robot.key, obstacles: [...world.obstacles, ...othersOnMap(robots, robot).map(({ pose }) => bodyOf(pose))] });

/**
 * One second of all robots on a map, which move at once: each turns and goes; obstacles drift. Who has arrived or collided leaves the map.
 * @param {World} world @param {Robot[]} robots
 * @param {number[]} commands one for each robot; those of robots that have left the map do not count
 * @param {number[][] | null} slip how likely each action turns into another
 * @returns {{world: World, robots: Robot[]}}
 */
export function advanceTeam(world, robots, step, commands, speed, slip = null) {
  const after = { ...world, obstacles: drift(world, step) };
  const ways = new Map(robots.map((robot, r) => [robot, isOnMap(robot) && destination(robot, step, commands[r], speed, slip)]));
  return { world: after, robots: robots.map((robot) => {
    if (!isOnMap(robot)) return robot;
    const [{ x, y }, pose, others] = [robot.pose, ways.get(robot), othersOnMap(robots, robot)];
    const apart = others.map((other) => sweptDistance(bodyOf(ways.get(other)), other.pose, x, y, pose.x, pose.y));
    const clearance = Math.min(sweptClearance(after, world.obstacles, x, y, pose.x, pose.y), ...apart.map((distance) => Math.max(distance, 0)));
    const left = micrometres(Math.hypot(robot.target[0] - pose.x, robot.target[1] - pose.y));
    const outcome = micrometres(clearance) < ROBOT.collision ? "collided" : left <= ROBOT.arrival ? "arrived" : "running";
    return { ...robot, pose, outcome, met: apart.some((distance) => micrometres(distance) < ROBOT.collision) };
  }) };
}

/**
 * One second of a robot that is alone.
 * @returns {{world: World, pose: Pose, outcome: string}} outcome: running, arrived or collided
 */
export function advance(world, pose, step, command, speed, slip = null) {
  const alone = { pose, target: world.target, key: world.key, outcome: "running", met: false };
  const { world: after, robots: [{ pose: next, outcome }] } = advanceTeam(world, [alone], step, [command], speed, slip);
  return { world: after, pose: next, outcome };
}

// ---- Policies -------------------------------------------------------------------------------------------------------

const TARGETS = {
  number: (region) => [region / 9],
  signed: (region) => [(region - 1 > 4 ? region - 10 : region - 1) / 4],
  "one-hot": (region) => Array.from({ length: 9 }, (_, k) => (k === region - 1 ? 1 : 0)),
  "sine-cosine": (region) => [Math.sin((region - 1) * ROBOT.sector), Math.cos((region - 1) * ROBOT.sector)],
};

/**
 * What a network reads. With `raw`, the degrees of danger and the sector are the numbers of Eq. (4.5) as they are.
 * @param {Encoder & {raw?: boolean}} encoder
 * @param {Sensing} sensing
 */
export function encode({ sensors, walls, target, raw = false }, sensing) {
  const degrees = sensors.map((sensor) => degreeOfDanger(sensing.ranges[sensor - 1]));
  const flags = walls ? sensors.map((sensor) => (sensing.walls[sensor - 1] ? 1 : 0)) : [];
  const sector = raw ? [sensing.region] : TARGETS[target](sensing.region);
  return [...(raw ? degrees : degrees.map((degree) => degree / 7)), ...sector, sensing.seen ? 1 : 0, ...flags];
}

/** The rule that turns to the side with more room. @param {Sensing} sensing */
export function turnToClearerSide({ ranges }) {
  if (ranges[0] >= 6) return 0;
  return Math.min(ranges[1], ranges[2]) > Math.min(ranges[7], ranges[8]) ? 2 : 4;
}

/** Policies that need no network. */
export const RULES = { straight: () => 0, "freer-side": turnToClearerSide };

/** Gumbel noise for each action in a step: the largest of z + T noise is drawn as Boltzmann's distribution has it. */
export const gumbel = (key, step) => (action) => -Math.log(-Math.log(uniform(key, CHOOSING, step, action, 0)));

/**
 * A network's policy: what it reads, every activation, the outputs' sums, and the action it takes.
 * @param {{network: Network, encoder: Encoder, temperature?: number}} policy
 * @param {Sensing} sensing
 * @param {(action: number) => number} noise
 */
export function consult({ network, encoder, temperature = 0 }, sensing, noise = () => 0) {
  const { activations, z } = propagate(network, encode(encoder, sensing));
  return { activations, z, action: largest(temperature > 0 ? z.map((sum, action) => sum + temperature * noise(action)) : z) };
}
