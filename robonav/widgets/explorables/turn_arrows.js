// A policy of one's own: turn an arrow, and see which values follow.

export default explorable({
  controls: () => ({}),
  start: ({ policy, marked }) => ({ policy: [...policy], marked }),
  draw({ given, stage, act }) {
    const model = modelOf(given.model);
    const before = valuesOf(model, given.discount, given.policy);
    const grid = markedGrid({
      layout: given.layout, name: "policy", act,
      help: "A grid with the arrows of a policy. Arrow keys mark a cell, Enter turns its arrow.",
      press: (state, cell) => (state.policy[cell] = (state.policy[cell] + 1) % 4),
    });
    stage.append(h("figure", {}, grid.element, h("p", { class: "told" }, "Touch a cell to mark it, touch it again to turn its arrow.")));
    return ({ policy, marked }) => {
      const values = valuesOf(model, given.discount, policy);
      const differs = (sign) => values.filter((value, s) => sign * (value - before[s]) > 5e-4).length;
      grid.show({ values, policy, said: "values of the policy drawn", trajectory: [] }, 1, marked);
      const q = actionValues(model, given.discount, values, marked);
      const lines = given.layout.ends.includes(marked)
        ? ["The episode ends here."]
        : q.map((value, a) => `${WORDS[a]}: Q = ${number(value, 3)}${a === policy[marked] ? " = V, the arrow here" : `, advantage ${number(value - values[marked], 3)}`}`);
      const loss = Math.max(...given.best.map((value, s) => value - values[s]));
      return [
        `Marked: ${grid.where(marked)}.`, ...lines, "",
        `Against the policy at the start, ${differs(1)} values are higher and ${differs(-1)} lower.`,
        loss < 5e-4 ? "No advantage is positive anywhere: this policy is optimal." : `The largest loss of value in a cell is ${number(loss, 3)}.`,
      ].join("\n");
    };
  },
});
