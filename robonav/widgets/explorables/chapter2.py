"""The numbers of chapter 2's explorables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from robonav import mdp
from robonav.mdp.belief_planning import AlphaVectors, backup

from ..grid import page_grid
from ..model import page_model
from .registry import asks


@asks(
    "How far ahead does a discount look?",
    "The near charger gives a reward of 4 after 2 steps, and the far one gives 10 after 8 steps. "
    "From which discount γ on has the far charger the larger return?",
    guesses=["from 0.4", "from 0.6", "from 0.86", "from 0.99"],
    right="from 0.86",
    because="The two returns are equal where γ⁶ = 0.4, that is at γ = 0.858, and a larger γ favours "
    "the later reward.",
)
def discounted_return(
    soon: float = 4.0, soon_steps: int = 2, late: float = 10.0, late_steps: int = 8
) -> dict[str, Any]:
    """Two ways with one reward each at their end, and the discount at which both returns are equal."""
    near, far = np.zeros(soon_steps), np.zeros(late_steps)
    near[-1], far[-1] = soon, late
    equal = (soon / late) ** (1 / (late_steps - soon_steps))
    returns = [float(mdp.discounted_return(way, equal)[0]) for way in (near, far)]
    return {
        "near": near.tolist(),
        "far": far.tolist(),
        "equal": equal,
        "value": returns[0],
    }


def grid_to_touch(
    grid: mdp.GridWorld, discount: float
) -> tuple[mdp.FiniteMDP, dict[str, Any]]:
    """A grid's model, and what each explorable on a grid takes: picture, model, start and best values."""
    model = grid.mdp(discount)
    best = mdp.policy_iteration(model)
    return model, {
        "layout": page_grid(grid),
        "model": page_model(model),
        "discount": discount,
        "marked": int(grid.start.argmax()),
        "best": best.values.tolist(),
    }


@asks(
    "Turn an arrow of a policy",
    "One of the nine arrows below is not optimal. "
    "If you turn it and leave all others, in how many cells does the value rise?",
    guesses=["in that cell only", "in two cells", "in five cells", "in all nine cells"],
    right="in two cells",
    because="Only the paths from its own cell and from the corner to its right lead through it.",
    files=("grid", "model", "explorables/marked_grid"),
)
def turn_arrows(discount: float = 0.95) -> dict[str, Any]:
    """The policy that goes around, on the grid of four by three cells."""
    _, given = grid_to_touch(mdp.four_by_three(), discount)
    return given | {"policy": [1, 1, 1, 1, 0, 0, 0, 0, 3, 3, 3], "marked": 8}


@asks(
    "One Bellman backup at a time",
    "All values are 0. "
    "You may back up one cell at a time, in any order. "
    "What is the smallest number of backups after which the start S has a value above 0?",
    guesses=["1", "3", "5", "9"],
    right="5",
    because="The start is five steps away from the good exit, and each backup carries the value one "
    "cell further.",
    files=("grid", "model", "explorables/marked_grid"),
)
def bellman_backup(discount: float = 0.9) -> dict[str, Any]:
    """Values to be backed up by hand, on the grid of four by three cells."""
    return grid_to_touch(mdp.four_by_three(), discount)[1]


@asks(
    "Evaluate and improve by hand",
    "All arrows point up and all values are 0. "
    "You press in turn: one sweep, improve, one sweep, improve, and so on. "
    "After how many improvements are all arrows optimal?",
    guesses=["1", "2", "4", "more than 10"],
    right="4",
    because="Each sweep carries the rewards of the exits only one cell further, so the arrows of far "
    "cells turn later.",
    files=("grid", "model"),
)
def evaluate_improve(discount: float = 0.9) -> dict[str, Any]:
    """Policy iteration by hand, from a policy that always goes up."""
    model, given = grid_to_touch(mdp.four_by_three(), discount)
    q = model.action_values(np.array(given["best"]))
    ties = q >= q.max(axis=1, keepdims=True) - 1e-9
    optimal = [np.flatnonzero(row).tolist() for row in ties]
    return given | {"policy": [0] * model.n_states, "optimal": optimal}


