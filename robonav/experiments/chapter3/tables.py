"""Tables 3.2 and 3.3, Figs. 3.5 to 3.10, and the encoding and the margin, which the thesis does not give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from robonav.benchmark import BASELINES
from robonav.lfd import (
    Demonstrations,
    demonstrate,
    demonstrate_by_hand,
    labelled_states,
    learn_neighbours,
    learn_policy,
    plan,
    plan_on_grid,
    sketch,
    summarise_dataset,
)
from robonav.lfd.dagger import TEMPERATURE
from robonav.networks import cross_entropy_cost, network_accuracy
from robonav.robot import Policy, Worlds, navigate, neighbour_slip, random_worlds
from robonav.robot.encoding import TARGET_ENCODINGS

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers, Plot
from .setup import (
    ABOUT,
    CONDITIONS,
    DEMONSTRATION_SEED,
    DEMONSTRATIONS,
    ROUNDS,
    SEEDS,
    SETUP,
    cloned_policy,
    dagger_result,
    demonstrations,
    expert_in_test_worlds,
    policy_of,
    training,
)

ITERATIONS: int = CONDITIONS["iterations"]
MOST_ITERATIONS: int = CONDITIONS["most_iterations"]
OTHERS: int = CONDITIONS["others"]
PLANNING = CONDITIONS["planning"]
MARGIN: float = PLANNING["margin"]


def with_demonstrations(case: Case, seed: int, scale: str) -> Numbers:
    """Table 3.2: one network from a number of demonstrations, tested in new maps."""
    expert, inputs = str(case["expert"]), str(case["inputs"])
    number = int(case["demonstrations"])
    if case["target"] == "number":
        trained = training(seed, expert, inputs, number=number)
        policy = policy_of(trained.network, inputs)
    else:
        learned_from = demonstrations(seed, number=number, expert=expert)
        policy = learn_policy(learned_from, seed=seed)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))


def with_iterations(case: Case, seed: int, scale: str) -> Numbers:
    """Table 3.3: accuracy on the training demonstrations and on others, cost, and success in new maps."""
    expert, inputs = str(case["expert"]), str(case["inputs"])
    trained = training(seed, expert, inputs, iterations=MOST_ITERATIONS)
    assert trained.networks is not None
    done = min(int(case["iterations"]), trained.iterations)
    policy = policy_of(trained.networks[done], inputs)
    others = labelled_states(
        demonstrations(seed + OTHERS, expert=expert), policy.encoder
    )
    rates = SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))
    return {
        "accuracy": 100 * trained.accuracies[done],
        "accuracy, other demonstrations": 100
        * network_accuracy(policy.network, *others),
        "cost": trained.costs[done],
        "success": rates["success"],
    }


def training_cost(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.7: the cost before training and after each iteration. After convergence the last cost is repeated."""
    trained = training(seed, str(case["expert"]), str(case["inputs"]))
    costs = np.pad(trained.costs, (0, ITERATIONS - trained.iterations), mode="edge")
    return {"cost": costs, "cost at the end": costs[-1]}


def compare_planners(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.5: modified A* and grid A* in the same maps. Lengths include the last part up to the target."""
    target = (90.0, float(case["target y"]))
    worlds = planning_worlds(seed, int(case["obstacles"]), target)
    ours = [plan(world, margin=MARGIN) for world in worlds]
    grids = [
        plan_on_grid(world, margin=MARGIN, cell=float(case["grid cell"]))
        for world in worlds
    ]
    lengths = np.array(
        [
            [found.length + np.linalg.norm(found.points[-1] - target) for found in pair]
            for pair in zip(ours, grids, strict=True)
            if all(found.found for found in pair)
        ]
    )
    modified, grid = lengths.T
    return {
        "length, modified A*": modified.mean(),
        "length, grid A*": grid.mean(),
        "modified A* shorter": 100 * (modified < grid - 1e-6).mean(),
        "expanded, modified A*": np.mean([found.expanded for found in ours]),
        "expanded, grid A*": np.mean([found.expanded for found in grids]),
        "found by both": 100 * len(lengths) / PLANNING["maps"],
    }


def planning_worlds(seed: int, obstacles: int, target: tuple[float, float]) -> Worlds:
    """Return the maps of a run."""
    first = SETUP.test_seed + seed
    return random_worlds(PLANNING["maps"], obstacles, seed=first, targets=(target,))


def expert_demonstrations(expert: str, seed: int) -> Demonstrations:
    """Return 25 demonstrations by a computer or a human expert, with or without slipping (section 5.5.5)."""
    worlds = random_worlds(DEMONSTRATIONS, seed=DEMONSTRATION_SEED + seed)
    slip = neighbour_slip(PLANNING["slip"]) if expert.endswith("slipping") else None
    if expert.startswith("computer"):
        return demonstrate(worlds, slip=slip, reflex=SETUP.reflex)
    drawn = sketch(worlds, seed=seed)
    return demonstrate_by_hand(worlds, drawn, slip=slip, reflex=SETUP.reflex)


def compare_experts(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.6: the content of 25 demonstrations, and the success of the policy learned from them."""
    trajectories = expert_demonstrations(str(case["expert"]), seed)
    held = summarise_dataset(trajectories)
    policy = learn_policy(trajectories, seed=seed)
    rates = SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))
    return {
        "success of the expert": 100 * held.arrived / held.trajectories,
        "steps an episode": held.steps / held.trajectories,
        "effective pairs an episode": held.effective / held.trajectories,
        "distinct states an episode": held.states / held.trajectories,
        "straight on": 100 * held.actions[0] / held.effective,
        "least range": held.closest,
        "success": rates["success"],
    }


