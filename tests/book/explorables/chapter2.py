"""What the explorables of chapter 2 have to show."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from robonav import mdp
from robonav.mdp.belief_planning import AlphaVectors
from robonav.style import BLUE, GREEN, GREY, INK, ORANGE, VERMILION
from robonav.widgets.explorables.chapter2 import (
    best_while_exploring,
    cliff,
    two_states,
)

from .grids import Grid, grid_of
from .hashed_numbers import HashedNumbers
from .reader import choose, keys, press, slide, slide_all, touch_part, write
from .shown import Shown
from .table import expects

Values = NDArray[np.float64]
Actions = NDArray[np.intp]
DIRECTIONS = ("up", "right", "down", "left")
OPEN_RIGHT = 2


def exponent(power: int) -> str:
    """A whole number as an exponent."""
    return str(power).translate(str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"))


@expects()
def discounted_return(shown: Shown) -> None:
    discount = shown.number("discount γ")
    steps = int(shown.number("steps to the far charger"))
    ways = ([0.0, 4.0], [0.0] * (steps - 1) + [10.0])
    near, far = (mdp.discounted_return(way, discount)[0] for way in ways)
    larger = "near" if near > far else "far"
    shown.says(
        f"Near: γ¹ · 4 = {near}",
        f"Far: γ{exponent(steps - 1)} · 10 = {far}",
        "Both returns are equal."
        if abs(near - far) < 0.005
        else f"The {larger} charger gives the larger return.",
        f"looks about {1 / (1 - discount)} steps ahead."
        if discount < 1
        else "Without a discount only the size of a reward matters.",
    )
    chart = shown.picture()
    chart.has_bars(BLUE, [near])
    chart.has_bars(ORANGE, [far])
    times = np.arange(1, 20.75, 0.25)
    chart.has_curve(INK, np.column_stack([times, 10 * discount ** (times - 1)]))


# ---- On a grid ------------------------------------------------------------------------------------------------------


def small_grid(shown: Shown) -> tuple[mdp.GridWorld, mdp.FiniteMDP, Grid]:
    """The grid of four by three cells, its model with the page's discount, and its picture."""
    grid = mdp.four_by_three()
    return grid, grid.mdp(shown.given["discount"]), grid_of(shown)


def place_of(grid: mdp.GridWorld, cell: int) -> str:
    """Where a cell is, in the page's words."""
    row, column = grid.cells[cell]
    return f"row {row + 1}, column {column + 1}"


def pressed_cells(shown: Shown) -> Iterator[int]:
    """The cells that the reader pressed: with Enter, or with a touch of a cell that was marked already."""
    for act, before, after in shown.steps():
        marked = grid_of(after).marked()
        if act == "Enter" or (act == "touch" and marked == grid_of(before).marked()):
            yield marked


@expects(
    by_keyboard=[keys("Enter ArrowRight Enter Enter ArrowUp Enter ArrowRight")],
    by_touch=[touch_part(".cell", cell) for cell in (8, 8, 4, 4, 4, 9, 3)],
)
def turn_arrows(shown: Shown) -> None:
    grid, model, picture = small_grid(shown)
    first = np.array(shown.given["policy"])
    policy = first.copy()
    for cell in pressed_cells(shown):
        policy[cell] = (policy[cell] + 1) % 4 * ~grid.terminal[cell]
    inside = np.flatnonzero(~grid.terminal)
    assert picture.arrows() == {s: policy[s] for s in inside}

    values = mdp.policy_evaluation(model, policy)
    picture.has_values(values[inside])
    marked = picture.marked()
    shown.says(f"Marked: {place_of(grid, marked)}.")
    if grid.terminal[marked]:
        shown.says("The episode ends here.")
    else:
        q = mdp.policy_action_values(model, policy)[marked]
        advantages = mdp.advantage(model, policy)[marked]
        for action, direction in enumerate(DIRECTIONS):
            own = action == policy[marked]
            more = (
                " = V, the arrow here" if own else f", advantage {advantages[action]}"
            )
            shown.says(f"{direction}: Q = {q[action]}{more}")

    change = values - mdp.policy_evaluation(model, first)
    higher, lower = (change > 5e-4).sum(), (change < -5e-4).sum()
    loss = (mdp.policy_iteration(model).values - values).max()
    shown.says(
        f"Against the policy at the start, {higher} values are higher and {lower} lower.",
        "No advantage is positive anywhere: this policy is optimal."
        if loss < 5e-4
        else f"The largest loss of value in a cell is {loss}.",
    )


