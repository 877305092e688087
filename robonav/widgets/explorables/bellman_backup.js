// One Bellman backup at a time, with its sum written out.

/** The sum of an action value, as it is worked out by hand. */
function written(model, discount, values, s, a) {
  const terms = model.probabilities(s, a).map(([next, p]) => `${number(p, 1)} · ${number(values[next])}`);
  return `${WORDS[a]}: ${number(model.reward(s, a))} + ${discount} (${terms.join(" + ")}) = ${number(actionValue(model, discount, values, s, a))}`;
}

/** The value of one state after its backup, Eq. (2.26). */
export const backedUp = (model, discount, values, s) => Math.max(...actionValues(model, discount, values, s));

export default explorable({
  controls: ({ discount, model: packedModel }) => ({
    sweep: press({
      label: "Back up all cells at once",
      act: (state) => {
        state.values = optimalitySweep(modelOf(packedModel), discount, state.values);
        state.backups += state.cells;
        state.last = null;
      },
    }),
  }),
  start: ({ layout, marked }) => ({ values: layout.cells.map(() => 0), backups: 0, marked, last: null, cells: layout.cells.length - layout.ends.length }),
  draw({ given, stage, act }) {
    const model = modelOf(given.model);
    const grid = markedGrid({
      layout: given.layout, name: "values", act, once: true,
      help: "A grid with values. Arrow keys mark a cell, Enter backs it up.",
      press: (state, cell) => {
        const sums = Array.from({ length: model.actions }, (_, a) => written(model, given.discount, state.values, cell, a));
        state.values[cell] = backedUp(model, given.discount, state.values, cell);
        state.backups += 1;
        state.last = { cell, sums, value: state.values[cell] };
      },
    });
    stage.append(h("figure", {}, grid.element, h("p", { class: "told" }, "Touch a cell to back it up.")));
    return ({ values, backups, marked, last }) => {
      const policy = greedy(model, given.discount, values, values.map(() => 0));
      grid.show({ values, policy, said: `values after ${backups} backups`, trajectory: [] }, 1, marked);
      const off = Math.max(...given.best.map((value, s) => Math.abs(value - values[s])));
      return [
        `Backups of a cell: ${backups}. Value of the start S: ${number(values[given.marked])}.`,
        ...(last ? ["", `The last one, in ${grid.where(last.cell)}. Mean reward + γ (sum of probability · value):`, ...last.sums, `The largest of them is the new value: ${number(last.value)}`] : []),
        "", off < 0.005 ? "All values are right to two digits." : `The values are still wrong by up to ${number(off)}.`,
      ].join("\n");
    };
  },
});
