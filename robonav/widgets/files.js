// Files that a reader takes away or brings: npz archives of NumPy arrays, and safetensors. Needs simulator.js.

// ---- npz: a zip of npy files, stored without compression ------------------------------------------------------------

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k += 1) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});
const crc32 = (bytes) => ~bytes.reduce((crc, byte) => CRC_TABLE[(crc ^ byte) & 255] ^ (crc >>> 8), ~0) >>> 0;
const latin = (text) => Uint8Array.from(text, (character) => character.charCodeAt(0));

function joined(parts) {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  parts.reduce((at, part) => (whole.set(part, at), at + part.length), 0);
  return whole;
}

/** Little-endian fields: `fields([2, 20], [4, 0])` is a 2-byte 20 and a 4-byte 0. */
function fields(...pairs) {
  const view = new DataView(new ArrayBuffer(pairs.reduce((sum, [width]) => sum + width, 0)));
  pairs.reduce((at, [width, value]) => {
    if (width === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    return at + width;
  }, 0);
  return new Uint8Array(view.buffer);
}

const WRITERS = {
  "<f8": [8, (view, at, value) => view.setFloat64(at, value, true)],
  "<i8": [8, (view, at, value) => view.setBigInt64(at, BigInt(value), true)],
  "<u4": [4, (view, at, value) => view.setUint32(at, value, true)],
  "|i1": [1, (view, at, value) => view.setInt8(at, value)],
  "|b1": [1, (view, at, value) => view.setUint8(at, value ? 1 : 0)],
};

/** The bytes of a .npy file. @param {{descr: string, shape: number[], values: any[] | string}} array */
function npy({ descr, shape, values }) {
  let [type, data] = [descr, null];
  if (typeof values === "string") {
    type = `<U${values.length}`;
    data = joined([...values].map((character) => fields([4, character.codePointAt(0)])));
  } else {
    const [width, write] = WRITERS[descr];
    const view = new DataView(new ArrayBuffer(width * values.length));
    values.forEach((value, i) => write(view, i * width, value));
    data = new Uint8Array(view.buffer);
  }
  const size = shape.length === 1 ? `${shape[0]},` : shape.join(", ");
  const about = `{'descr': '${type}', 'fortran_order': False, 'shape': (${size}), }`;
  const padded = about.padEnd(Math.ceil((about.length + 11) / 64) * 64 - 11) + "\n";
  return joined([latin("\x93NUMPY\x01\x00"), fields([2, padded.length]), latin(padded), data]);
}

/** The bytes of an npz archive. @param {Record<string, {descr: string, shape: number[], values: any[] | string}>} arrays */
export function npz(arrays) {
  const [bodies, entries] = [[], []];
  let at = 0;
  for (const [name, array] of Object.entries(arrays)) {
    const [title, data] = [latin(`${name}.npy`), npy(array)];
    const about = fields([2, 20], [2, 0], [2, 0], [2, 0], [2, 0x21], [4, crc32(data)], [4, data.length], [4, data.length], [2, title.length], [2, 0]);
    const body = joined([latin("PK\x03\x04"), about, title, data]);
    entries.push(joined([latin("PK\x01\x02"), fields([2, 20]), about, fields([2, 0], [2, 0], [2, 0], [4, 0], [4, at]), title]));
    bodies.push(body);
    at += body.length;
  }
  const directory = joined(entries);
  const count = entries.length;
  return joined([...bodies, directory, latin("PK\x05\x06"), fields([2, 0], [2, 0], [2, count], [2, count], [4, directory.length], [4, at], [2, 0])]);
}

// ---- npz, read ------------------------------------------------------------------------------------------------------

const READERS = {
  "<f8": [8, (view, at) => view.getFloat64(at, true)],
  "<f4": [4, (view, at) => view.getFloat32(at, true)],
  "<i8": [8, (view, at) => Number(view.getBigInt64(at, true))],
  "<i4": [4, (view, at) => view.getInt32(at, true)],
  "<i2": [2, (view, at) => view.getInt16(at, true)],
  "<u4": [4, (view, at) => view.getUint32(at, true)],
  "|i1": [1, (view, at) => view.getInt8(at)],
  "|u1": [1, (view, at) => view.getUint8(at)],
  "|b1": [1, (view, at) => view.getUint8(at) !== 0],
};

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The array in the bytes of a .npy file: its shape and its values, row by row. */
function npyRead(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const long = bytes[6] > 1;
  const start = (long ? 12 : 10) + (long ? view.getUint32(8, true) : view.getUint16(8, true));
  const about = new TextDecoder().decode(bytes.subarray(0, start));
  const [, descr] = about.match(/'descr': *'([^']+)'/);
  const shape = [...about.match(/'shape': *\(([^)]*)\)/)[1].matchAll(/\d+/g)].map(Number);
  const count = shape.reduce((product, length) => product * length, 1);
  if (descr.startsWith("<U")) {
    const letters = Array.from({ length: Number(descr.slice(2)) }, (_, k) => view.getUint32(start + 4 * k, true));
    return { shape, values: String.fromCodePoint(...letters.filter((letter) => letter > 0)) };
  }
  const [width, read] = READERS[descr];
  const values = Array.from({ length: count }, (_, k) => read(view, start + k * width));
  if (!/'fortran_order': *True/.test(about) || shape.length < 2) return { shape, values };
  const strides = shape.map((_, axis) => shape.slice(0, axis).reduce((product, length) => product * length, 1));
  const rowwise = shape.map((_, axis) => shape.slice(axis + 1).reduce((product, length) => product * length, 1));
  return { shape, values: values.map((_, k) => values[shape.reduce((at, length, axis) => at + (Math.floor(k / rowwise[axis]) % length) * strides[axis], 0)]) };
}