def written_backup(model: mdp.FiniteMDP, values: Values, s: int) -> list[str]:
    """The sums of Eq. (2.15) for each action in a state, in the page's words."""
    sums = []
    rows = model.transitions_from(s).toarray()
    for action, (direction, row) in enumerate(zip(DIRECTIONS, rows, strict=True)):
        terms = [f"{row[t]} · {values[t]}" for t in np.flatnonzero(row)]
        q = model.action_values(values)[s, action]
        reward = model.rewards[s, action]
        sums.append(f"{direction}: {reward} + 0.9 ({' + '.join(terms)}) = {q}")
    return sums


@expects(
    by_keyboard=[
        keys("ArrowUp ArrowUp ArrowRight ArrowRight Enter ArrowLeft Enter"),
        keys("ArrowLeft Enter ArrowDown"),
    ],
    by_touch=[touch_part(".cell", cell) for cell in (2, 1, 0, 5, 9)],
)
def bellman_backup(shown: Shown) -> None:
    grid, model, picture = small_grid(shown)
    values, backups, last = np.zeros(model.n_states), 0, None
    for act, _, after in shown.steps():
        cell = grid_of(after).marked()
        if act == "Back up all cells at once":
            values = mdp.bellman_optimality_operator(model, values)
            backups += int((~grid.terminal).sum())
            last = None
        elif act in ("Enter", "touch") and not grid.terminal[cell]:
            sums = written_backup(model, values, cell)
            values[cell] = model.action_values(values)[cell].max()  # Eq. (2.26)
            backups += 1
            last = (cell, sums, values[cell])

    inside = np.flatnonzero(~grid.terminal)
    picture.has_values(values[inside])
    ties = best_actions(model, values)
    assert all(ties[s, a] for s, a in picture.arrows().items())
    start = int(grid.start.argmax())
    off = abs(mdp.policy_iteration(model).values - values).max()
    shown.says(
        f"Backups of a cell: {backups}. Value of the start S: {values[start]}.",
        "All values are right to two digits."
        if off < 0.005
        else f"The values are still wrong by up to {off}.",
    )
    if last is None:
        assert "The last one" not in shown.contents["said"]
    else:
        cell, sums, value = last
        shown.says(f"The last one, in {place_of(grid, cell)}.", *sums)
        shown.says(f"The largest of them is the new value: {value}")


def best_actions(model: mdp.FiniteMDP, values: Values) -> NDArray[np.bool_]:
    """Which actions (S, A) are best for some values; equal values differ by rounding."""
    q = model.action_values(values)
    return q >= q.max(axis=1, keepdims=True) - 1e-9


def improved(
    model: mdp.FiniteMDP, values: Values, policy: Actions, chosen: dict[int, int]
) -> Actions:
    """The greedy policy that was chosen; fails if it is not greedy, or if an action changed although it was."""
    best, new = best_actions(model, values), policy.copy()
    for s, action in chosen.items():
        assert best[s, action]
        assert action == policy[s] or not best[s, policy[s]]
        new[s] = action
    return new


