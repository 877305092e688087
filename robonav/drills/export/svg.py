"""Read the small SVG pictures of drills, and draw them as PNG for platforms that take no SVG."""

from __future__ import annotations

import functools
import io
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Colour = tuple[float, float, float]
INHERITED = {
    "fill": "black",
    "stroke": "none",
    "stroke-width": "1",
    "stroke-dasharray": "none",
    "font-size": "15",
    "font-style": "normal",
    "font-weight": "normal",
    "text-anchor": "start",
    "opacity": "1",
    "fill-opacity": "1",
    "stroke-opacity": "1",
}
MINUS = re.compile(r"(?<![\w.])-(?=\d)")  # a hyphen that is a sign
CORNERS = 64  # a circle is drawn as a polygon
SILENT = {"title", "desc"}
PIXELS = 2  # of a PNG picture for each pixel of the SVG, for sharp screens


@dataclass(frozen=True, eq=False)
class Line:
    """A line or area.

    Attributes
    ----------
    points : array, shape (n, 2)
        Its corners, in pixels from the picture's upper left.
    closed : bool
        Whether the last corner is joined to the first.
    fill, stroke : tuple of float, or None
        Colours of the area and of the line.
    width : float
        Of the line.
    dashes : tuple of float
        Lengths of dashes and gaps; empty for a whole line.
    """

    points: Points
    closed: bool
    fill: Colour | None
    stroke: Colour | None
    width: float
    dashes: tuple[float, ...]


@dataclass(frozen=True)
class Label:
    """A text.

    Attributes
    ----------
    x, y : float
        Where its base line begins, ends, or has its middle, as ``anchor`` says.
    text : str
        The text.
    size : float
        Of the letters.
    anchor : str
        "start", "middle" or "end".
    colour : tuple of float
        Of the letters.
    bold, italic : bool
        The style of the letters.
    """

    x: float
    y: float
    text: str
    size: float
    anchor: str
    colour: Colour
    bold: bool = False
    italic: bool = False


@dataclass(frozen=True)
class Drawing:
    """A picture as lines and texts.

    Attributes
    ----------
    width, height : float
        In pixels.
    shapes : tuple of Line and Label
        What is drawn, from the back to the front.
    title : str
        What can be seen, in words.
    """

    width: float
    height: float
    shapes: tuple[Line | Label, ...]
    title: str


def read(svg: str) -> Drawing:
    """Read an SVG picture of a drill.

    Parameters
    ----------
    svg : str
        A picture with rectangles, circles, ellipses, lines, polygons, paths and texts, and groups of them.

    Returns
    -------
    Drawing

    Raises
    ------
    ValueError
        If it has something else.

    Examples
    --------
    >>> from robonav.drills.pictures import box, label, picture
    >>> drawing = read(picture(30, 20, box(1, 1, 8, 8), label(15, 5, "A"), title="a box"))
    >>> drawing.width, drawing.title, [type(shape).__name__ for shape in drawing.shapes]
    (30.0, 'a box', ['Line', 'Label'])
    """
    root = ElementTree.fromstring(svg)
    _, _, width, height = map(float, root.attrib["viewBox"].split())
    shapes = tuple(_shapes(root, INHERITED, np.eye(3)))
    return Drawing(width, height, shapes, root.get("aria-label", ""))


def _shapes(
    element: ElementTree.Element, outer: Mapping[str, str], frame: Points
) -> Iterator[Line | Label]:
    """What an element and its children draw."""
    tag = element.tag.rpartition("}")[2]
    if tag in SILENT:
        return
    style = {key: element.get(key, value) for key, value in outer.items()}
    frame = frame @ _transform(element.get("transform", ""))
    if tag in ("svg", "g"):
        for child in element:
            yield from _shapes(child, style, frame)
    elif tag == "text":
        yield _label(element, style, frame)
    else:
        for points, closed in _outlines(tag, element):
            yield _line(points @ frame[:2, :2].T + frame[:2, 2], closed, style)


def _line(points: Points, closed: bool, style: Mapping[str, str]) -> Line:
    dashes = style["stroke-dasharray"]
    return Line(
        points,
        closed,
        _colour(style["fill"], float(style["opacity"]) * float(style["fill-opacity"])),
        _colour(
            style["stroke"], float(style["opacity"]) * float(style["stroke-opacity"])
        ),
        float(style["stroke-width"]),
        () if dashes == "none" else tuple(_numbers(dashes)),
    )


