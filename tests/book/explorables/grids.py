"""A picture of a grid, read: its arrows, values, marked cell and trajectory."""

from __future__ import annotations

import re
from dataclasses import dataclass

from robonav.style import VERMILION

from .shown import Picture, Shown, number_in

CELL = 64  # pixels, as grid.js has it


@dataclass(frozen=True)
class Grid:
    """A picture of a grid with the cells of a layout."""

    picture: Picture
    cells: list[list[int]]

    def at(self, x: float, y: float) -> int:
        """The number of the cell at a place in pixels."""
        return self.cells.index([int(y // CELL), int(x // CELL)])

    def arrows(self) -> dict[int, int]:
        """The action of each cell that has an arrow."""
        found = {}
        for arrow in self.picture.of("path", **{"class": "arrow"}):
            x, y, degrees = map(float, re.findall(r"-?[0-9.]+", arrow["transform"]))
            found[self.at(x, y + 9)] = round(degrees / 90)
        return found

    def values(self) -> list[str]:
        """The values written into the cells that do not end the episode."""
        return self.picture.texts(font_size="14", text_anchor="middle")

    def marked(self) -> int:
        """The marked cell."""
        (frame,) = self.picture.of("rect", stroke=VERMILION, visibility="visible")
        return self.at(float(frame["x"]), float(frame["y"]))

    def trajectory(self, number: int = 0) -> list[int]:
        """The cells of a trajectory."""
        places = self.picture.of("path", **{"class": "trajectory still"})[number]["d"]
        numbers = list(map(float, re.findall(r"[0-9.]+", places)))
        return [self.at(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]

    def has_values(self, values: list[float]) -> None:
        """Fail unless these values are written into the cells, as far as there is room."""
        written = [number_in(text) for text in self.values()]
        digits = [len(text.partition(".")[2]) for text in self.values()]
        for shown, places, value in zip(written, digits, values, strict=True):
            assert abs(shown - value) <= 0.5 * 10**-places + 1e-7, (written, values)


def grid_of(shown: Shown, number: int = 0) -> Grid:
    """The picture of the explorable's grid."""
    return Grid(shown.picture(number), shown.given["layout"]["cells"])
