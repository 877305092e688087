// How much each past target still counts in a Q-value, with a learning rate that stays or falls.

const UPDATES = 20;

/** The learning rates of the updates: they fall geometrically from the first to the last, or stay. */
export const ratesOf = ({ first, last }) => Array.from({ length: UPDATES }, (_, k) => first * (last / first) ** (k / (UPDATES - 1)));

/** The share of the value that comes from each target, the oldest first, and from the value at the start. */
export function weightsOf(rates) {
  let left = 1;
  const weights = new Array(rates.length).fill(0);
  for (let k = rates.length - 1; k >= 0; k -= 1) {
    weights[k] = rates[k] * left;
    left *= 1 - rates[k];
  }
  return { weights, start: left };
}

/** Of how many targets a mean would vary as much: 1 over the sum of the squared shares. */
export const asManyTargets = ({ weights, start }) => 1 / (weights.reduce((sum, weight) => sum + weight ** 2, 0) + start ** 2);

export default explorable({
  controls: () => {
    const rate = (label, value) => range({ label, from: 0.05, to: 0.95, step: 0.05, value, text: (a) => a.toFixed(2) });
    return { first: rate("learning rate of the first update", 0.8), last: rate("of the last update", 0.8) };
  },
  draw({ stage }) {
    const chart = plot({ x: [0.4, UPDATES + 0.6], y: [0, 1], xLabel: "target of update", yLabel: "share of the value", xTicks: [1, 5, 10, 15, 20] });
    stage.append(h("figure", {}, chart.element));
    return (state) => {
      const shares = weightsOf(ratesOf(state));
      const { weights, start } = shares;
      const bars = weights.map((weight, k) => svg("rect", {
        x: chart.X(k + 0.6), width: chart.X(0.8) - chart.X(0), y: chart.Y(weight), height: chart.Y(0) - chart.Y(weight), fill: k === weights.length - 1 ? PALETTE.ORANGE : PALETTE.BLUE,
      }));
      chart.put(`Parts of the value that come from each of ${UPDATES} targets: the latest ${weights.at(-1).toFixed(2)}`, ...bars);
      return [
        `${number(100 * weights.at(-1), 0)} % of the value come from the latest target and ${number(100 * weights.at(-2), 0)} % from the one before.`,
        `The value is as reliable as a mean of ${number(asManyTargets(shares), 1)} targets.`,
        `${number(100 * start, 1)} % of the value come from the initial value.`,
      ].join("\n");
    };
  },
});
