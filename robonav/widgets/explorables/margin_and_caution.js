// The expert's path with a margin and with caution.

/** Which of the paths belongs to a margin and a caution. */
export const placeOf = ({ margins, cautions }, { margin, caution }) => cautions.indexOf(caution) * margins.length + margins.indexOf(margin);

export default explorable({
  controls: ({ margins, cautions }) => ({
    margin: range({ label: "margin", from: margins[0], to: margins.at(-1), step: margins[1] - margins[0], value: margins[0], text: (value) => `${value} m` }),
    caution: segments({ label: "caution (extra cost near obstacles)", options: cautions, value: 0 }),
  }),
  draw({ given, stage }) {
    const board = mapCanvas({ role: "img" });
    stage.append(h("figure", {}, board.canvas, legend([PALETTE.VERMILION, "margin 1 m, no caution"], [PALETTE.BLUE, "your setting"])));
    return (state) => {
      const [shortest, mine] = [given.paths[0], given.paths[placeOf(given, state)]];
      board.begin(given.world.size);
      given.world.obstacles.forEach((obstacle) => board.obstacle(obstacle));
      board.start(given.world.start);
      board.target(given.world.target);
      board.line(shortest.points, PALETTE.VERMILION, 2);
      board.line(mine.points, PALETTE.BLUE, 3);
      const longer = number((100 * (mine.length - shortest.length)) / shortest.length, 1);
      set(board.canvas, { "aria-label": `A map with the expert's path, ${number(mine.length, 0)} m long` });
      return [
        mine === shortest ? `Length: ${number(mine.length, 0)} m, the shortest of all settings.` : `Length: ${number(mine.length, 0)} m, which is ${longer} % more than ${number(shortest.length, 0)} m.`,
        `Nearest to anything: ${number(mine.clearance, 1)} m.`,
      ].join("\n");
    };
  },
});
