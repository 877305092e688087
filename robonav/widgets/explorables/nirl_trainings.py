"""What the kernel trains for the explorables of chapter 5: rewards, on the terrain of mud and road and on the robot."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logit

from robonav import mdp, nirl
from robonav.errors import ConvergenceWarning
from robonav.lfd import demonstrate
from robonav.networks.multilayer_perceptron import Network
from robonav.nirl.decisions import Decisions
from robonav.robot import Action, navigate, random_worlds

from ..kernel_training import TRIED, Report, sentence_on_rates
from ..reward_learning import ReplaySGDWithCallback, iteration_callback
from .chapter5 import TARGETS, WALK_STEPS, terrain_with, transferred
from .training import Curve, Dial, Menu, Trained, trains

Floats = NDArray[np.float64]

STEPS = 60
"""Steps of a demonstration on the terrain; with a discount of 0.95, later steps have a twentieth of the weight."""

PAIRS = {
    "road and target": (2, 3),
    "mud and road": (1, 2),
    "grass and road": (0, 2),
    "mud and target": (1, 3),
}
GUESSES = {
    "projection": nirl.projection_guess,
    "widest margin": nirl.max_margin_guess,
}
DEMONSTRATIONS = Dial("demonstrations (0: exact expectations)", 0, 200, 5, 0)
SLIP = Dial("a step slips with probability", 0.0, 0.5, 0.05, 0.2)
DISCOUNT = Dial("discount γ", 0.5, 0.95, 0.05, 0.9)
REGULARISATION = Dial("regularisation λ", 0.0, 1.0, 0.01, 0.05)
GAP_AND_ACCURACY = {  # of maximum causal entropy, after each iteration
    "gap": Curve(
        "gap",
        "How far the learner's feature expectations are from the expert's.",
        digits=3,
    ),
    "accuracy": Curve(
        "accuracy (%)",
        "In how many cells the learner's likeliest action is the best one.",
        high=100.0,
        digits=0,
    ),
}


def _expert_expectations(
    task: nirl.RewardFreeMDP, expert: Any, demonstrations: int
) -> Floats:
    """The feature expectations of an expert: exact, or the mean over some demonstrations, Eq. (5.13)."""
    if demonstrations == 0:
        return nirl.initial_expectations(task, expert)
    seen = task.rollout(expert, demonstrations, STEPS, seed=0)
    features = task.features[seen.states, seen.actions]
    return nirl.empirical_expectations(
        features.reshape(-1, features.shape[-1]), seen.trajectory, task.discount
    )


@trains(
    "projection_steps",
    "Apprenticeship learning on the terrain of mud and road",
    unit="policies found after the first",
    length="iterations",
    settings={
        "features": Menu("features of the reward", tuple(PAIRS)),
        "guess": Menu("the reward is guessed by", tuple(GUESSES)),
        "demonstrations": DEMONSTRATIONS,
        "slip": SLIP,
        "discount": DISCOUNT,
        "iterations": Dial("policies to find at most", 1, 40, 1, 20),
    },
    curves={
        "distance": Curve(
            "distance",
            "How far the expert's feature expectations are from the mixture's.",
            digits=3,
        ),
        "lost": Curve(
            "lost value",
            "By how much the value of the best policy found is below the expert's, under the expert's own reward.",
        ),
    },
)
def apprentice(settings: dict[str, Any], report: Report) -> Trained:
    """Apprenticeship learning with two features; the page gets the policies found as points."""
    _, terrain = nirl.terrain(slip=settings["slip"], discount=settings["discount"])
    truth = terrain.with_reward(nirl.TRUE_WEIGHTS)
    expert = mdp.policy_iteration(truth).policy
    pair = PAIRS[settings["features"]]
    task = nirl.RewardFreeMDP(
        terrain.transitions,
        terrain.features[:, :, pair],
        terrain.discount,
        terrain.starts,
    )
    total = settings["iterations"]
    values: list[float] = []
    value = float(terrain.starts @ mdp.policy_evaluation(truth, expert))

    def solve(weights: Floats) -> tuple[Any, Floats]:
        policy = mdp.policy_iteration(task.with_reward(weights)).policy
        values.append(float(terrain.starts @ mdp.policy_evaluation(truth, policy)))
        return policy, nirl.initial_expectations(task, policy)

    def guess(goal: Floats, found: Any) -> tuple[Floats, float]:
        weights, distance = GUESSES[settings["guess"]](goal, found)
        at = len(found) - 1
        report(at, total, at=at, distance=distance, lost=value - max(values))
        return weights, distance

    found = nirl.apprenticeship_learning(
        _expert_expectations(task, expert, settings["demonstrations"]),
        solve,
        solve(np.zeros(2)),
        guess=guess,
        iterations=total,
    )
    report(total, total)
    points = np.vstack([found.expectations, found.expert])
    policies = len(found.policies) - 1
    return Trained(
        [found],
        f"After {policies} more {'policy' if policies == 1 else 'policies'} the distance is {found.distances[-1]:.3f}. "
        f"Under the expert's own reward, which has four features, the mixture has the value "
        f"{found.mixture @ values:.2f}, and the expert {value:.2f}. The picture projects onto the policies found.",
        {
            "points": found.expectations.tolist(),
            "expert": found.expert.tolist(),
            "first": 0,
            "names": settings["features"].split(" and "),
            "least": float(np.floor(points.min())),
            "most": float(np.ceil(points.max())),
        },
    )


@trains(
    "trajectory_features",
    "The reward of maximum causal entropy",
    unit="iteration",
    length="iterations",
    settings={
        "demonstrations": DEMONSTRATIONS,
        "slip": SLIP,
        "discount": DISCOUNT,
        "regularisation": REGULARISATION,
        "iterations": Dial("iterations of L-BFGS at most", 1, 100, 1, 40),
    },
    curves=GAP_AND_ACCURACY,
)
def causal_entropy(settings: dict[str, Any], report: Report) -> Trained:
    """Maximum causal entropy; the page gets the weights of the four kinds of terrain."""
    _, task = nirl.terrain(slip=settings["slip"], discount=settings["discount"])
    truth = task.with_reward(nirl.TRUE_WEIGHTS)
    expert = mdp.policy_iteration(truth).policy
    goal = _expert_expectations(task, expert, settings["demonstrations"])
    found, accuracy = _causal_entropy(task, goal, expert, settings, report)
    names = ", ".join(
        f"{weight:.2f} for {kind}"
        for kind, weight in zip(nirl.TERRAIN_KINDS, found.weights, strict=True)
    )
    return Trained(
        [found],
        f"The weights of the reward are {names}. The learner's likeliest action is the best one in "
        f"{accuracy:.0f} % of the cells.",
        {
            # in the steps of the page's sliders; the notebook has all digits
            "weights": (np.round(found.weights / 0.05) * 0.05).round(2).tolist(),
            "discount": settings["discount"],
        },
    )


def _causal_entropy(
    task: nirl.RewardFreeMDP,
    goal: Floats,
    best: Any,
    settings: dict[str, Any],
    report: Report,
) -> tuple[nirl.MaximumCausalEntropy, float]:
    """Learn a reward, report every iteration, and return it with the learner's accuracy at the end."""
    total, done, accuracy = settings["iterations"], 0, 0.0

    def callback(weights: Floats) -> None:
        nonlocal done, accuracy
        model = task.with_reward(weights)
        policy = nirl.soft_value_iteration(model, tolerance=1e-3).policy
        gap = goal - nirl.initial_expectations(task, policy)
        same = policy.argmax(axis=1) == best
        accuracy = 100 * float(same[~task.terminal].mean())
        report(done, total, at=done, gap=float(np.linalg.norm(gap)), accuracy=accuracy)
        done += 1

    callback(np.zeros(len(goal)))
    with warnings.catch_warnings():
        # The reader has set the number of iterations, and sees the gap.
        warnings.simplefilter("ignore", ConvergenceWarning)
        found = nirl.maximum_causal_entropy(
            task,
            goal,
            regularisation=settings["regularisation"],
            tolerance=1e-3,
            iterations=total,
            callback=callback,
        )
    report(total, total)
    return found, accuracy


