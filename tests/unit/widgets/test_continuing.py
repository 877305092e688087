"""What the page learned goes on in Python, and what Python learned goes on in the page, through their files."""

from __future__ import annotations

import base64
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from robonav.lfd import demonstrate, labelled_states, save_demonstrations
from robonav.networks import (
    Weights,
    lbfgs,
    load_weights,
    random_network,
    save_weights,
)
from robonav.networks.multilayer_perceptron import Network
from robonav.nirl import RobotTask, expert_decisions, learn, learn_under_reward
from robonav.nnql import NavigationTask, dqn, nnql, online, q_network
from robonav.robot import NNQL_SENSORS, Encoder, random_worlds
from robonav.widgets.q_learning_settings import QLearningSettings

METHODS = {"nnql": nnql, "online": online, "dqn": dqn}
Q_FILES = (
    "simulator",
    "files",
    "learning/random",
    "learning/network",
    "learning/worlds",
    "learning/nnql",
    "learning/dqn",
)
LFD_FILES = (
    "simulator",
    "files",
    "learning/random",
    "learning/worlds",
    "learning/network",
    "learning/lbfgs",
    "learning/trials",
    "kept_demonstrations",
    "imitation",
)
NIRL_FILES = (
    "simulator",
    "files",
    "learning/random",
    "learning/worlds",
    "learning/network",
    "learning/nirl",
)
READ = """
const buffer = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0)).buffer;
const robot = (text) => {
  const { network, ...about } = page.weightsFromFile(buffer(text));
  return { ...about, network: page.networks(network)() };
};
const text = (bytes) => btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
const file = (network, encoder, method) => text(page.weightsFile({ network, encoder, method }));
"""


def encoded(path):
    return base64.b64encode(path.read_bytes()).decode()


def written(path, text):
    path.write_bytes(base64.b64decode(text))
    return path


def same_networks(ours: Network, theirs: Network) -> None:
    for mine, its in zip(
        (*ours.weights, *ours.biases), (*theirs.weights, *theirs.biases), strict=True
    ):
        np.testing.assert_allclose(mine, its, rtol=0, atol=1e-9)


TRAIN_ON = f"""{READ}
const train = (settings, start) => {{
  let network = null;
  for (const ended of page.neuralQLearning(settings, {{ start }})) if (ended) ({{ network }} = ended);
  return network;
}};
const first = robot(data.python);
const on = train(data.on, first);
const mine = train(data.first, null);
const encoder = {{ sensors: page.encoderOf(data.first).sensors, walls: true, target: data.first.inputs }};
const again = train(data.on, robot(file(mine, encoder, data.first.method)));
return [on, mine, again].map((network, k) => file(network, k === 0 ? first.encoder : encoder, data.first.method));
"""


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "encoder",
    [Encoder(NNQL_SENSORS, walls=True, target="number"), Encoder()],
    ids=["as the page's", "as in chapter 3"],
)
def test_q_learning_goes_on_from_a_file(node, tmp_path, method, encoder):
    """Python's first episodes and the page's next are Python's first and next; and the other way round."""
    own = {"gradient_step": (0.003, 0.003)} if method == "dqn" else {}
    first = QLearningSettings(method=method, episodes=3, seed=4, **own)
    on = QLearningSettings(method=method, episodes=2, seed=5, **own)
    env = NavigationTask(encoder=encoder).environment()

    def train(env, network, settings):
        return METHODS[method](
            env,
            network,
            episodes=settings.episodes,
            seed=settings.seed,
            **settings.hyperparameters(),
        )

    python = train(env, q_network(env, seed=4), first)
    path = tmp_path / "python.safetensors"
    save_weights(path, Weights(python, method, encoder))
    data = {
        "python": encoded(path),
        "first": first.for_page(),
        "on": on.for_page(),
    }
    on_in_page, mine, again = (
        load_weights(written(tmp_path / f"{k}.safetensors", text))
        for k, text in enumerate(node(Q_FILES, TRAIN_ON, data))
    )
    same_networks(on_in_page.network, train(env, load_weights(path).network, on))
    assert on_in_page.encoder == encoder
    page_env = NavigationTask(encoder=mine.encoder).environment()
    same_networks(again.network, train(page_env, mine.network, on))


IMITATE_ON = f"""{READ}
const first = robot(data.python);
const examples = {{ m: data.x.length, x: Float64Array.from(data.x.flat()), y: Float64Array.from(data.y.flat()) }};
const trial = {{ seed: 1, maps: 0, obstacles: 10 }};
const learn = (start) => {{
  const learning = {{ examples, network: null, start, sizes: [], seed: 0, regularisation: 0.1, iterations: 5 }};
  const run = page.imitate({{ ...learning, encoder: first.encoder, rivals: [], trial }});
  let step = run.next();
  while (!step.done) step = run.next();
  return step.value;
}};
const on = learn(first.network);
const again = learn(on);
return [on, again].map((network) => file(network, first.encoder, "lfd"));
"""


