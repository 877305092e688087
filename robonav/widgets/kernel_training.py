"""Training in the kernel for a widget: in a thread, with progress, live curves and a way to cancel it.

The page sends ``{"ask": "kernel"}``, ``{"ask": "train", "run": k, ...}`` or ``{"ask": "cancel"}``. The kernel answers
``{"kernel": ...}``, and for run k ``{"run": k, "done": ..., "total": ..., "live": [...]}`` now and then, at last
``{"run": k, "ended": ...}``, ``{"run": k, "cancelled": True}`` or ``{"run": k, "error": ...}``. The page's side is
``learning/kernel_panel.js``.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import anywidget
import traitlets

from robonav.experiments import bootstrap_interval
from robonav.progress import Progress
from robonav.robot import REFLEX, ReflexRule, Worlds, navigate

PAUSE = 0.05  # seconds between two messages to the page

TRIED = 400
"""Maps that each robot is tried in which the kernel trains."""


class Cancelled(Exception):
    """Raised in a training that the reader has cancelled."""


class Report:
    """Tells the page how far a training is. The next report of a cancelled training raises :class:`Cancelled`.

    Parameters
    ----------
    send : callable
        Sends a message to the page.
    cancelled : threading.Event
        Set when the reader cancels.

    Examples
    --------
    >>> import threading
    >>> from robonav.widgets.kernel_training import Report
    >>> report = Report(print, threading.Event())
    >>> report(2, 2, at=2, cost=0.5)
    {'done': 2, 'total': 2, 'live': [{'at': 2, 'cost': 0.5}]}
    """

    def __init__(
        self, send: Callable[[dict[str, Any]], None], cancelled: threading.Event
    ) -> None:
        self._send, self._cancelled = send, cancelled
        self._news: list[dict[str, Any]] = []
        self._told = 0.0

    def due(self, done: int, total: int) -> bool:
        """Whether a report sends its message at once: the last one does, and others after a pause."""
        return done >= total or time.monotonic() - self._told > PAUSE

    def __call__(self, done: int, total: int, /, **measured: Any) -> None:
        """Report ``done`` of ``total`` steps, and points of the curves such as ``at=3, cost=0.2``."""
        if self._cancelled.is_set():
            raise Cancelled
        if measured:
            self._news.append(measured)
        if self.due(done, total):
            self._told = time.monotonic()
            live = {"live": self._news} if self._news else {}
            self._send({"done": done, "total": total, **live})
            self._news = []

    def part(self, before: int, of_all: int) -> Progress:
        """Return the callback of a part that begins when ``before`` of ``of_all`` steps are done."""

        def progress(done: int, total: int) -> None:
            """Tell the page how far the whole is."""
            self(before + done, of_all)

        return progress


class KernelTraining(anywidget.AnyWidget):
    """A widget that can also train in the kernel. A subclass says how, in :meth:`train`.

    Attributes
    ----------
    trainings : list
        The results of the last training in the kernel, one for each robot. Trainings in the page stay there.
    """

    data = traitlets.Dict().tag(sync=True)

    def __init__(self, data: dict[str, Any]) -> None:
        super().__init__(data=data)
        self.trainings: list[Any] = []
        self._cancelled = threading.Event()
        self._thread: threading.Thread | None = None
        self.on_msg(self._answer)

    def uses_kernel(self) -> bool:
        """Whether the page may offer what needs a kernel."""
        return True

    def train(self, request: dict[str, Any], report: Report) -> Any:
        """Train as the page asked, report, and return what the page gets at the end."""
        raise NotImplementedError

    def _answer(self, _widget: Any, message: dict[str, Any], _buffers: Any) -> None:
        """Answer the page, which asks whether a kernel is there, for a training, or for its end."""
        asked = message.get("ask")
        if asked == "kernel":
            self.send({"kernel": self.uses_kernel()})
        elif asked == "cancel":
            self._cancelled.set()
        elif asked == "train" and self.uses_kernel():
            self._cancelled.set()  # a training that still runs
            self._cancelled = threading.Event()
            self._thread = threading.Thread(
                target=self._run, args=(message, self._cancelled), daemon=True
            )
            # In a thread of its own, so that the kernel can receive a cancellation.
            self._thread.start()

    def _run(self, request: dict[str, Any], cancelled: threading.Event) -> None:
        """Train, and send the page its end."""

        def send(message: dict[str, Any]) -> None:
            self.send({"run": request.get("run", 0), **message})

        try:
            send({"ended": self.train(request, Report(send, cancelled))})
        except Cancelled:
            send({"cancelled": True})
        # An error in a thread would be lost, so the page shows it.
        except Exception as error:
            send({"error": f"{type(error).__name__}: {error}"})


def success_rates(
    policies: Iterable[Any],
    worlds: Worlds,
    *,
    speed: float = 2.0,
    max_steps: int = 500,
    reflex: ReflexRule = REFLEX,
) -> list[float]:
    """Return the percentage of the worlds in which each policy arrives.

    Examples
    --------
    >>> from robonav.robot import random_worlds, straight
    >>> from robonav.widgets.kernel_training import success_rates
    >>> success_rates([straight], random_worlds(10, obstacles=0, seed=1))
    [100.0]
    """
    driven = (
        navigate(policy, worlds, speed, max_steps, reflex=reflex) for policy in policies
    )
    return [100 * float(each.success.mean()) for each in driven]


def sentence_on_rates(rates: Sequence[float], maps: int) -> str:
    """Say how often robots arrive in new maps, with the interval of the mean over the robots.

    Examples
    --------
    >>> from robonav.widgets.kernel_training import sentence_on_rates
    >>> sentence_on_rates([92.5], 400)
    'One robot crosses 92.5 % of 400 new maps.'
    """
    mean = sum(rates) / len(rates)
    if len(rates) == 1:
        return f"One robot crosses {mean:.1f} % of {maps} new maps."
    low, high = bootstrap_interval(rates)
    return (
        f"{len(rates)} robots cross {mean:.1f} % of {maps} new maps on average, "
        f"95 % interval {low:.1f} to {high:.1f}; the worst {min(rates):.1f} %."
    )
