"""DAgger by hand: an episode that robot and reader share, and corrections that raise the rate."""

import numpy as np
import pytest

from robonav.benchmark.policies import method
from robonav.lfd import demonstrate, labelled_states
from robonav.networks import lbfgs, one_hot, random_network
from robonav.robot import Encoder, navigate, random_worlds, sense, straight
from robonav.widgets.dagger_lab import dagger_lab
from robonav.widgets.simulator import page_world

FILES = (
    "simulator", "maps", "episode", "files", "learning/random", "learning/worlds",
    "learning/network", "learning/lbfgs", "learning/astar", "learning/trials",
    "learning/worker", "learning/training_panel", "kept_demonstrations", "kept_robots", "imitation", "dagger_lab",
)  # fmt: skip


def test_steps_are_taken_back_and_only_the_readers_are_corrections(node):
    body = """
      const episode = page.sharedEpisode(data);
      while (!episode.asks()) episode.go(0, "robot");
      const asked = episode.steps.length;
      episode.go(1, "reader");
      episode.back(1);
      const again = [episode.steps.length, episode.now().pose];
      episode.go(3, "reader");
      const { steps } = episode.corrections();
      episode.back(1000);
      const actions = steps.map(({ action }) => action);
      return { asked, again, actions, left: episode.steps.length, moments: episode.moments.length };
    """
    got = node(FILES, body, page_world(random_worlds(1, 20, seed=4)))
    assert got["again"][0] == got["asked"]
    assert got["actions"] == [3]
    assert (got["left"], got["moments"]) == (0, 1)


def test_the_next_map_where_a_robot_fails_is_found(node):
    got = node(FILES, "return page.nextFailure({ rule: 'straight' }, 3).map;", None)
    ends = [
        navigate(straight, random_worlds(1, 10, seed=600_000 + k), max_steps=200)
        for k in range(3, 40)
    ]
    assert got == 3 + int(np.argmin([end.success[0] for end in ends]))


CORRECT = """
const base = page.replayed(data.expert);
const learn = (demonstrations) => {
  const encoder = { sensors: [1, 2, 3, 4, 5, 6, 7, 8, 9], walls: false, target: "sine-cosine" };
  const learning = { sizes: [12, 8, 5], seed: 0, regularisation: 0.1, iterations: 300 };
  const trial = { seed: 2024, maps: 200, obstacles: 10 };
  const examples = page.examplesFrom(demonstrations);
  const task = { ...learning, examples, network: null, encoder, rivals: [], trial };
  let [step, arrived, job] = [null, 0, page.imitate(task)];
  for (step = job.next(); !step.done; step = job.next()) {
    if (step.value.live.outcomes?.[0] === "arrived") arrived += 1;
  }
  return { policy: { network: step.value, encoder: task.encoder }, rate: arrived / 200 };
};
const first = learn(base);
const corrected = [];
let map = -1;
for (let k = 0; k < 3; k += 1) {
  const found = page.nextFailure(first.policy, map + 1);
  map = found.map;
  const episode = page.sharedEpisode(found.world);
  const robot = () => page.consult(first.policy, episode.now().sensing).action;
  while (episode.now().outcome === "running" && episode.steps.length < 100) episode.go(robot(), "robot");
  episode.back(5);
  const expert = page.computerExpert();
  while (episode.now().outcome === "running" && episode.steps.length < 300) {
    const { world, pose } = episode.now();
    episode.go(episode.asks() ? expert(world, pose, 2) : 0, "reader");
  }
  corrected.push(episode.corrections());
}
const second = learn([...base, ...corrected]);
return { before: first.rate, after: second.rate, corrections: corrected.flatMap(({ steps }) => steps).length };
"""


def test_three_corrected_maps_raise_the_rate(node):
    got = node(FILES, CORRECT, dagger_lab(method("dagger")).data)
    assert 0.4 < got["before"] < 0.6
    assert got["after"] > 0.85
    assert got["corrections"] < 60


RETRAIN = """
const base = page.replayed(data.expert).slice(0, 1);
const { world } = page.nextFailure({ rule: "straight" }, 0);
const episode = page.sharedEpisode(world);
while (episode.now().outcome === "running") episode.go(0, "robot");
episode.back(5);
const expert = page.computerExpert();
while (episode.now().outcome === "running" && episode.steps.length < 300) {
  const { world: now, pose } = episode.now();
  episode.go(episode.asks() ? expert(now, pose, 2) : 0, "reader");
}
const corrected = episode.corrections();
const encoder = { sensors: [1, 2, 3, 4, 5, 6, 7, 8, 9], walls: false, target: "sine-cosine" };
const learning = { sizes: [12, 8, 5], seed: 0, regularisation: 0.1, iterations: 10 };
const trial = { seed: 2024, maps: 1, obstacles: 10 };
const examples = page.examplesFrom([...base, corrected]);
const job = page.imitate({ ...learning, examples, network: null, encoder, rivals: [], trial });
const costs = [];
let step = job.next();
for (; !step.done; step = job.next()) if ("cost" in step.value.live) costs.push(step.value.live.cost);
const { weights, biases } = step.value;
return {
  costs, parameters: [...weights, ...biases].flatMap((part) => [...part]),
  steps: corrected.steps.map(({ pose: { x, y, heading }, action }) => [x, y, heading, action]),
};
"""


@pytest.mark.slow
def test_the_robot_learns_from_corrections_as_in_python(node):
    """The corrected states, sensed by Python, with the expert's: the same costs and the same network."""
    got = node(FILES, RETRAIN, dagger_lab(method("dagger")).data)
    steps = np.array(got["steps"])
    number = next(
        k
        for k in range(40)
        if not navigate(straight, random_worlds(1, 10, seed=600_000 + k)).success[0]
    )
    worlds = random_worlds(1, 10, seed=600_000 + number)[np.zeros(len(steps), int)]
    first = demonstrate(random_worlds(1, 10, seed=9))
    x, y = labelled_states(first)
    x = np.vstack([x, Encoder()(sense(worlds, steps[:, :3]))])
    y = np.vstack([y, one_hot(steps[:, 3].astype(int), 5)])
    expected = lbfgs(
        random_network((12, 8, 5), seed=0), x, y, regularisation=0.1, iterations=10
    )
    np.testing.assert_allclose(got["costs"], expected.costs, rtol=0, atol=1e-9)
    network = expected.network
    parts = [part.ravel() for part in (*network.weights, *network.biases)]
    np.testing.assert_allclose(
        got["parameters"], np.concatenate(parts), rtol=0, atol=1e-8
    )


def test_a_wrong_argument_gets_one_sentence():
    with pytest.raises(ValueError, match="n_worlds must be at least 1"):
        dagger_lab(method("dagger"), n_worlds=0)
