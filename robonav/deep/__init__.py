"""Chapter 6, deep reinforcement learning and imitation: PPO and GAIL."""

from .adversarial_training import GAILResult, train_gail
from .episodes import ppo_on_episodes, ppo_on_rollouts
from .gail import (
    best_discriminator,
    constant_reward,
    deceiving_reward,
    discriminator_loss,
    gail,
    hurrying_reward,
    log_odds,
    random_discriminator,
)
from .networks import ActorCritic
from .ppo import (
    Batch,
    actor_critic,
    advantages,
    clipped_surrogate,
    objective,
    ppo,
)
from .team import TeamTraining, train_team
from .training import PPOResult, navigation_task, train_ppo

__all__ = [
    "ActorCritic",
    "Batch",
    "GAILResult",
    "PPOResult",
    "TeamTraining",
    "actor_critic",
    "advantages",
    "best_discriminator",
    "clipped_surrogate",
    "constant_reward",
    "deceiving_reward",
    "discriminator_loss",
    "gail",
    "hurrying_reward",
    "log_odds",
    "navigation_task",
    "objective",
    "ppo",
    "ppo_on_episodes",
    "ppo_on_rollouts",
    "random_discriminator",
    "train_gail",
    "train_ppo",
    "train_team",
]
