// One neuron with two inputs: its weights draw a line, and say how abruptly the answer changes there.

/** What the neuron answers to a point, Eqs. (3.1) and (3.4). */
export const answer = ({ first, second, bias }, [x1, x2]) => sigmoid(first * x1 + second * x2 + bias);

/** How many examples lie on the side where they belong. */
export const right = (neuron, points, labels) => points.filter((point, i) => (answer(neuron, point) > 0.5 ? 1 : 0) === labels[i]).length;

/** How fast the answer changes on the line and across it: the sigmoid's slope there, 1/4, times the length of the weights. */
export const steepness = ({ first, second }) => 0.25 * Math.hypot(first, second);

const [LOW, HIGH, SHADES] = [-3, 3, 24];

/** The ends of the neuron's line in the picture, where w1 x1 + w2 x2 + b is 0; none where the line lies outside. */
export function lineOf({ first, second, bias }) {
  if (first === 0 && second === 0) return [];
  const along = Math.abs(second) >= Math.abs(first)
    ? [LOW, HIGH].map((x) => [x, (-bias - first * x) / second])
    : [LOW, HIGH].map((y) => [(-bias - second * y) / first, y]);
  return clipped(along);
}

export default explorable({
  controls: ({ sets }) => {
    const weight = (label, value) => range({ label, from: -8, to: 8, step: 0.5, value, text: (w) => number(w, 1) });
    return {
      first: weight("weight w₁", 1), second: weight("weight w₂", 1), bias: weight("bias b", -1),
      double: press({ label: "Double all three", act: (state) => {
        for (const name of ["first", "second", "bias"]) state[name] = Math.max(-8, Math.min(8, 2 * state[name]));
      } }),
      set: segments({ label: "points", options: sets.map(({ name }, k) => [k, name]), value: 0 }),
    };
  },
  draw({ given: { sets }, stage }) {
    const plane = plot({ x: [LOW, HIGH], y: [LOW, HIGH], xLabel: "input x₁", yLabel: "input x₂", height: 380 });
    stage.append(h("figure", {}, plane.element, legend([PALETTE.ORANGE, "label 1, and answers near 1"], [PALETTE.BLUE, "label 0, and answers near 0"])));
    const size = (HIGH - LOW) / SHADES;
    return (neuron) => {
      const { first, second, bias, set: chosen } = neuron;
      const { points, labels } = sets[chosen];
      const shades = Array.from({ length: SHADES * SHADES }, (_, i) => {
        const [x, y] = [LOW + (i % SHADES) * size, LOW + Math.floor(i / SHADES) * size];
        const a = answer(neuron, [x + size / 2, y + size / 2]);
        return svg("rect", {
          x: plane.X(x), y: plane.Y(y + size), width: plane.X(size) - plane.X(0) + 0.3, height: plane.Y(0) - plane.Y(size) + 0.3,
          fill: a > 0.5 ? PALETTE.ORANGE : PALETTE.BLUE, "fill-opacity": (0.7 * Math.abs(a - 0.5)).toFixed(3),
        });
      });
      const inside = lineOf(neuron);
      const dots = points.map(([x, y], i) => svg("circle", { cx: plane.X(x), cy: plane.Y(y), r: 4, fill: labels[i] ? PALETTE.ORANGE : PALETTE.BLUE, stroke: "var(--ink)", "stroke-width": 0.7 }));
      const count = right(neuron, points, labels);
      plane.put(
        `Answers of a neuron with weights ${first} and ${second} and bias ${bias}`,
        ...shades, ...(inside.length ? [plane.line(inside, { stroke: "var(--ink)", "stroke-width": 2 })] : []), ...dots,
      );
      const sign = (w) => (w < 0 ? "−" : "+");
      return [
        `Line: ${number(first, 1)} x₁ ${sign(second)} ${number(Math.abs(second), 1)} x₂ ${sign(bias)} ${number(Math.abs(bias), 1)} = 0`,
        inside.length ? `Across the line the answer changes by ${number(steepness(neuron))} per unit.` : "There is no line within the picture: the neuron gives all points one answer.", "",
        `${count} of ${points.length} points are on the right side.`,
      ].join("\n");
    };
  },
});

/** The part of a straight line, given by two points, that lies in the picture. */
function clipped(ends) {
  const [[x0, y0], [x1, y1]] = ends;
  let [from, to] = [0, 1];
  for (const [start, change] of [[x0, x1 - x0], [y0, y1 - y0]]) {
    if (change === 0) {
      if (start < LOW || start > HIGH) return [];
    } else {
      const [a, b] = [(LOW - start) / change, (HIGH - start) / change].sort((p, q) => p - q);
      [from, to] = [Math.max(from, a), Math.min(to, b)];
    }
  }
  return from < to ? [from, to].map((t) => [x0 + t * (x1 - x0), y0 + t * (y1 - y0)]) : [];
}