@trains(
    "reward_transfer",
    "Copy the actions and learn the reward, from the same demonstrations",
    unit="iteration",
    length="iterations",
    settings={
        "demonstrations": Dial("demonstrations", 1, 100, 1, 10),
        "errors": Dial("the expert's action is random in", 0, 50, 5, 0, " %"),
        "regularisation": REGULARISATION,
        "iterations": Dial("iterations of L-BFGS at most", 1, 100, 1, 40),
    },
    curves=GAP_AND_ACCURACY,
)
def copied_and_learned(settings: dict[str, Any], report: Report) -> Trained:
    """Both learners; the page gets their policies and values for each place of the target."""
    _, task = terrain_with(TARGETS["where it was"])
    best = mdp.policy_iteration(task.with_reward(nirl.TRUE_WEIGHTS)).policy
    expert = mdp.epsilon_greedy(np.eye(task.n_actions)[best], settings["errors"] / 100)
    seen = task.rollout(expert, settings["demonstrations"], STEPS, seed=0)
    states, actions = seen.states.ravel(), seen.actions.ravel()
    likeliest = nirl.most_frequent(states, actions, task.n_actions).actions
    copied = np.zeros(task.n_states, dtype=np.intp)  # up, where nothing was shown
    copied[states] = likeliest
    visited = len(np.unique(states[~task.terminal[states]]))
    goal = _expert_expectations(task, expert, settings["demonstrations"])
    found, _ = _causal_entropy(task, goal, best, settings, report)
    terrains = transferred(copied, found.weights)
    (far,) = [terrain for terrain in terrains if terrain["name"] == "top left"]
    moved = [far[who]["values"][far["start"]] for who in ("copied", "reward")]
    return Trained(
        [found],
        f"The demonstrations visit {visited} of {terrains[0]['cells']} cells. With the target at the top left, the "
        f"copied actions have the value {moved[0]:.2f} from the start, and the best ones for the learned reward "
        f"{moved[1]:.2f}.",
        {"terrains": terrains, "learned": True},
    )


