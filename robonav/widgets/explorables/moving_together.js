// A network trained on one pair of state and target: its values there and elsewhere.

/** The outputs in both states before and after so many steps on one pair. */
export function trainedOn(packed, states, { action, target, steps }) {
  const network = flattened(networks(packed)());
  const outputs = () => states.map((state) => [...propagate(network, state).activations.at(-1)]);
  const before = outputs();
  const learn = trainOnPairs(network);
  for (let k = 0; k < steps; k += 1) {
    const wanted = Float64Array.from(propagate(network, states[0]).activations.at(-1));
    wanted[action] = target;
    learn([states[0]], [wanted], 1, 1, 0);
  }
  return { before, after: outputs() };
}

export default explorable({
  controls: ({ actions }) => ({
    action: segments({ label: "the action trained, in state A", options: actions.map((name, a) => [a, name]), value: 0 }),
    target: range({ label: "its target", from: 0, to: 1, step: 0.05, value: 0.9, text: (value) => value.toFixed(2) }),
    steps: range({ label: "steps of gradient descent", from: 0, to: 100, value: 2 }),
  }),
  draw({ given, stage }) {
    const { names, actions } = given;
    const charts = names.map((name) => ({ name, chart: plot({ x: [0, actions.length], y: [0, 1], xLabel: `state ${name}`, yLabel: "Q-value", xTicks: [], height: 190 }) }));
    stage.append(h("figure", {}, ...charts.map(({ chart }) => chart.element), legend([PALETTE.GREY, "before"], [PALETTE.BLUE, "after"])));
    return (state) => {
      const { before, after } = trainedOn(given.network, given.states, state);
      charts.forEach(({ name: place, chart }, s) => {
        const bar = (at, value, fill) => svg("rect", { x: chart.X(at), y: chart.Y(value), width: chart.X(0.35) - chart.X(0), height: chart.Y(0) - chart.Y(value), fill });
        chart.put(
          `Values in state ${place}`,
          ...actions.flatMap((name, a) => [bar(a + 0.12, before[s][a], PALETTE.GREY), bar(a + 0.5, after[s][a], PALETTE.BLUE), svg("text", { x: chart.X(a + 0.5), y: chart.Y(0) + 17, "font-size": 13, "text-anchor": "middle" }, name)]),
        );
      });
      const change = (s, a) => after[s][a] - before[s][a];
      return [
        `State A: ${actions[state.action]} changed by ${number(change(0, state.action))}.`,
        `State B: the actions changed by ${actions.map((_, a) => number(change(1, a))).join(", ")}.`, "",
        "The states share the hidden units, and so do the actions. A table would have changed one number.",
      ].join("\n");
    };
  },
});
