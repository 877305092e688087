// The computer expert in the page: modified A* (Algorithm 4) over the robot's own actions. Needs simulator.js.

const [TURN_COUNT, CLOSE_ENOUGH] = [12, ROBOT.arrival - 2e-6];
const TURNED = [0, 1, 2, -1, -2]; // what F, L30, L60, R30, R60 add, in steps of 30 degrees
const MOVE = 1; // metres: slower robots turn at most once in this distance
const [EXPERT_MARGIN, EXPERT_CAUTION, MARGIN_STEP, MOST_NODES] = [3, 2, 0.5, 50_000];

/** A square as a double number and what it rounded off (Dekker 1971). */
function exactSquare(a) {
  const square = a * a;
  const far = 134217729 * a;
  const high = far - (far - a);
  const low = a - high;
  return [square, high * high - square + 2 * high * low + low * low];
}

/** The hypotenuse, rounded as C rounds it: of paths that are equally long, the same one is found as in Python. */
function exactHypot(a, b) {
  const [[p, pRest], [q, qRest]] = [exactSquare(a), exactSquare(b)];
  const sum = p + q;
  if (sum === 0) return 0;
  const rest = p - (sum - (sum - p)) + (q - (sum - p)) + pRest + qRest;
  const root = Math.sqrt(sum);
  const [square, squareRest] = exactSquare(root);
  return root + (sum - square + rest - squareRest) / (2 * root);
}

/** Cosine and sine, rounded right, as C nearly always does and `Math.cos` often does not: Taylor's series in whole numbers of 2 ** -100. */
function exactCosineAndSine(angle) {
  const one = 1n << 100n;
  const x = BigInt(Math.trunc(angle * 2 ** 100));
  const sums = [0n, 0n, 0n, 0n]; // of the terms x^n / n!, by the remainder of n over 4
  for (let [n, term] = [0n, one]; term !== 0n; n += 1n, term = (term * x) / (n * one)) sums[n % 4n] += term;
  return [sums[0] - sums[2], sums[1] - sums[3]].map((sum) => Number(sum) / 2 ** 100);
}

/** A heap of [F, H, node], the least first. */
function makeHeap() {
  const items = [];
  const less = (a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2];
  const swap = (i, j) => ([items[i], items[j]] = [items[j], items[i]]);
  return {
    items,
    push: (item) => {
      items.push(item);
      for (let i = items.length - 1; i > 0; ) {
        const parent = (i - 1) >> 1;
        if (less(items[i], items[parent]) >= 0) break;
        swap(i, parent);
        i = parent;
      }
    },
    pop: () => {
      const first = items[0];
      const last = items.pop();
      if (items.length === 0) return first;
      items[0] = last;
      for (let i = 0; ; ) {
        let least = i;
        for (const child of [2 * i + 1, 2 * i + 2]) if (child < items.length && less(items[child], items[least]) < 0) least = child;
        if (least === i) return first;
        swap(i, least);
        i = least;
      }
    },
  };
}

/** How many steps a robot goes straight on before it may turn again: as many as cover a cell, or a metre. */
const stepsInMove = (speed, cell) => Math.max(1, Math.ceil(Math.min(cell, MOVE) / speed));

/**
 * A path of moves, each of several steps, as a path of steps that ends where the robot arrives; a move turns at its start.
 * @param {Pose[]} poses @param {number[]} actions
 */
function asSingleSteps({ poses, actions }, steps, target) {
  const single = { poses: [poses[0]], actions: [] };
  for (const [k, action] of actions.entries()) {
    for (let step = 1; step <= steps; step += 1) {
      const [from, to] = [poses[k], poses[k + 1]];
      const [x, y] = [from.x + (step / steps) * (to.x - from.x), from.y + (step / steps) * (to.y - from.y)];
      single.poses.push({ x, y, heading: to.heading });
      single.actions.push(step === 1 ? action : 0);
      if (exactHypot(x - target[0], y - target[1]) <= CLOSE_ENOUGH) return single;
    }
  }
  return single;
}

/** Modified A* as robonav.lfd.plan: by moves of one step, or for a slow robot of several. */
export function modifiedAstar(world, pose, { speed, cell = MOVE, ...settings }) {
  const steps = stepsInMove(speed, cell);
  const path = searchMoves(world, pose, { move: steps * speed, cell, ...settings });
  return steps === 1 ? path : { ...path, ...asSingleSteps(path, steps, world.target) };
}

/**
 * Modified A*, Algorithm 4: a path from a pose to the target, in the world as it stands.
 * @param {World} world
 * @param {Pose} pose
 * @returns {{found: boolean, poses: Pose[], actions: number[], expanded: number}} the start alone where there is no path
 */
