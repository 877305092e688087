// Tile coding on a line: an update in one place moves the value of every place that shares tiles with it.

/** The number of the tile that holds a place, in one of several grids; the grids are shifted by parts of a tile. */
export const tileOf = (place, width, grid, grids) => Math.floor(place / width + grid / grids);

/** The share of its tiles that one place has in common with another: by so much of its own rise the value of the other rises. */
export function sharedTiles(place, other, width, grids) {
  const same = Array.from({ length: grids }, (_, k) => tileOf(place, width, k, grids) === tileOf(other, width, k, grids));
  return same.filter(Boolean).length / grids;
}

const OFF = 0.03; // no place lies on the border of a tile

export default explorable({
  controls: ({ length, most, tilings }) => ({
    grids: range({ label: "tilings", from: 1, to: most, value: tilings }),
    width: segments({ label: "width of a tile", options: [[0.5, "0.5 m"], [1, "1 m"], [1.5, "1.5 m"], [2, "2 m"]], value: 1 }),
    place: range({ label: "place of the update (m)", from: 1, to: length - 3, step: 0.1, value: 2.2, text: (value) => value.toFixed(1) }),
    apart: range({ label: "metres to the other place", from: 0, to: 2, step: 0.1, value: 0, text: (value) => value.toFixed(1) }),
  }),
  draw({ given: { length, most }, stage }) {
    const rise = plot({ x: [0, length], y: [0, 1.1], xLabel: "place (m)", yLabel: "rise of the value", height: 190, yTicks: [0, 0.5, 1] });
    const tiles = plot({ x: [0, length], y: [0, most], xLabel: "place (m)", yLabel: "tilings", height: 230, yTicks: [] });
    stage.append(h("figure", {}, rise.element, tiles.element, legend([PALETTE.BLUE, "place of the update, and its tiles"], [PALETTE.ORANGE, "the other place"])));
    return ({ grids, width, place, apart }) => {
      const [own, other] = [place + OFF, place + OFF + apart];
      const share = sharedTiles(own, other, width, grids);
      const places = Array.from({ length: 10 * length }, (_, k) => k / 10 + OFF);
      const dot = (x, y, fill) => svg("circle", { cx: rise.X(x), cy: rise.Y(y), r: 6, fill });
      rise.put(
        `The value rises by ${number(share)} where ${number(apart, 1)} m lie between`,
        rise.line(places.map((x) => [x, sharedTiles(own, x, width, grids)]), { stroke: PALETTE.GREY }),
        dot(own, 1, PALETTE.BLUE), dot(other, share, PALETTE.ORANGE),
      );
      const tile = (k, number) => {
        const [from, to] = [0, 1].map((side) => Math.min(length, Math.max(0, (number + side - k / grids) * width)));
        const held = tileOf(own, width, k, grids) === number;
        return svg("rect", {
          x: tiles.X(from), y: tiles.Y(k + 0.9), width: tiles.X(to) - tiles.X(from), height: tiles.Y(0.1) - tiles.Y(0.9),
          fill: held ? PALETTE.BLUE : "none", stroke: PALETTE.GREY, "stroke-width": 1.5,
        });
      };
      const rows = Array.from({ length: grids }, (_, k) => k);
      const across = (x, stroke) => svg("line", { x1: tiles.X(x), x2: tiles.X(x), y1: tiles.Y(0), y2: tiles.Y(grids), stroke, "stroke-width": 3 });
      tiles.put(
        `${grids} ${grids === 1 ? "tiling" : "tilings"} of tiles ${width} m wide`,
        ...rows.flatMap((k) => Array.from({ length: Math.ceil(length / width) + 1 }, (_, number) => tile(k, number))),
        across(other, PALETTE.ORANGE),
      );
      const common = Math.round(share * grids);
      return [
        `The update raises the value of its own place by 1.`,
        `The other place shares ${common} of ${grids} ${grids === 1 ? "tile" : "tiles"} with it, so its value rises by ${number(share)}.`, "",
        `No place that is ${width} m or more away shares a tile with it.`,
      ].join("\n");
    };
  },
});