def _label(
    element: ElementTree.Element, style: Mapping[str, str], frame: Points
) -> Label:
    size = float(style["font-size"].removesuffix("px"))
    shift = element.get("dy", "0")
    dy = float(shift.removesuffix("em")) * (size if shift.endswith("em") else 1)
    x, y = float(element.get("x", 0)), float(element.get("y", 0))
    at = frame @ (x, y, 1)
    return Label(
        at[0],
        at[1] + dy,
        MINUS.sub("−", "".join(element.itertext())),
        size,
        style["text-anchor"],
        _colour(style["fill"], float(style["opacity"])) or (0, 0, 0),
        style["font-weight"] in ("bold", "600", "700"),
        style["font-style"] == "italic",
    )


def _colour(name: str, opacity: float) -> Colour | None:
    """Red, green and blue from 0 to 1 on white paper, or None for what is not drawn."""
    from matplotlib.colors import to_rgb

    if name in ("none", "transparent"):
        return None
    red, green, blue = to_rgb("black" if name == "currentColor" else name)
    mixed = [1 - opacity * (1 - part) for part in (red, green, blue)]
    return (mixed[0], mixed[1], mixed[2])


def _numbers(text: str) -> list[float]:
    return [float(one) for one in re.findall(r"-?(?:\d*\.\d+|\d+)(?:e-?\d+)?", text)]


def _transform(text: str) -> Points:
    """The matrix of a transform such as "translate(3 4) rotate(30)"."""
    matrix = np.eye(3)
    for name, arguments in re.findall(r"(\w+)\(([^)]*)\)", text):
        matrix = matrix @ _one_transform(name, _numbers(arguments))
    return matrix


def _one_transform(name: str, numbers: list[float]) -> Points:
    if name == "translate":
        x, y = [*numbers, 0][:2]
        return np.array([[1, 0, x], [0, 1, y], [0, 0, 1.0]])
    if name == "scale":
        x, y = (numbers * 2)[:2]
        return np.diag([x, y, 1.0])
    if name == "rotate":
        angle, x, y = [*numbers, 0, 0][:3]
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        return np.array(
            [[c, -s, x - c * x + s * y], [s, c, y - s * x - c * y], [0, 0, 1]]
        )
    raise ValueError(f"a picture of a drill cannot have the transform {name}")


def _outlines(tag: str, element: ElementTree.Element) -> Iterator[tuple[Points, bool]]:
    """The outlines of a shape, each with whether it is closed."""

    def number(name: str, default: float = 0) -> float:
        return float(element.get(name, default))

    if tag == "rect":
        x, y = number("x"), number("y")
        right, below = x + number("width"), y + number("height")
        yield np.array([[x, y], [right, y], [right, below], [x, below]]), True
    elif tag in ("circle", "ellipse"):
        angles = 2 * np.pi * np.arange(CORNERS) / CORNERS
        radii = number("rx", number("r")), number("ry", number("r"))
        round_ = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        yield np.array([number("cx"), number("cy")]) + round_ * radii, True
    elif tag == "line":
        ends = [[number("x1"), number("y1")], [number("x2"), number("y2")]]
        yield np.array(ends), False
    elif tag in ("polyline", "polygon"):
        corners = np.array(_numbers(element.get("points", ""))).reshape(-1, 2)
        yield corners, tag == "polygon"
    elif tag == "path":
        yield from _outlines_of_path(element.get("d", ""))
    else:
        raise ValueError(f"a picture of a drill cannot have the element {tag}")


def _outlines_of_path(d: str) -> Iterator[tuple[Points, bool]]:
    """Follow a path's moves, straight lines, Bézier curves and arcs."""
    points: list[tuple[float, float]] = []
    for command, arguments in re.findall(r"([a-zA-Z])([^a-zA-Z]*)", d):
        kind, numbers = command.upper(), _numbers(arguments)
        if kind == "Z":
            yield np.array(points), True
            points = points[:1]
            continue
        if kind == "M" and len(points) > 1:
            yield np.array(points), False
        start = points[-1] if points else (0.0, 0.0)
        points = [] if kind == "M" else points
        count = {"M": 2, "L": 2, "H": 1, "V": 1, "Q": 4, "C": 6, "A": 7}.get(kind)
        if count is None:
            raise ValueError(f"a path of a drill cannot have the command {command}")
        for at in range(0, len(numbers), count):
            step = _absolute(kind, numbers[at : at + count], start, command.islower())
            points.extend(_followed(kind, step, start))
            start = points[-1]
    if len(points) > 1:
        yield np.array(points), False