@pytest.mark.parametrize("encoder", [Encoder(), Encoder(target="signed")])
def test_imitation_goes_on_from_a_file(node, tmp_path, encoder):
    """L-BFGS begins anew with the weights of the file, since its approximation of the curvature is in no file."""
    x, y = labelled_states(demonstrate(random_worlds(5, 10, seed=7)), encoder)
    go_on = partial(lbfgs, x=x, y=y, regularisation=0.1, iterations=5)
    python = go_on(random_network((encoder.size, 6, 5), seed=3)).network
    path = tmp_path / "python.safetensors"
    save_weights(path, Weights(python, "lfd", encoder))
    data = {"python": encoded(path), "x": x.tolist(), "y": y.tolist()}
    on, again = (
        load_weights(written(tmp_path / f"{k}.safetensors", text)).network
        for k, text in enumerate(node(LFD_FILES, IMITATE_ON, data))
    )
    same_networks(on, go_on(load_weights(path).network).network)
    same_networks(again, go_on(on).network)


UNDER_REWARD = f"""{READ}
const expert = {{ inputs: data.inputs.map((row) => Float64Array.from(row)), actions: data.actions }};
const learn = (settings, seed, reward) => {{
  const run = page.nirl(expert, {{ ...page.NIRL_SETTINGS, ...settings }}, seed, reward);
  let step = run.next();
  while (!step.done) step = run.next();
  return step.value;
}};
const under = (reward) => {{
  const {{ network, iteration }} = learn({{ iterations: 3, ...data.elsewhere }}, 1, reward);
  return [file(network, page.NIRL_SETTINGS.encoder, "nirl"), iteration];
}};
return page.rewardFromFile(buffer(data.reward), [5, 18]).then((reward) => {{
  const own = learn({{ iterations: 3 }}, 0, null).theta;
  return {{ python: under(reward), saved: text(page.rewardFile(own, 5)), page: under(own) }};
}});
"""


def test_a_policy_is_trained_for_a_reward_from_a_file(node, tmp_path):
    """A reward of Python is used in the page, and a reward of the page in Python, in other worlds than its own."""
    demonstrations = demonstrate(random_worlds(4, 20, seed=30))
    expert = expert_decisions(demonstrations, RobotTask().encoder)
    path = tmp_path / "reward.npz"
    learned = learn(demonstrations, "nirl", 0, iterations=3).reward_weights
    np.savez_compressed(path, reward_weights=learned)
    elsewhere = {"obstacles": 10, "moving": 10, "speed": 3}
    data = {
        "inputs": expert.inputs.tolist(),
        "actions": expert.actions.tolist(),
        "reward": encoded(path),
        "elsewhere": elsewhere,
    }
    got = node(NIRL_FILES, UNDER_REWARD, data)
    saved = np.load(written(tmp_path / "saved.npz", got["saved"]))["reward_weights"]
    np.testing.assert_allclose(saved, learned, rtol=0, atol=1e-9)
    for name, weights in (("python", np.load(path)["reward_weights"]), ("page", saved)):
        expected = learn_under_reward(
            demonstrations, weights, task=RobotTask(**elsewhere), seed=1, iterations=3
        )
        text, iteration = got[name]
        assert iteration == expected.chosen
        ours = load_weights(written(tmp_path / "policy.safetensors", text)).network
        same_networks(ours, expected.network)


REFUSED = f"""{READ}
return page.rewardFromFile(buffer(data), [5, 18]).catch((error) => error.message);
"""


@pytest.mark.parametrize(
    ("arrays", "why"),
    [
        (None, "it is damaged or of another kind."),
        ({"theta": np.zeros((5, 18))}, "it has no such array."),
        ({"reward_weights": np.zeros((5, 10))}, "it is of the shape (5, 10)."),
        ({"reward_weights": np.zeros(90)}, "it is of the shape (90)."),
        (
            {"reward_weights": np.full((5, 18), np.nan)},
            "it holds values that are not numbers.",
        ),
    ],
)
def test_a_file_that_holds_no_reward_gets_one_sentence(node, tmp_path, arrays, why):
    path = tmp_path / "reward.npz"
    if arrays is None:
        path.write_bytes(b"nothing")
    else:
        np.savez(path, **arrays)
    said = node(NIRL_FILES, REFUSED, encoded(path))
    begins = "The file must hold a reward, an array reward_weights of 5 rows and 18"
    assert said == f"{begins} columns: {why}"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["policy-learning", "nnql", "nirl"])
def test_the_python_of_the_pages_goes_on_from_the_files(tmp_path, monkeypatch, name):
    page = (Path(__file__).parents[3] / f"book/{name}.md").read_text("utf-8")
    (code,) = re.findall(r"\n```python\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    shown = demonstrate(random_worlds(3, 10, seed=3))
    save_demonstrations("my-demonstrations.npz", shown)
    encoder = Encoder(NNQL_SENSORS, walls=True, target="number")
    network = random_network((encoder.size, 8, 5), seed=3)
    for file in ("my-robot", "my-nnql"):
        save_weights(f"{file}.safetensors", Weights(network, "own", encoder))
    learned = learn(shown, "nirl", 0, iterations=2)
    np.savez("my-reward.npz", reward_weights=learned.reward_weights)
    names = {"shown": shown, "learned": learned}
    quick = code.replace("episodes=50", "episodes=2")
    exec(quick.replace("elsewhere, seed=1", "elsewhere, seed=1, iterations=2"), names)
    further = names["result"].network if name == "nirl" else names["further"]
    assert further.sizes[-1] == 5
