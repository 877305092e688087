"""Policies with and without a memory in worlds with crossings."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.benchmark import outcome_rates
from robonav.lfd import ComputerExpert
from robonav.memory import (
    MemoryPolicy,
    RecurrentNetwork,
    WindowNetwork,
    dagger_with_memory,
    labelled_episodes,
    ppo_with_window,
)
from robonav.robot import (
    Encoder,
    Simulator,
    Worlds,
    crossing_worlds,
    navigate,
)
from robonav.robot.pockets import CORRIDOR, SECONDS, open_on_the_left

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from .setup import CONDITIONS

MEMORY: dict[str, Any] = CONDITIONS["memory"]
PPO: dict[str, Any] = CONDITIONS["memory-ppo"]
PROBED = 12.0  # metres before the end of the corridor: the robot knows nothing of the crossing yet


def new_policy(case: Case, seed: int) -> MemoryPolicy:
    """Return the policy of a case before its training."""
    encoder, k = Encoder(), int(case["k"])
    network = (
        RecurrentNetwork(encoder.size, units=MEMORY["units"], seed=seed)
        if case["network"] == "gru"
        else WindowNetwork(encoder.size, k=k, hidden=MEMORY["hidden"], seed=seed)
    )
    return MemoryPolicy(network, encoder, MEMORY["temperature"])


def trained_policy(case: Case, seed: int, scale: str) -> MemoryPolicy:
    """Train the policy of a case in worlds that are used for nothing else. The robot has no reflex."""
    first = MEMORY["training_seed"] + 100 * seed
    rounds = range(MEMORY["rounds"][scale])
    return dagger_with_memory(
        new_policy(case, seed),
        [crossing_worlds(MEMORY["worlds"][scale], seed=first + r) for r in rounds],
        reflex=None,
        validation=crossing_worlds(50, seed=MEMORY["validation_seed"] + seed),
        expert=ComputerExpert(margin=3.0, caution=2.0),
        steps=MEMORY["steps"][scale],
        batch=MEMORY["batch"],
        gradient_step=MEMORY["gradient_step"],
        max_steps=SECONDS,
        seed=seed,
    )


def train_and_test(case: Case, seed: int, scale: str) -> Numbers:
    """One training by DAgger and its test."""
    return numbers_of(trained_policy(case, seed, scale), seed, scale)


def reinforce_and_test(case: Case, seed: int, scale: str) -> Numbers:
    """One training by PPO from random weights, and its test."""
    policy = ppo_with_window(
        new_policy(case, seed),
        new_crossings,
        PPO["updates"][scale],
        gradient_step=PPO["gradient_step"],
        entropy_weight=PPO["entropy_weight"],
        seed=PPO["training_seed"] + seed,
    )
    return numbers_of(policy, seed, scale)


def new_crossings(rng: np.random.Generator) -> Simulator:
    """Return robots at the start of new worlds, in which nobody is tested: those have smaller seeds."""
    drawn = int(rng.integers(PPO["first_world_seed"], 2**31))
    return Simulator(crossing_worlds(PPO["robots"], seed=drawn), max_steps=SECONDS)


def numbers_of(policy: MemoryPolicy, seed: int, scale: str) -> Numbers:
    """The test of a policy, and what a line reads from its memory about the niche."""
    worlds = crossing_worlds(MEMORY["tests"][scale], seed=MEMORY["test_seed"] + seed)
    ends = navigate(policy, worlds, 2.0, SECONDS, reflex=None)
    longer = navigate(policy, worlds, 2.0, MEMORY["patience"], reflex=None)
    return outcome_rates(ends) | {
        "success in 300 s": outcome_rates(longer)["success"],
        "niche read": probe(policy, worlds),
    }


def probe(policy: MemoryPolicy, worlds: Worlds) -> float:
    """Return for how many worlds (per cent) a line reads from the memory on which side the niche was.

    The memory is that of the first step in the last 12 m of the corridor. A half of the worlds fits the line by least
    squares, and the other half tests it. If fewer than two robots come to this place, it is 50, as by chance.
    """
    memories, left = memories_before_the_crossing(policy, worlds)
    if len(left) < 2:
        return 50.0
    half = len(left) // 2
    x = np.column_stack([memories, np.ones(len(memories))])
    gram = x[:half].T @ x[:half] + np.eye(x.shape[1])
    line = np.linalg.solve(gram, x[:half].T @ np.where(left[:half], 1.0, -1.0))
    return 100 * float(((x[half:] @ line > 0) == left[half:]).mean())


def memories_before_the_crossing(
    policy: MemoryPolicy, worlds: Worlds
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the memories (K, d) of the robots that come to the end of the corridor, and whether left is open (K,)."""
    simulator = Simulator(worlds, max_steps=SECONDS)
    found: dict[int, NDArray[np.float64]] = {}
    places: list[list[float]] = [[] for _ in range(len(worlds))]

    def expert(simulator: Simulator, robots: NDArray[np.int64]) -> NDArray[np.int64]:
        """Note where the robots are; the labels are not used."""
        for robot in robots:
            places[robot].append(simulator.poses[robot, :2].sum() / np.sqrt(2))
        return np.zeros(len(robots), dtype=np.int64)

    rng = np.random.default_rng(0)
    seen = labelled_episodes(simulator, policy, expert, False, rng, None)
    states = _memories(policy, seen.inputs)
    for robot, along in enumerate(places):
        late = np.flatnonzero(np.array(along) > CORRIDOR[1] - PROBED)
        if len(late):
            found[robot] = states[late[0], robot]
    return np.array(list(found.values())), open_on_the_left(worlds)[list(found)]


def _memories(policy: MemoryPolicy, inputs: Any) -> NDArray[np.float64]:
    """Return the memories (T, N, d) after each of T inputs."""
    import torch

    memory, kept = policy.network.begin(inputs.shape[1]), []
    with torch.no_grad():
        for x in inputs:
            _, memory = policy.network.step(memory, x)
            kept.append(memory.flatten(1).numpy())
    return np.array(kept)


EXPERIMENTS = (
    Experiment(
        name="memory",
        title="Success at crossings of policies that see the last k steps, and of a recurrent one",
        cases=[
            {"network": "window", "k": 1, "reflex": "none"},
            {"network": "window", "k": 8, "reflex": "none"},
            {"network": "window", "k": 20, "reflex": "none"},
            {"network": "gru", "k": 0, "reflex": "none"},
        ],
        run=train_and_test,
        seeds=MEMORY["seeds"],
        settings={name: value for name, value in MEMORY.items() if name != "seeds"},
        shortened="A quick run trains in two rounds of six worlds, with 20 steps of Adam in each.",
        note="A recurrent network has no window; its k is 0. An episode has 90 s.",
        plot=SUCCESS_BARS,
    ),
    Experiment(
        name="memory-ppo",
        title="Success at crossings of policies that learn by PPO and see the last k steps",
        cases=[
            {"network": "window", "k": 1, "reflex": "none"},
            {"network": "window", "k": 20, "reflex": "none"},
        ],
        run=reinforce_and_test,
        seeds=PPO["seeds"],
        settings={name: value for name, value in PPO.items() if name != "seeds"}
        | {
            name: MEMORY[name]
            for name in ("hidden", "temperature", "tests", "test_seed", "patience")
        },
        shortened="A quick run has two updates.",
        note="The weights are random at first, and there is no expert. An arrival earns 1, a collision -1.",
        plot=SUCCESS_BARS,
    ),
)
