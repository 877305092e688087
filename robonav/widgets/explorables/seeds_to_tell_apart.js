// Two methods, each trained a few times: how often the better one looks better.

/** The normal distribution function, between the points of a table. */
export function normalCdf(x, cdf, at) {
  if (at <= x[0]) return 0;
  if (at >= x.at(-1)) return 1;
  const place = (at - x[0]) / (x[1] - x[0]);
  const k = Math.floor(place);
  return cdf[k] + (place - k) * (cdf[k + 1] - cdf[k]);
}

/** The standard deviation of the difference of two means, each of n trainings. */
export const scatterOfDifference = (scatter, n) => scatter * Math.sqrt(2 / n);

/** How often the better of two methods has the higher mean of n trainings. */
export const looksBetter = ({ x, cdf }, { difference, scatter }, n) => normalCdf(x, cdf, difference / scatterOfDifference(scatter, n));

export default explorable({
  controls: ({ seeds, difference, scatter }) => ({
    seeds: range({ label: "trainings of each method", from: 1, to: 64, value: seeds }),
    difference: range({ label: "true difference, in points", from: 0, to: Math.max(5, difference), step: 0.25, value: difference, text: (value) => value.toFixed(2) }),
    scatter: range({ label: "standard deviation of single trainings", from: 0.5, to: Math.max(6, scatter), step: 0.25, value: scatter, text: (value) => value.toFixed(2) }),
  }),
  draw({ given, stage }) {
    const chart = plot({ x: [0, 64], y: [0.5, 1], xLabel: "trainings of each method", yLabel: "better one has the higher mean" });
    stage.append(h("figure", {}, chart.element));
    return (state) => {
      const { seeds, scatter } = state;
      const right = (n) => looksBetter(given, state, n);
      chart.put(
        `In ${Math.round(100 * right(seeds))} per cent of such comparisons the better method has the higher mean`,
        chart.line(Array.from({ length: 64 }, (_, k) => [k + 1, right(k + 1)]), { stroke: PALETTE.BLUE }),
        svg("circle", { cx: chart.X(seeds), cy: chart.Y(right(seeds)), r: 6, fill: PALETTE.VERMILION }),
      );
      return [
        `The better method has the higher mean in ${(100 * right(seeds)).toFixed(0)} % of such comparisons.`,
        `A 95 % interval of the difference is about ±${number(1.96 * scatterOfDifference(scatter, seeds), 1)} points.`, "",
        "Four times as many trainings halve the interval.",
      ].join("\n");
    };
  },
});
