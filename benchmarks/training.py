"""How long each method takes to learn one policy: seconds of processor time on one core.

python benchmarks/training.py
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Mapping
from typing import Any

import torch

from robonav.deep import train_gail, train_ppo
from robonav.experiments.chapter3 import setup as chapter3
from robonav.experiments.chapter4 import setup as chapter4
from robonav.experiments.chapter5 import setup as chapter5
from robonav.experiments.chapter6 import curriculum, gail, ppo
from robonav.nnql import METHODS

Train = Callable[[int], Any]

DEMONSTRATIONS = 10  # of GAIL


def of_chapter_4(method: str) -> Train:
    """The training of a method of Table 4.3, one seed alone."""
    settings = chapter4.tuned()[method]
    return lambda seed: chapter4.training(method, seed, "quick", settings)


def of_chapter_5(method: str) -> Train:
    """The training of a method of Table 5.2, with its demonstrations."""
    settings = chapter5.tuned(method, chapter5.OTHER_DISCOUNT)
    return lambda seed: chapter5.trained(method, seed, settings)


def by_gail(seed: int) -> Any:
    """Learn from ten demonstrations."""
    shown = gail.demonstrations_of_run(DEMONSTRATIONS, seed)
    return train_gail(shown, [seed], task=ppo.task(), **gail.TRAINING)


TRAININGS: Mapping[str, Train] = {
    "lfd": chapter3.cloned_policy,
    "dagger": chapter3.dagger_result,
    **{method: of_chapter_4(method) for method in METHODS},
    **{method: of_chapter_5(method) for method in chapter5.LEARNERS},
    "ppo": lambda seed: train_ppo([seed], task=ppo.task(), **ppo.TRAINING),
    "gail": by_gail,
    "ppo-curriculum": lambda seed: curriculum.trained(
        list(curriculum.STAGES)[-1], (seed,), "thesis"
    ),
}
"""How each method learns one policy from a seed, demonstrations included."""

FIRST, MEASURED = 500, 501  # two seeds: the first run also loads the compiled code


def main() -> None:
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    torch.set_num_threads(1)
    for name, train in TRAININGS.items():
        if name != "ppo-curriculum":  # nothing of it is compiled after "ppo"
            train(FIRST)
        began = time.process_time()
        train(MEASURED)
        passed = time.process_time() - began
        print(f"training of {name:18} {passed:8.2f} s of one core", flush=True)


if __name__ == "__main__":
    main()
