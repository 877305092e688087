// A robot that knows the plan of its corridor, but not its place in it: it moves, it senses, and its belief follows.

const [LEFT, RIGHT, STAY] = [0, 1, 2];
const SAID = ["tried to move left", "tried to move right", "stayed"]; // it cannot tell whether a move failed

function render({ model, el }) {
  const { corridors, sensors, wheels, transitions, observations, seed } = model.get("data");
  const chosen = { corridor: 0, sensor: 0, wheel: 0 };
  let [run, pomdp, random, drawing] = [seed, null, null, null];
  let history = [];

  const status = h("p", { class: "status", role: "status" });
  const stage = h("div", { class: "stage" });
  const button = (label, act_) => h("button", { type: "button", click: act_ }, label);
  const undo = button("Undo", () => { if (history.length > 1) history.pop(); show(); });
  const reveal = h("input", { type: "checkbox", change: () => show() });
  const key = (colour, text) => h("span", { style: `--mark: ${colour}` }, text);
  const setting = (name, label, options) =>
    choice({ label, options, change: (index) => { chosen[name] = index; begin(); } }).element;

  /** A robot that knows nothing, in the corridor that is chosen. */
  function begin() {
    pomdp = pomdpOf({
      transitions: transitions[chosen.corridor][chosen.wheel],
      observations: observations[chosen.corridor][chosen.sensor],
    });
    random = numbersFrom(run);
    history = [lost(pomdp, random)];
    drawing = corridorPicture(corridors[chosen.corridor].cells);
    stage.replaceChildren(drawing.element);
    show();
  }

  function go(action) {
    history.push(act(pomdp, history.at(-1), action, random));
    show();
  }

  function show() {
    const now = history.at(-1);
    drawing.show(now, reveal.checked ? now.place : null);
    undo.disabled = history.length === 1;
    const best = largest(now.belief);
    const seen = pomdp.kinds === 1 ? "sensed nothing, as always" : `saw a ${["wall", "door"][now.observation]} (probability ${(100 * now.probability).toFixed(1)} %)`;
    const what = history.length === 1
      ? "Step 0: the robot knows the plan, not its place."
      : `Step ${history.length - 1}: the robot ${SAID[now.action]} and ${seen}.`;
    const share = (100 * now.belief[best]).toFixed(1);
    const alike = now.belief[best] - Math.min(...now.belief) < 1e-9;
    const known = alike ? `All ${now.belief.length} cells are equally likely, with ${share} %` : `Likeliest cell ${best} with ${share} %`;
    const where = reveal.checked ? ` It is in cell ${now.place}.` : "";
    status.textContent = `${what} ${known}; uncertainty ${entropy(now.belief).toFixed(2)} bits.${where}`;
  }

  const keys = (event) => {
    const action = { ArrowLeft: LEFT, ArrowRight: RIGHT, ArrowDown: STAY }[event.key];
    if (action === undefined) return;
    event.preventDefault();
    go(action);
  };
  set(stage, { tabindex: 0, role: "group", "aria-label": "The corridor. Arrow keys move the robot left and right; down stays and senses.", keydown: keys });

  asWidget(el, "Belief lab", "belief-lab");
  el.replaceChildren(
    h("div", { class: "row" },
      setting("corridor", "corridor", corridors.map(({ name }) => name)),
      setting("sensor", "door sensor", sensors),
      setting("wheel", "wheels", wheels)),
    stage,
    h("div", { class: "legend", "aria-hidden": "true" },
      key(PALETTE.ORANGE, "door"), key(PALETTE.PURPLE, "prediction, after the move"), key(PALETTE.GREEN, "how well each cell explains what was seen"),
      key(PALETTE.BLUE, "belief, in per cent")),
    h("div", { class: "row" },
      button("← Left", () => go(LEFT)), button("Stay and sense", () => go(STAY)), button("Right →", () => go(RIGHT)),
      undo, button("New run", () => { run += 1; begin(); }),
      h("label", { class: "check" }, reveal, " show the robot")),
    status,
  );
  begin();
}

export default { render };
