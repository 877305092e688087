// How many steps of gradient descent an episode of NNQL makes, beside its online form.

/** Steps after all decisions: after the k-th, `passes` times through k pairs. */
export const stepsOf = (decisions, passes) => (passes * decisions * (decisions + 1)) / 2;

export default explorable({
  controls: ({ decisions, passes }) => ({
    decisions: range({ label: "decisions in the episode", from: 1, to: 100, value: decisions }),
    passes: range({ label: "passes after each decision", from: 1, to: 5, value: passes }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, 100], y: [0, 26], xLabel: "decisions", yLabel: "thousand gradient steps" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "all pairs of the episode"], [PALETTE.ORANGE, "the latest pair alone"])));
    return ({ decisions, passes }) => {
      const [all, latest] = [stepsOf(decisions, passes), passes * decisions];
      const curve = (steps) => Array.from({ length: 100 }, (_, k) => [k + 1, steps(k + 1) / 1000]);
      chart.put(
        `${all} steps of gradient descent in ${decisions} decisions`,
        chart.line(curve((n) => stepsOf(n, passes)), { stroke: PALETTE.BLUE }), chart.line(curve((n) => passes * n), { stroke: PALETTE.ORANGE }),
        svg("circle", { cx: chart.X(decisions), cy: chart.Y(all / 1000), r: 6, fill: PALETTE.BLUE }), svg("circle", { cx: chart.X(decisions), cy: chart.Y(latest / 1000), r: 6, fill: PALETTE.ORANGE }),
      );
      return [
        `All pairs: ${passes} · ${decisions} · ${decisions + 1} / 2 = ${all.toLocaleString("en")} steps.`, `The latest pair alone: ${latest.toLocaleString("en")} steps.`, "",
        "An early pair is trained again after every later decision, the last one only once. The work grows with the square of the episode's length.",
      ].join("\n");
    };
  },
});
