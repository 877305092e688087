// The robot's map on a canvas, drawn in metres; looks as robonav.plots.robot draws it.

const [SIDE, EDGE] = [520, 14]; // pixels: of a map's side, and around it

/** A square canvas and what can be drawn on it. Call `begin` first. */
export function mapCanvas(attributes = {}) {
  const canvas = h("canvas", { width: SIDE, height: SIDE, class: "map", ...attributes });
  const pen = canvas.getContext("2d");
  let scale = 1; // pixels a metre
  const toX = (x) => EDGE + x * scale;
  const toY = (y) => SIDE - EDGE - y * scale;

  /** An empty map of a size, its border drawn. */
  const begin = (size) => {
    scale = (SIDE - 2 * EDGE) / size;
    const dense = Math.min(window.devicePixelRatio || 1, 2);
    if (canvas.width !== SIDE * dense) canvas.width = canvas.height = SIDE * dense;
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    pen.clearRect(0, 0, SIDE, SIDE);
    pen.strokeStyle = PALETTE.OBSTACLE;
    pen.lineWidth = 2;
    pen.strokeRect(toX(0), toY(size), size * scale, size * scale);
  };

  /** @param {Obstacle} o */
  const obstacle = (o, { x = o.x, y = o.y, marked = false } = {}) => {
    pen.beginPath();
    if (o.circle) pen.arc(toX(x), toY(y), o.a * scale, 0, 2 * Math.PI);
    else {
      const [c, s] = [Math.cos(o.turned), Math.sin(o.turned)];
      for (const [i, j] of [[1, 1], [-1, 1], [-1, -1], [1, -1]]) {
        pen.lineTo(toX(x + c * o.a * i - s * o.b * j), toY(y + s * o.a * i + c * o.b * j));
      }
      pen.closePath();
    }
    pen.fillStyle = o.speed > 0 ? PALETTE.MOVING : PALETTE.OBSTACLE;
    pen.fill();
    if (!marked) return;
    pen.strokeStyle = PALETTE.ORANGE;
    pen.lineWidth = 3;
    pen.stroke();
  };

  const start = ([x, y], colour = PALETTE.ROBOT) => {
    pen.fillStyle = colour;
    pen.fillRect(toX(x) - 4, toY(y) - 4, 8, 8);
  };

  const target = ([x, y], marked = false, colour = PALETTE.TARGET) => {
    pen.strokeStyle = colour;
    pen.lineWidth = marked ? 4 : 2.5;
    pen.beginPath();
    pen.arc(toX(x), toY(y), ROBOT.arrival * scale, 0, 2 * Math.PI);
    pen.stroke();
  };

  /** What each sensor sees, in as many equal sectors as there are ranges. @param {Pose} pose */
  const sectors = ({ x, y, heading }, ranges) => {
    const half = Math.PI / ranges.length;
    ranges.forEach((distance, k) => {
      const middle = heading + k * 2 * half;
      pen.beginPath();
      pen.moveTo(toX(x), toY(y));
      pen.arc(toX(x), toY(y), Math.max(distance, 0) * scale, -(middle - half), -(middle + half), true);
      pen.closePath();
      const near = distance < ROBOT.range;
      pen.globalAlpha = near ? 0.4 : 0.18;
      pen.fillStyle = near ? PALETTE.ORANGE : PALETTE.SKY;
      pen.fill();
      pen.globalAlpha = 0.7;
      pen.strokeStyle = PALETTE.BLUE;
      pen.lineWidth = 0.7;
      pen.stroke();
    });
    pen.globalAlpha = 1;
  };

  /** @param {Pose} pose */
  const robot = ({ x, y, heading }, colour = PALETTE.ROBOT) => {
    pen.beginPath();
    for (const angle of [0, 2.5, -2.5]) pen.lineTo(toX(x + 2.2 * Math.cos(heading + angle)), toY(y + 2.2 * Math.sin(heading + angle)));
    pen.closePath();
    pen.fillStyle = colour;
    pen.fill();
  };

  /** Where a robot of several ended in a collision. @param {Pose} pose */
  const cross = ({ x, y }, colour) => {
    for (const slope of [-1, 1]) line([[x - 1.2, y - 1.2 * slope], [x + 1.2, y + 1.2 * slope]], colour, 2.5);
  };

  /** A way through points [x, y]. */
  const line = (points, colour, width = 1.8) => {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    points.forEach(([x, y]) => pen.lineTo(toX(x), toY(y)));
    pen.stroke();
  };

  /** Dots at x, y, x, y, ... from one index of a dot to before another. */
  const dots = (flat, from, to, { colour, radius, alpha = 1 }) => {
    pen.globalAlpha = alpha;
    pen.fillStyle = colour;
    for (let i = from; i < to; i += 1) pen.fillRect(toX(flat[2 * i]) - radius, toY(flat[2 * i + 1]) - radius, 2 * radius, 2 * radius);
    pen.globalAlpha = 1;
  };

  /** Where on the map an event of the pointer is, in metres. */
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    const [px, py] = [((event.clientX - box.left) / box.width) * SIDE, ((event.clientY - box.top) / box.height) * SIDE];
    return [(px - EDGE) / scale, (SIDE - EDGE - py) / scale];
  };

  return { canvas, begin, obstacle, start, target, sectors, robot, cross, line, dots, place };
}

