"""Learning in the page: cost, gradient, descent and L-BFGS as in Python's readable functions."""

import numpy as np
import pytest

from robonav.lfd import demonstrate, labelled_states
from robonav.networks import (
    CROSS_ENTROPY,
    SQUARED_ERROR,
    Network,
    fit,
    gradient_descent,
    lbfgs,
    one_hot,
    random_network,
)
from robonav.nnql import train_on_pairs
from robonav.robot import random_worlds

OBJECTIVES = {"squared-error": SQUARED_ERROR, "cross-entropy": CROSS_ENTROPY}
SEEDS = range(20)
SIZES = [(4, 6, 3), (3, 1), (5, 4, 3, 2), (12, 8, 5)]
FILES = ("learning/random", "learning/network", "learning/lbfgs")


def flat(network: Network) -> np.ndarray:
    return np.concatenate(
        [part.ravel() for part in (*network.weights, *network.biases)]
    )


def tasks():
    """Examples for each seed, with networks of several shapes."""
    for seed in SEEDS:
        rng = np.random.default_rng([seed, 1])
        sizes = SIZES[seed % len(SIZES)]
        x = rng.uniform(-1, 1, (30, sizes[0]))
        y = one_hot(rng.integers(0, sizes[-1], 30), sizes[-1])
        if sizes[-1] == 1:
            y = rng.integers(0, 2, (30, 1)).astype(float)
        yield {"seed": seed, "sizes": sizes, "x": x.tolist(), "y": y.tolist()}


@pytest.fixture(scope="module")
def examples():
    return list(tasks())


def test_first_weights_are_pythons(node, examples):
    body = "return data.map(({ seed, sizes }) => [...page.randomNetwork(sizes, page.defaultRng(seed)).parameters]);"
    for task, got in zip(examples, node(FILES, body, examples), strict=True):
        assert got == flat(random_network(task["sizes"], seed=task["seed"])).tolist()


@pytest.mark.parametrize("kind", OBJECTIVES)
def test_costs_and_gradients_are_pythons(node, examples, kind):
    body = """return data.tasks.map(({ seed, sizes, x, y }) => {
      const network = page.randomNetwork(sizes, page.defaultRng(seed));
      const cost = page.costFunction(data.kind, sizes, page.examplesOf(x, y), 0.3);
      const gradient = new Float64Array(network.parameters.length);
      return [cost.evaluate(network.parameters, gradient), [...gradient], cost.accuracy()];
    });"""
    got = node(FILES, body, {"tasks": examples, "kind": kind})
    for task, (cost, gradient, accuracy) in zip(examples, got, strict=True):
        network = random_network(task["sizes"], seed=task["seed"])
        objective, x, y = OBJECTIVES[kind], task["x"], np.array(task["y"])
        assert cost == pytest.approx(
            objective.cost(network, x, y, regularisation=0.3), abs=1e-9
        )
        expected = flat(objective.gradient(network, x, y, regularisation=0.3))
        np.testing.assert_allclose(gradient, expected, rtol=0, atol=1e-9)
        z = network.logits(x)
        right = (z > 0) == (y > 0.5) if y.shape[1] == 1 else z.argmax(1) == y.argmax(1)
        assert accuracy == pytest.approx(right.mean())


@pytest.mark.parametrize("kind", OBJECTIVES)
@pytest.mark.parametrize("updates", [1, 10, 100])
def test_gradient_descent_gives_pythons_weights(node, examples, kind, updates):
    """And the cost after each update, and the gradient after the last."""
    body = """return data.tasks.map(({ seed, sizes, x, y }) => {
      const { parameters } = page.randomNetwork(sizes, page.defaultRng(seed));
      const cost = page.costFunction(data.kind, sizes, page.examplesOf(x, y), 0.01);
      const costs = [...page.gradientDescent(cost, parameters, { gradientStep: 0.5, iterations: data.updates })];
      const gradient = new Float64Array(parameters.length);
      cost.evaluate(parameters, gradient);
      return [[...parameters], costs.map(({ cost }) => cost), [...gradient]];
    });"""
    got = node(FILES, body, {"tasks": examples, "kind": kind, "updates": updates})
    for task, (parameters, costs, gradient) in zip(examples, got, strict=True):
        history = gradient_descent(
            random_network(task["sizes"], seed=task["seed"]), task["x"], task["y"],
            gradient_step=0.5, iterations=updates, regularisation=0.01,
            objective=OBJECTIVES[kind],
        )  # fmt: skip
        np.testing.assert_allclose(parameters, flat(history.network), rtol=0, atol=1e-9)
        np.testing.assert_allclose(costs, history.costs, rtol=0, atol=1e-9)
        expected = OBJECTIVES[kind].gradient(
            history.network, task["x"], task["y"], regularisation=0.01
        )
        np.testing.assert_allclose(gradient, flat(expected), rtol=0, atol=1e-9)


