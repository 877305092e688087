// Backpropagation through one hidden unit, a number at a time.

/** All numbers of the two passes for an input, a hidden unit and an output, without biases. */
export function passes({ x, y, first, second }) {
  const z2 = first * x;
  const a2 = sigmoid(z2);
  const z3 = second * a2;
  const a3 = sigmoid(z3);
  const delta3 = -(y - a3) * a3 * (1 - a3);
  const delta2 = second * delta3 * a2 * (1 - a2);
  return { z2, a2, z3, a3, cost: 0.5 * (a3 - y) ** 2, delta3, delta2, gradient2: a2 * delta3, gradient1: x * delta2 };
}

const STEPS = 8;

export default explorable({
  controls: () => {
    const weight = (label, value) => range({ label, from: -8, to: 8, step: 0.5, value, text: (w) => number(w, 1) });
    return {
      first: weight("first weight w₁", 1), second: weight("second weight w₂", 2),
      x: range({ label: "input x", from: 0, to: 1, step: 0.1, value: 0.8, text: (v) => v.toFixed(1) }),
      y: range({ label: "label y", from: 0, to: 1, step: 0.1, value: 0.2, text: (v) => v.toFixed(1) }),
      back: press({ label: "One step back", act: (state) => (state.step -= 1), off: ({ step }) => step === 0 }),
      next: press({ label: "Next step", act: (state) => (state.step += 1), off: ({ step }) => step === STEPS }),
      all: press({ label: "All steps", act: (state) => (state.step = STEPS), off: ({ step }) => step === STEPS }),
    };
  },
  start: () => ({ step: 0 }),
  draw({ stage }) {
    const picture = svg("svg", { viewBox: "0 0 384 170", width: 384, height: 170, role: "img" });
    stage.append(h("figure", {}, picture));
    const [LEFT_X, MIDDLE_X, RIGHT_X, ROW] = [44, 192, 334, 80];
    const text = (x, y, words, more = {}) => svg("text", { x, y, "text-anchor": "middle", "font-size": 14, ...more }, words);
    return (state) => {
      const { x, y, first, second, step } = state;
      const n = passes(state);
      const three = (value) => number(value, 3);
      const unit = (cx, name, value, error, active) => [
        svg("circle", { cx, cy: ROW, r: 24, fill: PALETTE.SKY, "fill-opacity": active ? 0.45 : 0.08, stroke: PALETTE.INK, "stroke-width": 1.5 }),
        text(cx, ROW + 5, value), text(cx, ROW - 34, name, { class: "quiet" }),
        text(cx, ROW + 48, error, { style: `fill: ${PALETTE.VERMILION}`, "font-weight": 600 }),
      ];
      const edge = (from, to, name, weight, gradient) => [
        svg("line", { x1: from + 24, x2: to - 24, y1: ROW, y2: ROW, stroke: weight < 0 ? PALETTE.VERMILION : PALETTE.BLUE, "stroke-width": 1 + Math.abs(weight) / 2 }),
        text((from + to) / 2, ROW - 14, `${name} = ${number(weight, 1)}`),
        text((from + to) / 2, ROW + 74, gradient, { style: `fill: ${PALETTE.VERMILION}` }),
      ];
      picture.replaceChildren(
        ...edge(LEFT_X, MIDDLE_X, "w₁", first, step >= 7 ? `∂J/∂w₁ = ${number(n.gradient1, 4)}` : ""),
        ...edge(MIDDLE_X, RIGHT_X, "w₂", second, step >= 8 ? `∂J/∂w₂ = ${number(n.gradient2, 4)}` : ""),
        ...unit(LEFT_X, "input", number(x, 1), "", true),
        ...unit(MIDDLE_X, "hidden", step >= 2 ? three(n.a2) : "", step >= 6 ? `δ = ${number(n.delta2, 4)}` : "", step >= 2),
        text(RIGHT_X - 4, 18, `label ${number(y, 1)}`),
        ...unit(RIGHT_X, "output", step >= 4 ? three(n.a3) : "", step >= 5 ? `δ = ${number(n.delta3, 4)}` : "", step >= 4),
      );
      set(picture, { "aria-label": `A network of three units after step ${step} of ${STEPS}` });
      const lines = [
        `1. z⁽²⁾ = w₁ x = ${number(first, 1)} · ${number(x, 1)} = ${three(n.z2)}`,
        `2. a⁽²⁾ = f(z⁽²⁾) = ${three(n.a2)}`,
        `3. z⁽³⁾ = w₂ a⁽²⁾ = ${number(second, 1)} · ${three(n.a2)} = ${three(n.z3)}`,
        `4. a⁽³⁾ = f(z⁽³⁾) = ${three(n.a3)}; the label is ${number(y, 1)}`,
        `5. output's error: −(y − a⁽³⁾) · a⁽³⁾(1 − a⁽³⁾) = ${number(n.delta3, 4)}`,
        `6. hidden error: w₂ δ⁽³⁾ · a⁽²⁾(1 − a⁽²⁾) = ${number(n.delta2, 4)}`,
        `7. ∂J/∂w₁ = x δ⁽²⁾ = ${number(n.gradient1, 4)}`,
        `8. ∂J/∂w₂ = a⁽²⁾ δ⁽³⁾ = ${number(n.gradient2, 4)}`,
      ];
      return step === 0 ? "Nothing is computed yet. Press “Next step”." : lines.slice(0, step).join("\n");
    };
  },
});