def _absolute(
    kind: str, numbers: list[float], start: tuple[float, float], relative: bool
) -> list[float]:
    """A step's numbers as seen from the picture's corner."""
    if kind == "H":
        return [numbers[0] + relative * start[0], start[1]]
    if kind == "V":
        return [start[0], numbers[0] + relative * start[1]]
    if not relative:
        return numbers
    if kind == "A":
        return [*numbers[:5], numbers[5] + start[0], numbers[6] + start[1]]
    return [number + start[k % 2] for k, number in enumerate(numbers)]


def _followed(
    kind: str, numbers: list[float], start: tuple[float, float]
) -> list[tuple[float, float]]:
    """The points that a step adds."""
    if kind in "MLHV":
        return [(numbers[0], numbers[1])]
    if kind == "A":
        return _arc(numbers, start)
    controls = np.array([*start, *numbers]).reshape(-1, 2)
    t = np.linspace(0, 1, 17)[1:, None]
    degree = len(controls) - 1
    curve = sum(
        math.comb(degree, k) * t**k * (1 - t) ** (degree - k) * control
        for k, control in enumerate(controls)
    )
    return [(x, y) for x, y in np.asarray(curve)]


def _arc(numbers: list[float], start: tuple[float, float]) -> list[tuple[float, float]]:
    """Points on an arc of a circle; an ellipse is taken as a circle of its first radius."""
    radius, _, _, large, sweep, x, y = numbers
    a, b = complex(*start), complex(x, y)
    chord = abs(b - a)
    if chord == 0 or radius == 0:
        return [(x, y)]
    radius = max(radius, chord / 2)
    height = math.sqrt(max(radius**2 - (chord / 2) ** 2, 0))
    side = 1 if bool(large) != bool(sweep) else -1
    centre = (a + b) / 2 + side * height * 1j * (b - a) / chord
    first, last = (math.atan2((p - centre).imag, (p - centre).real) for p in (a, b))
    turn = (last - first) % (2 * math.pi) - (0 if sweep else 2 * math.pi)
    angles = first + turn * np.linspace(0, 1, 25)[1:]
    return [
        (centre.real + radius * math.cos(one), centre.imag + radius * math.sin(one))
        for one in angles
    ]


@functools.lru_cache(maxsize=256)
def png(svg: str) -> bytes:
    """Return an SVG picture of a drill as PNG, black on white. The same picture is drawn once.

    Parameters
    ----------
    svg : str

    Returns
    -------
    bytes

    Examples
    --------
    >>> from robonav.drills.pictures import box, picture
    >>> png(picture(30, 20, box(1, 1, 8, 8), title="a box"))[1:4]
    b'PNG'
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Polygon

    drawing = read(svg)
    dpi = 72 * PIXELS
    figure = Figure(figsize=(drawing.width / 72, drawing.height / 72), dpi=dpi)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, drawing.width), ylim=(drawing.height, 0))
    axes.set_axis_off()
    anchors = {"start": "left", "middle": "center", "end": "right"}
    for shape in drawing.shapes:
        if isinstance(shape, Label):
            axes.text(
                shape.x,
                shape.y,
                shape.text.replace("$", r"\$"),
                fontsize=shape.size,
                ha=anchors[shape.anchor],
                va="baseline",
                color=shape.colour,
                weight="bold" if shape.bold else "normal",
                style="italic" if shape.italic else "normal",
            )
            continue
        style = (0, shape.dashes) if shape.dashes else "solid"
        axes.add_patch(
            Polygon(
                shape.points,
                closed=shape.closed,
                facecolor=shape.fill or "none",
                edgecolor=shape.stroke or "none",
                linewidth=shape.width if shape.stroke else 0,
                linestyle=style,
            )
        )
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=dpi, facecolor="white")
    return file.getvalue()
