// From disk a page may not read its neighbours, so the search lists its hits without an excerpt of each.
if (location.protocol === "file:" && typeof DOCUMENTATION_OPTIONS !== "undefined") {
  DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;
}

// The colours are right from the first line on: the theme would set them when the page is whole, and style all of it again.
if (document.documentElement.dataset.mode === "auto") {
  document.documentElement.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

// All icons stand in the page from the beginning: there is no need to look for more in every formula that is set.
globalThis.FontAwesomeConfig = { observeMutations: false };

// Formulas are set a few at a time, so that the page answers to a touch in between.
const FORMULAS_AT_ONCE = 10;
if (globalThis.MathJax) {
  MathJax.startup = { ...MathJax.startup, pageReady: async () => {
    const places = [...document.querySelectorAll(".math, .output_area")].filter((place) => !place.parentElement.closest(".math, .output_area"));
    for (let at = 0; at < places.length; at += FORMULAS_AT_ONCE) {
      await MathJax.typesetPromise(places.slice(at, at + FORMULAS_AT_ONCE));
      await new Promise((resolve) => setTimeout(resolve));
    }
  } };
}

// The page's notebook is saved under its name, where the browser by itself might show its text.
document.addEventListener("click", (event) => {
  const link = event.target.closest("a.btn-download-notebook-button");
  const notebook = document.getElementById("notebook");
  if (!link || !notebook) return;
  event.preventDefault();
  const file = document.createElement("a");
  file.href = URL.createObjectURL(new Blob([notebook.textContent], { type: "application/x-ipynb+json" }));
  file.download = link.pathname.split("/").pop();
  file.click();
  setTimeout(() => URL.revokeObjectURL(file.href), 1000);
});

// A table or an output that is wider than the page says so. The line that says it changes the height, so only a new width
// is looked at: else the two would change each other for ever.
document.addEventListener("DOMContentLoaded", () => {
  const widths = new WeakMap();
  const watch = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      if (widths.get(target) === target.clientWidth) continue;
      widths.set(target, target.clientWidth);
      target.removeAttribute("data-cut");
      target.toggleAttribute("data-cut", target.scrollWidth > target.clientWidth + 1);
    }
  });
  for (const place of document.querySelectorAll(".pst-scrollable-table-container, .cell_output pre")) watch.observe(place);
});

// The theme's buttons that unfold pages in the sidebar have no name of their own.
document.addEventListener("DOMContentLoaded", () => {
  for (const button of document.querySelectorAll("nav .has-children > details > summary")) {
    button.setAttribute("aria-label", `Pages below “${button.closest("li").querySelector("a").textContent.trim()}”`);
  }
});

// An answer of a quiz that is a formula alone is named by its source; a drawn formula has no text.
document.addEventListener("DOMContentLoaded", () => {
  for (const answer of document.querySelectorAll(".quiz summary:has(.math)")) {
    const words = answer.cloneNode(true);
    words.querySelectorAll(".math").forEach((formula) => formula.remove());
    if (words.textContent.trim() === "") answer.setAttribute("aria-label", answer.textContent.replaceAll(/\\[()]/g, "").trim());
  }
});
