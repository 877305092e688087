"""What the explorables of chapter 3 have to show."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
from scipy.stats import binomtest

from robonav import networks, nirl
from robonav.lfd import plan, plan_on_grid
from robonav.lfd.astar import Node
from robonav.lfd.planning import Plan
from robonav.robot import TARGET_ENCODINGS, clearance, random_worlds
from robonav.style import BLUE, GREEN, ORANGE, SKY, VERMILION
from robonav.widgets.explorables.chapter3 import small_map

from .reader import choose, keys, press, slide, slide_all, touch_part
from .shown import Picture, Shown
from .table import expects


@expects(
    choose("points", "opposite corners"),
    slide("weight w₁", 0.7),
    press("Double all three"),
    by_keyboard=[slide_all],
)
def neuron_line(shown: Shown) -> None:
    weights = np.array([shown.number("weight w₁"), shown.number("weight w₂")])
    bias = shown.number("bias b")
    neuron = networks.Network((weights[None, :],), (np.array([bias]),))
    data = next(s for s in shown.given["sets"] if s["name"] == shown.chosen("points"))
    answers = neuron.forward(np.array(data["points"]))[:, 0]
    right = ((answers > 0.5) == np.array(data["labels"], dtype=bool)).sum()

    def signed(number: float) -> str:
        return f"{'−' if number < 0 else '+'} {abs(number)}"

    corners = np.array([(x, y) for x in (-3, 3) for y in (-3, 3)]) @ weights + bias
    crosses = corners.min() < 0 < corners.max()
    steepest = networks.sigmoid_slope(0.5) * np.linalg.norm(weights)
    shown.says(
        f"Line: {weights[0]} x₁ {signed(weights[1])} x₂ {signed(bias)} = 0",
        f"Across the line the answer changes by {steepest} per unit."
        if crosses
        else "There is no line within the picture: the neuron gives all points one answer.",
        f"{right} of {len(answers)} points are on the right side.",
    )
    plane = shown.picture()
    has_answers(plane, neuron)
    has_line_of(plane, weights, bias, crosses)


def has_answers(plane: Picture, neuron: networks.Network) -> None:
    """Fail unless the colours of the plane are the answers of a neuron."""
    middles = np.arange(24) / 4 - 3 + 0.125
    places = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    answers = neuron.forward(places)[:, 0]
    shades = plane.of("rect")
    shown = [
        0.5 + float(s["fill-opacity"]) / 0.7 * (1 if s["fill"] == ORANGE else -1)
        for s in shades
    ]
    np.testing.assert_allclose(shown, answers, atol=0.001)


def has_line_of(
    plane: Picture, weights: np.ndarray, bias: float, crosses: bool
) -> None:
    """Fail unless a line is drawn where the weighted sum is 0, if there is such a place."""
    lines = plane.of("polyline")
    assert len(lines) == crosses
    zero, unit = plane.x(0), plane.x(1) - plane.x(0)
    down, up = plane.y(0), plane.y(1) - plane.y(0)
    for line in lines:
        for place in line["points"].split():
            x, y = map(float, place.split(","))
            point = np.array([(x - zero) / unit, (y - down) / up])
            assert abs(weights @ point + bias) < 0.05


@expects(
    press("All steps"),
    slide("second weight w₂", 0.2),
    slide("first weight w₁", 0.7),
    slide("input x", 0.4),
    slide("label y", 0.9),
    *[press("One step back")] * 3,
    press("Next step"),
)
def backpropagation_by_hand(shown: Shown) -> None:
    first, second = shown.number("first weight w₁"), shown.number("second weight w₂")
    x, y = shown.number("input x"), shown.number("label y")
    network = networks.Network(
        (np.array([[first]]), np.array([[second]])), (np.zeros(1), np.zeros(1))
    )
    _, a2, a3 = (float(a.item()) for a in network.activations([[x]]))
    gradient = networks.squared_error_gradient(
        network, [[x]], [[y]], regularisation=0.0
    )
    w1, w2 = (float(weight.item()) for weight in gradient.weights)
    delta2, delta3 = (float(bias.item()) for bias in gradient.biases)
    lines = [
        f"1. z⁽²⁾ = w₁ x = {first} · {x} = {first * x}",
        f"2. a⁽²⁾ = f(z⁽²⁾) = {a2}",
        f"3. z⁽³⁾ = w₂ a⁽²⁾ = {second} · {a2} = {second * a2}",
        f"4. a⁽³⁾ = f(z⁽³⁾) = {a3}; the label is {y}",
        f"5. output's error: −(y − a⁽³⁾) · a⁽³⁾(1 − a⁽³⁾) = {delta3}",
        f"6. hidden error: w₂ δ⁽³⁾ · a⁽²⁾(1 − a⁽²⁾) = {delta2}",
        f"7. ∂J/∂w₁ = x δ⁽²⁾ = {w1}",
        f"8. ∂J/∂w₂ = a⁽²⁾ δ⁽³⁾ = {w2}",
    ]
    step = 0
    for act, _, _ in shown.steps():
        step += {"Next step": 1, "One step back": -1}.get(act, 0)
        step = 8 if act == "All steps" else step
    shown.says(*lines[:step])
    assert step == 8 or f"{step + 1}. " not in shown.contents["said"]
    if step == 0:
        shown.says("Nothing is computed yet.")
    numbers = {4: a3, 5: delta3, 6: delta2, 7: w1, 8: w2}
    names = {4: "", 5: "δ = ", 6: "δ = ", 7: "∂J/∂w₁ = ", 8: "∂J/∂w₂ = "}
    for own, number in numbers.items():
        if own <= step:
            shown.picture().says(f"{names[own]}{number}")


class SearchByHand:
    """A* on the page's grid, of which someone else chooses the node to expand."""

    def __init__(self, given: dict[str, Any]) -> None:
        self.points, self.steps = given["points"], given["steps"]
        self.target = given["target"]
        self.nodes: dict[int, Node] = {}
        self.open: list[int] = []
        self.closed: list[int] = []
        self.reach(given["start"], 0.0, None)

    def reach(self, place: int, G: float, parent: Node | None) -> None:
        """Put a node into the open list, or give it a cheaper path."""
        point = self.points[place]
        H = math.dist(point, self.points[self.target])
        self.nodes[place] = Node((place,), point, G, H, parent)
        if place not in self.open:
            self.open.append(place)

    def expand(self, place: int) -> None:
        """Reach the neighbours of an open node."""
        self.open.remove(place)
        self.closed.append(place)
        current = self.nodes[place]
        for neighbour in self.steps[place]:
            G = current.G + math.dist(current.point, self.points[neighbour])
            known = self.nodes.get(neighbour)
            if neighbour not in self.closed and (known is None or G < known.G - 1e-9):
                self.reach(neighbour, G, current)

    def next_by(self, rule: str) -> int:
        """The open node that a rule takes: least F, of equal F least H; or least G; or least H."""
        keys = {
            "F": lambda node: (round(node.F, 9), round(node.H, 9)),
            "G": lambda node: round(node.G, 9),
            "H": lambda node: round(node.H, 9),
        }
        return min(self.open, key=lambda k: (keys[rule](self.nodes[k]), self.points[k]))

    @property
    def ended(self) -> bool:
        """Whether the target was expanded, or nothing is left to expand."""
        return not self.open or self.closed[-1:] == [self.target]

    def path(self) -> list[Any]:
        """The points from the start to the node expanded last, or to the first node."""
        node: Node | None = self.nodes[(self.closed or self.open)[-1]]
        points = []
        while node is not None:
            points.append(node.point)
            node = node.parent
        return points[::-1]


