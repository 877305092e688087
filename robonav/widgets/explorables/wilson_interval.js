// How much a number of test maps says: Wilson's interval.

const COUNTS = [8, 20, 50, 100, 200, 500, 1000];

export default explorable({
  controls: () => ({
    maps: segments({ label: "new maps", options: COUNTS, value: COUNTS[1] }),
    share: range({ label: "reached", from: 0, to: 1, step: 0.01, value: 0.99, text: (share) => `${Math.round(100 * share)} %` }),
  }),
  draw({ stage }) {
    const chart = plot({ x: [0, 100], y: [0, COUNTS.length], xLabel: "success rate (%)", yLabel: "new maps", yTicks: [], height: 270 });
    stage.append(h("figure", {}, chart.element));
    return ({ maps, share }) => {
      const reached = Math.round(share * maps);
      const shapes = COUNTS.flatMap((count, k) => {
        const successes = Math.round(share * count);
        const [low, high] = wilsonInterval(successes, count);
        const y = chart.Y(COUNTS.length - 0.5 - k);
        const mine = count === maps;
        return [
          svg("text", { x: chart.X(0) - 5, y: y + 4.5, "text-anchor": "end", "font-size": 13, "font-weight": mine ? 700 : 400 }, String(count)),
          svg("line", { x1: chart.X(100 * low), x2: chart.X(100 * high), y1: y, y2: y, stroke: mine ? PALETTE.BLUE : PALETTE.INK, "stroke-width": mine ? 7 : 3 }),
          svg("circle", { cx: chart.X((100 * successes) / count), cy: y, r: mine ? 6 : 4, fill: mine ? PALETTE.BLUE : PALETTE.INK }),
        ];
      });
      const [low, high] = wilsonInterval(reached, maps);
      chart.put(`Intervals of the success rate for ${COUNTS.join(", ")} maps`, ...shapes);
      return [
        `${reached} of ${maps} maps reached.`,
        `95 % interval of the true rate: ${number(100 * low, 1)} % to ${number(100 * high, 1)} %, which is ${number(100 * (high - low), 1)} points wide.`,
      ].join("\n");
    };
  },
});