@pytest.mark.parametrize(("pairs", "passes"), [(1, 1), (10, 1), (20, 5)])
def test_stochastic_gradient_descent_gives_pythons_weights(
    node, examples, pairs, passes
):
    body = """return data.tasks.map(({ seed, sizes, x, y }) => {
      const network = page.randomNetwork(sizes, page.defaultRng(seed));
      const [inputs, targets] = [x, y].map((rows) => rows.slice(0, data.pairs).map((row) => Float64Array.from(row)));
      page.trainOnPairs(network)(inputs, targets, 0.3, data.passes, 0);
      const learned = page.examplesOf(...[x, y].map((rows) => rows.slice(0, data.pairs)));
      const cost = page.costFunction("cross-entropy", sizes, learned);
      const gradient = new Float64Array(network.parameters.length);
      return [[...network.parameters], cost.evaluate(network.parameters, gradient), [...gradient]];
    });"""
    got = node(FILES, body, {"tasks": examples, "pairs": pairs, "passes": passes})
    for task, (parameters, cost, gradient) in zip(examples, got, strict=True):
        x, y = np.array(task["x"])[:pairs], np.array(task["y"])[:pairs]
        start = random_network(task["sizes"], seed=task["seed"])
        trained = train_on_pairs(start, x, y, 0.3, passes, 0)
        np.testing.assert_allclose(parameters, flat(trained), rtol=0, atol=1e-9)
        assert cost == pytest.approx(CROSS_ENTROPY.cost(trained, x, y), abs=1e-9)
        expected = flat(CROSS_ENTROPY.gradient(trained, x, y))
        np.testing.assert_allclose(gradient, expected, rtol=0, atol=1e-9)


LBFGS = """return data.tasks.map(({ seed, sizes, x, y }) => {
  const { parameters } = page.randomNetwork(sizes, page.defaultRng(seed));
  const cost = page.costFunction("cross-entropy", sizes, page.examplesOf(x, y), data.regularisation);
  return [...page.lbfgs(cost, parameters, data.iterations)].map((iterate) => [iterate.cost, iterate.accuracy]);
});"""


def test_lbfgs_goes_pythons_way(node, examples):
    given = {"tasks": examples, "regularisation": 0.1, "iterations": 10}
    for task, iterates in zip(examples, node(FILES, LBFGS, given), strict=True):
        history = lbfgs(
            random_network(task["sizes"], seed=task["seed"]), task["x"], task["y"],
            regularisation=0.1, iterations=10,
        )  # fmt: skip
        costs, accuracies = np.transpose(iterates)
        np.testing.assert_allclose(costs, history.costs, rtol=0, atol=1e-7)
        np.testing.assert_allclose(accuracies, history.accuracies)


@pytest.mark.slow
def test_lbfgs_ends_where_pythons_does(node, examples):
    given = {"tasks": examples, "regularisation": 1.0, "iterations": 300}
    for task, iterates in zip(examples, node(FILES, LBFGS, given), strict=True):
        history = lbfgs(
            random_network(task["sizes"], seed=task["seed"]), task["x"], task["y"],
            regularisation=1.0, iterations=300,
        )  # fmt: skip
        assert iterates[-1][0] == pytest.approx(history.costs[-1], abs=1e-6), task[
            "seed"
        ]


@pytest.fixture(scope="module")
def demonstrated():
    """Inputs and labels of the 25 demonstrations that the imitation lab begins with."""
    return labelled_states(demonstrate(random_worlds(25, obstacles=10, seed=7)))