/** The arrays of an npz archive by name. @param {ArrayBuffer} buffer */
export async function npzRead(buffer) {
  const [view, bytes] = [new DataView(buffer), new Uint8Array(buffer)];
  let end = buffer.byteLength - 22;
  while (view.getUint32(end, true) !== 0x06054b50) end -= 1;
  const arrays = {};
  let at = view.getUint32(end + 16, true);
  for (let left = view.getUint16(end + 10, true); left > 0; left -= 1) {
    const [method, size, title] = [view.getUint16(at + 10, true), view.getUint32(at + 20, true), view.getUint16(at + 28, true)];
    const local = view.getUint32(at + 42, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + title)).replace(/\.npy$/, "");
    const from = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
    const body = bytes.slice(from, from + size);
    arrays[name] = npyRead(method === 8 ? await inflated(body) : body);
    at += 46 + title + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
  }
  return arrays;
}

// ---- Files of demonstrations ----------------------------------------------------------------------------------------

/**
 * @typedef {{pose: Pose, sensing: Sensing, action: number}} DemonstrationStep
 * @typedef {{world: World, speed: number, steps: DemonstrationStep[], outcome: string}} Demonstration outcome: arrived, collided,
 *   or running where it was given up
 */

const OUTCOME_CODES = { arrived: 1, collided: 2, running: 3 };
const DEMONSTRATIONS = "robonav demonstrations 1";

/** Demonstrations of one speed as a file that robonav.lfd.load_demonstrations reads. @param {Demonstration[]} demonstrations */
export function demonstrationsFile(demonstrations) {
  const d = demonstrations.length;
  const worlds = demonstrations.map(({ world }) => world);
  const slots = Math.max(...worlds.map(({ obstacles }) => obstacles.length));
  const nothing = { speed: 0, heading: 0, x: 0, y: 0, a: 0, b: 0, turned: 0 };
  const obstacles = worlds.flatMap((world) => Array.from({ length: slots }, (_, m) => world.obstacles[m] ?? nothing));
  const steps = demonstrations.flatMap((demonstration) => demonstration.steps);
  const k = steps.length;
  const floats = (shape, values) => ({ descr: "<f8", shape, values });
  const wholes = (shape, values) => ({ descr: "<i8", shape, values });
  const flags = (shape, values) => ({ descr: "|b1", shape, values });
  return npz({
    format: { shape: [], values: DEMONSTRATIONS },
    speed: floats([], [demonstrations[0].speed]),
    trajectory: wholes([k], demonstrations.flatMap((demonstration, number) => demonstration.steps.map(() => number))),
    actions: wholes([k], steps.map(({ action }) => action)),
    poses: floats([k, 3], steps.flatMap(({ pose }) => [pose.x, pose.y, pose.heading])),
    ranges: floats([k, 9], steps.flatMap(({ sensing }) => sensing.ranges)),
    walls: flags([k, 9], steps.flatMap(({ sensing }) => sensing.walls)),
    target_region: wholes([k], steps.map(({ sensing }) => sensing.region)),
    target_seen: flags([k], steps.map(({ sensing }) => sensing.seen)),
    outcome: { descr: "|i1", shape: [d], values: demonstrations.map(({ outcome }) => OUTCOME_CODES[outcome]) },
    "worlds.kinds": { descr: "|i1", shape: [d, slots], values: obstacles.map((o) => (o === nothing ? 0 : o.circle ? 1 : 2)) },
    "worlds.shapes": floats([d, slots, 3], obstacles.flatMap(({ circle, a, b, turned }) => [a, circle ? 0 : b, circle ? 0 : turned])),
    "worlds.centres": floats([d, slots, 2], obstacles.flatMap(({ x, y }) => [x, y])),
    "worlds.speeds": floats([d, slots], obstacles.map(({ speed }) => speed)),
    "worlds.headings": floats([d, slots], obstacles.map(({ heading }) => heading)),
    "worlds.starts": floats([d, 2], worlds.flatMap(({ start }) => start)),
    "worlds.targets": floats([d, 2], worlds.flatMap(({ target }) => target)),
    "worlds.keys": { descr: "<u4", shape: [d, 2], values: worlds.flatMap(({ key }) => key) },
    "worlds.size": floats([], [worlds[0].size]),
  });
}

