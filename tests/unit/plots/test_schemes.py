"""The three schemes: every arrow joins two boxes, every word stands in both languages and inside the picture."""

from __future__ import annotations

import matplotlib as mpl
import pytest

mpl.use("agg")

from matplotlib import pyplot as plt

from robonav import style
from robonav.plots.schemes import SCHEMES, SIZE, draw_scheme


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("language", ["en", "fr"])
def test_every_word_is_drawn_inside_the_picture(name: str, language: str) -> None:
    with plt.rc_context(style.STYLE):
        figure, axes = plt.subplots(figsize=SIZE)
        draw_scheme(axes, name, language=language)
        figure.canvas.draw()
    chosen = SCHEMES[name]
    words = {text.get_text() for text in axes.texts} - {""}
    assert words == {
        part.texts[language] for part in (*chosen.boxes.values(), *chosen.arrows)
    }
    for text in axes.texts:
        box = text.get_window_extent()
        if text.get_text():
            assert box.x0 >= 0
            assert box.y0 >= 0
            assert box.x1 <= figure.bbox.x1
            assert box.y1 <= figure.bbox.y1
    plt.close(figure)


@pytest.mark.parametrize("name", SCHEMES)
def test_arrows_join_boxes_that_exist(name: str) -> None:
    chosen = SCHEMES[name]
    assert {end for arrow in chosen.arrows for end in (arrow.start, arrow.end)} == set(
        chosen.boxes
    )


def test_unknown_scheme_and_language_are_refused() -> None:
    with pytest.raises(
        ValueError,
        match="name must be one of demonstration, reinforcement, inverse, got 'x'",
    ):
        draw_scheme(plt.figure().add_subplot(), "x")
    with pytest.raises(ValueError, match="language must be one of en, fr, got 'de'"):
        draw_scheme(plt.figure().add_subplot(), "inverse", language="de")
    plt.close("all")
