// NumPy's random numbers: `defaultRng(seed)` draws the same numbers as `numpy.random.default_rng(seed)`.

// ---- SeedSequence: a seed, or several, as 32-bit words well mixed (numpy/random/bit_generator.pyx) -------------------

const POOL = 4;

/** The 32-bit words of a whole number, the least first; 0 is one word. */
function wordsOf(number) {
  if (!(Number.isInteger(number) || typeof number === "bigint") || number < 0) {
    throw new Error(`A seed must be a whole number from 0 on, got ${number}.`);
  }
  const words = [];
  for (let rest = BigInt(number); rest > 0n || words.length === 0; rest >>= 32n) words.push(Number(rest & 0xffffffffn));
  return words;
}

/**
 * Words that depend on every bit of the seed, as `numpy.random.SeedSequence(seed).generate_state(count)`.
 * @param {number | bigint | (number | bigint)[]} seed
 * @param {number} count
 * @returns {Uint32Array}
 */
export function seedWords(seed, count) {
  const entropy = (Array.isArray(seed) ? seed : [seed]).flatMap(wordsOf);
  const pool = new Uint32Array(POOL);
  let hash = 0x43b0d7e5;
  const hashed = (value) => {
    const mixed = value ^ hash;
    hash = Math.imul(hash, 0x931e8875);
    const product = Math.imul(mixed, hash);
    return (product ^ (product >>> 16)) >>> 0;
  };
  const mixed = (x, y) => {
    const result = Math.imul(0xca01f9dd, x) - Math.imul(0x4973f715, y);
    return (result ^ (result >>> 16)) >>> 0;
  };
  for (let i = 0; i < POOL; i += 1) pool[i] = hashed(entropy[i] ?? 0);
  for (let from = 0; from < POOL; from += 1) {
    for (let to = 0; to < POOL; to += 1) if (from !== to) pool[to] = mixed(pool[to], hashed(pool[from]));
  }
  for (let from = POOL; from < entropy.length; from += 1) {
    for (let to = 0; to < POOL; to += 1) pool[to] = mixed(pool[to], hashed(entropy[from]));
  }
  const state = new Uint32Array(count);
  let key = 0x8b51f9dd;
  for (let i = 0; i < count; i += 1) {
    let word = pool[i % POOL] ^ key;
    key = Math.imul(key, 0x58f38ded);
    word = Math.imul(word, key);
    state[i] = word ^ (word >>> 16);
  }
  return state;
}

// ---- PCG64: a linear congruence of 128 bits (O'Neill 2014), here as eight words of 16 bits, the least first ----------

const MULTIPLIER = [0xf645, 0x9fcc, 0xdf64, 0x4385, 0x5da4, 0x1fc6, 0xed05, 0x2360];
const halves = (words) => [...words].flatMap((word) => [word & 0xffff, word >>> 16]);

/** The random numbers of one seed. */
export class RandomNumbers {
  #state = new Float64Array(8);
  #increment = new Float64Array(8);
  #left = -1; // half of a number of 64 bits that `next32` has not given yet
  #high = 0;
  #low = 0;

  /** @param {number | bigint | (number | bigint)[]} seed */
  constructor(seed) {
    const words = seedWords(seed, 8);
    const [first, sequence] = [words.subarray(0, 4), words.subarray(4, 8)].map((four) => halves([four[2], four[3], four[0], four[1]]));
    let carried = 1;
    sequence.forEach((half, i) => {
      this.#increment[i] = ((half << 1) & 0xffff) | carried;
      carried = half >>> 15;
    });
    this.#step();
    let carry = 0;
    first.forEach((half, i) => {
      const sum = this.#state[i] + half + carry;
      this.#state[i] = sum % 65536;
      carry = sum >= 65536 ? 1 : 0;
    });
    this.#step();
  }

  #step() {
    const [before, state] = [Float64Array.from(this.#state), this.#state];
    let carry = 0;
    for (let k = 0; k < 8; k += 1) {
      let sum = carry + this.#increment[k];
      for (let i = 0; i <= k; i += 1) sum += before[i] * MULTIPLIER[k - i];
      carry = Math.floor(sum / 65536);
      state[k] = sum - carry * 65536;
    }
  }

  /** Draws 64 bits into `#high` and `#low`: the two halves of the state, xored and rotated. */
  #next64() {
    this.#step();
    const s = this.#state;
    const low = ((s[1] ^ s[5]) << 16) | (s[0] ^ s[4]);
    const high = ((s[3] ^ s[7]) << 16) | (s[2] ^ s[6]);
    const turns = s[7] >>> 10;
    const by = turns & 31;
    const [a, b] = turns & 32 ? [low, high] : [high, low];
    this.#high = (by ? (a >>> by) | (b << (32 - by)) : a) >>> 0;
    this.#low = (by ? (b >>> by) | (a << (32 - by)) : b) >>> 0;
  }

  #next32() {
    if (this.#left >= 0) {
      const word = this.#left;
      this.#left = -1;
      return word;
    }
    this.#next64();
    this.#left = this.#high;
    return this.#low;
  }

  /** The next 64 bits, as a bigint; Python's `integers(2**63)` is half of it. */
  raw() {
    this.#next64();
    return (BigInt(this.#high) << 32n) | BigInt(this.#low);
  }

  /** A number in [0, 1). */
  random() {
    this.#next64();
    return (this.#high * 2097152 + (this.#low >>> 11)) / 9007199254740992;
  }

  /** As many numbers between `low` and `high`, as `uniform(low, high, count)`. */
  uniform(low, high, count) {
    const range = high - low;
    return Float64Array.from({ length: count }, () => low + range * this.random());
  }

  /** A whole number from `low` to `high - 1`, at most 2^32 of them (Lemire 2019). */
  integers(low, high) {
    const range = high - low;
    if (range === 1) return low;
    const draw = () => {
      const word = this.#next32();
      const rest = Math.imul(word, range) >>> 0;
      return [Math.round((word * range - rest) / 4294967296), rest];
    };
    let [value, rest] = draw();
    if (rest < range) {
      const least = (4294967296 - range) % range;
      while (rest < least) [value, rest] = draw();
    }
    return low + value;
  }

  /** The numbers 0 to `count - 1` in random order. */
  permutation(count) {
    const order = Array.from({ length: count }, (_, i) => i);
    for (let i = count - 1; i > 0; i -= 1) {
      const mask = 2 ** (32 - Math.clz32(i)) - 1;
      let j = (this.#next32() & mask) >>> 0;
      while (j > i) j = (this.#next32() & mask) >>> 0;
      [order[i], order[j]] = [order[j], order[i]];
    }
    return order;
  }
}

/** @param {number | bigint | (number | bigint)[]} seed */
export const defaultRng = (seed) => new RandomNumbers(seed);
