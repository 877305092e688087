"""Chapter 3 again: Table 3.2 and 3.3, Fig. 3.5 to 3.10; encoding and margin, on which the thesis is silent."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from robonav.lfd import (
    Demonstrations,
    demonstrate,
    demonstrate_by_hand,
    labelled_states,
    learn_neighbours,
    learn_policy,
    overview,
    plan,
    plan_on_grid,
    sketch,
)
from robonav.networks import accuracy
from robonav.robot import Policy, navigate, neighbour_slip, random_worlds
from robonav.robot.encoding import TARGET_ENCODINGS

from ..baselines import RULES
from ..runner.experiment import Case, Experiment
from ..runner.results import RESULTS as RESULTS
from .setup import (
    ABOUT,
    DEMONSTRATIONS,
    ROUNDS,
    SEEDS,
    SHOWN_WORLDS,
    TEST_WORLDS,
    Numbers,
    aggregated,
    cloned,
    driven,
    expert_in_new_worlds,
    new_worlds,
    shown,
    trained,
    unscaled,
)

ITERATIONS, MOST_ITERATIONS = 300, 500
OTHERS = 500  # run k is tested on the demonstrations of run k + 500
MAPS = 20  # that a run plans in
MARGIN = 2.0  # metres that planners keep: every map has a way that wide
OTHER_WAY = 10.0  # metres that two paths may be apart before they count as two ways
SLIP = 0.2  # how likely a slipping expert turns 30 degrees too far or too little


def with_demonstrations(case: Case, seed: int, scale: str) -> Numbers:
    """Table 3.2: one network from so many demonstrations, driven through new maps."""
    expert, degrees, drives = (
        str(case["expert"]),
        str(case["degrees"]),
        int(case["demonstrations"]),
    )
    if case["target"] == "number":
        policy = unscaled(
            trained(seed, expert, degrees, drives=drives).network, degrees
        )
    else:
        policy = learn_policy(shown(seed, drives=drives, expert=expert), seed=seed)
    return driven(policy, new_worlds(seed, scale))


def with_iterations(case: Case, seed: int, scale: str) -> Numbers:
    """Table 3.3: agreement with the demonstrations learned from, and with others; cost; and what the robot does."""
    expert, degrees = str(case["expert"]), str(case["degrees"])
    training = trained(seed, expert, degrees, iterations=MOST_ITERATIONS)
    assert training.networks is not None
    done = min(int(case["iterations"]), training.iterations)
    policy = unscaled(training.networks[done], degrees)
    others = labelled_states(shown(seed + OTHERS, expert=expert), policy.encoder)
    return {
        "accuracy": 100 * training.accuracies[done],
        "accuracy on others": 100 * accuracy(policy.network, *others),
        "cost": training.costs[done],
        "success": driven(policy, new_worlds(seed, scale))["success"],
    }


def cost(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.7: the cost before training and after each iteration; one that can fall no further stays."""
    training = trained(seed, str(case["expert"]), str(case["degrees"]))
    costs = np.pad(training.costs, (0, ITERATIONS - training.iterations), mode="edge")
    return {"cost": costs, "cost at the end": costs[-1]}