/** Where the arrow keys lead on a map, in metres. */
export const MAP_KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/**
 * A map on which the reader moves things: by dragging one of them, or by touching a place or with the arrow keys for the chosen one.
 * @param {{size: number, margin: number}} map its size in metres, and how far things stay from its border
 * @param {() => {x: number, y: number, reach: number}[]} things where they are now, and how near to one a finger takes it
 * @param {() => number} chosen the number of the one that keys move
 * @param {(thing: number, place: {x: number, y: number}) => void} move called with a place within the map
 */
export function mapToMoveOn({ size, margin }, things, chosen, move) {
  const within = (value) => Math.min(size - margin, Math.max(margin, Number(value.toFixed(1))));
  const put = (thing, [x, y]) => move(thing, { x: within(x), y: within(y) });
  const board = mapCanvas({ tabindex: 0, role: "application", "data-keys": "ArrowLeft ArrowUp", "data-touch": "" });
  const thingAt = ([px, py]) => things().findIndex(({ x, y, reach }) => Math.hypot(px - x, py - y) < reach);
  let dragged = -1;
  board.canvas.addEventListener("pointerdown", (event) => {
    dragged = thingAt(board.place(event));
    if (dragged >= 0) board.canvas.setPointerCapture(event.pointerId);
  });
  board.canvas.addEventListener("pointermove", (event) => dragged >= 0 && put(dragged, board.place(event)));
  for (const end of ["pointerup", "pointercancel"]) board.canvas.addEventListener(end, () => (dragged = -1));
  board.canvas.addEventListener("click", (event) => thingAt(board.place(event)) < 0 && put(chosen(), board.place(event)));
  board.canvas.addEventListener("keydown", (event) => {
    if (!(event.key in MAP_KEYS)) return;
    event.preventDefault();
    const [{ x, y }, [right, up]] = [things()[chosen()], MAP_KEYS[event.key]];
    put(chosen(), [x + right, y + up]);
  });
  holdFinger(board.canvas, (touch) => thingAt(board.place(touch)) >= 0);
  return board;
}

/** A map on which the reader moves the robot. @param {{size: number}} world @param {() => Pose} robot where it is now @param {(place: {x: number, y: number}) => void} move */
export const mapForRobot = ({ size }, robot, move) => mapToMoveOn({ size, margin: 1 }, () => [{ ...robot(), reach: 3 }], () => 0, (_, place) => move(place));