@expects(
    *[press(name) for name in 4 * ("Evaluate: one sweep", "Improve")],
    press("Evaluate: until nothing changes"),
)
def evaluate_improve(shown: Shown) -> None:
    grid, model, picture = small_grid(shown)
    policy, values = np.zeros(model.n_states, dtype=int), np.zeros(model.n_states)
    for act, _, after in shown.steps():
        if act == "Evaluate: one sweep":
            values = mdp.bellman_policy_operator(model, policy, values)
        elif act == "Evaluate: until nothing changes":
            values = mdp.policy_evaluation(model, policy)
        else:
            policy = improved(model, values, policy, grid_of(after).arrows())

    inside = np.flatnonzero(~grid.terminal)
    assert picture.arrows() == {s: policy[s] for s in inside}
    picture.has_values(values[inside])
    pressed = [act for act, _, _ in shown.steps()]
    change = abs(mdp.bellman_policy_operator(model, policy, values) - values).max()
    optimal = best_actions(model, mdp.policy_iteration(model).values)
    wrong = sum(not optimal[s, policy[s]] for s in inside)
    shown.says(
        f"Improvements: {pressed.count('Improve')}.",
        f"Sweeps of evaluation: {pressed.count('Evaluate: one sweep')}.",
        f"Full evaluations: {pressed.count('Evaluate: until nothing changes')}.",
        "The values fit the arrows."
        if change < 5e-4
        else f"The values do not fit the arrows: a sweep would still change one by {change}.",
        f"Arrows that are not yet optimal: {wrong}."
        if wrong
        else "All arrows are optimal.",
    )


# ---- Values that are learned ----------------------------------------------------------------------------------------


@expects(write("orange start, state 0", "-7"), write("orange start, state 1", "3"))
def contraction(shown: Shown) -> None:
    model = two_states(shown.number("discount γ"))
    starts = [shown.number(f"orange start, state {s}") for s in range(2)]
    sweep = int(shown.number("sweep"))
    runs = [[np.zeros(2)], [np.array(starts)]]
    for run in runs:
        for _ in range(60):
            run.append(mdp.bellman_optimality_operator(model, run[-1]))
    blue, orange = np.array(runs)
    gaps = abs(blue - orange).max(axis=1)
    bounds = gaps[0] * model.discount ** np.arange(61)
    shown.says(
        f"After {sweep} sweeps: blue {blue[sweep, 0]}, orange {orange[sweep, 0]} in state 0.",
        f"Largest difference over both states: {gaps[sweep]}. The bound is {bounds[sweep]}.",
        f"From sweep {(bounds <= gaps[0] / 100).argmax()} on, the bound is at most a hundredth"
        if bounds[-1] <= gaps[0] / 100
        else "The bound does not fall to a hundredth of the first difference within 60 sweeps.",
    )
    sweeps, values, differences = np.arange(61), shown.picture(), shown.picture(1)
    values.has_curve(BLUE, np.column_stack([sweeps, blue[:, 0]]))
    values.has_curve(ORANGE, np.column_stack([sweeps, orange[:, 0]]))
    differences.has_curve(GREY, np.column_stack([sweeps, bounds]))
    differences.has_curve(GREEN, np.column_stack([sweeps, gaps]))


class Episodes:
    """An environment that goes through the rooms as it was told, whatever the action."""

    def __init__(self, episodes: str) -> None:
        self.episodes = iter(episodes.split())

    def reset(self) -> tuple[int, dict]:
        self.rooms = map(int, next(self.episodes))
        return next(self.rooms), {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict]:
        room = next(self.rooms)
        return room, float(room == 6), room in (0, 6), False, {}


def values_after_each_episode(
    learn: Callable[..., None], episodes: str, first: float
) -> Values:
    """The values (101, 7) that a method has before and after each of 100 episodes, without a discount."""
    env = Episodes(episodes)
    values, visits = [0.0, *[first] * 5, 0.0], [0] * 7
    history = [values.copy()]
    for _ in range(100):
        learn(env, lambda room: 0, values, visits, 1, discount=1.0)
        history.append(values.copy())
    return np.array(history)


def errors(histories: list[Values]) -> Values:
    """The error (101,) of the values of the five rooms after each episode, a mean over runs."""
    truth = np.arange(1, 6) / 6
    off = np.array(histories)[:, :, 1:6] - truth
    return np.sqrt((off**2).mean(axis=2)).mean(axis=0)