def learned_policy(name: str, seed: int, obstacles: int = 10) -> Policy:
    """Return a baseline, or the policy of a method trained with a number of obstacles."""
    if name in BASELINES:
        return BASELINES[name]
    if name == "dagger":
        return dagger_result(seed, obstacles, rounds=ROUNDS).policy
    if name == "lfd":
        return cloned_policy(seed, obstacles)
    return learn_neighbours(demonstrations(seed, obstacles), int(name.split("-")[0]))


def in_new_maps(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.8 in numbers: a method is tested in maps with as many obstacles as in its training."""
    obstacles, name = int(case["obstacles"]), str(case["method"])
    worlds = SETUP.test_worlds(seed, scale, obstacles)
    rates = SETUP.evaluate(learned_policy(name, seed, obstacles), worlds)
    if name != "dagger":
        return rates
    policies = dagger_result(seed, obstacles, rounds=ROUNDS).policies
    by_round = [SETUP.evaluate(policy, worlds)["success"] for policy in policies]
    return rates | {"success by round": np.array(by_round)}


def beside_the_expert(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.9: a learned policy and its expert in the same maps."""
    obstacles = int(case["obstacles"])
    expert = expert_in_test_worlds(seed, scale, obstacles)
    worlds = expert.worlds
    policy = learned_policy(str(case["method"]), seed, obstacles)
    learned = navigate(policy, worlds, record_paths=True, reflex=SETUP.reflex)
    assert learned.paths is not None
    both = np.flatnonzero(learned.success & (expert.outcome == "arrived"))
    distances = [
        cKDTree(expert.poses[expert.trajectory == k, :2]).query(learned.paths[k][:, :2])[0]
        for k in both
    ]  # fmt: skip
    planned = [plan(worlds[k], margin=MARGIN).length for k in both]
    other = [apart.max() > PLANNING["other_path"] for apart in distances]
    return {
        "length, planned": np.median(planned),
        "length, expert": SETUP.speed * np.median(expert.lengths[both]),
        "length, learned": SETUP.speed * np.median(learned.steps[both]),
        "length, learned, mean": SETUP.speed * learned.steps[both].mean(),
        "distance": np.mean([apart.mean() for apart in distances]),
        "different path": 100 * np.mean(other),
    }


def among_moving_obstacles(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 3.10: standing and moving obstacles, for policies trained with standing ones."""
    worlds = SETUP.test_worlds(seed, scale, int(case["obstacles"]), int(case["moving"]))
    return SETUP.evaluate(learned_policy(str(case["method"]), seed), worlds)


def compare_encodings(case: Case, seed: int, scale: str) -> Numbers:
    """The target's sector, encoded in four ways."""
    obstacles, target = int(case["obstacles"]), str(case["target"])
    if case["method"] == "dagger":
        policy = dagger_result(seed, obstacles, target=target, rounds=1).policy
    else:
        policy = cloned_policy(seed, obstacles, target=target)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale, obstacles))


def expert_margin(case: Case, seed: int, scale: str) -> Numbers:
    """Test an expert that keeps a margin, and the policy learned from it."""
    obstacles = int(case["obstacles"])
    trajectories = demonstrate(
        random_worlds(DEMONSTRATIONS, obstacles, seed=DEMONSTRATION_SEED + seed),
        margin=float(case["margin"]),
        caution=float(case["caution"]),
        reflex=SETUP.reflex,
    )
    policy = learn_policy(trajectories, seed=seed)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale, obstacles))


def with_equal_data(case: Case, seed: int, scale: str) -> Numbers:
    """One round of DAgger, and cloning from demonstrations in equally many maps, the control for it."""
    obstacles, maps = int(case["obstacles"]), int(case["worlds"])
    if case["method"] == "dagger":
        result = dagger_result(seed, obstacles, rounds=1)
        policy, learned_from = result.policy, result.demonstrations[-1]
    else:
        learned_from = demonstrations(seed, obstacles, number=maps)
        cloned = learn_policy(learned_from, seed=seed)
        policy = replace(cloned, temperature=float(case["temperature"]))
    rates = SETUP.evaluate(policy, SETUP.test_worlds(seed, scale, obstacles))
    return rates | {"examples": len(learned_from.effective)}


