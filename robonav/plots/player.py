"""Players of matplotlib animations, which work on a static page, offline and with a screen reader."""

from __future__ import annotations

import html
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robonav.validation import check_integer

if TYPE_CHECKING:
    from IPython.display import HTML
    from matplotlib.animation import Animation

_ICON_FONT = re.compile(r"<link\b[^>]*font-awesome[^>]*>\s*", re.IGNORECASE)
_PRELOADED = "new Image();"
"""With which the player would decode all pictures as the page opens; a picture is decoded when it is first shown."""
_NAMED_FORM = re.compile(r'<form title="([^"]+)" aria-label="[^"]+"([^>]*)>')
"""A form with a name is a landmark of the page, and each player would add one of the same name."""
_BUTTON_TITLE = re.compile(r'<button title="([^"]+)"')


def player(
    animation: Animation,
    *,
    description: str,
    frames_per_second: int = 8,
    loop: bool = True,
) -> HTML:
    """Return a player of an animation, with buttons and a slider. It is the last value of a notebook cell.

    Parameters
    ----------
    animation : Animation
        An animation of matplotlib's, such as ``FuncAnimation``.
    description : str
        A description of the animation for readers who do not see it.
    frames_per_second : float
        The speed at first; at least 1.
    loop : bool
        Whether the animation starts again at the end.

    Returns
    -------
    HTML

    Raises
    ------
    ValueError
        If ``description`` is empty or ``frames_per_second`` is less than 1.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from matplotlib.animation import FuncAnimation
    >>> figure, axes = plt.subplots(figsize=(1, 1))
    >>> animation = FuncAnimation(figure, lambda frame: axes.plot([0, frame]), frames=2)
    >>> "A line rises" in player(animation, description="A line rises").data
    True
    >>> plt.close(figure)
    """
    from IPython.display import HTML
    from matplotlib import pyplot as plt

    check_integer("frames_per_second", frames_per_second, at_least=1)
    if not description.strip():
        raise ValueError(
            "description must say what the animation shows, got an empty text"
        )
    page = _frames(animation, frames_per_second, "loop" if loop else "once")
    plt.close("all")  # else the notebook shows the last frame once more
    page = _ICON_FONT.sub("", page).replace(_PRELOADED, "{};")
    page = page.replace(
        '<img id="_anim_img', f'<img alt="{html.escape(description)}" id="_anim_img'
    )
    page = page.replace(
        'type="range" class="anim-slider"',
        'type="range" aria-label="Frame" class="anim-slider"',
    )
    page = _NAMED_FORM.sub(r'<form\2><div role="group" aria-label="\1">', page)
    page = page.replace("</form>", "</div></form>")
    return HTML(_BUTTON_TITLE.sub(r'<button title="\1" aria-label="\1"', page))


def _frames(animation: Animation, frames_per_second: int, mode: str) -> str:
    """Return matplotlib's own page of an animation, with frames of transparent background.

    The frames are pictures in lossless WebP, which need about half of the bytes of PNG.
    """
    from matplotlib.animation import HTMLWriter

    class Transparent(HTMLWriter):
        def grab_frame(self, **options: Any) -> None:
            # matplotlib would lay it on white
            lossless = {"facecolor": "none", "pil_kwargs": {"lossless": True}}
            super().grab_frame(**{**options, **lossless})

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "animation.html")
        writer = Transparent(
            fps=frames_per_second, embed_frames=True, default_mode=mode
        )
        writer.supported_formats = ["webp"]
        writer.frame_format = "webp"
        animation.save(str(path), writer=writer)
        return path.read_text("utf-8")