def plan_both(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.5: modified A* and grid A* in the same maps; lengths up to the target itself, which neither steps on."""
    target = (90.0, float(case["target y"]))
    worlds = random_worlds(
        MAPS, int(case["obstacles"]), seed=TEST_WORLDS + seed, targets=(target,)
    )
    ours = [plan(world, margin=MARGIN) for world in worlds]
    grids = [
        plan_on_grid(world, margin=MARGIN, cell=float(case["grid cell"]))
        for world in worlds
    ]
    lengths = np.array([[made.length + np.linalg.norm(made.points[-1] - target) for made in pair]
                        for pair in zip(ours, grids, strict=True) if all(made.found for made in pair)])  # fmt: skip
    modified, grid = lengths.T
    return {
        "modified": modified.mean(),
        "grid": grid.mean(),
        "modified shorter": 100 * (modified < grid - 1e-6).mean(),
        "modified expands": np.mean([made.expanded for made in ours]),
        "grid expands": np.mean([made.expanded for made in grids]),
        "found by both": 100 * len(lengths) / MAPS,
    }


def expert_drives(expert: str, seed: int) -> Demonstrations:
    """25 demonstrations by the computer or a hand, steady or slipping (section 5.5.5)."""
    worlds = random_worlds(DEMONSTRATIONS, seed=SHOWN_WORLDS + seed)
    slip = neighbour_slip(SLIP) if expert.endswith("slipping") else None
    if expert.startswith("computer"):
        return demonstrate(worlds, slip=slip)
    return demonstrate_by_hand(worlds, sketch(worlds, seed=seed), slip=slip)


def experts(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.6: what 25 demonstrations hold, and how the robot drives that learned from them."""
    demonstrations = expert_drives(str(case["expert"]), seed)
    held = overview(demonstrations)
    return {
        "arrived": 100 * held.arrived / held.drives,
        "steps a drive": held.steps / held.drives,
        "effective pairs a drive": held.effective / held.drives,
        "distinct states a drive": held.states / held.drives,
        "straight on": 100 * held.actions[0] / held.effective,
        "least range": held.closest,
        "success": driven(
            learn_policy(demonstrations, seed=seed), new_worlds(seed, scale)
        )["success"],
    }


def method(name: str, seed: int, scale: str, obstacles: int = 10) -> Policy:
    """A policy by name, learned among so many obstacles."""
    if name in RULES:
        return RULES[name]
    if name == "DAgger":
        return aggregated(seed, obstacles, rounds=ROUNDS).policy
    if name == "cloning":
        return cloned(seed, obstacles)
    return learn_neighbours(shown(seed, obstacles), int(name.split()[0]))


def in_new_maps(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.8, counted: a method drives through maps with as many obstacles as it learned among."""
    obstacles, name = int(case["obstacles"]), str(case["method"])
    worlds = new_worlds(seed, scale, obstacles)
    numbers = driven(method(name, seed, scale, obstacles), worlds)
    if name == "DAgger":
        policies = aggregated(seed, obstacles, rounds=ROUNDS).policies
        numbers["success by round"] = np.array(
            [driven(policy, worlds)["success"] for policy in policies]
        )
    return numbers


def beside_the_expert(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.9: the same maps driven by what was learned and by the expert that it was learned from."""
    expert = expert_in_new_worlds(seed, scale, int(case["obstacles"]))
    worlds = expert.worlds
    policy = method(str(case["method"]), seed, scale, int(case["obstacles"]))
    drives = navigate(policy, worlds, record_paths=True)
    assert drives.paths is not None
    both = np.flatnonzero(drives.success & (expert.outcome == "arrived"))
    apart = [
        cKDTree(expert.poses[expert.trajectory == drive, :2]).query(
            drives.paths[drive][:, :2]
        )[0]
        for drive in both
    ]
    planned = [plan(worlds[drive], margin=MARGIN).length for drive in both]
    return {
        "planned": np.median(planned),
        "the expert's": 2.0 * np.median(expert.lengths[both]),
        "learned": 2.0 * np.median(drives.steps[both]),
        "learned, mean": 2.0 * drives.steps[both].mean(),
        "apart": np.mean([distances.mean() for distances in apart]),
        "another way": 100
        * np.mean([distances.max() > OTHER_WAY for distances in apart]),
    }


def among_movers(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.10: standing and moving obstacles, for robots that learned among standing ones."""
    worlds = new_worlds(seed, scale, int(case["standing"]), int(case["moving"]))
    return driven(method(str(case["method"]), seed, scale), worlds)


def encoded(case: Case, seed: int, scale: str) -> Numbers:
    """The target's sector written in one way or another."""
    obstacles, target = int(case["obstacles"]), str(case["target"])
    if case["learner"] == "DAgger, 1 round":
        policy = aggregated(seed, obstacles, target=target, rounds=1).policy
    else:
        policy = cloned(seed, obstacles, target=target)
    return driven(policy, new_worlds(seed, scale, obstacles))


def keeping_off(case: Case, seed: int, scale: str) -> Numbers:
    """An expert that keeps so far off, and the robot that learned from it."""
    obstacles = int(case["obstacles"])
    worlds = random_worlds(DEMONSTRATIONS, obstacles, seed=SHOWN_WORLDS + seed)
    demonstrations = demonstrate(
        worlds, margin=float(case["margin"]), caution=float(case["caution"])
    )
    return driven(
        learn_policy(demonstrations, seed=seed), new_worlds(seed, scale, obstacles)
    )


TABLE_3_2 = Experiment(
    name="table-3.2",
    title="Success in new maps against number of demonstrations",
    cases=[
        {
            "expert": expert,
            "target": target,
            "degrees": degrees,
            "demonstrations": number,
        }
        for expert, target, degrees in (
            ("keeps off", "sine-cosine", "0 to 1"),
            ("keeps off", "number", "0 to 1"),
            ("shortest way", "number", "0 to 7"),
        )
        for number in (20, 25, 30, 35, 40)
    ],
    run=with_demonstrations,
    seeds=SEEDS,
    thesis={"success": [89, 92, 92, 93, 94] * 3},
    settings=ABOUT,
)
TABLE_3_3 = Experiment(
    name="table-3.3",
    title="Agreement with the demonstrations against iterations of training",
    cases=[
        {"expert": expert, "degrees": degrees, "iterations": iterations}
        for expert, degrees in (("shortest way", "0 to 7"), ("keeps off", "0 to 1"))
        for iterations in (100, 200, 250, 300, 350, 400, MOST_ITERATIONS)
    ],
    run=with_iterations,
    seeds=SEEDS,
    thesis={"accuracy": [81.12, 82.68, 82.83, 83.62, 83.31, 83.15, 83.46] * 2},
    settings=ABOUT,
)
FIGURE_3_5 = Experiment(
    name="figure-3.5",
    title="Modified A* beside grid A*: metres to the target, and nodes",
    cases=[
        {"target y": y, "obstacles": obstacles, "grid cell": cell}
        for y in (90, 40)
        for obstacles in (10, 20)
        for cell in (1, 2)
    ],
    run=plan_both,
    seeds={"quick": 2, "thesis": 10},
    thesis={"modified": [120.2053] + [None] * 7, "grid": [124.3638] + [None] * 7},
    settings={
        "maps a run": MAPS,
        "margin in m": MARGIN,
        "first seed of the worlds": TEST_WORLDS,
    },
)
FIGURE_3_6 = Experiment(
    name="figure-3.6",
    title="What 25 demonstrations hold, by expert, and how the robot drives that learned from them",
    cases=[
        {"expert": expert}
        for expert in ("computer", "computer, slipping", "hand", "hand, slipping")
    ],
    run=experts,
    seeds=SEEDS,
    thesis={"success": [92, None, None, None]},
    settings=ABOUT | {"slip": SLIP},
)
FIGURE_3_7 = Experiment(
    name="figure-3.7",
    title="The cost in training",
    cases=[
        {"expert": expert, "degrees": degrees}
        for expert, degrees in (
            ("shortest way", "0 to 7"),
            ("keeps off", "0 to 7"),
            ("keeps off", "0 to 1"),
        )
    ],
    run=cost,
    seeds=SEEDS | {"thesis": 8},
    thesis={"cost at the end": [0.91] * 3},
    settings=ABOUT,
)
FIGURE_3_8 = Experiment(
    name="figure-3.8",
    title="Success in new maps: cloning, what came before and after it, and two rules that learn nothing",
    cases=[
        {"obstacles": obstacles, "method": name}
        for obstacles in (10, 20, 30)
        for name in (
            *RULES,
            "1 neighbour",
            "5 neighbours",
            "15 neighbours",
            "cloning",
            "DAgger",
        )
    ],
    run=in_new_maps,
    seeds=SEEDS,
    thesis={"success": [None] * 5 + [92] + [None] * 15},
    settings=ABOUT,
)
FIGURE_3_9 = Experiment(
    name="figure-3.9",
    title="Learned paths beside planned ones: medians in metres",
    cases=[
        {"obstacles": obstacles, "method": name}
        for obstacles in (10, 20)
        for name in ("cloning", "DAgger")
    ],
    run=beside_the_expert,
    seeds=SEEDS,
    settings=ABOUT,
)
FIGURE_3_10 = Experiment(
    name="figure-3.10",
    title="Among moving obstacles, learned among standing ones",
    cases=[
        {"standing": standing, "moving": moving, "method": name}
        for standing, moving in ((10, 5), (10, 10))
        for name in (*RULES, "cloning", "DAgger")
    ],
    run=among_movers,
    seeds=SEEDS,
    settings=ABOUT,
)
ENCODINGS = Experiment(
    name="lfd-encodings",
    title="Four ways to write the target's sector",
    cases=[
        {"learner": learner, "obstacles": obstacles, "target": target}
        for learner in ("cloning", "DAgger, 1 round")
        for obstacles in (10, 20)
        for target in TARGET_ENCODINGS
    ],
    run=encoded,
    seeds=SEEDS | {"thesis": 6},
    settings=ABOUT,
)
MARGINS = Experiment(
    name="lfd-margins",
    title="How far the expert keeps off",
    cases=[
        {"obstacles": obstacles, "caution": caution, "margin": margin}
        for obstacles in (10, 20)
        for caution in (0, 2)
        for margin in (1, 2, 3, 5)
    ],
    run=keeping_off,
    seeds=SEEDS,
    settings=ABOUT,
)

EXPERIMENTS = (
    TABLE_3_2, TABLE_3_3, FIGURE_3_5, FIGURE_3_6, FIGURE_3_7, FIGURE_3_8, FIGURE_3_9, FIGURE_3_10, ENCODINGS, MARGINS,
)  # fmt: skip
