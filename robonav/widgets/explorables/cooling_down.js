// The temperature falls from episode to episode, and the best action is taken more and more often.

/** The probability of the best of five actions, which leads by so much, Eq. (4.7). */
export const bestTaken = (lead, temperature) => softmaxPolicy([lead, 0, 0, 0, 0], temperature)[0];

export default explorable({
  controls: ({ start, end, lead }) => ({
    start: range({ label: "first temperature", from: 0.05, to: 1.5, step: 0.05, value: start, text: (value) => value.toFixed(2) }),
    end: range({ label: "last temperature", from: 0.05, to: 1.5, step: 0.05, value: end, text: (value) => value.toFixed(2) }),
    lead: range({ label: "lead of the best action", from: 0, to: 0.5, step: 0.02, value: lead, text: (value) => value.toFixed(2) }),
    episode: range({ label: "episode", from: 0, to: 299, value: 0, text: (value) => String(value + 1) }),
  }),
  draw({ given: { episodes }, stage }) {
    const chart = plot({ x: [0, episodes], y: [0, 1], xLabel: "episode", yLabel: "share" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "the best action is taken"], [PALETTE.GREY, "any of five, at random"], [PALETTE.VERMILION, "this episode"])));
    return ({ start, end, lead, episode }) => {
      const at = (k) => geometricSchedule([start, end], k / (episodes - 1));
      const now = bestTaken(lead, at(episode));
      chart.put(
        `The best action is taken in ${Math.round(100 * now)} per cent of the decisions of episode ${episode + 1}`,
        chart.line([[0, 0.2], [episodes, 0.2]], { stroke: PALETTE.GREY, "stroke-dasharray": "5 4" }),
        chart.line(Array.from({ length: episodes }, (_, k) => [k + 1, bestTaken(lead, at(k))]), { stroke: PALETTE.BLUE }),
        svg("circle", { cx: chart.X(episode + 1), cy: chart.Y(now), r: 6, fill: PALETTE.VERMILION }),
      );
      return [
        `Temperature in episode ${episode + 1}: ${number(at(episode), 3)}.`, `The best action is taken in ${(100 * now).toFixed(1)} % of the decisions.`, "",
        "The probability depends on the lead divided by the temperature. Q-values lie between 0 and 1, so a temperature of 0.9 makes all actions nearly equally likely.",
      ].join("\n");
    };
  },
});
