// One update of one action's value, and the two readings of "rescale".

export default explorable({
  controls: () => ({
    target: range({ label: "new target of the second action", from: -1, to: 2, step: 0.05, value: -0.4, text: (value) => number(value) }),
    how: segments({ label: "rescaled by", options: [["clip", "clipping"], ["shift", "shifting and dividing"]], value: "clip" }),
  }),
  draw({ given: { q, taken }, stage }) {
    const chart = plot({ x: [0, 5], y: [-1, 2], xLabel: "action", yLabel: "Q-value", xTicks: [] });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.GREY, "before"], [PALETTE.BLUE, "new targets"], [PALETTE.ORANGE, "rescaled targets, which the network learns"])));
    return ({ target, how }) => {
      const updated = qTargets(Float64Array.from(q), taken, target, 0, 1, 0);
      const learned = RESCALE[how](updated);
      const bar = (at, value, fill) => {
        const [top, bottom] = [chart.Y(Math.max(value, 0)), chart.Y(Math.min(value, 0))];
        return svg("rect", { x: chart.X(at), y: top, width: chart.X(0.24) - chart.X(0), height: Math.max(bottom - top, 0.5), fill });
      };
      const level = (value) => chart.line([[0, value], [5, value]], { stroke: PALETTE.INK, "stroke-width": 0.8, "stroke-dasharray": "3 3" });
      chart.put(
        "Values of five actions before and after the update", level(0), level(1),
        ...q.flatMap((value, a) => [bar(a + 0.1, value, PALETTE.GREY), bar(a + 0.36, updated[a], PALETTE.BLUE), bar(a + 0.62, learned[a], PALETTE.ORANGE)]),
        ...q.map((_, a) => svg("text", { x: chart.X(a + 0.48), y: chart.Y(-1) + 17, "font-size": 13, "text-anchor": "middle" }, ROBOT.actions[a])),
      );
      const moved = q.filter((value, a) => a !== taken && Math.abs(learned[a] - value) > 1e-9).length;
      return [
        `The new target of ${ROBOT.actions[taken]} is ${number(updated[taken])}.`,
        `The network learns: ${[...learned].map((value) => number(value)).join(", ")}.`, "",
        moved ? `The targets of ${moved} other actions differ from their values, so the network has to change them too.` : "The targets of the other actions equal their values.",
      ].join("\n");
    };
  },
});
