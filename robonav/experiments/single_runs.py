"""Figures of the thesis that show single episodes, plans and demonstrations, as numbers.

Every case is one panel. Its world is drawn from seeds that the case contains; ``x`` and ``y`` are the path in metres.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav import mdp
from robonav.benchmark import EXACT_REFLEX, fingerprint, method
from robonav.lfd import (
    ComputerExpert,
    demonstrate_by_hand,
    plan,
    plan_on_grid,
    record_demonstrations,
    sketch,
)
from robonav.nnql import NavigationTask, TrainingResult, train
from robonav.robot import Worlds, navigate, neighbour_slip, random_worlds

from .runner.experiment import Case, Experiment, Numbers, Plot

ONCE = {"quick": 1, "thesis": 1}
SEED = 4_010  # the seed of the worlds
EPISODES = 300
TRAINING_SEED = 3  # the seed of the training that Fig. 4.2 shows
MAX_STEPS = 500  # of an episode, unless a panel says otherwise
TASK = NavigationTask(reflex=EXACT_REFLEX)  # of the training that Fig. 4.2 shows
EVERY = 4  # every fourth visited node is kept
FAR = {"starts": ((10.0, 50.0), (50.0, 10.0)), "targets": ((90.0, 85.0), (50.0, 90.0))}


def world_of(case: Case) -> Worlds:
    """Return the world (a batch of one) of a panel."""
    if "episode" in case:
        return TASK.worlds([TRAINING_SEED], 0, EPISODES)[int(case["episode"]) - 1]
    ends: dict[str, Any] = FAR if case.get("starts") == "new" else {}
    drawn = random_worlds(
        int(case["world"]) + 1,
        int(case["obstacles"]),
        int(case.get("moving", 0)),
        seed=SEED,
        **ends,
    )
    return drawn[int(case["world"])]


def path_of(poses: ArrayLike) -> dict[str, ArrayLike]:
    """Return the x and y of poses (T, 2 or more)."""
    x, y = np.asarray(poses, dtype=float)[:, :2].T
    return {"x": x, "y": y}


def navigation(case: Case, seed: int, scale: str) -> Numbers:
    """Return one episode of a method in the panel's world."""
    episode = navigate(
        method(str(case["method"])),
        world_of(case),
        float(case["speed"]),
        int(case.get("steps", MAX_STEPS)),
        record_paths=True,
        reflex=EXACT_REFLEX,
        seed=seed,
    )
    assert episode.paths is not None
    return path_of(episode.paths[0]) | {"success": float(episode.success[0])}


def search(case: Case, seed: int, scale: str) -> Numbers:
    """Return the path of a planner and every fourth of the nodes that it expands (Fig. 3.4)."""
    methods: dict[str, Callable[..., Any]] = {
        "modified-a-star": plan,
        "grid-a-star": plan_on_grid,
    }
    found = methods[str(case["method"])](world_of(case), margin=2.0, record=True)
    visited = path_of(found.visited[::EVERY])
    return (
        path_of(found.points)
        | {"visited x": visited["x"], "visited y": visited["y"]}
        | {"length": found.length, "expanded": float(found.expanded)}
    )


@lru_cache(maxsize=1)
def training() -> TrainingResult:
    """Return the training that Fig. 4.2 shows."""
    return train("nnql", [TRAINING_SEED], EPISODES, task=TASK, record=True)


def training_episode(case: Case, seed: int, scale: str) -> Numbers:
    """Return the path of one episode of training (Fig. 4.2)."""
    number = int(case["episode"]) - 1
    trained = training()
    assert trained.paths is not None
    return path_of(trained.paths[0][number]) | {
        "success": float(trained.successes[0, number])
    }


def demonstration_by_hand(case: Case, seed: int, scale: str) -> Numbers:
    """Return a demonstration through key points (Figs. 5.3 and 5.6)."""
    world = world_of(case)
    drawn = sketch(world, seed=seed)
    trajectories = demonstrate_by_hand(world, drawn, reflex=EXACT_REFLEX)
    return path_of(trajectories.poses) | {
        "effective pairs": float(len(trajectories.effective))
    }