@asks(
    "Two runs of value iteration approach each other",
    "Value iteration runs twice, once from values of 0 and once from values of 20. "
    "The discount is 0.9. "
    "After how many sweeps is the largest difference between the two at most a hundredth of "
    "the first one?",
    guesses=["10", "22", "44", "never"],
    right="44",
    because="Each sweep multiplies the largest difference by at most 0.9, and 0.9⁴⁴ is the first "
    "power below 0.01.",
    files=("model",),
)
def contraction() -> dict[str, Any]:
    """The process with two states whose values the page draws in a plane."""
    return {"model": page_model(two_states(0.9))}


def two_states(discount: float) -> mdp.FiniteMDP:
    """A process with two states and two actions."""
    return mdp.FiniteMDP(
        transitions=[[[0.2, 0.8], [0, 1]], [[1, 0], [0.3, 0.7]]],
        rewards=[[-0.9, 0.6], [-0.6, 0.4]],
        discount=discount,
    )


RUNS, EPISODES = 20, 100
ROOMS = slice(1, 6)
"""The five rooms among the states; state 0 is the hole, and state 6 the goal."""
COIN = np.tile([0.5, 0.0, 0.5, 0.0], (7, 1))  # left, down, right, up
TRUTH = np.arange(1, 6) / 6


def five_rooms() -> gym.Env[Any, Any]:
    """The five rooms in a row, between a hole and the goal."""
    return gym.make("FrozenLake-v1", desc=["HFFSFFG"], is_slippery=False)


def page_episodes(episodes: Iterable[Iterable[int]]) -> str:
    """Pack episodes for the page, as the numbers of the states passed."""
    return " ".join("".join(map(str, episode)) for episode in episodes)


@asks(
    "How large should the learning rate be?",
    "TD(0) learns from the same episodes with different learning rates. "
    "Is the learning rate with the smallest error after 10 episodes also the best one after 100?",
    guesses=[
        "yes, the same one",
        "no, later a smaller one is better",
        "no, later a larger one is better",
    ],
    right="no, later a smaller one is better",
    because="At first the initial values are wrong, and a large learning rate forgets them sooner; "
    "later the noise of the last episodes matters, and a small one averages it out.",
)
def td_step_size() -> dict[str, Any]:
    """Episodes in the five rooms, the true values, and the learning rate that the page begins with."""
    rooms = five_rooms()
    episodes = [
        page_episodes(
            episode.states for episode in mdp.rollouts(rooms, COIN, EPISODES, seed=seed)
        )
        for seed in range(RUNS)
    ]
    return {"episodes": episodes, "truth": TRUTH.tolist(), "prize": 6, "rate": 0.1}


CLIFF = """
. . . . . .
. . . . . .
. . . . . .
S X X X X G
"""


def cliff() -> mdp.GridWorld:
    """A short cliff: a step costs 1, and a fall costs 100 and ends the episode."""
    return mdp.GridWorld(
        CLIFF,
        legend={"X": mdp.Cell(reward=-99.0, ends=True), "G": mdp.Cell(ends=True)},
        step_reward=-1.0,
    )


@asks(
    "Exploring beside a cliff",
    "Without exploring (ε\u00a0=\u00a00) both methods walk along the edge from S to G. "
    "Which paths do they learn with ε\u00a0=\u00a00.3?",
    guesses=[
        "both stay at the edge",
        "SARSA keeps away, Q-learning stays",
        "both keep away",
        "Q-learning keeps away, SARSA stays",
    ],
    right="SARSA keeps away, Q-learning stays",
    because="SARSA's target contains the random steps, which may fall off the edge, while "
    "Q-learning's target always takes the best next action.",
    files=("random_numbers", "grid"),
)
def cliff_exploration() -> dict[str, Any]:
    """The cliff, and for each amount of exploring how far from its edge the best trajectory is, and what it expects."""
    grid = cliff()
    model, begin = grid.mdp(1.0), int(grid.start.argmax())
    best = []
    for epsilon in np.linspace(0, 0.5, 11):
        q = best_while_exploring(model, epsilon)
        greedy = mdp.rollouts(
            grid.environment(), q.argmax(axis=1), 1, max_steps=30, seed=0
        )[0]
        rows = 2 - grid.cells[greedy.states, 0].min()
        best.append(
            {
                "rows": int(rows),
                "value": float((mdp.epsilon_greedy(q, epsilon) * q).sum(axis=1)[begin]),
            }
        )
    return {
        "layout": page_grid(grid),
        "moves": grid.moves.tolist(),
        "rewards": (grid.cell_rewards).tolist(),
        "ends": grid.terminal.tolist(),
        "begin": begin,
        "best": best,
    }


