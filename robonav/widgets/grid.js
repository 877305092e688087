// The picture of a grid with values and arrows.

const CELL = 64; // pixels
const MOVES = [[0, -1], [1, 0], [0, 1], [-1, 0]]; // across and down, of the actions up, right, down, left
const WORDS = ["up", "right", "down", "left"];
const [PALE, DARK, STRENGTH] = ["#F3F4F5", "#1F2328", 0.6]; // as plots/mdp.py has them

const parts = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** The colour of a value, given as a share of the strongest, -1 to 1: blue where positive, red where negative. */
export function colourOf(share) {
  const full = parts(share > 0 ? PALETTE.BLUE : PALETTE.VERMILION);
  const mixed = parts(PALE).map((pale, i) => Math.round(pale + STRENGTH * Math.min(Math.abs(share), 1) * (full[i] - pale)));
  return `rgb(${mixed.join(", ")})`;
}

/** A value in few letters, with a minus sign that is one. */
export function short(value) {
  const size = Math.abs(value);
  const digits = size >= 99.5 ? 0 : size >= 9.95 ? 1 : 2;
  return `${value < 0 && Number(size.toFixed(digits)) > 0 ? "−" : ""}${size.toFixed(digits)}`;
}

/** The state beside another one: where the arrow keys move the mark. Walls are stepped over, borders hold. */
export function beside(cells, state, [across, down]) {
  const [row, column] = cells[state];
  const ahead = cells
    .map(([r, c], s) => [s, (r - row) * down + (c - column) * across, (r - row) * across, (c - column) * down])
    .filter(([, distance, ...aside]) => distance > 0 && aside.every((off) => off === 0))
    .sort((one, other) => one[1] - other[1]);
  return ahead.length ? ahead[0][0] : state;
}

/**
 * A grid as Python's `page_grid` describes it: each cell with value and arrow, one of them marked.
 * `mark` hears of a cell touched; `write` makes a text of a value.
 */
export function gridPicture({ layout, name, mark = () => {}, write = short }) {
  const [rows, columns] = [layout.rows.length, layout.rows[0].length];
  const [width, height] = [columns * CELL, rows * CELL];
  const middle = ([row, column]) => [(column + 0.5) * CELL, (row + 0.5) * CELL];
  const ends = new Set(layout.ends);
  const element = svg("svg", { viewBox: `-2 -2 ${width + 4} ${height + 4}`, width: width + 4, height: height + 4, role: "img", class: "grid" });
  const base = element.appendChild(svg("g", {}));
  base.append(svg("rect", { width, height, fill: PALETTE.OBSTACLE }));
  const path = element.appendChild(svg("path", { fill: "none", stroke: PALETTE.ORANGE, "stroke-width": 4, "stroke-linejoin": "round", class: "trajectory still" }));
  const marks = element.appendChild(svg("g", { class: "marks" })); // over the path, which must not hide a number
  const cells = layout.cells.map((place, state) => {
    const [row, column] = place;
    const [x, y] = middle(place);
    const letter = layout.rows[row][column];
    const box = svg("rect", {
      x: column * CELL, y: row * CELL, width: CELL, height: CELL, stroke: PALETTE.INK, "stroke-width": 0.8, class: "cell",
      click: () => mark(state),
    });
    const arrow = svg("path", { d: "M0 15V-11M-6 -5L0 -14L6 -5", fill: "none", stroke: DARK, "stroke-width": 2.4, class: "arrow", transform: `translate(${x} ${y - 9})` });
    const text = svg("text", { x, y: y + 25, "text-anchor": "middle", "font-size": 14, style: `fill: ${DARK}` });
    base.append(box);
    marks.append(arrow, text);
    if (ends.has(state)) {
      const reward = layout.rewards[state];
      arrow.remove();
      marks.append(svg("rect", { x: x - 26, y: y - 26, width: 52, height: 52, fill: "none", stroke: DARK, "stroke-width": 2, class: "still" }));
      const lettered = /[A-Z]/.test(letter);
      set(text, { y: y + (lettered ? 17 : 6), "font-size": 18 });
      text.textContent = `${reward < 0 ? "−" : reward > 0 ? "+" : ""}${Math.abs(reward)}`;
      if (lettered) marks.append(svg("text", { x: x - 22, y: y - 6, "font-size": 14, style: `fill: ${DARK}` }, letter));
    } else if (letter !== ".") {
      marks.append(svg("text", { x: x - 28, y: y - 14, "font-size": 14, style: `fill: ${DARK}` }, letter));
    }
    return { box, arrow, text, fixed: ends.has(state) };
  });
  const chosen = element.appendChild(svg("rect", { width: CELL - 4, height: CELL - 4, fill: "none", stroke: PALETTE.VERMILION, "stroke-width": 4, class: "still" }));

  const show = ({ values, policy, said, trajectory }, strongest, marked) => {
    cells.forEach(({ box, arrow, text, fixed }, state) => {
      box.setAttribute("fill", fixed ? PALE : colourOf(values[state] / strongest));
      if (fixed) return;
      const [x, y] = middle(layout.cells[state]);
      arrow.setAttribute("transform", `translate(${x} ${y - 9}) rotate(${90 * policy[state]})`);
      text.textContent = write(values[state]);
    });
    path.setAttribute("d", trajectory.map((state, i) => `${i ? "L" : "M"}${middle(layout.cells[state]).join(" ")}`).join(""));
    const [row, column] = layout.cells[marked] ?? [0, 0];
    set(chosen, { x: column * CELL + 2, y: row * CELL + 2, visibility: marked in layout.cells ? "visible" : "hidden" });
    element.setAttribute("aria-label", `${name}: ${said}`);
  };
  return { element, show };
}

/** Lets the arrow keys move the mark from cell to cell. */
export function marksByKeys(element, { cells, marked, mark }) {
  set(element, { tabindex: 0 });
  element.addEventListener("keydown", (event) => {
    const direction = ["ArrowUp", "ArrowRight", "ArrowDown", "ArrowLeft"].indexOf(event.key);
    if (direction < 0) return;
    event.preventDefault();
    mark(beside(cells(), marked(), MOVES[direction]));
  });
}