def with_decay(case: Case, seed: int, scale: str) -> Numbers:
    """Weight decay: cost and accuracy on other demonstrations, and success in new maps."""
    policy = learn_policy(
        demonstrations(seed), regularisation=float(case["regularisation"]), seed=seed
    )
    x, y = labelled_states(demonstrations(seed + OTHERS))
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale)) | {
        "cost, other demonstrations": cross_entropy_cost(policy.network, x, y),
        "accuracy, other demonstrations": 100 * network_accuracy(policy.network, x, y),
    }


def with_short_rounds(case: Case, seed: int, scale: str) -> Numbers:
    """DAgger whose rollouts end early: the last policy, and the one that does best in maps kept for validation."""
    obstacles = int(case["obstacles"])
    limit = int(case["steps in a rollout"])
    policies = dagger_result(seed, obstacles, max_steps=limit).policies
    kept = SETUP.worlds(
        CONDITIONS["validation_maps"], SETUP.tuning_seed + seed, obstacles
    )
    validated = [SETUP.evaluate(policy, kept)["success"] for policy in policies]
    worlds = SETUP.test_worlds(seed, scale, obstacles)
    chosen = SETUP.evaluate(policies[int(np.argmax(validated))], worlds)
    return SETUP.evaluate(policies[-1], worlds) | {
        "success, chosen round": chosen["success"]
    }


