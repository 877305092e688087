// Generalised advantage estimation over the last steps of an episode: errors of the value function, and their sums.

/** Errors of the value function, Eq. (12) of Schulman et al. (2017); `after` is the value of the last state. */
export const valueErrors = (rewards, values, after, discount) =>
  rewards.map((reward, t) => reward + discount * (t + 1 < values.length ? values[t + 1] : after) - values[t]);

/** Their sums from each step on, Eq. (11): each later error counts by another factor discount times trace decay. */
export function advantagesOf(errors, discount, traceDecay) {
  const found = new Array(errors.length);
  let following = 0;
  for (let t = errors.length - 1; t >= 0; t -= 1) {
    following = errors[t] + discount * traceDecay * following;
    found[t] = following;
  }
  return found;
}

const ENDS = ["it arrives", "it collides", "the time is over"];

export default explorable({
  controls: () => ({
    traceDecay: range({ label: "λ", from: 0, to: 1, step: 0.05, value: 0, text: (value) => value.toFixed(2) }),
    discount: range({ label: "discount γ", from: 0.5, to: 1, step: 0.01, value: 0.99, text: (value) => value.toFixed(2) }),
    end: segments({ label: "how the episode ends", options: ENDS, value: ENDS[0] }),
  }),
  draw({ given, stage }) {
    const { values, after } = given;
    const steps = values.length;
    const size = { x: [0.5, steps + 0.5], y: [-2, 1.5], xLabel: "step", height: 200, xTicks: values.map((_, t) => t + 1) };
    const errorsChart = plot({ ...size, yLabel: "error δ of the value function" });
    const chart = plot({ ...size, yLabel: "advantage" });
    stage.append(h("figure", {}, errorsChart.element, chart.element, legend([PALETTE.ORANGE, "error δ"], [PALETTE.BLUE, "advantage"])));
    const bars = (picture, heights, fill) =>
      heights.map((height, t) => svg("rect", {
        x: picture.X(t + 0.7), width: picture.X(t + 1.3) - picture.X(t + 0.7),
        y: picture.Y(Math.max(0, height)), height: Math.abs(picture.Y(height) - picture.Y(0)), fill,
      }));
    const zero = (picture) => picture.line([[0.5, 0], [steps + 0.5, 0]], { stroke: PALETTE.INK, "stroke-width": 1 });
    return ({ traceDecay, discount, end }) => {
      const rewards = values.map((_, t) => (t < steps - 1 ? 0 : [1, -1, 0][ENDS.indexOf(end)]));
      const errors = valueErrors(rewards, values, end === ENDS[2] ? after : 0, discount);
      const advantages = advantagesOf(errors, discount, traceDecay);
      errorsChart.put("Errors of the value function", ...bars(errorsChart, errors, PALETTE.ORANGE), zero(errorsChart));
      chart.put("Advantages", ...bars(chart, advantages, PALETTE.BLUE), zero(chart));
      return [
        `Values V: ${values.map((value) => number(value, 1)).join(", ")}. The last reward is ${number(rewards[steps - 1], 0)}.`,
        `Errors δ: ${errors.map((error) => number(error)).join(", ")}.`,
        `Advantages: ${advantages.map((advantage) => number(advantage)).join(", ")}.`, "",
        `The last error counts in the advantage of step 1 by (γ λ)${exponent(steps - 1)} = ${number((discount * traceDecay) ** (steps - 1), 3)}.`,
      ].join("\n");
    };
  },
});
