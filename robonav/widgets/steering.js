// Steering by a person: the same turns and the step back by key, by button, and by gamepad.

/** What a person can choose, in the order of the buttons: a sign, the action, its name. */
const STEERING = [["↰", 2, "left 60°"], ["↖", 1, "left 30°"], ["↑", 0, "ahead"], ["↗", 3, "right 30°"], ["↱", 4, "right 60°"], ["↓", 5, "back"]];
const ARROWS = { ArrowUp: 0, ArrowLeft: 1, ArrowRight: 3, ArrowDown: 5 };
const REPEAT = 250; // milliseconds between two steps while a gamepad is held

/** The action of a key, or null; Shift makes a turn sharper. @param {{key: string, shiftKey: boolean}} event */
export function keyAction({ key, shiftKey }) {
  if (!(key in ARROWS)) return null;
  return shiftKey && key === "ArrowLeft" ? 2 : shiftKey && key === "ArrowRight" ? 4 : ARROWS[key];
}

/** Buttons that steer, below a map. @param {{label: string, take: (action: number) => void, back?: boolean}} options */
export const steeringButtons = ({ label, take, back = true }) =>
  h("div", { class: "wheel", role: "group", "aria-label": label }, ...STEERING.filter(([, action]) => back || action !== 5).map(([sign, action, name]) =>
    h("button", { type: "button", click: () => take(action) }, h("span", { class: "sign", "aria-hidden": "true" }, sign), h("span", {}, name))));

const touchOnly = () => Boolean(globalThis.matchMedia?.("(hover: none) and (pointer: coarse)").matches);

/** What to press to steer: a device without keys and mouse has the buttons alone. */
export const whatSteers = () => (touchOnly() ? "a button below the map" : "an arrow key or a button below the map");

/** The name of an action in words. @param {number} action */
export const actionName = (action) => STEERING.find(([, each]) => each === action)[2];

/** How keys and buttons steer. */
export const howToSteer = () => (touchOnly() ? "Each button is one second: the robot turns to its own left or right, and goes on."
  : "Arrow keys: ahead, left and right 30°, back; with Shift 60°. Left and right are the robot's.");

/**
 * What a gamepad asks for, or null: the left stick or the directional pad turns by 30°, far to the side or a shoulder button by 60°.
 * @param {{axes: readonly number[], buttons: readonly {pressed: boolean}[]}} pad in the standard layout
 */
export function padAction({ axes, buttons }) {
  const pressed = (k) => Boolean(buttons[k]?.pressed);
  for (const [button, action] of [[4, 2], [5, 4], [14, 1], [15, 3], [12, 0], [13, 5]]) if (pressed(button)) return action;
  const [x = 0, y = 0] = axes;
  if (Math.hypot(x, y) < 0.5) return null;
  const angle = (Math.atan2(x, -y) * 180) / Math.PI; // from straight up, to the right
  const turn = Math.abs(angle);
  if (turn > 135) return 5;
  if (turn < 15) return 0;
  return angle < 0 ? (turn < 60 ? 1 : 2) : turn < 60 ? 3 : 4;
}

/**
 * Calls `take` with the action of any gamepad, again and again while it is held, and `begin` when its first button is pressed.
 * Returns a function that ends this.
 */
export function watchPads(take, begin = () => {}) {
  let [frame, last, since, held] = [0, null, -REPEAT, false];
  const pads = () => {
    try {
      return [...(navigator.getGamepads?.() ?? [])].filter(Boolean);
    } catch {
      return []; // the page may not ask
    }
  };
  const look = (time) => {
    frame = 0;
    const found = pads();
    if (found.length === 0) return;
    const action = found.map(padAction).find((asked) => asked !== null) ?? null;
    if (action !== null && (last === null || time - since >= REPEAT)) {
      since = time;
      take(action);
    }
    last = action;
    const pressed = found.some(({ buttons }) => buttons[0]?.pressed);
    if (pressed && !held) begin();
    held = pressed;
    frame = requestAnimationFrame(look);
  };
  const start = () => (frame ||= requestAnimationFrame(look));
  globalThis.addEventListener("gamepadconnected", start);
  if (pads().length > 0) start();
  return () => {
    globalThis.removeEventListener("gamepadconnected", start);
    cancelAnimationFrame(frame);
  };
}
