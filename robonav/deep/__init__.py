"""Chapter 6, deep reinforcement learning: proximal policy optimisation (PPO)."""

from .networks import ActorCritic
from .ppo import (
    Batch,
    actor_critic,
    advantages,
    clipped_surrogate,
    objective,
    ppo,
)
from .training import PPOResult, navigation_task, train_ppo

__all__ = [
    "ActorCritic",
    "Batch",
    "PPOResult",
    "actor_critic",
    "advantages",
    "clipped_surrogate",
    "navigation_task",
    "objective",
    "ppo",
    "train_ppo",
]