/**
 * The demonstrations in a file that robonav.lfd.save_demonstrations or this page wrote.
 * @param {ArrayBuffer} buffer
 * @returns {Promise<Demonstration[]>}
 */
export async function demonstrationsFromFile(buffer) {
  const refuse = (why) => new Error(`The file must hold demonstrations saved by robonav: ${why}.`);
  let arrays = null;
  try {
    arrays = await npzRead(buffer);
  } catch {
    throw refuse("it is damaged or of another kind");
  }
  if (arrays.format?.values !== DEMONSTRATIONS) throw refuse("it does not say so");
  const [steps, demonstrations] = [arrays.actions?.shape[0], arrays.outcome?.shape[0]];
  const slots = arrays["worlds.kinds"]?.shape[1];
  const expected = {
    speed: [], trajectory: [steps], actions: [steps], poses: [steps, 3], ranges: [steps, 9], walls: [steps, 9],
    target_region: [steps], target_seen: [steps], outcome: [demonstrations], "worlds.kinds": [demonstrations, slots],
    "worlds.shapes": [demonstrations, slots, 3], "worlds.centres": [demonstrations, slots, 2], "worlds.speeds": [demonstrations, slots],
    "worlds.headings": [demonstrations, slots], "worlds.starts": [demonstrations, 2], "worlds.targets": [demonstrations, 2],
    "worlds.keys": [demonstrations, 2], "worlds.size": [],
  };
  for (const [name, shape] of Object.entries(expected)) {
    const { shape: got, values } = arrays[name] ?? { shape: null };
    if (String(got) !== String(shape) || got.length !== shape.length) throw refuse(`its array ${name} is missing or of another shape`);
    if (values.some((value) => !Number.isFinite(Number(value)))) throw refuse(`its array ${name} holds values that are not numbers`);
  }
  const rows = (name) => (index) => {
    const [, ...rest] = arrays[name].shape;
    const width = rest.reduce((product, length) => product * length, 1);
    return arrays[name].values.slice(index * width, (index + 1) * width);
  };
  const row = Object.fromEntries(Object.keys(expected).map((name) => [name, rows(name)]));
  const [[size], [speed]] = [arrays["worlds.size"].values, arrays.speed.values];
  const made = Array.from({ length: demonstrations }, (_, d) => {
    const shapes = row["worlds.shapes"](d);
    const centres = row["worlds.centres"](d);
    const obstacles = row["worlds.kinds"](d).map((kind, m) => ({
      circle: kind === 1, x: centres[2 * m], y: centres[2 * m + 1], a: shapes[3 * m], b: shapes[3 * m + 1], turned: shapes[3 * m + 2],
      speed: row["worlds.speeds"](d)[m], heading: row["worlds.headings"](d)[m], kind,
    })).filter(({ kind }) => kind > 0).map(({ kind, ...obstacle }) => obstacle);
    const world = { size, start: row["worlds.starts"](d), target: row["worlds.targets"](d), key: row["worlds.keys"](d), obstacles };
    const code = arrays.outcome.values[d];
    return { world, speed, steps: [], outcome: Object.keys(OUTCOME_CODES).find((name) => OUTCOME_CODES[name] === code) };
  });
  if (made.some(({ outcome }) => outcome === undefined)) throw refuse("a demonstration ends in a way that there is not");
  for (let k = 0; k < steps; k += 1) {
    const [demonstration, action] = [made[arrays.trajectory.values[k]], arrays.actions.values[k]];
    const [region] = row.target_region(k);
    if (!demonstration || !(action in ROBOT.actions) || !(region >= 1 && region <= ROBOT.sensors)) throw refuse("a step of it is none of the robot's");
    const [x, y, heading] = row.poses(k);
    demonstration.steps.push({ pose: { x, y, heading }, sensing: { ranges: row.ranges(k), walls: row.walls(k), region, seen: row.target_seen(k)[0] }, action });
  }
  return made;
}

