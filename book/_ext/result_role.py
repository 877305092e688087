"""Numbers in the text that are read from results, so that no number is typed by hand.

``{result}`table-4.3; method=nnql; success``` becomes the mean of a metric of the committed results of an experiment,
such as 98.5. The parts are separated by semicolons, and their order after the first is free:

- the name of the experiment comes first;
- ``key=value`` chooses the case, and ``step=29`` or ``step=last`` the step of a curve;
- a metric, without which ``success`` is read;
- a statistic: ``mean`` (without one), ``interval`` (98.4 to 98.7), ``with interval`` (98.5 [98.4, 98.7]), ``worst``,
  ``best``, ``deviation``, ``interquartile mean``, ``seeds``, or ``thesis`` for the number that the thesis reports;
- a format, such as ``.0f``.

``{benchmark}`300 iterations: * ms``` becomes the number at the place of the (last) star in the output of the benchmarks
(``book/benchmarks.md``). A format may follow, as in ``{benchmark}`300 iterations: * ms; .0f```.

The numbers are put into the source before it is parsed. They therefore work in tables and captions as well. They do not
stand in code cells: a notebook is executed before its numbers are put in, and would be executed once more after that.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

from robonav.experiments.runner.experiment import Results
from robonav.experiments.runner.report import short, thesis_number, usual_format
from robonav.experiments.runner.results import read_results
from robonav.experiments.runner.statistics import Summary, summarise

BENCHMARKS = Path(__file__).parents[1] / "benchmarks.md"
ROLE = re.compile(r"\{(?P<kind>result|benchmark)\}`(?P<text>[^`]+)`")
FORMAT = re.compile(r"\+?,?\.\d+[a-z%]")
NUMBER = re.compile(r"-?\d[\d,]*(?:\.\d+)?")
STATISTICS = (
    "mean",
    "interval",
    "with interval",
    "worst",
    "best",
    "deviation",
    "interquartile mean",
    "seeds",
    "thesis",
)

_results = cache(read_results)


def with_results(markdown: str) -> str:
    """Return the text of a page with all its results and benchmarks as numbers."""
    return ROLE.sub(
        lambda role: {"result": result, "benchmark": benchmark}[role["kind"]](
            role["text"]
        ),
        markdown,
    )


def result(text: str) -> str:
    """Return the number that the role ``{result}`` asks for.

    Raises
    ------
    ValueError
        If there is no such experiment, metric or step, or not exactly one such case.
    """
    name, *parts = (part.strip() for part in text.split(";"))
    results = _results(name)
    keys = results.experiment.cases[0]
    chosen, metric, statistic, form, step = {}, "success", "mean", None, None
    for part in parts:
        key, _, value = (side.strip() for side in part.partition("="))
        if key in keys:
            chosen[key] = value
        elif key == "step":
            step = value
        elif part in STATISTICS:
            statistic = part
        elif FORMAT.fullmatch(part):
            form = part
        else:
            metric = part
    case = _only_case(results, chosen)
    if statistic == "thesis":
        number = thesis_number(results, metric, case)
        if number is None:
            raise ValueError(f"the thesis has no number for {text}")
        return format(number, form or "g")
    values = results.values(metric, case)
    if values.ndim == 2:
        if step is None:
            raise ValueError(f"{text} is a curve: choose a step, such as step=last")
        values = values[:, -1 if step == "last" else int(step)]
    return _written(summarise(values), statistic, form)


def _only_case(results: Results, chosen: dict[str, str]) -> int:
    """Return the place of the one case with the chosen settings."""
    cases = results.experiment.cases
    found = [
        place
        for place, case in enumerate(cases)
        if all(str(case[key]) == value for key, value in chosen.items())
    ]
    if len(found) != 1:
        known = "; ".join(
            ", ".join(f"{key}={value}" for key, value in case.items()) for case in cases
        )
        raise ValueError(
            f"{results.experiment.name} must have one case with {chosen}, got {len(found)} of: {known}"
        )
    return found[0]


def _written(summary: Summary, statistic: str, form: str | None) -> str:
    """Return a statistic as text. Without a format, the digits depend on the size of the mean."""
    if statistic == "seeds":
        return str(summary.seeds)
    form = form or usual_format(summary)
    if statistic == "interval":
        return f"{summary.low:{form}} to {summary.high:{form}}"
    if statistic == "with interval":
        return short(summary, form)
    return format(getattr(summary, statistic.replace(" ", "_")), form)


def benchmark(text: str) -> str:
    """Return the number at the place of the star, in the one line of the benchmarks that has this text.

    Raises
    ------
    ValueError
        If no line has the text, or more than one.
    """
    text, _, form = text.partition(";")
    before, star, after = text.rpartition("*")
    places = re.findall(
        rf"{re.escape(before)}\s*({NUMBER.pattern}){re.escape(after)}",
        BENCHMARKS.read_text("utf-8"),
    )
    if not star or len(places) != 1:
        raise ValueError(
            f"one line of the benchmarks must have the text {text!r} with a star for the number, got {len(places)}"
        )
    found = str(places[0])
    return format(float(found.replace(",", "")), form.strip()) if form else found


def put_in(app: Sphinx, page: str, source: list[str]) -> None:
    """Put the numbers into a page before it is parsed."""
    try:
        source[0] = with_results(source[0])
    except (ValueError, FileNotFoundError) as error:
        raise ExtensionError(f"{page}: {error}") from None


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", put_in)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
