// Random worlds in the page: robonav.robot.random_worlds in JavaScript, the same worlds for the same keys. Needs simulator.js.

const [DRAWING, ENDPOINTS, REDRAWS, ATTEMPTS] = [1, ITEMS - 1, 100, 1000];
const [SPARE, KEEP_OUT] = [2, 6]; // metres: left clear along some way to the target, and about start and target
const [SMALLEST, LARGEST, SHORTEST, LONGEST] = [1.5, 4, 3, 8]; // metres: radius of a circle, side of a rectangle
const WORD = 0xffffffffffffffffn;

/**
 * Keys of n worlds (splitmix64).
 * @param {number} n
 * @param {bigint} origin the first 64-bit word of NumPy's `SeedSequence(seed)`
 * @returns {number[][]} two 32-bit numbers a world
 */
export function worldKeys(n, origin) {
  return Array.from({ length: n }, (_, i) => {
    let z = (origin + BigInt(i + 1) * 0x9e3779b97f4a7c15n) & WORD;
    z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & WORD;
    z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & WORD;
    z ^= z >> 31n;
    return [Number(z & 0xffffffffn), Number(z >> 32n)];
  });
}

/** Draws obstacle m; null if no place was found clear of start and target. @returns {Obstacle | null} */
function drawObstacle(key, number, m, circle, size, ends) {
  for (let redraw = 0; redraw < REDRAWS; redraw += 1) {
    const draw = (k) => uniform(key, DRAWING, number * REDRAWS + redraw, m, k);
    const a = circle ? SMALLEST + (LARGEST - SMALLEST) * draw(2) : 0.5 * (SHORTEST + (LONGEST - SHORTEST) * draw(2));
    const b = circle ? 0 : 0.5 * (SHORTEST + (LONGEST - SHORTEST) * draw(3));
    const turned = circle ? 0 : Math.PI * draw(4);
    const reach = reachOf({ circle, a, b });
    const [x, y] = [reach + (size - 2 * reach) * draw(0), reach + (size - 2 * reach) * draw(1)];
    const obstacle = { circle, x, y, a, b, turned, speed: 0, heading: 0 };
    if (ends.every(([ex, ey]) => sweptDistance(obstacle, obstacle, ex, ey, ex, ey) >= KEEP_OUT)) return obstacle;
  }
  return null;
}

/** The cells of a grid of whole metres that are nearer than SPARE to an obstacle or a border. */
function closedCells(obstacles, size) {
  const cells = Math.trunc(size) + 1;
  const closed = new Uint8Array(cells * cells).fill(1);
  for (let i = Math.ceil(SPARE); i <= Math.floor(size - SPARE); i += 1) {
    closed.fill(0, i * cells + Math.ceil(SPARE), i * cells + Math.floor(size - SPARE) + 1);
  }
  for (const { circle, x, y, a, b, turned } of obstacles) {
    const [c, s] = [Math.cos(turned), Math.sin(turned)];
    const reach = reachOf({ circle, a, b }) + SPARE;
    for (let i = Math.max(Math.ceil(x - reach), 0); i < Math.min(Math.floor(x + reach) + 1, cells); i += 1) {
      for (let j = Math.max(Math.ceil(y - reach), 0); j < Math.min(Math.floor(y + reach) + 1, cells); j += 1) {
        const [dx, dy] = [i - x, j - y];
        const near = circle ? dx * dx + dy * dy < reach * reach : boxDistance(c * dx + s * dy, c * dy - s * dx, a, b) < SPARE;
        if (near) closed[i * cells + j] = 1;
      }
    }
  }
  return { closed, cells };
}

/** Whether a path on whole metres, SPARE clear of everything, joins two points (depth-first flood fill). */
export function reachable(obstacles, size, [x0, y0], [x1, y1]) {
  const { closed, cells } = closedCells(obstacles, size);
  const [first, goalI, goalJ] = [Math.floor(x0 + 0.5) * cells + Math.floor(y0 + 0.5), Math.floor(x1 + 0.5), Math.floor(y1 + 0.5)];
  if (closed[first]) return false;
  closed[first] = 1;
  const stack = [first];
  while (stack.length > 0) {
    const cell = stack.pop();
    const [i, j] = [Math.floor(cell / cells), cell % cells];
    if (Math.abs(i - goalI) <= 1 && Math.abs(j - goalJ) <= 1) return true;
    const neighbours = [[i - 1, j], [i + 1, j], [i, j - 1], [i, j + 1]];
    neighbours.sort((p, q) => Math.hypot(q[0] - goalI, q[1] - goalJ) - Math.hypot(p[0] - goalI, p[1] - goalJ)); // nearest last: visited first
    for (const [ni, nj] of neighbours) {
      const at = ni * cells + nj;
      if (ni < 0 || nj < 0 || ni >= cells || nj >= cells || closed[at]) continue;
      closed[at] = 1;
      stack.push(at);
    }
  }
  return false;
}

/**
 * The world that belongs to a key: half of the standing obstacles are circles, half rectangles; so with the moving ones.
 * @param {number[]} key two 32-bit numbers
 * @returns {World}
 */
export function drawWorld(key, { obstacles: still, moving = 0, starts = [[10, 10]], targets = [[90, 90]], movingSpeeds = [0.4, 0.9], size = 100 }) {
  for (let number = 0; number < ATTEMPTS; number += 1) {
    const start = starts[Math.trunc(uniform(key, DRAWING, number, ENDPOINTS, 0) * starts.length)];
    const target = targets[Math.trunc(uniform(key, DRAWING, number, ENDPOINTS, 1) * targets.length)];
    const obstacles = [];
    let placed = true;
    for (let m = 0; m < still + moving && placed; m += 1) {
      const obstacle = drawObstacle(key, number, m, (m < still ? m : m - still) % 2 === 0, size, [start, target]);
      placed = obstacle !== null;
      if (placed && m >= still) {
        obstacle.speed = movingSpeeds[0] + (movingSpeeds[1] - movingSpeeds[0]) * uniform(key, DRAWING, number, m, 5);
        obstacle.heading = Math.PI * (2 * uniform(key, DRAWING, number, m, 6) - 1);
      }
      if (placed) obstacles.push(obstacle);
    }
    if (placed && reachable(obstacles.slice(0, still), size, start, target)) return { size, start: [...start], target: [...target], key, obstacles };
  }
  throw new Error(`${still + moving} obstacles leave no way to the target; take fewer.`);
}

/** Keys of the first n worlds of a seed, as `robonav.robot.world_keys`. Needs random.js. @param {number | bigint} seed */
export function worldKeysOf(n, seed) {
  const [low, high] = seedWords(seed, 2);
  return worldKeys(n, BigInt(low) | (BigInt(high) << 32n));
}

/** The first so many worlds of a seed, as `robonav.robot.random_worlds`. @returns {World[]} */
export const randomWorlds = (count, { seed, ...settings }) => worldKeysOf(count, seed).map((key) => drawWorld(key, settings));
