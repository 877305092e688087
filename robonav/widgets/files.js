// Files that a reader takes away or brings: npz archives of NumPy arrays, and safetensors.

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

/** A drive of the playground as a file that robonav.lfd.load_demonstrations reads. */
export function demonstrationFile({ base, steps, speed, outcome }) {
  const { obstacles } = base;
  const [k, m] = [steps.length, obstacles.length];
  const floats = (shape, values) => ({ descr: "<f8", shape, values });
  const wholes = (shape, values) => ({ descr: "<i8", shape, values });
  const flags = (shape, values) => ({ descr: "|b1", shape, values });
  return npz({
    format: { shape: [], values: "robonav demonstrations 1" },
    speed: floats([], [speed]),
    trajectory: wholes([k], steps.map(() => 0)),
    actions: wholes([k], steps.map(({ action }) => action)),
    poses: floats([k, 3], steps.flatMap(({ pose }) => [pose.x, pose.y, pose.heading])),
    ranges: floats([k, 9], steps.flatMap(({ sensing }) => sensing.ranges)),
    walls: flags([k, 9], steps.flatMap(({ sensing }) => sensing.walls)),
    target_region: wholes([k], steps.map(({ sensing }) => sensing.region)),
    target_seen: flags([k], steps.map(({ sensing }) => sensing.seen)),
    outcome: { descr: "|i1", shape: [1], values: [{ arrived: 1, collided: 2 }[outcome] ?? 3] },
    "worlds.kinds": { descr: "|i1", shape: [1, m], values: obstacles.map(({ circle }) => (circle ? 1 : 2)) },
    "worlds.shapes": floats([1, m, 3], obstacles.flatMap(({ circle, a, b, turned }) => [a, circle ? 0 : b, circle ? 0 : turned])),
    "worlds.centres": floats([1, m, 2], obstacles.flatMap(({ x, y }) => [x, y])),
    "worlds.speeds": floats([1, m], obstacles.map(({ speed: own }) => own)),
    "worlds.headings": floats([1, m], obstacles.map(({ heading }) => heading)),
    "worlds.starts": floats([1, 2], base.start),
    "worlds.targets": floats([1, 2], base.target),
    "worlds.keys": { descr: "<u4", shape: [1, 2], values: base.key },
    "worlds.size": floats([], [base.size]),
  });
}

// ---- safetensors ----------------------------------------------------------------------------------------------------

const base64 = (bytes) => btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));

/**
 * The policy in a file that robonav.networks.save_weights wrote.
 * @param {ArrayBuffer} buffer
 * @returns {{network: PackedNetwork, encoder: Encoder, temperature: number}}
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
  const inputs = TARGETS[about.encoder.target](1).length + 1 + about.encoder.sensors.length * (about.encoder.walls ? 2 : 1);
  if (sizes[0] !== inputs) throw refuse(`its network has ${sizes[0]} inputs, and it says that it reads ${inputs} numbers`);
  if (sizes.at(-1) > 6) throw refuse(`its network has ${sizes.at(-1)} outputs, the robot six actions`);
  return { network: { sizes, weights, biases }, encoder: about.encoder, temperature: about.temperature ?? 0 };
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
