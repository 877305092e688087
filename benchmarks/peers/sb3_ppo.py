"""stable-baselines3's PPO on CartPole, two networks with a layer of 32, 16 actors of 128 steps: steps a second."""

import sys
import time

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env

ACTORS, STEPS = 16, 128
CLOCK = time.process_time if "--cpu" in sys.argv else time.perf_counter
torch.set_num_threads(1)
settings = {
    "n_steps": STEPS,
    "batch_size": ACTORS * STEPS // 4,
    "n_epochs": 4,
    "seed": 0,
    "device": "cpu",
}
learner = PPO(
    "MlpPolicy",
    make_vec_env("CartPole-v1", ACTORS, seed=0),
    policy_kwargs={"net_arch": {"pi": [32], "vf": [32]}},
    **settings,
)
learner.learn(ACTORS * STEPS)
updates = 10
start = CLOCK()
learner.learn(updates * ACTORS * STEPS, reset_num_timesteps=False)
print(updates * ACTORS * STEPS / (CLOCK() - start))
