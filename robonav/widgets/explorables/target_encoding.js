// Four ways to tell a network in which sector the target lies, and how far neighbours are apart in each.

const NAMES = { number: "1 to 9", signed: "−4 to 4", "one-hot": "one-hot", "sine-cosine": "sine and cosine" };

/** The inputs for a sector, 1 to 9. */
export const encodedTarget = (encoding, sector) => TARGETS[encoding](sector);

/** How far the inputs of two sectors are apart. */
export const jump = (encoding, one, other) => Math.hypot(...encodedTarget(encoding, one).map((value, k) => value - encodedTarget(encoding, other)[k]));

const after = (sector) => (sector % ROBOT.sensors) + 1;

export default explorable({
  controls: () => ({
    encoding: segments({ label: "encoding", options: Object.entries(NAMES), value: "number" }),
    sector: range({ label: "the target is in sector", from: 1, to: 9, value: 1 }),
    on: press({ label: "Move on by one sector", act: (state) => (state.sector = after(state.sector)) }),
  }),
  draw({ stage }) {
    const [SIDE, R] = [260, 100];
    const dial = svg("svg", { viewBox: `0 0 ${SIDE} ${SIDE}`, width: SIDE, height: SIDE, role: "img" });
    const chart = plot({ x: [0.4, 9.6], y: [0, 2], xLabel: "from this sector to the next", yLabel: "jump of the inputs", height: 200, xTicks: [1, 2, 3, 4, 5, 6, 7, 8, 9] });
    stage.append(h("figure", {}, dial, chart.element));
    const place = (angle, radius) => [SIDE / 2 - radius * Math.sin(angle), SIDE / 2 - radius * Math.cos(angle)];
    return ({ encoding, sector }) => {
      const wedges = Array.from({ length: ROBOT.sensors }, (_, k) => {
        const [a, b] = [place((k - 0.5) * ROBOT.sector, R), place((k + 0.5) * ROBOT.sector, R)];
        const [x, y] = place(k * ROBOT.sector, 75);
        return [
          svg("path", { d: `M${SIDE / 2} ${SIDE / 2}L${a.join(" ")}A${R} ${R} 0 0 0 ${b.join(" ")}Z`, fill: k + 1 === sector ? PALETTE.ORANGE : PALETTE.SKY, "fill-opacity": k + 1 === sector ? 0.6 : 0.2, stroke: PALETTE.INK }),
          svg("text", { x, y: y + 5, "text-anchor": "middle", "font-size": 14 }, String(k + 1)),
        ];
      });
      const [tx, ty] = place((sector - 1) * ROBOT.sector, 117);
      const robot = svg("path", { d: `M${SIDE / 2} ${SIDE / 2 - 14}L${SIDE / 2 + 9} ${SIDE / 2 + 10}H${SIDE / 2 - 9}Z`, fill: PALETTE.ROBOT });
      dial.replaceChildren(...wedges.flat(), robot, svg("circle", { cx: tx, cy: ty, r: 9, fill: "none", stroke: PALETTE.TARGET, "stroke-width": 3 }));
      set(dial, { "aria-label": `Nine sectors around the robot; the target is in sector ${sector}` });
      const jumps = Array.from({ length: ROBOT.sensors }, (_, k) => jump(encoding, k + 1, after(k + 1)));
      const bars = jumps.map((size, k) => svg("rect", {
        x: chart.X(k + 0.65), width: chart.X(0.7) - chart.X(0), y: chart.Y(size), height: chart.Y(0) - chart.Y(size), fill: k + 1 === sector ? PALETTE.ORANGE : PALETTE.BLUE,
      }));
      chart.put(`Jumps of the inputs from each sector to the next: ${jumps.map((size) => number(size)).join(", ")}`, ...bars);
      return [
        `Inputs for sector ${sector}: ${encodedTarget(encoding, sector).map((value) => number(value)).join(", ")}.`,
        `Inputs for sector ${after(sector)}: ${encodedTarget(encoding, after(sector)).map((value) => number(value)).join(", ")}.`,
        `They are ${number(jump(encoding, sector, after(sector)))} apart. The largest jump between neighbours is ${number(Math.max(...jumps))}.`,
      ].join("\n");
    };
  },
});
