"""stable-baselines3's DQN on CartPole, two layers of 64, one update of 32 steps after every step: updates a second."""

import sys
import time

import torch
from stable_baselines3 import DQN

STEPS = 4000
CLOCK = time.process_time if "--cpu" in sys.argv else time.perf_counter
torch.set_num_threads(1)
settings = {
    "learning_starts": 200,
    "train_freq": 1,
    "batch_size": 32,
    "buffer_size": 10_000,
    "seed": 0,
    "device": "cpu",
}
learner = DQN(
    "MlpPolicy", "CartPole-v1", policy_kwargs={"net_arch": [64, 64]}, **settings
)
learner.learn(500)
start = CLOCK()
learner.learn(STEPS, reset_num_timesteps=False)
print(STEPS / (CLOCK() - start))
