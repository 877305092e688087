"""The animation player: named for every reader, and nothing fetched from elsewhere."""

from __future__ import annotations

import base64
import io
import re

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("agg")

from matplotlib import pyplot as plt
from matplotlib.animation import FuncAnimation
from PIL import Image

from robonav.plots.player import player


def moving_dot() -> FuncAnimation:
    figure, axes = plt.subplots(figsize=(1, 1))
    (dot,) = axes.plot([0], [0], "o")
    return FuncAnimation(figure, lambda frame: dot.set_data([frame], [frame]), frames=2)


def test_picture_slider_and_buttons_have_names():
    page = player(moving_dot(), description='A "dot" moves.').data
    assert re.search(r'<img alt="A &quot;dot&quot; moves." id="_anim_img', page)
    assert re.search(r'<input[^>]*type="range"[^>]*aria-label="Frame"', page)
    assert all("aria-label" in tag for tag in re.findall(r"<button[^>]*>", page))
    (form,) = re.findall(r"<form.*?</form>", page, re.DOTALL)
    group = r'<form [^>]*><div role="group" aria-label="[^"]+">.*</div></form>'
    assert re.fullmatch(group, form, re.DOTALL)
    assert "label=" not in re.match(r"<form[^>]*>", form)[0]


def frames_of(page: str) -> list[bytes]:
    frames = re.findall(r'"data:image/webp;base64,(.*?)"', page, re.DOTALL)
    return [base64.b64decode(frame.replace("\\", "")) for frame in frames]


def pixels_of(picture: bytes) -> np.ndarray:
    """Red, green, blue and opacity; where nothing is to be seen, the colour does not count."""
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("RGBA"))
    return np.where(pixels[:, :, 3:] == 0, 0, pixels)


def test_frames_let_the_page_through():
    frames = frames_of(player(moving_dot(), description="A dot moves.").data)
    assert len(frames) == 2
    for frame in frames:
        assert pixels_of(frame)[0, 0, 3] == 0


def test_frames_are_as_matplotlib_draws_them():
    frames = frames_of(player(moving_dot(), description="A dot moves.").data)
    figure, axes = plt.subplots(figsize=(1, 1))
    (dot,) = axes.plot([0], [0], "o")
    for at, frame in enumerate(frames):
        dot.set_data([at], [at])
        drawn = io.BytesIO()
        figure.savefig(drawn, format="png", facecolor="none")
        np.testing.assert_array_equal(pixels_of(frame), pixels_of(drawn.getvalue()))
    plt.close(figure)


def test_nothing_comes_from_elsewhere():
    assert not re.search(
        r'(src|href)="https?:', player(moving_dot(), description="A dot moves.").data
    )


def test_no_figure_is_left_open():
    player(moving_dot(), description="A dot moves.")
    assert plt.get_fignums() == []


def test_description_and_speed_are_checked():
    animation = moving_dot()
    with pytest.raises(ValueError, match="description must say"):
        player(animation, description=" ")
    with pytest.raises(ValueError, match="frames_per_second must be at least 1"):
        player(animation, description="A dot moves.", frames_per_second=0)
    animation._draw_was_started = (
        True  # matplotlib warns of animations that are never drawn
    )
    plt.close("all")
