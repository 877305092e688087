"""VMAS navigation: 1024 environments of four agents with lidar, random actions; agent-steps a second."""

import time

import torch
from vmas import make_env

NUMBER, SECONDS = 1024, 4
env = make_env(
    "navigation",
    num_envs=NUMBER,
    device="cpu",
    continuous_actions=False,
    seed=0,
    n_agents=4,
)
env.reset()


def step():
    env.step([torch.randint(0, 5, (NUMBER,)) for _ in env.agents])


step()
steps, start = 0, time.perf_counter()
while (passed := time.perf_counter() - start) < SECONDS:
    step()
    steps += 1
print(steps * NUMBER / passed)
