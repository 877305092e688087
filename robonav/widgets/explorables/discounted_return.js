// Return against discount: two chargers, one near and small, one far and large.

/** The return of an episode from its first step on, Eq. (2.3): the sum of discount^t R_{t+1}. */
export const returnOf = (rewards, discount) => rewards.reduceRight((future, reward) => reward + discount * future, 0);

/** The same two ways with the far reward at another step. */
const farAt = (given, steps) => [...new Array(steps - 1).fill(0), given.far.at(-1)];

export default explorable({
  controls: ({ far }) => ({
    discount: range({ label: "discount γ", from: 0, to: 1, step: 0.01, value: 0.5, text: (value) => value.toFixed(2) }),
    steps: range({ label: "steps to the far charger", from: 3, to: 20, value: far.length }),
  }),
  draw({ given, stage }) {
    const [near, top] = [given.near, given.far.at(-1)];
    const chart = plot({ x: [0, 20.5], y: [0, top], xLabel: "step at which the reward comes", yLabel: "discounted reward" });
    stage.append(h("figure", {}, chart.element, legend([PALETTE.BLUE, "near charger"], [PALETTE.ORANGE, "far charger"], [PALETTE.GREY, "reward, not discounted"])));
    return ({ discount, steps }) => {
      const far = farAt(given, steps);
      const bar = (rewards, colour) => {
        const [at, reward, value] = [rewards.length, rewards.at(-1), returnOf(rewards, discount)];
        const box = (height, more) =>
          svg("rect", { x: chart.X(at - 0.35), width: chart.X(0.7) - chart.X(0), y: chart.Y(height), height: chart.Y(0) - chart.Y(height), ...more });
        return [box(reward, { fill: "none", stroke: PALETTE.GREY, "stroke-dasharray": "3 3" }), box(value, { fill: colour })];
      };
      const shrink = Array.from({ length: 79 }, (_, k) => 1 + k / 4).map((t) => [t, top * discount ** (t - 1)]);
      const [a, b] = [returnOf(near, discount), returnOf(far, discount)];
      chart.put(
        `Return of the near charger ${number(a)}, of the far charger ${number(b)}`,
        chart.line(shrink, { stroke: PALETTE.INK, "stroke-width": 1.5, "stroke-dasharray": "5 4" }),
        ...bar(near, PALETTE.BLUE), ...bar(far, PALETTE.ORANGE),
      );
      const better = Math.abs(a - b) < 0.005 ? "Both returns are equal." : `The ${a > b ? "near" : "far"} charger gives the larger return.`;
      const sight = discount < 1 ? `A robot with this discount looks about ${number(1 / (1 - discount), 0)} steps ahead.` : "Without a discount only the size of a reward matters.";
      return `Near: γ${exponent(near.length - 1)} · ${near.at(-1)} = ${number(a)}\nFar: γ${exponent(steps - 1)} · ${top} = ${number(b)}\n${better}\n\n${sight}`;
    };
  },
});