// ---- Rewards --------------------------------------------------------------------------------------------------------

/** A reward's weights as a file: in Python, `numpy.load(path)["reward_weights"]`. @param {ArrayLike<number>} theta @param {number} actions */
export const rewardFile = (theta, actions) => npz({ reward_weights: { descr: "<f8", shape: [actions, theta.length / actions], values: [...theta] } });

/**
 * The reward's weights in a file that this page wrote, or `numpy.savez(path, reward_weights=...)`.
 * @param {ArrayBuffer} buffer @param {number[]} shape how many rows, one an action, and columns there must be
 */
export async function rewardFromFile(buffer, [rows, columns]) {
  const refuse = (why) => new Error(`The file must hold a reward, an array reward_weights of ${rows} rows and ${columns} columns: ${why}.`);
  let found = null;
  try {
    ({ reward_weights: found } = await npzRead(buffer));
  } catch {
    throw refuse("it is damaged or of another kind");
  }
  if (!found) throw refuse("it has no such array");
  const { shape, values } = found;
  if (shape.length !== 2 || shape[0] !== rows || shape[1] !== columns) throw refuse(`it is of the shape (${shape.join(", ")})`);
  if (!values.every(Number.isFinite)) throw refuse("it holds values that are not numbers");
  return Float64Array.from(values);
}

// ---- safetensors ----------------------------------------------------------------------------------------------------

/** How many numbers an encoder gives. @param {Encoder} encoder */
export const encoderSize = ({ sensors, walls, target }) => TARGETS[target](1).length + 1 + sensors.length * (walls ? 2 : 1);

const base64 = (bytes) => btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));

/**
 * The policy in a file that robonav.networks.save_weights wrote.
 * @param {ArrayBuffer} buffer
 * @returns {{network: PackedNetwork, encoder: Encoder, method: string, temperature: number}}
 */
export function weightsFromFile(buffer) {
  const refuse = (why) => new Error(`The file must hold weights saved by robonav: ${why}.`);
  let header = null;
  let about = null;
  let start = 0;
  try {
    start = 8 + Number(new DataView(buffer).getBigUint64(0, true));
    header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, start - 8)));
    about = JSON.parse(header.__metadata__.robonav);
  } catch {
    throw refuse("it is damaged or of another kind");
  }
  if (about.format !== "robonav weights 1") throw refuse(`its format is ${about.format}`);
  if (!(about.encoder?.target in TARGETS) || !Array.isArray(about.encoder.sensors)) throw refuse("it does not say what the network reads");
  const tensor = (name) => {
    const { dtype, shape, data_offsets: [from, to] } = header[name];
    const kind = { F64: "float64", F32: "float32" }[dtype];
    if (!kind || start + to > buffer.byteLength) throw refuse(`its tensor ${name} cannot be read`);
    return { shape, dtype: kind, data: base64(new Uint8Array(buffer, start + from, to - from)) };
  };
  const layers = Object.keys(header).filter((name) => name.startsWith("weights.")).length;
  const numbers = Array.from({ length: layers }, (_, l) => l + 1);
  const [weights, biases] = [numbers.map((l) => tensor(`weights.${l}`)), numbers.map((l) => tensor(`biases.${l}`))];
  if (weights.length === 0 || weights.some(({ shape }) => shape.length !== 2)) throw refuse("it must hold one network");
  const sizes = [weights[0].shape[1], ...weights.map(({ shape }) => shape[0])];
  const inputs = encoderSize(about.encoder);
  if (sizes[0] !== inputs) throw refuse(`its network has ${sizes[0]} inputs, and it says that it reads ${inputs} numbers`);
  if (sizes.at(-1) > 6) throw refuse(`its network has ${sizes.at(-1)} outputs, the robot six actions`);
  return { network: { sizes, weights, biases }, encoder: about.encoder, method: about.method, temperature: about.temperature ?? 0 };
}

/**
 * The bytes of a safetensors file that robonav.networks.load_weights reads.
 * @param {{network: Network, encoder: Encoder, method: string, temperature?: number}} policy
 * @param {Record<string, any>} made what else made it, as JSON knows it
 */
