// A reward for keeping a distance, forever, against a target some seconds away.

/** The return of circling forever, and of a target so many seconds away, Eq. (2.3). */
export const bothReturns = ({ circling, seconds, discount, target = 1 }) => ({ circle: circling / (1 - discount), target: target * discount ** (seconds - 1) });

export default explorable({
  controls: ({ discount }) => ({
    circling: range({ label: "reward of a second of circling", from: 0, to: 0.6, step: 0.02, value: 0.1, text: (value) => value.toFixed(2) }),
    seconds: range({ label: "seconds to the target", from: 1, to: 40, value: 5 }),
    discount: range({ label: "discount γ", from: 0.3, to: 0.95, step: 0.05, value: discount, text: (value) => value.toFixed(2) }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [1, 40], y: [0, 2], xLabel: "seconds to the target", yLabel: "return" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "going to the target"], [PALETTE.VERMILION, "circling forever"])));
    return (state) => {
      const { circle, target } = bothReturns(state);
      const far = Array.from({ length: 40 }, (_, k) => [k + 1, bothReturns({ ...state, seconds: k + 1 }).target]);
      chart.put(
        `Going to the target has the return ${target.toFixed(2)}, circling ${circle.toFixed(2)}`,
        chart.line(far, { stroke: PALETTE.BLUE }), chart.line([[1, Math.min(circle, 2)], [40, Math.min(circle, 2)]], { stroke: PALETTE.VERMILION }),
        svg("circle", { cx: chart.X(state.seconds), cy: chart.Y(target), r: 6, fill: PALETTE.BLUE }),
      );
      return [
        `Target: 1 · γ^${state.seconds - 1} = ${number(target, 3)}. Circle: ${number(state.circling)} / (1 − γ) = ${number(circle, 3)}.`, "",
        circle > target ? "Circling has the larger return: a robot that maximises its return never arrives." : "Going to the target has the larger return.",
        "A larger discount increases both returns.",
      ].join("\n");
    };
  },
});