function searchMoves(world, pose, { move, margin, caution = 0, cell, limit = 200_000 }) {
  const { size, target, obstacles } = world;
  const cells = Math.ceil(size / cell);
  const [xs, ys] = [new Float64Array(cells * cells * TURN_COUNT), new Float64Array(cells * cells * TURN_COUNT)];
  const costs = new Float64Array(xs.length).fill(Infinity); // G
  const parents = new Int32Array(xs.length).fill(-1);
  const closed = new Uint8Array(xs.length);
  const headings = Array.from({ length: TURN_COUNT }, (_, turns) => pose.heading + 30 * turns * (Math.PI / 180));
  const ways = headings.map((heading) => exactCosineAndSine(heading).map((part) => move * part));
  const farEnough = margin + move + cell;
  const most = caution > 0 ? ROBOT.range : farEnough;
  const clear = new Float64Array(cells * cells).fill(-1);
  const clearance = (x0, y0, x1, y1) => sweptClearance(world, obstacles, x0, y0, x1, y1);
  const rest = (x, y) => exactHypot(target[0] - x, target[1] - y); // H
  const last = (value) => Math.min(Math.floor(value / cell), cells - 1);
  const start = (last(pose.x) * cells + last(pose.y)) * TURN_COUNT;
  [xs[start], ys[start], costs[start]] = [pose.x, pose.y, 0]; // 1
  const open = makeHeap();
  open.push([rest(pose.x, pose.y), rest(pose.x, pose.y), start]); // 2
  let [reached, expanded] = [-1, 0];
  while (open.items.length > 0 && expanded < limit) { // 3
    const node = open.pop()[2]; // 4
    if (closed[node]) continue;
    closed[node] = 1; // 5
    const [x, y, turns] = [xs[node], ys[node], node % TURN_COUNT];
    expanded += 1;
    if (rest(x, y) <= CLOSE_ENOUGH) { // 6
      reached = node; // 7
      break;
    }
    for (const turn of TURNED) { // 9, 15
      const turned = (turns + turn + TURN_COUNT) % TURN_COUNT;
      const [x1, y1] = [x + ways[turned][0], y + ways[turned][1]];
      if (!(x1 > 0 && x1 < size && y1 > 0 && y1 < size)) continue;
      const [column, row] = [Math.floor(x1 / cell), Math.floor(y1 / cell)];
      const square = column * cells + row;
      const neighbour = square * TURN_COUNT + turned;
      if (closed[neighbour] || costs[neighbour] <= costs[node] + move) continue; // 16, 17
      if (clear[square] < 0) {
        const [cx, cy] = [(column + 0.5) * cell, (row + 0.5) * cell];
        clear[square] = Math.min(clearance(cx, cy, cx, cy), most);
      }
      let tentative = costs[node] + move; // 19
      if (caution > 0) tentative += move * caution * (1 - clear[square] / most) ** 2;
      if (costs[neighbour] <= tentative) continue; // 20
      if (clear[square] < farEnough && clearance(x, y, x1, y1) < margin) continue; // 10, 11
      [xs[neighbour], ys[neighbour], costs[neighbour], parents[neighbour]] = [x1, y1, tentative, node]; // 21
      open.push([tentative + rest(x1, y1), rest(x1, y1), neighbour]); // 23
    }
  }
  const nodes = [reached < 0 ? start : reached]; // 28 to 35
  while (parents[nodes[0]] >= 0) nodes.unshift(parents[nodes[0]]);
  const poses = nodes.map((node) => ({ x: xs[node], y: ys[node], heading: wrap(Math.atan2(Math.sin(headings[node % TURN_COUNT]), Math.cos(headings[node % TURN_COUNT]))) }));
  const actions = nodes.slice(1).map((node, k) => TURNED.findIndex((turn) => (nodes[k] + turn - node) % TURN_COUNT === 0));
  return { found: reached >= 0, poses, actions, expanded };
}

/** The expert's plan from a pose, with the largest margin that leaves a path; straight on where none does. */
export function expertPlan(world, pose, speed) {
  for (let margin = EXPERT_MARGIN; margin >= ROBOT.collision; margin -= MARGIN_STEP) {
    const plan = modifiedAstar(world, pose, { speed, margin, caution: EXPERT_CAUTION, cell: Math.max(speed, MOVE), limit: MOST_NODES });
    if (plan.found) return plan;
  }
  return { found: false, poses: [pose], actions: [0], expanded: 0 };
}

/** An expert for one episode: it follows its plan, and plans again where the robot has left it, as robonav.lfd.ComputerExpert. */
export function computerExpert() {
  let [plan, done] = [null, 0];
  return (world, pose, speed) => {
    const at = plan?.poses[done];
    const near = at && done < plan.actions.length && [at.x - pose.x, at.y - pose.y, at.heading - pose.heading].every((gap) => Math.abs(gap) < 1e-6);
    if (!near || world.obstacles.some((obstacle) => obstacle.speed > 0)) [plan, done] = [expertPlan(world, pose, speed), 0];
    done += 1;
    return plan.actions[done - 1];
  };
}

/** The expert's demonstration in a world, as robonav.lfd.demonstrate. @param {World} first @returns {Demonstration} */
export function expertDemonstration(first, speed = 2, maxSteps = 500) {
  const [expert, steps] = [computerExpert(), []];
  let [world, pose, outcome] = [first, startPose(first), "running"];
  while (outcome === "running" && steps.length < maxSteps) {
    const sensing = sense(world, pose);
    const own = reflex(sensing, speed);
    const action = own < 0 ? expert(world, pose, speed) : own;
    steps.push({ pose, sensing, action });
    ({ world, pose, outcome } = advance(world, pose, steps.length - 1, action, speed));
  }
  return { world: first, speed, steps, outcome };
}