export function weightsFile({ network, encoder, method, temperature = 0 }, made = {}) {
  const { sizes, weights, biases } = network;
  const tensors = [
    ...weights.map((values, l) => [`weights.${l + 1}`, [sizes[l + 1], sizes[l]], values]),
    ...biases.map((values, l) => [`biases.${l + 1}`, [sizes[l + 1]], values]),
  ];
  const about = { format: "robonav weights 1", method, encoder, made: { page: true, ...made }, temperature, version: "in the page" };
  let at = 0;
  const header = { __metadata__: { robonav: JSON.stringify(about) } };
  for (const [name, shape, values] of tensors) header[name] = { dtype: "F64", shape, data_offsets: [at, (at += 8 * values.length)] };
  const text = new TextEncoder().encode(JSON.stringify(header));
  const padded = Math.ceil(text.length / 8) * 8;
  const view = new DataView(new ArrayBuffer(8 + padded + at));
  view.setBigUint64(0, BigInt(padded), true);
  const bytes = new Uint8Array(view.buffer);
  bytes.fill(32, 8, 8 + padded);
  bytes.set(text, 8);
  let place = 8 + padded;
  for (const [, , values] of tensors) for (const value of values) {
    view.setFloat64(place, value, true);
    place += 8;
  }
  return bytes;
}

/** Hands bytes to the reader as a file. */
export function saveFile(name, bytes) {
  const link = h("a", { href: URL.createObjectURL(new Blob([bytes])), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// ---- What the browser keeps -----------------------------------------------------------------------------------------

/**
 * Texts that the browser keeps under keys with a prefix, shared by all pages of the book.
 * @param {string} prefix
 * @param {{what: string, advice: string}} words what is kept, and what helps when the storage is full
 */
export function browserStore(prefix, { what, advice }) {
  /** What all widgets of a page share: texts that the browser would not keep, and who wants to hear of changes. */
  const shared = () => (globalThis[Symbol.for(prefix)] ??= { memory: new Map(), listeners: new Set() });
  /** The browser's storage, or null where it gives none. */
  const storage = () => {
    try {
      const found = globalThis.localStorage;
      found.setItem(`${prefix}try`, "");
      found.removeItem(`${prefix}try`);
      return found;
    } catch (error) {
      return error?.name === "QuotaExceededError" ? globalThis.localStorage : null;
    }
  };
  const tellAll = () => shared().listeners.forEach((listener) => listener());
  /** Keeps a text under a key, in place of one that is there; returns a sentence where the browser would not, or "". */
  const write = (key, text) => {
    const kept = storage();
    shared().memory.delete(key);
    kept?.removeItem(key);
    try {
      if (!kept) throw new Error("no storage");
      kept.setItem(key, text);
      return "";
    } catch {
      shared().memory.set(key, text);
      return kept ? `The browser's storage is full: ${what} made from now on last until you close the page. ${advice}`
        : `This browser keeps nothing for this page: ${what} last until you close it.`;
    }
  };
  return {
    /** Pairs of key and text, the oldest first. */
    all: () => {
      const kept = storage();
      const keys = Array.from({ length: kept?.length ?? 0 }, (_, k) => kept.key(k)).filter((key) => key.startsWith(prefix));
      return [...keys.map((key) => [key, kept.getItem(key)]), ...shared().memory].sort(([a], [b]) => (a < b ? -1 : 1));
    },
    /** Keeps texts; returns a sentence where the browser would not, or "". @param {string[]} texts */
    keep: (texts) => {
      const sentences = texts.map((text, k) =>
        write(`${prefix}${String(Date.now()).padStart(15, "0")}.${String(k).padStart(5, "0")}.${Math.random().toString(36).slice(2, 8)}`, text));
      tellAll();
      return sentences.find((sentence) => sentence !== "") ?? "";
    },
    /** Changes a text, or brings one back that was deleted; returns a sentence where the browser would not, or "". */
    put: (key, text) => {
      const sentence = write(key, text);
      tellAll();
      return sentence;
    },
    /** Deletes texts. @param {string[]} keys */
    remove: (keys) => {
      const kept = storage();
      for (const key of keys) {
        kept?.removeItem(key);
        shared().memory.delete(key);
      }
      tellAll();
    },
    /** Calls a function whenever the texts change, in this page or another; returns a function that ends this. */
    watch: (listener) => {
      const elsewhere = ({ key }) => (key === null || key.startsWith(prefix)) && listener();
      shared().listeners.add(listener);
      globalThis.addEventListener("storage", elsewhere);
      return () => {
        shared().listeners.delete(listener);
        globalThis.removeEventListener("storage", elsewhere);
      };
    },
  };
}
