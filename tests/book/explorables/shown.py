"""What an explorable shows at one moment: its controls, its words, its tables and the marks in its pictures."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]

RECORD_MAPS = """() => {
  const pen = CanvasRenderingContext2D.prototype;
  const also = (name, note) => {
    const own = pen[name];
    pen[name] = function (...given) {
      note(this.canvas, given, this);
      return own.apply(this, given);
    };
  };
  const keep = (kind, style) => (canvas, _, { [style]: colour }) =>
    canvas.drawn.push({ kind, colour, points: canvas.path });
  also("clearRect", (canvas) => (canvas.drawn = []));
  also("beginPath", (canvas) => (canvas.path = []));
  for (const name of ["moveTo", "lineTo", "arc"]) also(name, (canvas, [x, y, r = 0]) => canvas.path.push([x, y, r]));
  also("stroke", keep("line", "strokeStyle"));
  also("fill", keep("shape", "fillStyle"));
  also("fillRect", (canvas, [x, y, w, h], { fillStyle }) =>
    canvas.drawn.push({ kind: "square", colour: fillStyle, points: [[x + w / 2, y + h / 2, w]] }));
}"""
"""Lets every canvas note what is drawn on it, since its pixels cannot be read back as numbers."""

LOOK = """(widget) => {
  const all = (selector, read) => [...widget.querySelectorAll(selector)].map(read);
  const text = ({ textContent }) => textContent;
  const label = (element) => element.getAttribute("aria-label");
  const controls = [
    ...all("input[type=range]", (input) => [label(input), input.getAttribute("aria-valuetext")]),
    ...all("input[type=number]", (input) => [label(input), input.value]),
    ...all("fieldset.segments:not(.guess *)", (group) =>
      [group.querySelector("legend").textContent, group.querySelector("label:has(:checked)")?.textContent]),
  ];
  const marks = (picture) => [...picture.querySelectorAll("circle, rect, line, polyline, path, text")].map((mark) => ({
    tag: mark.tagName, text: mark.textContent,
    ...Object.fromEntries([...mark.attributes].map(({ name, value }) => [name, value])),
  }));
  const contents = {
    said: all("p.status, figure .told, figcaption", text).join("\\n"),
    labels: all("svg[role=img], canvas", label).join("\\n"),
    rows: all("tr", (row) => [...row.cells].map(text)),
    held: all("tr", (row) => row.classList.contains("holds")).indexOf(true),
    pictures: all("svg:not(button svg)", marks),
    maps: all("canvas", ({ drawn }) => drawn ?? []),
  };
  return [Object.fromEntries(controls), JSON.stringify(contents)];
}"""
"""What the controls say, and all that is shown besides, as a text, which reaches Python sooner than objects do."""

NUMBER = r"(?<![0-9.])-?[0-9]+(?:,[0-9]{3})*(?:\.[0-9]+)?(?:e[-+]?[0-9]+)?"
ROUNDING = 1e-7  # what two ways of computing the same number may differ by


def plain(text: str) -> str:
    """The text with hyphens for minus signs, as Python writes numbers."""
    return re.sub("−(?=[0-9])", "-", text)


def number_in(text: str) -> float:
    """The first number of a text."""
    found = re.search(NUMBER, plain(text))
    assert found is not None, f"{text!r} has no number"
    return float(found[0].replace(",", ""))


def is_rounded(shown: str, exact: str) -> bool:
    """Whether a number with some digits is another one rounded."""
    digits = len(shown.partition(".")[2])
    difference = float(shown.replace(",", "")) - float(exact.replace(",", ""))
    return abs(difference) <= 0.5 * 10**-digits + ROUNDING


def says(text: str, sentence: str) -> bool:
    """Whether a text has a sentence: the same words, and for each number of the sentence this number, rounded.

    >>> says("Value: −0.33. Best: listen.", "Value: -0.3333333.")
    True
    >>> says("Value: −0.33. Best: listen.", "Value: -0.34.")
    False
    """
    text, sentence = plain(text), plain(sentence)
    words = [re.escape(part) for part in re.split(NUMBER, sentence)]
    exact = re.findall(NUMBER, sentence)
    return any(
        all(map(is_rounded, found.groups(), exact))
        for found in re.finditer(f"({NUMBER})".join(words), text)
    )


@dataclass(frozen=True)
class Picture:
    """A picture in SVG: its marks as attributes by name. Where it has axes, they say what a place means."""

    marks: Sequence[dict[str, str]]

    def of(self, tag: str, **attributes: str) -> list[dict[str, str]]:
        """The marks of a kind that have these attributes; an underscore stands for a hyphen."""
        wanted = {key.replace("_", "-"): value for key, value in attributes.items()}
        return [
            mark
            for mark in self.marks
            if mark["tag"] == tag
            and all(mark.get(key) == value for key, value in wanted.items())
        ]

    def texts(self, **attributes: str) -> list[str]:
        """The texts in it."""
        return [plain(mark["text"]) for mark in self.of("text", **attributes)]

    def says(self, sentence: str) -> None:
        """Fail unless a text of the picture has this sentence, with its numbers rounded."""
        assert says("\n".join(self.texts()), sentence), (
            f"no {sentence!r}: {self.texts()}"
        )

    def axis(self, place: str, shift: float) -> tuple[float, float]:
        """Pixels at zero and pixels a unit, from the first and the last text beside an axis."""
        ticks = [
            (float(tick[place]) - shift, number_in(tick["text"]))
            for tick in self.of("text", **{"class": f"quiet {place}-tick"})
            if re.fullmatch(NUMBER, plain(tick["text"]))
        ]
        (first, low), (last, high) = ticks[0], ticks[-1]
        unit = (last - first) / (high - low)
        return first - low * unit, unit

    def x(self, values: ArrayLike) -> Points:
        """Where values stand on the horizontal axis, in pixels."""
        zero, unit = self.axis("x", 0)
        return zero + unit * np.asarray(values, dtype=float)

    def y(self, values: ArrayLike) -> Points:
        """Where values stand on the vertical axis, in pixels."""
        zero, unit = self.axis("y", 4)
        return zero + unit * np.asarray(values, dtype=float)

    def has_bars(self, colour: str, values: ArrayLike, thinnest: float = 0.0) -> None:
        """Fail unless the bars of a colour end at these values; none is thinner than some pixels."""
        zero = float(self.y(0))
        ends = []
        for bar in self.of("rect", fill=colour):
            top, height = float(bar["y"]), float(bar["height"])
            ends.append(top if top < zero - 1e-6 else top + height)
        exact = np.atleast_1d(self.y(values))
        np.testing.assert_allclose(ends, exact, rtol=0, atol=thinnest + 1e-6)

    def has_dots(self, colour: str, places: ArrayLike, tag: str = "circle") -> None:
        """Fail unless the dots of a colour are at these places (n, 2), in any order."""
        dots = [(float(d["cx"]), float(d["cy"])) for d in self.of(tag, fill=colour)]
        wanted = np.reshape(places, (-1, 2))
        exact = np.column_stack([self.x(wanted[:, 0]), self.y(wanted[:, 1])])
        np.testing.assert_allclose(sorted(dots), sorted(exact.tolist()), atol=1e-6)

    def has_curve(self, colour: str, places: ArrayLike) -> None:
        """Fail unless a line of a colour goes through these places (n, 2), which it has to a tenth of a pixel."""
        wanted = np.asarray(places, dtype=float)
        exact = np.column_stack([self.x(wanted[:, 0]), self.y(wanted[:, 1])])
        curves = [
            np.array([place.split(",") for place in line["points"].split()], float)
            for line in self.of("polyline", stroke=colour)
        ]
        assert any(
            curve.shape == exact.shape and np.allclose(curve, exact, atol=0.051, rtol=0)
            for curve in curves
        ), f"none of {curves} is {exact}"


@dataclass(frozen=True)
class Map:
    """A map on a canvas: what was drawn on it, in metres."""

    drawn: Sequence[dict[str, Any]]
    size: float

    def of(self, kind: str, colour: str) -> list[Points]:
        """The places (n, 3) of each line, shape or square of a colour; the third number is a radius or a side."""
        scale = (520 - 2 * 14) / self.size  # as maps.js has it
        found = []
        for mark in self.drawn:
            if mark["kind"] == kind and mark["colour"].lower() == colour.lower():
                x, y, length = np.reshape(mark["points"], (-1, 3)).T
                found.append(np.column_stack([x - 14, 520 - 14 - y, length]) / scale)
        return found

    def has_line(self, colour: str, places: ArrayLike) -> None:
        """Fail unless a line of a colour goes through these places (n, 2)."""
        exact = np.asarray(places, dtype=float)
        lines = [line[:, :2] for line in self.of("line", colour)]
        assert any(
            line.shape == exact.shape and np.allclose(line, exact, atol=1e-6, rtol=0)
            for line in lines
        ), f"none of {lines} is {exact}"

    def squares(self, colour: str) -> Points:
        """The middles (n, 2) of the squares of a colour."""
        return np.reshape(self.of("square", colour), (-1, 3))[:, :2]

    def circles(self, colour: str) -> Points:
        """Middle and radius (n, 3) of the circles of a colour."""
        shapes = self.of("shape", colour)
        return np.reshape([shape for shape in shapes if len(shape) == 1], (-1, 3))


@dataclass(frozen=True)
class Shown:
    """What an explorable shows, and what the reader has done to it since it was last reset."""

    controls: dict[str, str]
    contents: dict[str, Any]
    given: dict[str, Any]
    acts: Sequence[Act] = ()

    def chosen(self, label: str) -> str:
        """What a control says."""
        return self.controls[label]

    def number(self, label: str) -> float:
        """The number that a control says."""
        return number_in(self.controls[label])

    def share(self, label: str) -> float:
        """The percentage that a control says, as a share."""
        return self.number(label) / 100

    def says(self, *sentences: str) -> None:
        """Fail unless each sentence is in the text, with its numbers rounded."""
        for sentence in sentences:
            assert says(self.contents["said"], sentence), (
                f"{sentence!r} is not in {self.contents['said']!r}, with {self.controls}"
            )

    def is_named(self, name: str) -> None:
        """Fail unless a picture has this name for screen readers, with its numbers rounded."""
        assert says(self.contents["labels"], name), (
            f"{name!r} is not in {self.contents['labels']!r}, with {self.controls}"
        )

    def picture(self, number: int = 0) -> Picture:
        """One of its pictures."""
        return Picture(self.contents["pictures"][number])

    def map(self, size: float) -> Map:
        """Its map, of a size in metres."""
        return Map(self.contents["maps"][0], size)

    def steps(self) -> Iterator[tuple[str, Shown, Shown]]:
        """What the reader did since the last reset, in order: the act, and what was shown before it and after it."""
        looks = [*(act.before for act in self.acts), self]
        for act, after in zip(self.acts, looks[1:], strict=True):
            yield act.name, act.before, after


@dataclass(frozen=True)
class Act:
    """Something that a reader did, such as to press a button, and what was shown before."""

    name: str
    before: Shown
