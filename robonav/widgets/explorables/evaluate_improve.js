// Policy iteration by hand: a sweep of evaluation or an improvement, in any order.

/** By how much a sweep of evaluation would still change a value. */
export const misfit = (model, discount, values, policy) =>
  Math.max(...evaluationSweep(model, discount, values, policy).map((value, s) => Math.abs(value - values[s])));

/** How many arrows are not yet among the best of their cell. */
export const wrongArrows = ({ layout, optimal }, policy) => policy.filter((a, s) => !layout.ends.includes(s) && !optimal[s].includes(a)).length;

export default explorable({
  controls: ({ discount, model: packedModel }) => ({
    evaluate: press({
      label: "Evaluate: one sweep",
      act: (state) => {
        state.values = evaluationSweep(modelOf(packedModel), discount, state.values, state.policy);
        state.sweeps += 1;
      },
    }),
    fully: press({
      label: "Evaluate: until nothing changes",
      act: (state) => {
        state.values = valuesOf(modelOf(packedModel), discount, state.policy);
        state.full += 1;
      },
    }),
    improve: press({
      label: "Improve",
      act: (state) => {
        state.policy = greedy(modelOf(packedModel), discount, state.values, state.policy);
        state.improvements += 1;
      },
    }),
  }),
  start: ({ policy }) => ({ policy: [...policy], values: policy.map(() => 0), sweeps: 0, full: 0, improvements: 0 }),
  draw({ given, stage }) {
    const model = modelOf(given.model);
    const grid = gridPicture({ layout: given.layout, name: "values and policy" });
    stage.append(h("figure", {}, grid.element));
    return ({ policy, values, sweeps, full, improvements }) => {
      grid.show({ values, policy, said: "values and policy", trajectory: [] }, 1, -1);
      const unfit = misfit(model, given.discount, values, policy);
      const wrong = wrongArrows(given, policy);
      return [
        `Improvements: ${improvements}. Sweeps of evaluation: ${sweeps}. Full evaluations: ${full}.`, "",
        unfit < 0.0005 ? "The values fit the arrows." : `The values do not fit the arrows: a sweep would still change one by ${number(unfit, 3)}.`,
        wrong ? `Arrows that are not yet optimal: ${wrong}.` : "All arrows are optimal.",
      ].join("\n");
    };
  },
});