def slipping_demonstration(case: Case, seed: int, scale: str) -> Numbers:
    """Return a demonstration of an expert whose turns sometimes miss by 30 degrees (Fig. 5.5)."""
    world, slip = world_of(case), neighbour_slip(float(case["slip"]))
    executed, intended = (
        record_demonstrations(
            ComputerExpert(), world, slip=slip, intended=as_chosen, reflex=EXACT_REFLEX
        )
        for as_chosen in (False, True)
    )
    return path_of(executed.poses) | {
        "slipped": float((executed.actions != intended.actions).sum())
    }


def iteration_gaps(case: Case, seed: int, scale: str) -> Numbers:
    """Return the gaps of evaluation and improvement after each half step (Fig. 2.4)."""
    exits = {"G": mdp.Cell(reward=1, ends=True), "X": mdp.Cell(reward=-1, ends=True)}
    grid = mdp.GridWorld("S...\n.#.X\n...G", legend=exits, slip=0.2, step_reward=-0.04)
    solution = mdp.generalized_policy_iteration(
        grid.mdp(0.9), sweeps=int(case["sweeps"]), tolerance=1e-6
    )
    return {
        "evaluation gap": solution.evaluation_gap,
        "improvement gap": solution.greedy_gap,
    }


PATHS = Plot("single_runs.plot_paths")


def panels(
    name: str,
    title: str,
    run: Callable[..., Numbers],
    cases: Sequence[Case],
    plot: Plot = PATHS,
    **settings: Any,
) -> Experiment:
    """Return the experiment of a figure with one panel for each case. Each case has one run."""
    return Experiment(
        name=name,
        title=title,
        cases=cases,
        run=run,
        seeds=ONCE,
        settings={"worlds": SEED} | settings,
        plot=plot,
    )


def shipped_policy(
    name: str, title: str, policy: str, worlds: int, **conditions: float
) -> Experiment:
    """Return the experiment of a figure of a policy of the package in some worlds (Figs. 4.5 and 5.9)."""
    cases: list[Case] = [
        {"method": policy, "world": world, **conditions, "starts": "new"}
        for world in range(worlds)
    ]
    return panels(
        name,
        title,
        navigation,
        cases,
        Plot("single_runs.plot_paths", columns=2),
        methods={policy: fingerprint(policy)},
    )


EXPERIMENTS = (
    panels("figure-2.4", "Gaps of evaluation and of improvement in generalized policy iteration",
           iteration_gaps,
           [{"sweeps": sweeps} for sweeps in (1, 5, 1000)],
           plot=Plot("single_runs.plot_gaps")),
    panels(
        "figure-3.4",
        "Nodes that modified A* and grid A* expand",
        search,
        [{"method": method, "world": 0, "obstacles": 10} for method in ("modified-a-star", "grid-a-star")],
    ),
    panels(
        "figure-4.2",
        "One robot's path in eight of its 300 episodes",
        training_episode,
        [{"episode": number} for number in (1, 20, 50, 100, 150, 200, 250, 300)],
        learner=TRAINING_SEED,
    ),
    shipped_policy("figure-4.5", "NNQL in six new maps, from new starts to new targets", "nnql", 6,
                   speed=2.5, steps=400, obstacles=12),
    panels("figure-5.3", "Demonstrations by hand, through key points", demonstration_by_hand,
           [{"world": world, "obstacles": 20} for world in range(2)]),
    panels("figure-5.5", "Demonstrations whose actions slip", slipping_demonstration,
           [{"world": 0, "obstacles": 20, "slip": slip} for slip in (0.3, 0.03)]),
    panels("figure-5.6", "More demonstrations by hand", demonstration_by_hand,
           [{"world": world, "obstacles": 20} for world in range(2, 6)]),
    shipped_policy("figure-5.9", "NIRL in new maps", "nirl", 4, speed=2.0, obstacles=20),
)  # fmt: skip
