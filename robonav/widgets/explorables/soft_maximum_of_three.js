// The soft maximum of three values, beside the hard one, over the temperature.

/** The temperature times the logarithm of the sum of exponentials; the maximum where the temperature is 0. */
export function softMaximum(values, temperature) {
  const highest = Math.max(...values);
  if (temperature === 0) return highest;
  return highest + temperature * Math.log(values.reduce((sum, value) => sum + Math.exp((value - highest) / temperature), 0));
}

export default explorable({
  controls: ({ values }) => ({
    ...Object.fromEntries(values.map((value, k) => [`value${k}`, range({ label: `value of action ${k + 1}`, from: -2, to: 2, step: 0.1, value, text: (at) => number(at, 1) })])),
    temperature: range({ label: "temperature", from: 0, to: 3, step: 0.05, value: 0, text: (at) => at.toFixed(2) }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, 3], y: [-2, 6], xLabel: "temperature", yLabel: "value" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "soft maximum"], [PALETTE.GREY, "the three values"], [PALETTE.VERMILION, "the temperature now"])));
    return ({ temperature, ...named }) => {
      const values = Object.values(named);
      const now = softMaximum(values, temperature);
      const level = (value) => chart.line([[0, value], [3, value]], { stroke: PALETTE.GREY, "stroke-dasharray": "5 4", "stroke-width": 1.5 });
      chart.put(
        "Soft maximum over the temperature", ...values.map(level),
        chart.line(Array.from({ length: 121 }, (_, k) => [k / 40, softMaximum(values, k / 40)]), { stroke: PALETTE.BLUE }),
        svg("circle", { cx: chart.X(temperature), cy: chart.Y(now), r: 6, fill: PALETTE.VERMILION }),
      );
      const highest = Math.max(...values);
      return [
        `Hard maximum: ${number(highest)}. Soft maximum: ${number(now, 3)}.`,
        `It is larger by ${number(now - highest, 3)}; the most it can be larger is ${number(temperature * Math.log(3), 3)}, the temperature times log 3.`, "",
        "The soft maximum is the largest sum of expected value and temperature times entropy that a random choice can have.",
      ].join("\n");
    };
  },
});