def best_while_exploring(model: mdp.FiniteMDP, epsilon: float) -> NDArray[np.float64]:
    """Action values of the best policy among those that take a random action with probability ``epsilon``."""
    q = np.zeros((model.n_states, model.n_actions))
    for _ in range(5000):
        values = (mdp.epsilon_greedy(q, epsilon) * q).sum(axis=1)
        before, q = q, model.action_values(values)
        if abs(q - before).max() < 1e-9:
            break
    return q


@asks(
    "How far does an update reach?",
    "Four tilings of tiles that are 1 m wide are shifted by a quarter of a tile each. "
    "An update raises the value of one place by 1. "
    "By how much does it raise the value half a metre away?",
    guesses=["not at all", "by a quarter", "by a half", "by 1"],
    right="by a half",
    because="Half a metre away, two of the four tiles are still the same.",
)
def shared_tiles(length: int = 6, most: int = 8, tilings: int = 4) -> dict[str, Any]:
    """The length of the line in metres, the largest number of tilings, and the number that the page begins with."""
    return {"length": length, "most": most, "tilings": tilings}


@asks(
    "A belief in a corridor of your own",
    "This corridor has two doors and seven walls, and the robot knows only its plan. "
    "Which observation tells it more about its position?",
    guesses=["a door", "a wall", "both the same"],
    right="a door",
    because="Only two cells explain a door, while seven explain a wall, so a door excludes more "
    "cells.",
    files=("belief",),
)
def own_corridor(cells: str = ".D....D..") -> dict[str, Any]:
    """The plan of a corridor."""
    return {"cells": cells}


@asks(
    "When is the belief sure enough?",
    "Listening names the tiger's door correctly in 85 of 100 cases. There are eight steps to go. "
    "How many more times must the tiger be heard on the left than on the right before it is "
    "best to open the right door?",
    guesses=["once", "twice", "three times", "five times"],
    right="twice",
    because="Heard twice more often, the tiger is left with probability 0.970, just above the border "
    "of 0.967; heard once more often, with 0.85, and a wrong door costs 100.",
)
def tiger_vectors(steps: int = 12) -> dict[str, Any]:
    """The alpha vectors of the tiger with 1 to some steps to go, for three accuracies."""
    accuracies = (0.7, 0.85, 0.95)
    left = np.linspace(0, 1, 401)
    points = np.column_stack([left, 1 - left])
    return {
        "accuracies": list(accuracies),
        "plans": [
            [
                page_vectors(plan)
                for plan in plans_by_steps(mdp.tiger(accuracy=accuracy), points, steps)
            ]
            for accuracy in accuracies
        ],
    }


def page_vectors(plan: AlphaVectors) -> dict[str, Any]:
    """Pack alpha vectors for the page."""
    return {
        "vectors": plan.vectors.round(4).tolist(),
        "actions": plan.actions.tolist(),
    }


def plans_by_steps(
    pomdp: mdp.POMDP, points: NDArray[np.float64], steps: int
) -> Iterator[AlphaVectors]:
    """The best vectors at some beliefs (N, S), with 1, 2, ... steps to go."""
    states = pomdp.mdp.n_states
    known = AlphaVectors(np.zeros((1, states)), np.zeros(1, dtype=np.int64))
    for _ in range(steps):
        known = backup(pomdp, points, known)
        _, first = np.unique(known.vectors.round(9), axis=0, return_index=True)
        known = AlphaVectors(known.vectors[first], known.actions[first])
        yield known