@cache
def by_td(episodes: tuple[str, ...], alpha: float) -> list[Values]:
    """What TD(0) learns in each run."""
    algorithm = partial(
        inspect.unwrap(mdp.td_prediction), learning_rate=lambda visits: alpha
    )
    return [values_after_each_episode(algorithm, run, 0.5) for run in episodes]


@cache
def by_monte_carlo(episodes: tuple[str, ...]) -> list[Values]:
    """What every-visit Monte Carlo learns in each run; 0.5 where it knows nothing yet."""
    algorithm = partial(inspect.unwrap(mdp.monte_carlo_prediction), visit="every")
    return [values_after_each_episode(algorithm, run, 0.5) for run in episodes]


@expects(slide("learning rate α", 0.2), slide("run in the first picture", 0.5))
def td_step_size(shown: Shown) -> None:
    alpha, episode = shown.number("learning rate α"), int(shown.number("episodes"))
    run = int(shown.number("run in the first picture")) - 1
    episodes = tuple(shown.given["episodes"])
    td, monte_carlo = by_td(episodes, alpha), by_monte_carlo(episodes)
    error, baseline = errors(td), errors(monte_carlo)
    shown.says(
        f"After {episode} episode",
        f"TD(0) with α = {alpha}: error {error[episode]}",
        f"Monte Carlo: error {baseline[episode]}",
        f"the error after 10 episodes is {error[10]}, after 100 it is {error[100]}.",
    )
    rooms, chart = shown.picture(), shown.picture(1)
    for colour, learned in ((BLUE, td), (ORANGE, monte_carlo)):
        values = learned[run][episode]
        rooms.has_dots(colour, np.column_stack([np.arange(1, 6), values[1:6]]))
    for colour, series in ((GREEN, error), (ORANGE, baseline)):
        drawn = np.minimum(series, 0.3)
        chart.has_curve(colour, np.column_stack([np.arange(101), drawn]))


class Cliff:
    """The cliff as an environment whose steps do not depend on chance; an episode is cut off after 200 steps."""

    def __init__(self) -> None:
        grid = cliff()
        self.moves, self.rewards = grid.moves.tolist(), grid.cell_rewards.tolist()
        self.ends, self.begin = grid.terminal.tolist(), int(grid.start.argmax())

    def reset(self) -> tuple[int, dict]:
        self.state, self.steps = self.begin, 0
        return self.state, {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict]:
        self.state, self.steps = self.moves[self.state][action], self.steps + 1
        ended = self.ends[self.state]
        return self.state, self.rewards[self.state], ended, self.steps >= 200, {}


@cache
def learned_on_cliff(method: str, epsilon: float, episodes: int, seed: int) -> Values:
    """The mean action values (S, 4) of ten robots that learn by themselves."""
    learn = {"Q-learning": mdp.q_learning, "SARSA": mdp.sarsa}[method]
    learned = []
    for robot in range(10):
        n_states = cliff().n_states
        q, visits = ([[zero] * 4 for _ in range(n_states)] for zero in (0.0, 0))
        inspect.unwrap(learn)(
            Cliff(), q, visits, episodes, discount=1.0,
            learning_rate=lambda visits: 0.1, epsilon=lambda episode: epsilon,
            rng=HashedNumbers(10 * seed + robot),
        )  # fmt: skip
        learned.append(q)
    return np.mean(learned, axis=0)


def best_moves(q: Values) -> Actions:
    """The best action in each cell of the cliff; of equal ones, the first that leads to another cell."""
    ties = q >= q.max(axis=1, keepdims=True) - 1e-9
    leaves = cliff().moves != np.arange(len(q))[:, None]
    return (1.0 * ties + (ties & leaves)).argmax(axis=1)


def greedy_trajectory(q: Values) -> list[int]:
    """Where the best actions lead from the start of the cliff."""
    grid, best = cliff(), best_moves(q)
    trajectory = [int(grid.start.argmax())]
    while not grid.terminal[trajectory[-1]] and len(trajectory) < 30:
        trajectory.append(int(grid.moves[trajectory[-1], best[trajectory[-1]]]))
    return trajectory


