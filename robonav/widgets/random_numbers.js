// Random numbers that depend on a seed alone.

/** Numbers in [0, 1) that depend on the seed alone: the same run for the same seed. */
export function numbersFrom(seed) {
  let count = 0;
  return () => {
    count += 1;
    let x = Math.imul(seed + 1, 0x9e3779b9) ^ Math.imul(count, 0x85ebca6b);
    x = Math.imul(x ^ (x >>> 16), 0x7feb352d);
    x = Math.imul(x ^ (x >>> 15), 0x846ca68b);
    return ((x ^ (x >>> 16)) >>> 0) / 2 ** 32;
  };
}

/** The index that a number in [0, 1) falls on, each index as wide as its probability. */
export function draw(probabilities, number) {
  let left = number;
  const found = probabilities.findIndex((probability) => (left -= probability) < 0);
  return found >= 0 ? found : probabilities.findLastIndex((probability) => probability > 0);
}
