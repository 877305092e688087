"""Run every benchmark, one after the other, and write the book's page of them.

    python benchmarks/page.py --peers DIR      # about ten minutes, with nothing else running

The page, ``book/benchmarks.md``, holds what each script printed, the machine, and pictures of how time and memory grow.
"""

from __future__ import annotations

import argparse
import datetime
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib as mpl
from matplotlib import pyplot as plt

from robonav import atomic, progress, style
from robonav.experiments.runner.results import machine

HERE = Path(__file__).parent
BOOK = HERE.parent / "book"
PICTURE = BOOK / "_static" / "growth.svg"
SCRIPTS = {  # heading: script, options, whether it knows peers, what one should know
    "The robot": (
        "robot.py",
        (),
        True,
        "Steps of the simulator through Gymnasium's environments. CartPole is "
        "Gymnasium's simplest environment, the others simulate navigation. The "
        "more robots step at once, the less a step costs.",
    ),
    "Several robots": (
        "team.py",
        (),
        False,
        "Robots that cross a map together. A robot step is one robot's second: it moves "
        "and senses obstacles and the other robots. The whole loop also asks the reflex "
        "and a rule, and begins with drawn maps.",
    ),
    "Planning": (
        "dp.py",
        ("--million",),
        False,
        "Exact planning, compared with QuantEcon in the same process. A ratio "
        "below 1 means that this package is faster.",
    ),
    "Tabular learning": (
        "tabular.py",
        (),
        False,
        "Q-learning on FrozenLake, compared with a loop that only takes steps. "
        "The ratio says what learning adds to stepping.",
    ),
    "Learning from demonstration": (
        "lfd.py",
        (),
        False,
        "Planning, training and navigation of chapter 3. In brackets are the "
        "limits that the project sets itself.",
    ),
    "Matrix products": (
        "matrix.py",
        (),
        False,
        "Forward propagation in matrices, compared with a loop over units in the same run.",
    ),
    "Neural Q-learning": (
        "nnql.py",
        (),
        True,
        "Training of chapter 4, compared with stable-baselines3's DQN. The ratio "
        "is that of learning steps to updates in a second.",
    ),
    "Proximal policy optimisation": (
        "ppo.py",
        (),
        True,
        "Sixteen seeds of PPO, trained until each crosses maps with 10 obstacles, "
        "compared with stable-baselines3's PPO. The ratio is that of steps of actors "
        "in a second, learning included. The last training is that of the page on deep "
        "reinforcement learning.",
    ),
    "Generative adversarial imitation learning": (
        "gail.py",
        ("--cpu",),
        True,
        "GAIL on CartPole, compared with the library imitation: both learn from the same "
        "ten episodes of a rule, with networks of one size and equal numbers of steps. A score is "
        "the mean number of steps in 20 new episodes, at most 500. Three seeds are few, and their ranges overlap. "
        "The control earns 1 in each step, so that nothing of the expert reaches it, and it "
        "stays up longest: the reward of both programs is positive in each step, and in CartPole it is "
        "enough to last. So this task tells whether two programs do the same, and not what a discriminator teaches. "
        "Seconds are those of the processor.",
    ),
    "Inverse reinforcement learning": (
        "nirl.py",
        (),
        False,
        "Runs of chapter 5, and the four methods beside each other.",
    ),
    "Time to train": (
        "training.py",
        (),
        False,
        "One policy of each method, in processor time, with its demonstrations and its "
        "episodes in the simulator.",
    ),
    "Decisions": (
        "decisions.py",
        (),
        False,
        "One decision of each method on the leaderboard. Alone, a decision is "
        "mostly the time of Python; among 1,000 robots it costs a fraction of a "
        "microsecond.",
    ),
    "Grading a class": (
        "grading.py",
        ("--students", "300"),
        False,
        "Three hundred students and all exercises.",
    ),
    "Exams": (
        "exams.py",
        (),
        False,
        "Two hundred different papers of drills, with worked solutions, as PDF.",
    ),
    "Slides": (
        "slides.py",
        (),
        False,
        "`make slides` after `make book`: one deck for each lecture.",
    ),
}
INTRODUCTION = """# How fast it is

This page shows the output of the scripts in `benchmarks/` on {date}, on {system} on {machine} with {cores} cores
and no other programs. `python benchmarks/page.py --peers DIR` runs all of them and writes this page. Every number
is a median or the best of several rounds. Where another package does the same work, both packages took turns in one
run. Seconds on your machine will differ; ratios should be similar. `benchmarks/peers/README.md` tells how to install
the other packages.
"""
GROWTH = """## How time and memory grow

```{{figure}} _static/growth.svg
:alt: Seconds and memory against the numbers of obstacles, worlds, seeds and states; no slope is greater than one.
:name: fig-growth

Seconds (blue) and memory (orange) against size. A slope of one means that the cost is proportional to the size.
```

```text
{text}
```
"""


def printed(script: str, options: tuple[str, ...]) -> str:
    """The standard output of a script. One that ends with 1 has found something that takes longer than its limit."""
    command = [sys.executable, str(HERE / script), *options]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    text = ended.stdout.strip()
    if ended.returncode not in (0, 1) or "Traceback" in ended.stderr or not text:
        raise SystemExit(f"{script} failed:\n{ended.stderr.strip()}")
    if ended.returncode:
        print(f"{script}: something takes longer than its limit", file=sys.stderr)
    return text


def draw_growth(points: dict[str, list[dict[str, float]]]) -> None:
    """One panel for each quantity."""
    with mpl.rc_context(style.STYLE | {"svg.hashsalt": "growth"}):
        figure, panels = plt.subplots(
            4, figsize=(style.FIGURE_WIDTH, 9), layout="constrained"
        )
        for axes, (what, found) in zip(panels, points.items(), strict=True):
            shown = [point for point in found if point["size"] > 0]
            for key, colour in (("seconds", style.BLUE), ("MiB", style.ORANGE)):
                axes.loglog(
                    [p["size"] for p in shown],
                    [p[key] for p in shown],
                    "o-",
                    color=colour,
                    label=key,
                )
            axes.set(xlabel=what)
        panels[0].legend()
        with atomic.atomic_write(PICTURE) as file:
            figure.savefig(file, format="svg", metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--peers", type=Path, help="folder with the peers' virtual environments"
    )
    peers = parser.parse_args().peers
    parts = [INTRODUCTION.format(date=datetime.date.today(), **machine())]
    with progress.bar("benchmarks") as shown:
        for number, (heading, (script, options, knows_peers, about)) in enumerate(
            SCRIPTS.items()
        ):
            shown(number, len(SCRIPTS) + 1)
            beside = ("--peers", str(peers)) if peers and knows_peers else ()
            text = printed(script, (*options, *beside))
            parts.append(
                f"## {heading}\n\n{about} `benchmarks/{script}`:\n\n```text\n{text}\n```\n"
            )
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "growth.json")
            text = printed("growth.py", ("--json", str(path)))
            draw_growth(json.loads(path.read_text("utf-8")))
        parts.append(GROWTH.format(text=text))
        shown(len(SCRIPTS) + 1, len(SCRIPTS) + 1)
    atomic.write_text(BOOK / "benchmarks.md", "\n".join(parts))


if __name__ == "__main__":
    main()