TABLE_3_2 = Experiment(
    name="table-3.2",
    title="Success in new maps against number of demonstrations",
    cases=[
        {
            "expert": expert,
            "target": target,
            "inputs": inputs,
            "demonstrations": number,
        }
        for expert, target, inputs in (
            ("keeps clear", "sine-cosine", "0 to 1"),
            ("keeps clear", "number", "0 to 1"),
            ("shortest path", "number", "0 to 7"),
        )
        for number in (20, 25, 30, 35, 40)
    ],
    run=with_demonstrations,
    seeds=SEEDS,
    thesis={"success": [89, 92, 92, 93, 94] * 3},
    settings=ABOUT,
    plot=Plot("lfd.plot_demonstrations"),
)
TABLE_3_3 = Experiment(
    name="table-3.3",
    title="Accuracy on the demonstrations against iterations of training",
    cases=[
        {"expert": expert, "inputs": inputs, "iterations": iterations}
        for expert, inputs in (("shortest path", "0 to 7"), ("keeps clear", "0 to 1"))
        for iterations in (100, 200, 250, 300, 350, 400, MOST_ITERATIONS)
    ],
    run=with_iterations,
    seeds=SEEDS,
    thesis={"accuracy": [81.12, 82.68, 82.83, 83.62, 83.31, 83.15, 83.46] * 2},
    settings=ABOUT,
    plot=Plot("lfd.plot_iterations"),
)
FIGURE_3_5 = Experiment(
    name="figure-3.5",
    title="Modified A* and grid A*: metres to the target, and nodes expanded",
    cases=[
        {"target y": y, "obstacles": obstacles, "grid cell": cell}
        for y in (90, 40)
        for obstacles in (10, 20)
        for cell in (1, 2)
    ],
    run=compare_planners,
    seeds={"quick": 2, "thesis": 10},
    thesis={
        "length, modified A*": [120.2053] + [None] * 7,
        "length, grid A*": [124.3638] + [None] * 7,
    },
    settings={
        "maps a run": PLANNING["maps"],
        "margin in m": MARGIN,
        "first seed of the worlds": SETUP.test_seed,
    },
    plot=Plot("lfd.plot_planners"),
)
FIGURE_3_6 = Experiment(
    name="figure-3.6",
    title="Content of 25 demonstrations by expert, and success of the policy learned from them",
    cases=[
        {"expert": expert}
        for expert in ("computer", "computer, slipping", "human", "human, slipping")
    ],
    run=compare_experts,
    seeds=SEEDS,
    thesis={"success": [92, None, None, None]},
    settings=ABOUT | {"slip": PLANNING["slip"]},
    plot=SUCCESS_BARS,
)
FIGURE_3_7 = Experiment(
    name="figure-3.7",
    title="Cost during training, over iterations",
    cases=[
        {"expert": expert, "inputs": inputs}
        for expert, inputs in (
            ("shortest path", "0 to 7"),
            ("keeps clear", "0 to 7"),
            ("keeps clear", "0 to 1"),
        )
    ],
    run=training_cost,
    seeds=SEEDS | {"thesis": 8},
    thesis={"cost at the end": [0.91] * 3},
    settings=ABOUT,
    plot=Plot("lfd.plot_cost"),
)
FIGURE_3_8 = Experiment(
    name="figure-3.8",
    title="Success in new maps: nearest neighbours, behaviour cloning, DAgger, and two baselines",
    cases=[
        {"obstacles": obstacles, "method": name}
        for obstacles in (10, 20, 30)
        for name in (
            *BASELINES,
            "1-neighbour",
            "5-neighbours",
            "15-neighbours",
            "lfd",
            "dagger",
        )
    ],
    run=in_new_maps,
    seeds=SEEDS,
    thesis={"success": [None] * 5 + [92] + [None] * 15},
    settings=ABOUT,
    plot=Plot("lfd.plot_methods"),
)
FIGURE_3_9 = Experiment(
    name="figure-3.9",
    title="Lengths of learned and of planned paths: medians in metres",
    cases=[
        {"obstacles": obstacles, "method": name}
        for obstacles in (10, 20)
        for name in ("lfd", "dagger")
    ],
    run=beside_the_expert,
    seeds=SEEDS,
    settings=ABOUT,
    plot=Plot(
        "experiments.draw_bars",
        metric="length, learned",
        label="length of paths, median (m)",
    ),
)
FIGURE_3_10 = Experiment(
    name="figure-3.10",
    title="Success with standing and moving obstacles: policies learned with standing ones, and baselines",
    cases=[
        {"obstacles": obstacles, "moving": moving, "method": name}
        for obstacles, moving in ((10, 5), (10, 10))
        for name in (*BASELINES, "lfd", "dagger")
    ],
    run=among_moving_obstacles,
    seeds=SEEDS,
    settings=ABOUT,
    plot=SUCCESS_BARS,
)
ENCODINGS = Experiment(
    name="lfd-encodings",
    title="Success in new maps with four encodings of the target's sector",
    cases=[
        {"method": name, "obstacles": obstacles, "target": target}
        for name in ("lfd", "dagger")
        for obstacles in (10, 20)
        for target in TARGET_ENCODINGS
    ],
    run=compare_encodings,
    seeds=SEEDS | {"thesis": 6},
    settings=ABOUT | {"rounds of DAgger": 1},
    plot=SUCCESS_BARS,
)
MARGINS = Experiment(
    name="lfd-margins",
    title="Success in new maps by the margin that the expert keeps from obstacles",
    cases=[
        {"obstacles": obstacles, "caution": caution, "margin": margin}
        for obstacles in (10, 20)
        for caution in (0, 2)
        for margin in (1, 2, 3, 5)
    ],
    run=expert_margin,
    seeds=SEEDS,
    settings=ABOUT,
    plot=Plot("lfd.plot_margins"),
)
EQUAL_DATA = Experiment(
    name="lfd-equal-data",
    title="Success in new maps: one round of DAgger, and cloning from equally many maps",
    cases=[
        {
            "obstacles": obstacles,
            "method": name,
            "worlds": maps,
            "temperature": temperature,
        }
        for obstacles in (10, 20, 30)
        for name, maps, temperature in (
            ("lfd", DEMONSTRATIONS, 0.0),
            ("lfd", 2 * DEMONSTRATIONS, 0.0),
            ("lfd", 2 * DEMONSTRATIONS, TEMPERATURE),
            ("dagger", 2 * DEMONSTRATIONS, TEMPERATURE),
        )
    ],
    run=with_equal_data,
    seeds=SEEDS,
    settings=ABOUT,
    plot=SUCCESS_BARS,
)
REGULARISATION = Experiment(
    name="lfd-regularisation",
    title="Cost and accuracy on other demonstrations, and success in new maps, by weight decay",
    cases=[{"regularisation": decay} for decay in (1.0, 0.1, 0.01)],
    run=with_decay,
    seeds=SEEDS,
    settings=ABOUT,
    plot=SUCCESS_BARS,
)
SHORT_ROUNDS = Experiment(
    name="lfd-dagger-rounds",
    title="Success in new maps after three rounds of DAgger, and with the round chosen by validation",
    cases=[{"obstacles": 30, "steps in a rollout": steps} for steps in (500, 120)],
    run=with_short_rounds,
    seeds=SEEDS | {"thesis": 8},
    settings=ABOUT | {"maps for validation": CONDITIONS["validation_maps"]},
    plot=SUCCESS_BARS,
)

EXPERIMENTS = (
    TABLE_3_2, TABLE_3_3, FIGURE_3_5, FIGURE_3_6, FIGURE_3_7, FIGURE_3_8, FIGURE_3_9, FIGURE_3_10, ENCODINGS, MARGINS,
    EQUAL_DATA, REGULARISATION, SHORT_ROUNDS,
)  # fmt: skip
