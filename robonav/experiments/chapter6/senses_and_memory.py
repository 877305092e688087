"""Policies with richer sensors and with a memory in the worlds of the leaderboard.

All are trained by DAgger with the same expert in the same worlds, those of the page on sensing.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from robonav.benchmark import VERSION, evaluate_policy
from robonav.memory import MemoryPolicy, dagger_with_memory
from robonav.sensing import SensorPolicy

from ..runner.experiment import Case, Experiment, Numbers, Plot
from . import memory, sensing
from .memory import MEMORY
from .planners import BOARD
from .sensing import SETUP, TRAINING
from .setup import WORLDS

SENSORS: Mapping[str, Case] = {
    "sectors-9": {"sensor": "sectors", "number": 9, "network": "fully connected"},
    "sectors-36": {"sensor": "sectors", "number": 36, "network": "convolutional"},
    "picture": {"sensor": "picture", "number": 32, "network": "convolutional"},
}
MEMORIES: Mapping[str, Case] = {
    "window-1": {"network": "window", "k": 1},
    "window-8": {"network": "window", "k": 8},
    "gru": {"network": "gru", "k": 0},
}
VALIDATION = 50  # worlds in which the round of a policy with a memory is chosen


@cache
def trained(name: str, seed: int, scale: str) -> SensorPolicy | MemoryPolicy:
    """Return the policy of a row. Rows of one seed learn in the same worlds."""
    if name in SENSORS:
        return sensing.trained_policy(SENSORS[name], seed, scale)
    return dagger_with_memory(
        memory.new_policy(MEMORIES[name], seed),
        sensing.training_worlds(seed, scale),
        reflex=SETUP.reflex,
        validation=SETUP.tuning_worlds(seed, VALIDATION),
        steps=MEMORY["steps"][scale],
        batch=MEMORY["batch"],
        gradient_step=MEMORY["gradient_step"],
        max_steps=TRAINING["max_steps"],
        seed=seed,
    )


def train_and_evaluate(case: Case, seed: int, scale: str) -> Numbers:
    """Train a policy, and test it in one set of worlds of a setting."""
    policy = trained(str(case["method"]), seed, scale)
    return evaluate_policy(policy, str(case["setting"]), seed, WORLDS[scale])


EXPERIMENTS = (
    Experiment(
        name="senses-and-memory",
        title="Outcomes and SPL of policies with richer sensors and with a memory in the worlds of the leaderboard",
        cases=[
            {"method": name, "setting": setting}
            for name in (*SENSORS, *MEMORIES)
            for setting in BOARD
        ],
        run=train_and_evaluate,
        seeds=TRAINING["seeds"],
        settings={
            "version of the worlds": VERSION,
            "worlds a set": WORLDS,
            "a run": "a training, and a set of worlds of its own",
            "training": dict(sensing.SHARED["training"]),
            "training of a memory": {
                name: MEMORY[name]
                for name in (
                    "steps",
                    "batch",
                    "gradient_step",
                    "hidden",
                    "units",
                    "temperature",
                )
            },
        },
        shortened="A quick run trains in two rounds of four worlds.",
        note="A picture has no ranges, so that their error disturbs its robot through the reflex alone.",
        plot=Plot("experiments.draw_board", metric="success"),
    ),
)
