// The planners of chapter 6 in JavaScript, one robot at a time, held to robonav.planners by tests.

const SECTOR_MIDDLES = Array.from({ length: ROBOT.sensors }, (_, k) => ROBOT.sector * (((k + 4) % ROBOT.sensors) - 4));
const WAYS = [...ROBOT.turns.slice(0, 5), Math.PI]; // of the actions; B moves backwards
const [BINS, NEAREST_REPELLED] = [72, 0.1];
const folded = (angle) => ((((angle + Math.PI) % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI)) - Math.PI;
const rounded = (value) => Number(value.toFixed(9));
const firstLeast = (values) => values.reduce((best, value, k) => (rounded(value) < rounded(values[best]) ? k : best), 0);

/** Bearings of the bins of a polar histogram, in radians, counter-clockwise, 0 ahead. */
export const BIN_BEARINGS = Array.from({ length: BINS }, (_, b) => folded((b * 2 * Math.PI) / BINS));

/** Bearing of the middle of the target's sector. @param {Sensing} sensing */
export const targetBearing = ({ region }) => SECTOR_MIDDLES[region - 1];

/** The action that moves the robot most nearly in a direction. */
export const actionTowards = (bearing, back) => firstLeast((back ? WAYS : WAYS.slice(0, 5)).map((way) => Math.abs(folded(bearing - way))));

/**
 * The forces of an artificial potential field: of the target, and of what each sector reads; ahead and to the left.
 * @param {Sensing} sensing
 * @param {{repulsion: number, influence: number}} settings
 */
export function forces(sensing, { repulsion, influence }) {
  const target = targetBearing(sensing);
  const repulsions = sensing.ranges.map((range, k) => {
    const rho = Math.min(Math.max(range, NEAREST_REPELLED), influence);
    const strength = (repulsion * (1 / rho - 1 / influence)) / rho ** 2;
    return [-strength * Math.cos(SECTOR_MIDDLES[k]), -strength * Math.sin(SECTOR_MIDDLES[k])];
  });
  return { attraction: [Math.cos(target), Math.sin(target)], repulsions };
}

/** The sum of all forces. */
export function totalForce(sensing, settings) {
  const { attraction, repulsions } = forces(sensing, settings);
  return repulsions.reduce(([x, y], [dx, dy]) => [x + dx, y + dy], attraction);
}

/** What the potential field's policy does. @param {{repulsion: number, influence: number, inertia: number}} settings */
export function potentialFieldAction(sensing, settings) {
  const [x, y] = totalForce(sensing, settings);
  return actionTowards(Math.atan2(y, x + settings.inertia), false);
}

/** How much obstacle lies in each of the 72 directions. @param {{clearance: number, halfWidth: number}} settings */
export function polarHistogram({ ranges }, { clearance, halfWidth }) {
  return BIN_BEARINGS.map((bearing) =>
    ranges.reduce((sum, range, k) => {
      const distance = Math.max(range, 1e-9);
      const reach = halfWidth + Math.asin(Math.min(clearance / distance, 1));
      const covered = Math.abs(folded(bearing - SECTOR_MIDDLES[k])) <= reach + 1e-9;
      return covered ? sum + 1 - (distance / ROBOT.range) ** 2 : sum;
    }, 0),
  );
}

/** Which bins VFH+ takes as free: below the threshold, and not masked. */
export const freeBins = (histogram, threshold) =>
  histogram.map((value, b) => value < threshold && Math.abs(BIN_BEARINGS[b]) <= Math.PI / 2 + 1e-9);

/** The direction that VFH+ chooses, or null where nothing is free. */
export function chosenBearing(histogram, target, { threshold, wide, keep }) {
  const free = freeBins(histogram, threshold);
  const run = (b, step) => {
    let count = 0;
    while (count < wide && free[(((b + step * (count + 1)) % BINS) + BINS) % BINS]) count += 1;
    return count;
  };
  const half = Math.floor(wide / 2);
  const costs = free.map((isFree, b) => {
    const [left, right] = [run(b, 1), run(b, -1)];
    const inside = Math.min(left, right) >= half;
    const narrow = left + right < wide && Math.abs(left - right) <= 1;
    if (!isFree || !(inside || narrow)) return Infinity;
    return Math.abs(folded(BIN_BEARINGS[b] - target)) + keep * Math.abs(BIN_BEARINGS[b]);
  });
  const best = costs.reduce((least, cost, b) => (rounded(Math.min(cost, 99)) < rounded(Math.min(costs[least], 99)) ? b : least), 0);
  return Number.isFinite(costs[best]) ? BIN_BEARINGS[best] : null;
}