def nodes_of(picture: Picture, **attributes: str) -> set[int]:
    """The nodes that are drawn with some attributes, by their numbers."""
    nodes = [node for node in picture.of("circle") if node["r"] != "23"]
    drawn = picture.of("circle", **attributes)
    return {number for number, node in enumerate(nodes) if node in drawn}


def rule_of(shown: Shown) -> str:
    """F, G or H."""
    return shown.chosen("rule for the buttons").removeprefix("least ")[0]


def searched(shown: Shown) -> SearchByHand:
    """The search after all that the reader did."""
    search = SearchByHand(shown.given)
    for act, before, after in shown.steps():
        rule = rule_of(before)
        if act == "Expand the next by this rule":
            search.expand(search.next_by(rule))
        elif act == "Run to the end":
            while not search.ended:
                search.expand(search.next_by(rule))
        elif act == "Enter":
            (marked,) = nodes_of(before.picture(), stroke=VERMILION)
            search.expand(marked)
        elif act == "touch":
            (touched,) = nodes_of(after.picture(), r="8") - nodes_of(
                before.picture(), r="8"
            )
            search.expand(touched)
    return search


BY_RULES = (
    press("Expand the next by this rule"),
    press("Expand the next by this rule"),
    choose("rule for the buttons", "least G"),
    press("Expand the next by this rule"),
    choose("rule for the buttons", "least H"),
    press("Run to the end"),
)


