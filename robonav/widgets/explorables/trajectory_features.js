// Two trajectories over four kinds of terrain: what they collect, and which one a reward prefers.

/** Discounted counts of the kinds stepped onto: mu of one trajectory. */
export const collected = (kinds, count, discount) =>
  kinds.reduce((sums, kind, t) => sums.map((sum, k) => sum + (k === kind ? discount ** t : 0)), new Array(count).fill(0));

/** theta . mu, Eq. (5.4). */
export const returnOf = (weights, mu) => weights.reduce((sum, weight, k) => sum + weight * mu[k], 0);

export default explorable({
  controls: ({ kinds, weights, discount }) => ({
    discount: range({ label: "discount γ", from: 0.3, to: 1, step: 0.01, value: discount, text: (value) => value.toFixed(2) }),
    ...Object.fromEntries(kinds.map((name, k) => [name, range({ label: `reward of ${name}`, from: Math.min(-2, Math.floor(Math.min(...weights))), to: Math.max(4, Math.ceil(Math.max(...weights))), step: 0.05, value: weights[k], text: (value) => number(value) })])),
  }),
  draw({ given: { layout, trajectories, kinds }, stage }) {
    const chart = plot({ x: [0, 8], y: [0, 8], xLabel: "", yLabel: "discounted steps", xTicks: [], height: 210 });
    const grids = trajectories.map(() => gridPicture({ layout, name: "two trajectories to the target" }));
    stage.append(
      h("figure", {}, grids[0].element),
      h("figure", {}, chart.element, legend([PALETTE.BLUE, trajectories[0].name], [PALETTE.ORANGE, trajectories[1].name])));
    grids.forEach((grid, k) => {
      const nothing = layout.cells.map(() => 0);
      grid.show({ values: nothing, policy: nothing, said: trajectories[k].name, trajectory: trajectories[k].states }, 1, -1);
      grid.element.querySelectorAll(".arrow").forEach((arrow) => arrow.remove());
      for (const text of grid.element.querySelectorAll("text")) {
        if (/^[mrS]$/.test(text.textContent)) set(text, { "font-size": 24, dy: 8 });
        else if (text.textContent !== "+3") text.remove();
        else set(text, { "font-size": 22 });
      }
      const path = grid.element.querySelector(".trajectory");
      set(path, { stroke: [PALETTE.BLUE, PALETTE.ORANGE][k], "stroke-width": 6 });
      grids[0].element.querySelector(".marks").before(path);
    });
    return ({ discount, ...rewards }) => {
      const mus = trajectories.map((trajectory) => collected(trajectory.kinds, kinds.length, discount));
      const values = mus.map((mu) => returnOf(kinds.map((name) => rewards[name]), mu));
      const bar = (k, w) => svg("rect", {
        x: chart.X(2 * k + 0.3 + 0.7 * w), y: chart.Y(mus[w][k]), width: chart.X(0.6) - chart.X(0), height: chart.Y(0) - chart.Y(mus[w][k]), fill: [PALETTE.BLUE, PALETTE.ORANGE][w],
      });
      chart.put(
        "Discounted steps onto each kind of terrain",
        ...kinds.flatMap((name, k) => [bar(k, 0), bar(k, 1), svg("text", { x: chart.X(2 * k + 1), y: chart.Y(0) + 17, "font-size": 13, "text-anchor": "middle" }, name)]),
      );
      const better = Math.abs(values[0] - values[1]) < 1e-9 ? "Both are equally good." : `Better: ${trajectories[values[0] > values[1] ? 0 : 1].name}.`;
      return [
        ...trajectories.map(({ name }, w) => `${name}: μ = (${mus[w].map((value) => number(value)).join(", ")}), θ·μ = ${number(values[w], 3)}`), "", better,
        "The rewards change θ and leave μ as it is. The discount changes μ.",
      ].join("\n");
    };
  },
});