METHODS = {
    "NIRL": "nirl",
    "apprenticeship learning": "apprenticeship",
    "relative entropy": "relative-entropy",
    "SCIRL": "scirl",
}
ENDS = {
    "1, and 0 after a collision": nirl.SURVIVAL_BONUS,
    "1/2": nirl.NEUTRAL_TERMINAL_VALUES,
    "0": nirl.ZERO_TERMINAL_VALUES,
}
OBSTACLES = 20
DEMONSTRATION_SEED, MAPS_SEED = 3, 57_000


@trains(
    "value_of_an_end",
    "Learn a reward, with ends of a value of your choice",
    unit="iteration",
    length="iterations",
    settings={
        "method": Menu("method", tuple(METHODS)),
        "ends": Menu("value of an end", tuple(ENDS)),
        "demonstrations": Dial("demonstrations", 2, 40, 2, 10),
        "discount": Dial("discount γ", 0.3, 0.95, 0.05, 0.65),
        "iterations": Dial("iterations", 5, 140, 5, 60),
    },
    curves={
        "balanced": Curve(
            "balanced accuracy (%)",
            "How well the policy predicts the demonstrations, each action with the same weight.",
            high=100.0,
            digits=0,
        ),
        "arrived": Curve(
            "arrived (%)",
            "How many of the iteration's episodes reach the target.",
            high=100.0,
            digits=0,
        ),
    },
)
def reward_and_ends(settings: dict[str, Any], report: Report) -> Trained:
    """One of the four methods on the robot; the page gets the mean reward of a step beside the value of an end."""
    terminal_values = ENDS[settings["ends"]]
    demonstrations = demonstrate(
        random_worlds(settings["demonstrations"], OBSTACLES, seed=DEMONSTRATION_SEED)
    )
    task = nirl.RobotTask(obstacles=OBSTACLES)
    expert = nirl.expert_decisions(demonstrations, task.encoder)
    total = settings["iterations"]
    tell = iteration_callback(expert, task, report, 0, total)
    means: list[float] = []

    def callback(network: Network, decisions: Decisions, rewards: Floats) -> None:
        means.append(float(nirl.scale_to_unit_interval(rewards).mean()))
        tell(network, decisions, rewards)

    result = nirl.learn(
        demonstrations,
        METHODS[settings["method"]],
        task=task,
        improver=ReplaySGDWithCallback(
            discount=settings["discount"],
            terminal_values=terminal_values,
            callback=callback,
        ),
        iterations=total,
    )
    tried = navigate(result.policy, random_worlds(TRIED, OBSTACLES, seed=MAPS_SEED))
    report(total, total)
    arrived, collided = (
        100 * float(share.mean()) for share in (tried.success, tried.collision)
    )
    return Trained(
        [result],
        f"{sentence_on_rates([arrived], TRIED)} It collides in {collided:.1f} %, and in "
        f"{100 - arrived - collided:.1f} % it neither arrives nor collides. In the last iteration the mean reward of "
        f"a step was {means[-1]:.2f}, scaled to the range from 0 to 1.",
        {
            # in the steps of the page's sliders
            "reward": round(means[-1] / 0.05) * 0.05,
            "end": terminal_values[1],
            "discount": settings["discount"],
        },
    )


