"""Chapter 6, memory: policies that see the last k steps, and a recurrent one."""

from .dagger import Episodes, dagger_with_memory, labelled_episodes
from .gru import GRU
from .networks import RecurrentNetwork, WindowNetwork
from .policies import MemoryPolicy
from .ppo import ppo_with_window

__all__ = [
    "GRU",
    "Episodes",
    "MemoryPolicy",
    "RecurrentNetwork",
    "WindowNetwork",
    "dagger_with_memory",
    "labelled_episodes",
    "ppo_with_window",
]
