"""Where a learner practises: the robot in new maps, or a finite MDP with known truth (step 4 of Algorithm 10)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robonav.lfd.demonstrations import LEARNED
from robonav.networks.policy import sample_actions
from robonav.robot import Encoder, Sensing, Simulator, Worlds, drive, random_worlds
from robonav.robot._fast import ARRIVED, COLLIDED
from robonav.validation import check_integer, check_positive

from .reward_free_mdp import RewardFreeMDP
from .transitions import ENCODER, Floats, Ints, Steps

Chances = Callable[[Floats], Floats]
"""``chances(inputs (N, k)) -> (N, A)``: how likely a policy is to take each action."""


class Course(Protocol):
    """Anything a policy can practise on."""

    @property
    def inputs(self) -> int:
        """k, the number of a policy's inputs."""

    @property
    def actions(self) -> int:
        """A."""

    def drive(self, chances: Chances, rng: np.random.Generator) -> Steps:
        """A few drives with a policy, each from a new start."""


@dataclass(frozen=True)
class RobotTask:
    """The robot in new random maps; its reflexes act as ever, and only what the policy decided is kept.

    Attributes
    ----------
    trajectories : drives at a time, each in a map of its own.
    obstacles, moving : of the maps.
    speed : m/s.
    max_steps : seconds after which a drive is called off.
    encoder : phi.
    """

    trajectories: int = 10
    obstacles: int = 20
    moving: int = 0
    speed: float = 2.0
    max_steps: int = 200
    encoder: Encoder = ENCODER

    def __post_init__(self) -> None:
        check_integer("trajectories", self.trajectories, at_least=1)
        check_integer("max_steps", self.max_steps, at_least=1)
        check_positive("speed", self.speed)

    @property
    def inputs(self) -> int:
        return self.encoder.size

    @property
    def actions(self) -> int:
        return LEARNED

    def drive(self, chances: Chances, rng: np.random.Generator) -> Steps:
        """``trajectories`` drives, each in a map that was never driven before."""
        worlds = random_worlds(self.trajectories, self.obstacles, self.moving, seed=rng)
        simulator = Simulator(worlds, self.speed, max_steps=self.max_steps)
        return collect(simulator, chances, self.encoder, rng)


def collect(
    simulator: Simulator,
    chances: Chances,
    encoder: Encoder,
    rng: np.random.Generator,
    *,
    decisions: int | None = None,
) -> Steps:
    """Run N episodes with a policy, of ``decisions`` decisions each at most, and keep what the policy decided."""
    decided = np.zeros(len(simulator), dtype=np.int64)
    rows: list[tuple[Ints, Floats, Ints, Ints]] = []

    def choose(simulator: Simulator, sensing: Sensing, robots: Ints) -> Ints:
        inputs = encoder(sensing)
        actions = sample_actions(chances(inputs), rng.random(len(inputs)))
        rows.append((robots, inputs, actions, simulator.steps[robots]))
        decided[robots] += 1
        return actions

    for _ in drive(simulator, choose):
        if decisions is not None:
            simulator.stop(np.flatnonzero(decided >= decisions))
    return _by_drive(rows, encoder.size, simulator.outcome)


def _by_drive(
    rows: list[tuple[Ints, Floats, Ints, Ints]], width: int, outcome: NDArray[np.int8]
) -> Steps:
    """Decisions by drive from decisions by time."""
    nothing = (
        np.empty(0, np.int64),
        np.empty((0, width)),
        np.empty(0, np.int64),
        np.empty(0, np.int64),
    )
    owner, inputs, actions, when = (
        np.concatenate(part) for part in zip(nothing, *rows, strict=True)
    )
    order = np.argsort(owner, kind="stable")
    return Steps(
        inputs[order],
        actions[order],
        owner[order],
        when[order],
        outcome == COLLIDED,
        outcome == ARRIVED,
    )


@dataclass(frozen=True, eq=False)
class TabularTask:
    """A finite MDP as a course: one input a state. A drive ends in a terminal state, or after ``steps``.

    Attributes
    ----------
    mdp : S states, A actions.
    trajectories : drives at a time.
    steps : of each at most.
    """

    mdp: RewardFreeMDP
    trajectories: int = 10
    steps: int = 40

    @property
    def inputs(self) -> int:
        return self.mdp.n_states

    @property
    def actions(self) -> int:
        return self.mdp.n_actions

    def drive(self, chances: Chances, rng: np.random.Generator) -> Steps:
        """``trajectories`` walks."""
        return self.shown(
            chances(np.eye(self.mdp.n_states)), self.trajectories, seed=rng
        )

    def shown(
        self, policy: Floats, walks: int, *, seed: int | np.random.Generator
    ) -> Steps:
        """Walks by a known policy, (S,) actions or (S, A) probabilities: an expert's demonstrations, say."""
        walked = self.mdp.walk(policy, walks, self.steps, seed=seed)
        alive = ~self.mdp.terminal[walked.states]
        trajectory = walked.trajectory[alive.ravel()]
        when = np.broadcast_to(np.arange(self.steps), alive.shape)[alive]
        inputs = np.eye(self.mdp.n_states)[walked.states[alive]]
        over = ~alive[:, -1]
        return Steps(
            inputs,
            walked.actions[alive],
            trajectory,
            when,
            np.zeros(walks, dtype=bool),
            over,
        )


def start_at(worlds: Worlds, poses: Floats, speed: float, max_steps: int) -> Simulator:
    """Robots put at ``poses`` (N, 3), one in each of N worlds whose obstacles stand where they start."""
    simulator = Simulator(worlds, speed, max_steps=max_steps)
    simulator.poses = np.ascontiguousarray(poses, dtype=float)
    return simulator