EXPERT_RIGHT = 0.8
"""How often the expert of ``weights_of_samples`` goes to the right."""

POINTS = 25
"""Points of the curves over the number of samples."""

THETAS = (-1.0, 3.0)
"""The ends of the page's slider for theta."""


@trains(
    "weights_of_samples",
    "The weight θ of relative entropy, from more and more walks",
    action="Compute in Python",
    unit="random walks",
    length="samples",
    settings={
        "right": Dial(
            "a step goes to the right with probability", 0.5, 0.85, 0.05, 0.5
        ),
        "samples": Dial("random walks", 50, 1000, 50, 500),
        "demonstrations": Dial("demonstrations", 1, 100, 1, 20),
        "slack": Dial("slack ε", 0.0, 0.1, 0.01, 0.01),
        "seed": Dial("seed", 0, 20, 1, 0),
    },
    curves={
        "theta": Curve(
            "θ per step",
            "The weight of a step to the right; beyond the slider of the page, the slider's end.",
            low=THETAS[0],
            high=THETAS[1],
        ),
        "gap": Curve(
            "gap",
            "How far the weighted mean of the walks is from the expert's.",
            digits=3,
        ),
        "effective": Curve(
            "effective samples",
            "As many walks of equal weight would be as good.",
            digits=1,
        ),
    },
)
def weighted_samples(settings: dict[str, Any], report: Report) -> Trained:
    """Relative entropy with a growing number of walks; the page gets the walks, the expert's mean and theta."""
    right, total = settings["right"], settings["samples"]
    rng = np.random.default_rng(settings["seed"])
    shown = rng.binomial(WALK_STEPS, EXPERT_RIGHT, size=settings["demonstrations"])
    expert = float(shown.mean()) / WALK_STEPS
    walks = rng.binomial(WALK_STEPS, right, size=total) / WALK_STEPS
    for number in range(total // POINTS, total + 1, total // POINTS):
        with warnings.catch_warnings():
            # The reader sees the gap.
            warnings.simplefilter("ignore", ConvergenceWarning)
            found = nirl.relative_entropy_weights(
                [expert],
                walks[:number, None],
                np.zeros(number),
                slack=settings["slack"],
            )
        report(
            number,
            total,
            at=number,
            theta=float(np.clip(found.weights[0] / WALK_STEPS, *THETAS)),
            gap=float(abs(found.gap[0])),
            effective=found.effective_samples,
        )
    theta = float(found.weights[0]) / WALK_STEPS
    exact = float(logit(EXPERT_RIGHT) - logit(right))
    return Trained(
        [found],
        f"θ is {theta:.2f} per step to the right. Without slack it tends to {exact:.2f} as the walks and the "
        f"demonstrations become more. The weighted mean is {expert - found.gap[0]:.2f}, and the expert's "
        f"{expert:.2f}. The {total} walks are as good as {found.effective_samples:.1f} of equal weight.",
        {
            "features": walks.tolist(),
            "expert": expert,
            "theta": on_slider(theta, *THETAS),
        },
    )


def on_slider(value: float, least: float, most: float) -> float:
    """The nearest place on a slider of the page that goes from ``least`` to ``most`` in steps of 0.05."""
    return min(max(round(round(value / 0.05) * 0.05, 2), least), most)


MEASURES = {
    "accuracy": nirl.accuracy,
    "balanced accuracy": nirl.balanced_accuracy,
}


@trains(
    "accuracy_or_balance",
    "NIRL, and the policy that a measure keeps",
    unit="iteration",
    length="iterations",
    settings={
        "measure": Menu("the policy is kept by", tuple(MEASURES)),
        "caution": Dial("caution of the expert", 0.0, 2.0, 0.5, 0.0),
        "demonstrations": Dial("demonstrations", 2, 40, 2, 10),
        "iterations": Dial("iterations", 5, 140, 5, 40),
        "seed": Dial("seed", 0, 20, 1, 0),
    },
    curves={
        "accuracy": Curve(
            "accuracy (%)",
            "How many of the expert's decisions the iteration's policy predicts.",
            high=100.0,
            digits=0,
        ),
        "balanced": Curve(
            "balanced accuracy (%)",
            "The same with equal weight for each action of the expert.",
            high=100.0,
            digits=0,
        ),
        "arrived": Curve(
            "arrived (%)",
            "How many of the iteration's episodes reach the target.",
            high=100.0,
            digits=0,
        ),
    },
)
def kept_policy(settings: dict[str, Any], report: Report) -> Trained:
    """NIRL on the robot; the page gets how often the expert goes forward, and how well the kept policy predicts."""
    measure, total = settings["measure"], settings["iterations"]
    demonstrations = demonstrate(
        random_worlds(settings["demonstrations"], OBSTACLES, seed=DEMONSTRATION_SEED),
        caution=settings["caution"],
    )
    task = nirl.RobotTask(obstacles=OBSTACLES)
    expert = nirl.expert_decisions(demonstrations, task.encoder)
    tell = iteration_callback(expert, task, report, 0, total)
    result = nirl.learn(
        demonstrations,
        seed=settings["seed"],
        task=task,
        improver=ReplaySGDWithCallback(callback=tell),
        score=MEASURES[measure],
        iterations=total,
    )
    tried = navigate(result.policy, random_worlds(TRIED, OBSTACLES, seed=MAPS_SEED))
    report(total, total)
    scores = {
        "accuracy": result.history.accuracies,
        "balanced accuracy": result.history.balanced,
    }
    (other,) = MEASURES.keys() - {measure}
    forward = float((expert.actions == Action.F).mean())
    kept = {name: float(values[result.chosen]) for name, values in scores.items()}
    return Trained(
        [result],
        f"{measure.capitalize()} keeps the policy after iteration {result.chosen}, and {other} the one after iteration "
        f"{scores[other].argmax()}. The policy that is kept has an accuracy of {100 * kept['accuracy']:.0f} % and a "
        f"balanced accuracy of {100 * kept['balanced accuracy']:.0f} %; always going forward has an accuracy of "
        f"{100 * forward:.0f} %. {sentence_on_rates([100 * float(tried.success.mean())], TRIED)}",
        {
            "forward": on_slider(forward, 0.2, 0.95),
            "careful": on_slider(kept["balanced accuracy"], 0.2, 1.0),
        },
    )
