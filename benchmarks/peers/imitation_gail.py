"""imitation's GAIL on CartPole, from the demonstrations of a file: scores of the seeds, then steps a second.

python imitation_gail.py DEMONSTRATIONS.npz UPDATES SEED ... [--cpu]
"""

import sys
import tempfile
import time

import numpy as np
import torch
from imitation.algorithms.adversarial.gail import GAIL
from imitation.data.types import Transitions
from imitation.rewards.reward_nets import BasicRewardNet
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env

TASK, ACTORS, STEPS, STEP, EPISODES = "CartPole-v1", 8, 128, 0.01, 20
EPOCHS, BATCHES = 4, 4
CLOCK = time.process_time if "--cpu" in sys.argv else time.perf_counter
path, updates, *seeds = (one for one in sys.argv[1:] if one != "--cpu")
torch.set_num_threads(1)
rows = ACTORS * STEPS
shown = np.load(path)
demonstrations = Transitions(
    obs=shown["states"],
    acts=shown["actions"],
    infos=np.array([{}] * len(shown["actions"])),
    next_obs=shown["states"],  # not read: the discriminator judges pairs
    dones=np.zeros(len(shown["actions"]), dtype=bool),
)


def trained(seed):
    """A policy after some updates."""
    envs = make_vec_env(TASK, ACTORS, seed=seed)
    learner = PPO(
        "MlpPolicy", envs, n_steps=STEPS, batch_size=rows // BATCHES, n_epochs=EPOCHS,
        learning_rate=STEP, ent_coef=0.03, seed=seed, device="cpu",
        policy_kwargs={"net_arch": {"pi": [32], "vf": [32]}},
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as logs:
        trainer = GAIL(
            demonstrations=demonstrations,
            demo_batch_size=rows // BATCHES,
            n_disc_updates_per_round=EPOCHS * BATCHES,
            disc_opt_kwargs={"lr": STEP},
            gen_replay_buffer_capacity=rows,
            gen_train_timesteps=rows,
            venv=envs,
            gen_algo=learner,
            reward_net=BasicRewardNet(
                envs.observation_space, envs.action_space, hid_sizes=[32]
            ),
            allow_variable_horizon=True,
            log_dir=logs,
        )
        trainer.train(int(updates) * rows)
    return learner


def score(learner):
    """Mean return in the episodes in which ours is tested, too."""
    env, lengths = make_vec_env(TASK, 1).envs[0].unwrapped, []
    for number in range(EPISODES):
        state, _ = env.reset(seed=1000 + number)
        length, ended = 0, False
        while not ended and length < 500:
            action, _ = learner.predict(state, deterministic=True)
            state, _, ended, _, _ = env.step(int(action))
            length += 1
        lengths.append(length)
    return np.mean(lengths)


began = CLOCK()
learners = [trained(int(seed)) for seed in seeds]
spent = CLOCK() - began
print(*(score(learner) for learner in learners), sep="\n")
print(len(seeds) * int(updates) * rows / spent)