@expects(
    by_keyboard=[keys("ArrowRight Enter ArrowRight ArrowRight Enter"), *BY_RULES],
    by_touch=[touch_part(".touchable", 0), touch_part(".touchable", 1), *BY_RULES],
)
def astar_by_hand(shown: Shown) -> None:
    search, rule = searched(shown), rule_of(shown)
    nodes = search.nodes

    def told(place: int) -> str:
        node = nodes[place]
        return f"G = {node.G}, H = {node.H}, F = {node.F}"

    expanded = len(search.closed)
    shown.says(
        f"{expanded} {'node' if expanded == 1 else 'nodes'} expanded, {len(search.open)} open."
    )
    if search.ended:
        shown.says(
            f"The target is reached: the path is {nodes[search.target].G} m long."
        )
    else:
        shown.says(
            f"The open node with the least {rule} has {told(search.next_by(rule))}."
        )
    if search.closed:
        shown.says(f"The last one expanded had {told(search.closed[-1])}.")

    picture = shown.picture()
    assert nodes_of(picture, r="19") == set(search.open)
    assert nodes_of(picture, r="8") == set(search.closed)
    (path,) = picture.of("polyline", stroke=BLUE)
    drawn = [[float(n) for n in place.split(",")] for place in path["points"].split()]
    exact = [[4 + 9 * x, 4 + 9 * (40 - y)] for x, y in search.path()]
    np.testing.assert_allclose(drawn, exact, atol=1e-6)
    acts = [act for act, _, _ in shown.steps()]
    if acts == ["Run to the end"] and rule == "F":
        made = plan_on_grid(small_map(), margin=2.0, cell=5.0, record=True)
        expanded_points = [search.points[k] for k in search.closed]
        np.testing.assert_allclose(expanded_points, made.visited, atol=1e-9)
        assert abs(nodes[search.target].G - made.length) < 1e-9


@cache
def planned(margin: float, caution: float) -> tuple[Plan, float]:
    """The expert's path in the map of the page, and how near it comes to anything."""
    world = random_worlds(1, obstacles=15, seed=21)
    made = plan(world, margin=margin, caution=caution, cell=2)
    along = world[np.zeros(len(made.points), dtype=int)]
    return made, float(clearance(along, made.points).min())


@expects(choose("caution (extra cost near obstacles)", "2"), slide("margin", 0.6))
def margin_and_caution(shown: Shown) -> None:
    margin = shown.number("margin")
    caution = shown.number("caution (extra cost near obstacles)")
    (shortest, _), (mine, nearest) = planned(1.0, 0), planned(margin, caution)
    longer = 100 * (mine.length / shortest.length - 1)
    shown.says(
        f"Length: {mine.length} m, the shortest of all settings."
        if (margin, caution) == (1, 0)
        else f"Length: {mine.length} m, which is {longer} % more than {shortest.length} m.",
        f"Nearest to anything: {nearest} m.",
    )
    drawn = shown.map(100.0)
    drawn.has_line(VERMILION, shortest.points.round(2))
    drawn.has_line(BLUE, mine.points.round(2))


@expects(choose("what is counted", "balanced accuracy"))
def accuracy_and_success(shown: Shown) -> None:
    given, measure = shown.given, shown.chosen("what is counted")
    counts, safe = np.array(given["counts"]), given["safe"]
    counted = shown.share("safe steps that count") * safe
    actions = np.repeat(np.arange(5), counts)
    shares = []
    for policy in given["policies"]:
        predicted = np.concatenate(
            [
                np.repeat([action, (action + 1) % 5], [right, count - right])
                for action, (right, count) in enumerate(
                    zip(policy["right"], counts, strict=True)
                )
            ]
        )
        agreed = nirl.accuracy(predicted, actions) * len(actions)
        shares.append(
            {
                "accuracy": (agreed + counted) / (len(actions) + counted),
                "balanced accuracy": nirl.balanced_accuracy(predicted, actions),
                "success in new maps": policy["success"],
            }[measure]
        )
        shown.picture().says(f"{policy['name']}: {100 * shares[-1]} %")
    bars = [float(bar["width"]) for bar in shown.picture().of("rect")]
    widths = shown.picture().x(np.multiply(shares, 100)) - shown.picture().x(0)
    np.testing.assert_allclose(bars, widths, atol=1e-6)
    near = f"Counted: {len(actions)} steps near obstacles"
    shown.says(
        {
            "accuracy": f"{near}, and {counted} of {safe} safe steps"
            if counted
            else f"{near}. In {counts[0]} of them the expert goes straight on.",
            "balanced accuracy": "the mean of the accuracies for the five actions.",
            "success in new maps": f"how many of {given['maps']} new maps are reached.",
        }[measure]
    )


