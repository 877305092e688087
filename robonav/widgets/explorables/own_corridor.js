// A belief in a corridor of one's own: moving spreads it, seeing narrows it.

/** The transitions of a move by -1 or 1 that fails with probability `slip`, row by row, as robonav.mdp.corridor has them. */
export function moved(cells, by, slip) {
  const count = cells.length;
  const rows = new Float64Array(count * count);
  for (let s = 0; s < count; s += 1) {
    rows[s * count + Math.min(count - 1, Math.max(0, s + by))] += 1 - slip;
    rows[s * count + s] += slip;
  }
  return rows;
}

/** How likely each cell makes it that a door, or a wall, is seen. */
export const seen = (cells, door, accuracy) => [...cells].map((letter) => ((letter === "D") === door ? accuracy : 1 - accuracy));

/** Bayes' rule: weigh each cell by how well it explains what was seen. */
export function weighed(belief, likelihood) {
  const joint = belief.map((share, s) => share * likelihood[s]);
  const total = joint.reduce((sum, share) => sum + share, 0);
  return total > 0 ? joint.map((share) => share / total) : belief;
}

export default explorable({
  controls: () => {
    const move = (label, by) => press({ label, act: (state) => {
      state.belief = [...predict(state.belief, moved(state.cells, by, state.slip))];
      state.said = `It moved ${by < 0 ? "left" : "right"}.`;
      state.likelihood = null;
    } });
    const see = (label, door) => press({ label, act: (state) => {
      const likelihood = seen(state.cells, door, state.accuracy);
      state.belief = weighed(state.belief, likelihood);
      state.said = `It saw a ${door ? "door" : "wall"}.`;
      state.likelihood = likelihood;
    } });
    return {
      left: move("Move left", -1), door: see("See a door", true), wall: see("See a wall", false), right: move("Move right", 1),
      accuracy: range({ label: "the sensor is right in", from: 0.5, to: 0.99, step: 0.01, value: 0.9, text: (value) => `${Math.round(100 * value)} %` }),
      slip: range({ label: "a move fails in", from: 0, to: 0.5, step: 0.05, value: 0.1, text: (value) => `${Math.round(100 * value)} %` }),
    };
  },
  start: ({ cells }) => ({ cells, belief: new Array(cells.length).fill(1 / cells.length), said: "It knows the plan, but not its position.", likelihood: null }),
  draw({ stage, act }) {
    const holder = h("div", { role: "group", tabindex: 0, "data-keys": "3", "aria-label": "The corridor. The key of a cell's number puts a door there or takes it away." });
    const told = "Touch a cell, or press the key of its number, to put a door there or to take it away. The robot's belief is then uniform again.";
    stage.append(h("figure", {}, holder, h("p", { class: "told" }, told)));
    const turned = (cells, place) => [...cells].map((letter, k) => (k === place ? (letter === "D" ? "." : "D") : letter)).join("");
    const touched = (place) => act((state) => {
      state.cells = turned(state.cells, place);
      state.belief = new Array(state.cells.length).fill(1 / state.cells.length);
      state.said = "A new plan.";
      state.likelihood = null;
    });
    let [drawn, picture] = ["", null];
    holder.addEventListener("keydown", ({ key }) => /^\d$/.test(key) && Number(key) < drawn.length && touched(Number(key)));
    return ({ cells, belief, said, likelihood, accuracy, slip }) => {
      if (cells !== drawn) {
        [drawn, picture] = [cells, corridorPicture(cells, touched)];
        holder.replaceChildren(picture.element);
      }
      picture.show({ belief, likelihood, prior: null }, null);
      const probability = (door) => seen(cells, door, accuracy).reduce((sum, share, s) => sum + share * belief[s], 0);
      const alike = Math.max(...belief) - Math.min(...belief) < 1e-9;
      const known = alike ? "All cells are equally likely" : `Likeliest cell: ${largest(belief)}`;
      const after = (door) => number(entropy(weighed(belief, seen(cells, door, accuracy))));
      return [
        `${said} ${known}, with ${number(100 * Math.max(...belief), 1)} %.`,
        `Uncertainty: ${number(entropy(belief))} bits (0 when the cell is known, ${number(Math.log2(cells.length))} when no cell is excluded).`, "",
        `The probability of a door is ${number(100 * probability(true), 0)} %. A door would leave ${after(true)} bits, and a wall ${after(false)}.`,
        `A move succeeds with probability ${Math.round(100 * (1 - slip))} %.`,
      ].join("\n");
    };
  },
});