LEGS = """const [sizes, examples] = [[12, 8, 5], page.examplesOf(data.x, data.y)];
const cost = page.costFunction("cross-entropy", sizes, examples, data.regularisation);
return data.seeds.map((seed) => {
  const { parameters } = page.randomNetwork(sizes, page.defaultRng(seed));
  return data.legs.map((iterations) => {
    const start = [...parameters];
    return { start, costs: [...page.lbfgs(cost, parameters, iterations)].map((iterate) => iterate.cost) };
  });
});"""


def network_of(parameters: list[float]) -> Network:
    """The network (12, 8, 5) with these weights and biases."""
    w1, w2, b1, b2 = np.split(np.array(parameters), [96, 136, 144])
    return Network((w1.reshape(8, 12), w2.reshape(5, 8)), (b1, b2))


@pytest.mark.slow
def test_each_leg_of_300_iterations_is_pythons(node, demonstrated):
    """With the page's settings, on 20 seeds: Python starts each leg of iterations where the page does.

    The first leg is as long as rounding allows. L-BFGS multiplies a change of the first weights in their last bit by
    ten every few iterations. Two runs of the page that differ so, like the page and Python, are 1e-6 apart in cost
    after 58 to 137 iterations, and 1e-4 to 2e-3 after 150. So 300 iterations without a break cannot agree to 1e-6.
    """
    x, y = demonstrated
    legs = [50, *[25] * 10]
    given = {
        "x": x.tolist(), "y": y.tolist(), "seeds": list(SEEDS), "regularisation": 0.1,
        "legs": legs,
    }  # fmt: skip
    for run in node(FILES, LEGS, given):
        for iterations, leg in zip(legs, run, strict=True):
            history = lbfgs(
                network_of(leg["start"]), x, y,
                regularisation=0.1, iterations=iterations,
            )  # fmt: skip
            np.testing.assert_allclose(leg["costs"], history.costs, rtol=0, atol=1e-6)


def tasks_of(seeds, x, y):
    """Learning these examples with a network of the page's sizes, from the first weights of each seed."""
    examples = {"sizes": (12, 8, 5), "x": x.tolist(), "y": y.tolist()}
    return [{"seed": seed, **examples} for seed in seeds]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seeds", "regularisation", "iterations", "apart"),
    [((0, 1), 1.0, 1500, 1e-4), pytest.param((0,), 0.1, 3000, 2e-3, id="the page's")],
)
def test_demonstrations_are_learned_as_in_python(
    node, demonstrated, seeds, regularisation, iterations, apart
):
    """Rounding grows with the iterations: the two go one way at first, and end at one minimum."""
    x, y = demonstrated
    given = {
        "tasks": tasks_of(seeds, x, y), "regularisation": regularisation,
        "iterations": iterations,
    }  # fmt: skip
    for seed, iterates in zip(seeds, node(FILES, LBFGS, given), strict=True):
        history = fit(
            x, y, seed=seed, iterations=iterations, regularisation=regularisation
        )
        costs = history.costs
        got = np.array(iterates)[:, 0]
        np.testing.assert_allclose(got[:50], costs[:50], rtol=0, atol=1e-8)
        assert got[300] == pytest.approx(costs[300], abs=apart)
        assert got[-1] == pytest.approx(costs[-1], abs=1e-6)


@pytest.mark.exhaustive
@pytest.mark.slow
@pytest.mark.parametrize("seeds", [range(10), range(10, 20)], ids=["0-9", "10-19"])
def test_twenty_seeds_converge_where_pythons_do(node, demonstrated, seeds):
    """With the page's settings and ten times its iterations, the final costs of nearly all seeds agree to 1e-6.

    The cost has several minima. Where rounding has led the two 1e-3 apart on the way, a few seeds end in different
    ones, or one of the two still descends: on the machine where this was written, seeds 19 and 14.
    """
    x, y = demonstrated
    given = {
        "tasks": tasks_of(seeds, x, y), "regularisation": 0.1, "iterations": 3000
    }  # fmt: skip
    elsewhere = []
    for seed, iterates in zip(seeds, node(FILES, LBFGS, given), strict=True):
        costs = fit(x, y, seed=seed, iterations=3000, regularisation=0.1).costs
        if abs(iterates[-1][0] - costs[-1]) > 1e-6:
            elsewhere.append(seed)
    assert len(elsewhere) <= 2
