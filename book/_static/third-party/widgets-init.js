// Loaded after require.js on pages with widgets: where the local copies lie, and two repairs they need.
(() => {
  const base = document.currentScript.src.replace(/[^/]*$/, "");
  const manager = `${base}html-manager`;
  // The widget manager looks for its fonts under this address.
  window.__jupyter_widgets_assets_path__ = `${manager}/`;
  requirejs.config({
    paths: {
      anywidget: `${base}anywidget/index`,
      "@jupyter-widgets/html-manager/dist": manager,
      "@jupyter-widgets/html-manager": `${manager}/index`,
      "@jupyter-widgets/base": `${manager}/base`,
      "@jupyter-widgets/controls": `${manager}/controls`,
    },
  });
  // ipywidgets still calls MathJax 2's queue; MathJax 3 has promises.
  document.addEventListener("DOMContentLoaded", () => {
    const mathjax = window.MathJax;
    if (!mathjax || mathjax.Hub) return;
    const typeset = (element) => mathjax.startup.promise.then(() => mathjax.typesetPromise([element]));
    mathjax.Hub = {
      Queue: (job) => job && job[2] instanceof Element && typeset(job[2]),
      Config() {},
      Configured() {},
      Register: { StartupHook() {} },
    };
  });
})();
