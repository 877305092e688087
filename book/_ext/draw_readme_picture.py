"""Draw the README's picture: a robot that learned from 25 demonstrations, in four maps that it has never seen."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt

from robonav import lfd, style
from robonav.plots.robot import draw_maps
from robonav.robot import navigate, random_worlds

PICTURE = Path(__file__).resolve().parents[1] / "_static" / "navigation.png"

plt.rcParams.update(style.STYLE)
policy = lfd.learn_policy(lfd.demonstrate(random_worlds(25, obstacles=10, seed=7)))
worlds = random_worlds(4, obstacles=20, seed=2015)
episodes = navigate(policy, worlds, record_paths=True)
figure = plt.figure(figsize=(9, 2.6))
draw_maps(figure, worlds, episodes.paths, episodes.outcome)
figure.savefig(PICTURE, dpi=120)
