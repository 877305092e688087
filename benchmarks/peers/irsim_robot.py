"""ir-sim: one robot with nine beams among ten standing and ten moving circles, random turns; steps a second."""

import os
import tempfile
import time
from pathlib import Path

os.environ["MPLBACKEND"] = "Agg"
import irsim
import numpy as np

WORLD = """
world: {height: 100, width: 100, step_time: 0.1, sample_time: 0.1, collision_mode: unobstructed}
robot:
  - kinematics: {name: diff}
    shape: {name: circle, radius: 1.0}
    state: [5, 5, 0.5]
    goal: [95, 95, 0]
    sensors: [{name: lidar2d, range_min: 0, range_max: 20, angle_range: 5.585, number: 9}]
obstacle:
  - {number: 10, distribution: {name: random, range_low: [15, 15, -3.14], range_high: [95, 95, 3.14]},
     shape: {name: circle, radius: 2.0}}
  - {number: 10, kinematics: {name: omni},
     distribution: {name: random, range_low: [15, 15, -3.14], range_high: [95, 95, 3.14]},
     behavior: {name: dash, wander: true, range_low: [15, 15, -3.14], range_high: [95, 95, 3.14]},
     vel_max: [2, 2], vel_min: [-2, -2], shape: {name: circle, radius: 2.0}}
"""
SECONDS = 5
rng = np.random.default_rng(0)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "world.yaml"
    path.write_text(WORLD)
    env = irsim.make(str(path), display=False, disable_all_plot=True, log_level="ERROR")


def step():
    env.step(np.array([[1.0], [rng.uniform(-1, 1)]]))
    env.get_lidar_scan()


for _ in range(20):
    step()
steps, start = 0, time.perf_counter()
while (passed := time.perf_counter() - start) < SECONDS:
    step()
    steps += 1
    if env.robot.collision or env.robot.arrive or steps % 500 == 0:
        env.reset()
print(steps / passed)