ROWS_AWAY = (
    "along the edge",
    "one row away from the edge",
    "along the far wall",
)


def rows_away(trajectory: list[int]) -> str:
    """How far a trajectory is from the edge of the cliff, in the page's words."""
    return ROWS_AWAY[2 - cliff().cells[trajectory][:, 0].min()]


@cache
def best_on_cliff(epsilon: float) -> Values:
    """The best action values of a robot that explores."""
    return best_while_exploring(cliff().mdp(1.0), epsilon)


@expects(
    slide("random actions, ε", 0.3),
    slide("episodes", 0.07),
    by_keyboard=[press("Learn again with other seeds")],
)
def cliff_exploration(shown: Shown) -> None:
    epsilon, episodes = shown.number("random actions, ε"), int(shown.number("episodes"))
    seed = 1 + [act for act, _, _ in shown.steps()].count(
        "Learn again with other seeds"
    )
    best = best_on_cliff(epsilon)
    start = int(cliff().start.argmax())
    value = (mdp.epsilon_greedy(best, epsilon) * best).sum(axis=1)[start]
    shown.says(
        f"the mean of 10 robots after {episodes} episodes each.",
        f"that explores with ε = {epsilon} the best path leads {rows_away(greedy_trajectory(best))},"
        f" with an expected return of {value}.",
    )
    if episodes > 100:  # more would take Python too long
        return
    grid = cliff()
    inside = np.flatnonzero(~grid.terminal)
    for number, method in enumerate(("Q-learning", "SARSA")):
        q = learned_on_cliff(method, epsilon, episodes, seed)
        picture = grid_of(shown, number)
        assert picture.arrows() == {s: best_moves(q)[s] for s in inside}
        picture.has_values(q.max(axis=1)[inside])
        trajectory = greedy_trajectory(q)
        assert picture.trajectory() == trajectory
        arrives = (
            grid.rows[grid.cells[trajectory[-1], 0]][grid.cells[trajectory[-1], 1]]
            == "G"
        )
        shown.says(
            f"this path takes {len(trajectory) - 1} steps."
            if arrives
            else "this path does not reach G.",
            f"{method}'s path leads {rows_away(trajectory)}."
            if arrives
            else f"{method}'s path does not lead to G yet.",
        )


# ---- Partial observation --------------------------------------------------------------------------------------------


def doors_of(shown: Shown) -> str:
    """The plan of the corridor, a D for each door."""
    picture = shown.picture()
    doors = [float(door["x"]) for door in picture.of("rect", fill=ORANGE)]
    return "".join("D" if 48 + 30 * cell in doors else "." for cell in range(9))


def belief_of(shown: Shown) -> Values:
    """The belief after all that the reader did: moves and observations, and new plans."""
    belief = np.full(9, 1 / 9)
    for act, before, _ in shown.steps():
        model = mdp.corridor(
            doors_of(before),
            accuracy=before.share("the sensor is right in"),
            slip=before.share("a move fails in"),
        )
        if act in ("Move left", "Move right"):
            belief = model.predict(belief, ["Move left", "Move right"].index(act))
        elif act in ("See a wall", "See a door"):
            seen = ["See a wall", "See a door"].index(act)
            belief = model.update(belief, 2, seen)
        elif act in ("3", "touch"):
            belief = np.full(9, 1 / 9)
    return belief


@expects(choose("width of a tile", "1.5 m"), by_keyboard=[slide_all])
def shared_tiles(shown: Shown) -> None:
    width, count = shown.number("width of a tile"), int(shown.number("tilings"))
    place = shown.number("place of the update (m)") + 0.03
    apart = shown.number("metres to the other place")
    line = mdp.Tiles((0.0,), (6.0,), (round(6 / width),), count, n_actions=1)

    def shared(other: float) -> int:
        return int((line.active([place]) == line.active([other])).sum())

    same = shared(place + apart)
    rise = same / count
    tiles = "tile" if count == 1 else "tiles"
    shown.says(
        f"The other place shares {same} of {count} {tiles} with it, so its value rises by {rise}.",
        f"No place that is {width} m or more away shares a tile with it.",
    )
    chart = shown.picture()
    places = np.arange(60) / 10 + 0.03
    heights = [shared(x) / count for x in places]
    chart.has_curve(GREY, np.column_stack([places, heights]))
    chart.has_dots(BLUE, [[place, 1.0]])
    chart.has_dots(ORANGE, [[place + apart, rise]])
    assert len(shown.picture(1).of("rect", fill=BLUE)) == count


