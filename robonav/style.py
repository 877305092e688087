"""The palette that matplotlib and JavaScript share, and the matplotlib style.

The colours are those of Okabe and Ito (2008): colour-blind readers can tell them apart on light and dark pages.
A method has the same colour on every page.
"""

from __future__ import annotations

from typing import Any

BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
SKY, PURPLE, YELLOW, GREY = "#56B4E9", "#CC79A7", "#F0E442", "#7F7F7F"

ROBOT, TARGET, OBSTACLE, MOVING = BLUE, VERMILION, "#767B81", PURPLE

METHOD_COLOURS: dict[str, str] = {
    "straight": GREY,
    "freer-side": "#A6761D",
    "A*": ORANGE,
    "grid A*": SKY,
    "lfd": BLUE,
    "dagger": SKY,
    "knn": YELLOW,
    "nnql": GREEN,
    "online": ORANGE,
    "nfq": PURPLE,
    "dqn": VERMILION,
    "nirl": VERMILION,
    "apprenticeship": ORANGE,
    "relative-entropy": PURPLE,
    "scirl": SKY,
    "ppo": SKY,
    "potential-field": BLUE,
    "vfh": ORANGE,
    "dynamic-window": GREEN,
    "bug": PURPLE,
    "known-map": VERMILION,
}

# On a phone a figure is as wide as the page. At this width its 10 pt text is then 9 px high.
FIGURE_WIDTH = 5.2  # inches

# Figures are transparent. This grey has a contrast of 5:1 on a white page, and on a dark page too when the figure is
# brighter by a quarter, as the book's style sheet shows it there: one file serves both.
INK = "#6E6E6E"
STYLE: Any = {
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.facecolor": "none",
    "savefig.transparent": True,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "axes.titlecolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "grid.color": INK,
    "grid.alpha": 0.25,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 11,
    "axes.labelsize": 10,
    "font.size": 10,
    "legend.frameon": False,
    "lines.linewidth": 1.8,
    "figure.dpi": 110,
    "figure.constrained_layout.use": True,
    "svg.fonttype": "none",
}
