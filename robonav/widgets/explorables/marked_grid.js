// A grid to mark and to press: a touch or the arrow keys mark a cell; a second touch, or Enter, presses it.

/**
 * @param {object} parts
 * @param {(change: (state: State) => void) => void} parts.act changes the state; its `marked` is the marked cell
 * @param {(state: State, cell: number) => void} parts.press what pressing a cell does
 * @param {boolean} [parts.once] whether the first touch presses already
 */
export function markedGrid({ layout, name, help, act, press, once = false }) {
  const pressed = (state, cell) => layout.ends.includes(cell) || press(state, cell);
  const touched = (cell) => act((state) => {
    if (once || cell === state.marked) pressed(state, cell);
    state.marked = cell;
  });
  const grid = gridPicture({ layout, name, mark: touched });
  const element = h("div", { role: "group", "aria-label": help, "data-keys": "ArrowUp Enter" }, grid.element);
  let marked = 0;
  marksByKeys(element, { cells: () => layout.cells, marked: () => marked, mark: (cell) => act((state) => (state.marked = cell)) });
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    act((state) => pressed(state, state.marked));
  });
  element.querySelectorAll(".cell")[layout.cells.findIndex((_, cell) => !layout.ends.includes(cell))].setAttribute("data-touch", "");
  const show = (frame, strongest, cell) => {
    marked = cell;
    grid.show(frame, strongest, cell);
  };
  const where = (cell) => `row ${layout.cells[cell][0] + 1}, column ${layout.cells[cell][1] + 1}`;
  return { element, show, where };
}