@expects(
    press("See a door"),
    press("Move right"),
    press("See a wall"),
    slide("the sensor is right in", 0.6),
    slide("a move fails in", 0.6),
    press("Move left"),
    press("See a door"),
)
def own_corridor(shown: Shown) -> None:
    belief, cells = belief_of(shown), doors_of(shown)
    slip = shown.share("a move fails in")
    accuracy = shown.share("the sensor is right in")
    model = mdp.corridor(cells, accuracy=accuracy, slip=slip)
    wall, door = (mdp.entropy(model.update(belief, 2, seen)) for seen in (0, 1))
    probability = model.observation_probabilities(belief, 2)[1]
    if np.ptp(belief) < 1e-9:
        known = "All cells are equally likely"
    else:  # of cells with equal beliefs, rounding decides
        likeliest = np.flatnonzero(belief > belief.max() - 1e-9)
        names = [f"Likeliest cell: {cell}" for cell in likeliest]
        known = next(
            (name for name in names if name in shown.contents["said"]), names[0]
        )
    shown.says(
        f"{known}, with {100 * belief.max()} %.",
        f"Uncertainty: {mdp.entropy(belief)} bits",
        f"{np.log2(9)} when no cell is excluded",
        f"The probability of a door is {100 * probability} %.",
        f"A door would leave {door} bits, and a wall {wall}.",
        f"A move succeeds with probability {100 * (1 - slip)} %.",
    )
    heights = [float(bar["height"]) for bar in shown.picture().of("rect", fill=BLUE)]
    np.testing.assert_allclose(
        np.array(heights) / max(heights), belief / belief.max(), atol=0.005
    )


@expects(
    slide("steps to go", 0.2),
    slide("heard more often on the left than on the right", 0.8),
)
def tiger_vectors(shown: Shown) -> None:
    more = int(shown.number("heard more often on the left than on the right"))
    accuracy, steps = (
        shown.share("listening is right in"),
        int(shown.number("steps to go")),
    )
    tiger, belief = mdp.tiger(accuracy=accuracy), np.array([0.5, 0.5])
    for _ in range(abs(more)):
        belief = tiger.update(belief, 0, 0 if more > 0 else 1)
    row = shown.given["accuracies"].index(accuracy)
    plan = shown.given["plans"][row][steps - 1]
    vectors = AlphaVectors(np.array(plan["vectors"]), np.array(plan["actions"]))
    action = ("listen", "open left", "open right")[vectors.action(belief)]
    value = float(vectors.value(belief))
    left = np.arange(401) / 400
    along = np.column_stack([left, 1 - left]) @ vectors.vectors.T
    best = along.argmax(axis=1)
    sure = np.flatnonzero((vectors.actions[best] == OPEN_RIGHT) & (left > 0.5))
    shown.says(
        f"Belief that the tiger is left: {belief[0]}.",
        f"Best: {action}. Value: {value}.",
        f"It opens the right door from a belief of {left[sure[0]]} on."
        if len(sure)
        else "With this setting no belief is sure enough to open a door.",
        f"Plans that are best for some belief: {len(set(best))}.",
    )
    chart = shown.picture()
    chart.has_dots(VERMILION, [[belief[0], value]])
    for place, colour in enumerate((BLUE, GREEN, ORANGE)):
        taken = vectors.actions[best] == place
        if taken.any():
            chart.has_curve(colour, np.column_stack([left, along.max(axis=1)])[taken])
