"""Several robots on one map: how arrivals and collisions change with their number."""

from __future__ import annotations

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from robonav import style
from robonav.benchmark import display_name
from robonav.experiments import Results

PANELS = {
    "success": "robots that arrive (%)",
    "collision with a robot": "that hit a robot (%)",
}
MARKERS = "osD^vP"
LEARNERS = {1: style.ORANGE, 8: style.BLUE}
"""The colour of policies by the number of robots on a map in their training."""


def draw_against_robots(results: Results) -> Figure:
    """Draw arrivals, and collisions with robots, against the number of robots: one line a method, 95 % intervals.

    A line is one value of the first setting of the cases: a method, or the number of robots in training.
    """
    cases = list(results.experiment.cases)
    first = next(iter(cases[0]))
    lines = list(dict.fromkeys(case[first] for case in cases))
    figure, panels = plt.subplots(2, figsize=(style.FIGURE_WIDTH, 6.4), sharex=True)
    for axes, (metric, label) in zip(panels, PANELS.items(), strict=True):
        for line, marker in zip(lines, MARKERS, strict=False):
            places = [k for k, case in enumerate(cases) if case[first] == line]
            robots = [float(cases[k]["robots"]) for k in places]
            found = [results.summary(metric, k) for k in places]
            means = [each.mean for each in found]
            name, colour = line_style(line)
            axes.plot(
                robots, means, marker=marker, markersize=5, color=colour, label=name
            )
            low, high = [each.low for each in found], [each.high for each in found]
            axes.vlines(robots, low, high, color=colour)
        axes.set(ylabel=label, xscale="log")
    ticks = sorted({float(case["robots"]) for case in cases})
    panels[-1].set_xticks(ticks, [f"{number:.0f}" for number in ticks])
    panels[-1].minorticks_off()
    panels[-1].set(xlabel="robots on the map")
    panels[0].set_ylim(bottom=0)
    panels[0].legend(loc="lower left")
    return figure


def line_style(line: str | float) -> tuple[str, str]:
    """Return the name and the colour of a method, or of policies by the number of robots in their training.

    Parameters
    ----------
    line : str or float
        The method, or the number.

    Returns
    -------
    name : str
        What a legend says.
    colour : str
        Of the line.

    Examples
    --------
    >>> line_style("dagger")[0], line_style(1)[0], line_style(8)[0]
    ('DAgger', 'learned alone', 'learned among 8')
    """
    if isinstance(line, str):
        return display_name(line), style.METHOD_COLOURS.get(line, style.INK)
    name = "learned alone" if line == 1 else f"learned among {line}"
    return name, LEARNERS.get(int(line), style.INK)
