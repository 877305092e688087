// The distance of the nearest thing before and after a step, and the row of Table 4.1 that holds.

const PROPERTY = ["safe", "cozy", "dangerous"];

export default explorable({
  controls: () => ({
    before: range({ label: "nearest thing before the step", from: 1, to: 10, step: 0.5, value: 8, text: (value) => `${value.toFixed(1)} m` }),
    after: range({ label: "nearest thing after the step", from: 1, to: 10, step: 0.5, value: 8, text: (value) => `${value.toFixed(1)} m` }),
  }),
  draw({ given: { rows }, stage }) {
    const cells = rows.map((row) => {
      const words = [`${row.from} → ${row.to}`, row.condition || "anywhere", number(row.reward, 1)];
      return h("tr", {}, ...words.map((text, k) => h(k === 0 ? "th" : "td", k === 0 ? { scope: "row" } : {}, text)));
    });
    stage.append(h("figure", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table 4.1" }, h("table", { class: "results rows" },
      h("thead", {}, h("tr", {}, ...["from → to", "the nearest thing is", "reward"].map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...cells))));
    return ({ before, after }) => {
      const row = rewardRow({ ranges: [before] }, { ranges: [after] }, "running");
      cells.forEach((cell, k) => cell.classList.toggle("holds", k === row));
      const nearer = Math.max(0, Math.floor(before - after));
      return [
        `Before: ${before.toFixed(1)} m, ${PROPERTY[propertyAt(before)]}. After: ${after.toFixed(1)} m, ${PROPERTY[propertyAt(after)]}.`,
        `Nearer by ${nearer} whole metres.`, "", `The reward is ${number(rows[row].reward, 1)}.`,
      ].join("\n");
    };
  },
});