def wilson(share: float, maps: int) -> tuple[int, float, float]:
    """How many maps are reached, and the limits of Wilson's interval in per cent."""
    reached = math.floor(share * maps + 0.5)
    interval = binomtest(reached, maps).proportion_ci(method="wilson")
    return reached, 100 * interval.low, 100 * interval.high


@expects(choose("new maps", "100"), slide("reached", 0.7))
def wilson_interval(shown: Shown) -> None:
    maps, share = int(shown.chosen("new maps")), shown.share("reached")
    reached, low, high = wilson(share, maps)
    shown.says(
        f"{reached} of {maps} maps reached.",
        f"95 % interval of the true rate: {low} % to {high} %, which is {high - low} points wide.",
    )
    chart = shown.picture()
    for line, count in zip(
        chart.of("line"), (8, 20, 50, 100, 200, 500, 1000), strict=True
    ):
        limits = chart.x(wilson(share, count)[1:])
        np.testing.assert_allclose(
            [float(line["x1"]), float(line["x2"])], limits, atol=1e-6
        )


def expected_errors(error: float, off: float, back: float) -> np.ndarray:
    """Expected errors in 0 to 200 decisions: of a chain with two states, on the expert's path and off it."""
    returns = (1 - off) * back
    chain = np.array([[1 - error, error], [returns, 1 - returns]])
    where, sums = np.array([1.0, 0.0]), [0.0]
    for _ in range(200):
        sums.append(sums[-1] + where @ [error, off])
        where = where @ chain
    return np.array(sums)


@expects(by_keyboard=[slide_all])
def compounding_errors(shown: Shown) -> None:
    error = shown.share("errs on the expert's path")
    off, back = (
        shown.share("errs off the path"),
        shown.share("a right decision leads back"),
    )
    decisions = int(shown.number("decisions"))
    cloned, even = (
        expected_errors(error, off, back),
        expected_errors(error, error, back),
    )
    shown.says(
        f"In {decisions} decisions: {cloned[decisions]} errors expected.",
        f"If it erred in {100 * error} % of its decisions in all states: {even[decisions]}.",
    )
    for colour, series in ((BLUE, cloned), (GREEN, even)):
        points = np.column_stack([np.arange(201), series])
        shown.picture().has_curve(colour, points[series <= 100])


ENCODINGS = {
    "1 to 9": "number",
    "−4 to 4": "signed",
    "one-hot": "one-hot",
    "sine and cosine": "sine-cosine",
}


@expects(
    choose("encoding", "sine and cosine"),
    press("Move on by one sector"),
    choose("encoding", "one-hot"),
    slide("the target is in sector", 1.0),
    choose("encoding", "−4 to 4"),
)
def target_encoding(shown: Shown) -> None:
    encode = TARGET_ENCODINGS[ENCODINGS[shown.chosen("encoding")]]
    inputs = encode(np.arange(1, 10)).reshape(9, -1)
    jumps = np.linalg.norm(np.roll(inputs, -1, axis=0) - inputs, axis=1)
    sector = int(shown.number("the target is in sector"))
    after = sector % 9 + 1
    for each in (sector, after):
        numbers = ", ".join(map(str, inputs[each - 1]))
        shown.says(f"Inputs for sector {each}: {numbers}.")
    shown.says(
        f"They are {jumps[sector - 1]} apart. "
        f"The largest jump between neighbours is {jumps.max()}."
    )
    dial, chart = shown.picture(), shown.picture(1)
    wedges = [wedge["fill"] for wedge in dial.of("path")[:9]]
    assert wedges == [ORANGE if k == sector else SKY for k in range(1, 10)]
    chart.has_bars(ORANGE, [jumps[sector - 1]])
    chart.has_bars(BLUE, np.delete(jumps, sector - 1))
