"""The planners against exhaustive search and against shapely, an independent geometry library."""

import itertools
import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from shapely import LineString, Point, box
from shapely.affinity import rotate

from robonav.lfd import plan, plan_on_grid
from robonav.lfd.astar import grid_astar, modified_astar
from robonav.robot import ARRIVAL_DISTANCE, Simulator, make_world, random_worlds

TURNS = np.radians([0, 30, 60, -30, -60])


def shapes_of(world):
    """Obstacles of one world as shapely's shapes."""
    shapes = []
    for kind, (x, y), (a, b, turned) in zip(
        world.kinds[0], world.centres[0], world.shapes[0], strict=True
    ):
        if kind == 1:
            shapes.append(Point(x, y).buffer(a, quad_segs=256))
        elif kind == 2:
            shapes.append(
                rotate(box(x - a, y - b, x + a, y + b), turned, use_radians=True)
            )
    return shapes


def clearance(world, points):
    path = LineString(points)
    inside = box(0, 0, world.size, world.size)
    assert inside.contains(path)
    return min(
        [path.distance(shape) for shape in shapes_of(world)]
        + [path.distance(inside.exterior)]
    )


@pytest.mark.parametrize(("margin", "caution"), [(1.0, 0.0), (2.0, 0.0), (2.0, 2.0)])
def test_plan_keeps_its_margin_and_reports_its_length(margin, caution):
    for world in random_worlds(20, 15, seed=3):
        made = plan(world, margin=margin, caution=caution)
        assert made.found
        assert (
            clearance(world, made.points) >= margin - 1e-3
        )  # shapely's circles are polygons
        assert made.length == pytest.approx(
            np.linalg.norm(np.diff(made.points, axis=0), axis=1).sum()
        )
        assert np.linalg.norm(made.points[-1] - world.targets[0]) <= ARRIVAL_DISTANCE
        assert made.points[0] == pytest.approx(world.starts[0])
        turned = (made.headings - world.start_poses[0, 2]) / np.radians(30)
        assert np.allclose(turned, np.rint(turned))
        assert np.abs(made.headings).max() <= np.pi


def test_plan_is_what_the_robot_does():
    world = random_worlds(1, 20, seed=8)
    made = plan(world, speed=1.5)
    robot = Simulator(world, speed=1.5)
    for k, action in enumerate(made.actions):
        assert robot.poses[0] == pytest.approx(
            np.array([*made.points[k], made.headings[k]]), abs=1e-9
        )
        assert robot.outcome[0] == 0
        robot.step(np.array([action]))
    assert robot.outcome[0] == 1


def least_cost(world, speed, margin, depth, caution=0.0):
    """Least cost of all sequences of actions: length with caution, plus the distance left at arrival."""
    least = math.inf
    shapes = shapes_of(world)
    border = box(0, 0, world.size, world.size)

    def go(x, y, heading, done, cost):
        nonlocal least
        rest = math.hypot(world.targets[0, 0] - x, world.targets[0, 1] - y)
        if rest <= ARRIVAL_DISTANCE:
            least = min(least, cost + rest)
            return
        if (
            done == depth or cost + rest >= least
        ):  # no way on is shorter than the straight one
            return
        for turn in TURNS:
            angle = heading + turn
            x1, y1 = x + speed * math.cos(angle), y + speed * math.sin(angle)
            step = LineString([(x, y), (x1, y1)])
            if not border.contains(step):
                continue
            end = Point(x1, y1)
            clear = min(
                [step.distance(s) for s in shapes] + [step.distance(border.exterior)]
            )
            if clear < margin:
                continue
            if caution and clear >= margin + speed:
                clear = min(
                    [end.distance(s) for s in shapes] + [end.distance(border.exterior)]
                )
            price = 1 + caution * max(0.0, (10 - clear) / (10 - margin)) ** 2
            go(x1, y1, angle, done + 1, cost + speed * price)

    go(*world.start_poses[0], 0, 0.0)
    return least


@pytest.mark.parametrize(
    "rectangle",
    [
        (10.2, 10.1, 2.0, 1.5, 30.0),
        (9.5, 10.6, 3.0, 1.0, -50.0),
        (10.8, 9.6, 1.0, 4.0, 45.0),
        (11.0, 10.0, 5.0, 2.0, 0.0),
    ],
)
def test_plan_is_optimal_where_cells_tell_all_poses_apart(rectangle):
    world = make_world(
        rectangles=[rectangle], start=(6.0, 6.2), target=(14.0, 13.8), size=20
    )
    made = plan(world, speed=2.0, margin=1.0, cell=0.05)
    rest = np.linalg.norm(made.points[-1] - world.targets[0])
    assert made.found
    assert made.length + rest == pytest.approx(
        least_cost(world, 2.0, 1.0, depth=len(made.actions)), abs=1e-6
    )


@pytest.mark.parametrize(
    "rectangle",
    [
        (16.4, 12.6, 8.6, 4.6, -71.0),
        (15.6, 11.1, 7.4, 8.8, 16.2),
        (18.1, 17.3, 5.9, 3.6, 10.4),
    ],
)
def test_plan_is_optimal_where_a_greedy_search_is_not(rectangle):
    """Maps in which a search with 1.5 times the heuristic finds a longer path."""
    world = make_world(
        rectangles=[rectangle], start=(6.0, 6.2), target=(24.0, 23.8), size=30
    )
    made = plan(world, speed=3.0, margin=1.0, cell=0.06)
    rest = np.linalg.norm(made.points[-1] - world.targets[0])
    assert made.length + rest == pytest.approx(
        least_cost(world, 3.0, 1.0, depth=len(made.actions) + 1), abs=1e-6
    )


def test_no_shorter_way_than_a_plan_of_few_steps():
    """Nothing of one step less does: exhaustive search over shorter sequences finds no arrival at all, or a dearer."""
    world = make_world(
        circles=[(10.0, 9.9, 1.2)], start=(6.0, 6.0), target=(14.0, 14.0), size=20
    )
    made = plan(world, speed=2.5, margin=1.0, cell=0.05)
    cost = made.length + np.linalg.norm(made.points[-1] - world.targets[0])
    assert least_cost(world, 2.5, 1.0, depth=len(made.actions) + 1) == pytest.approx(
        cost, abs=1e-3
    )


@pytest.mark.slow
def test_grid_plan_is_a_shortest_path_of_the_grid():
    target, margin = (30.5, 31.2), 2.0
    points = np.array(list(itertools.product(range(2, 39), repeat=2)))
    pairs = np.argwhere(np.triu(np.abs(points[:, None] - points).max(axis=2) == 1))
    steps = shapely.linestrings(points[pairs])
    for world in random_worlds(
        5, 12, seed=21, size=40, starts=((10, 10),), targets=(target,)
    ):
        free = shapely.distance(steps, shapely.union_all(shapes_of(world))) >= margin
        edges = pairs[free]
        graph = coo_array(
            (shapely.length(steps[free]), edges.T), shape=(len(points),) * 2
        )
        lengths = dijkstra(
            graph, directed=False, indices=np.flatnonzero((points == 10).all(axis=1))[0]
        )
        rest = np.linalg.norm(points - target, axis=1)
        made = plan_on_grid(world, margin=margin)
        assert made.length + math.dist(made.points[-1], target) == pytest.approx(
            (lengths + rest)[rest <= ARRIVAL_DISTANCE].min(), abs=1e-9
        )
        assert clearance(world, made.points) >= margin - 1e-3


def test_no_path_is_a_result():
    walls = [(50, 50, 6, 96, 0)]
    world = make_world(rectangles=walls)
    made, on_grid = plan(world), plan_on_grid(world)
    assert not made.found
    assert not on_grid.found
    assert len(made.actions) == 0
    assert made.points.tolist() == on_grid.points.tolist() == [[10, 10]]
    assert made.expanded > 1000
    assert not plan(random_worlds(1, 0, seed=1), limit=10).found


def test_visited_nodes_are_those_expanded():
    world = random_worlds(1, 10, seed=5)
    made, on_grid = plan(world, record=True), plan_on_grid(world, record=True)
    assert made.visited.shape == (made.expanded, 3)
    assert on_grid.visited.shape == (on_grid.expanded, 2)
    assert made.visited[0] == pytest.approx(world.start_poses[0])
    assert made.visited[-1, :2] == pytest.approx(made.points[-1])
    assert on_grid.visited[-1] == pytest.approx(on_grid.points[-1])
    assert plan(world).visited is None


def test_caution_keeps_plans_away_from_obstacles():
    worlds = random_worlds(20, 10, seed=4)
    near = [clearance(w, plan(w).points) for w in worlds]
    far = [clearance(w, plan(w, caution=2.0).points) for w in worlds]
    assert np.mean(far) > np.mean(near) + 1


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.5, 4.0), st.floats(1.0, 3.0))
def test_any_plan_arrives_clear(seed, speed, margin):
    world = random_worlds(1, 10, seed=seed)
    made = plan(world, speed=speed, margin=margin)
    if made.found:
        assert clearance(world, made.points) >= margin - 1e-3
        assert len(made.points) == len(made.headings) == len(made.actions) + 1


@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [
        ("margin", 0, "margin must be greater than 0"),
        ("margin", 51, "margin must be greater than 0 and at most 50"),
        ("speed", 0, "speed must be greater than 0"),
        ("speed", math.nan, "speed must be finite"),
        ("caution", -1, "caution must be at least 0"),
        ("cell", 0, "cell must be at least 0.2"),
        ("cell", 1e9, "cell must be at least 0.2 and at most 100"),
        ("limit", 0, "limit must be at least 1"),
        ("pose", (1, 2), "pose must have shape"),
        (
            "pose",
            (-1, 2, 0),
            r"pose must lie in the map, 0 to 100 m, got \(-1.0, 2.0\)",
        ),
    ],
)
def test_wrong_arguments_get_a_sentence(argument, value, message):
    with pytest.raises(ValueError, match=message):
        plan(random_worlds(1, 2, seed=1), **{argument: value})


@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [
        ("cell", 0, "cell must be at least 0.2"),
        ("cell", -1, "cell must be at least 0.2"),
        ("cell", math.nan, "cell must be finite"),
        ("margin", 51, "margin must be greater than 0 and at most 50"),
        ("start", (1, 2, 0), "start must have shape"),
        ("start", (1, 200), "start must lie in the map"),
    ],
)
def test_wrong_arguments_of_the_grid_get_a_sentence(argument, value, message):
    with pytest.raises(ValueError, match=message):
        plan_on_grid(random_worlds(1, 2, seed=1), **{argument: value})


@pytest.mark.parametrize("planner", [plan, plan_on_grid])
def test_one_world_at_a_time(planner):
    with pytest.raises(ValueError, match="world must be one world, got a batch of 2"):
        planner(random_worlds(2, 2, seed=1))
    with pytest.raises(TypeError, match="world must be Worlds, got str"):
        planner("x")


@pytest.mark.parametrize(
    ("speed", "margin", "caution", "cell"),
    [
        (2.0, 2.0, 0.0, 1.0),
        (2.0, 3.0, 2.0, 2.0),
        pytest.param(1.5, 1.0, 0.5, 0.7, marks=pytest.mark.slow),
    ],
)
def test_readable_and_compiled_modified_astar(speed, margin, caution, cell):
    for world in random_worlds(4, 15, seed=9):
        settings = {"speed": speed, "margin": margin, "caution": caution, "cell": cell}
        made = plan(world, **settings)
        found, path, expanded = modified_astar(
            world, world.start_poses[0], limit=200_000, **settings
        )
        assert (found, expanded) == (made.found, made.expanded)
        assert np.array_equal([node.point for node in path], made.points)
        assert [node.action for node in path] == [-1, *made.actions]
        turns = np.array([node.index[2] for node in path])
        turned = made.headings - world.start_poses[0, 2] - np.radians(30) * turns
        assert np.allclose(np.cos(turned), 1)


@pytest.mark.parametrize("cell", [1.0, 0.7])
def test_readable_and_compiled_astar_on_a_grid(cell):
    for world in random_worlds(4, 15, seed=9):
        made = plan_on_grid(world, cell=cell)
        start = world.starts[0]
        found, path, expanded = grid_astar(world, start, margin=2.0, cell=cell)
        assert (found, expanded) == (made.found, made.expanded)
        assert np.array_equal([node.point for node in path], made.points)


@pytest.mark.parametrize("cell", [3.2, 3.0, 0.6, 0.2])
def test_a_grid_begins_where_the_robot_starts(cell):
    """48 / 3.2 is 15, and 48 % 3.2 is 3.2 all but a rounding error: the path began behind the wall."""
    wall = make_world(rectangles=[(50, 50, 0.5, 100, 0)], target=(90.0, 90.0))
    for start in ([48.0, 12.0], [36.0, 48.0], [0.6, 99.6], [48.0, 96.0]):
        blocked = plan_on_grid(wall, cell=cell, margin=0.1, start=start)
        assert not blocked.found
        np.testing.assert_allclose(blocked.points, [start], atol=1e-9)
        free = plan_on_grid(make_world(), cell=cell, margin=0.1, start=start)
        assert free.found
        np.testing.assert_allclose(free.points[0], start, atol=1e-9)


@pytest.mark.parametrize("cell", [0.2, 0.7, 3.2])
def test_a_start_on_the_last_line_of_the_grid_has_no_way(cell):
    for start in ([100.0, 100.0], [100.0, 50.0], [50.0, 100.0]):
        assert not plan_on_grid(make_world(), cell=cell, start=start).found


def test_readable_searches_without_a_path():
    world = make_world(rectangles=[(50, 50, 6, 96, 0)])
    pose = world.start_poses[0]
    found, path, expanded = modified_astar(
        world, pose, speed=2.0, margin=2.0, caution=0.0, cell=1.0, limit=300
    )
    assert (found, len(path), expanded) == (False, 1, 300)
    assert expanded == plan(world, limit=300).expanded
    assert len(grid_astar(world, pose[:2], margin=2.0, cell=1.0)[1]) == 1


@pytest.mark.parametrize("speed", [0.5, 0.3, 0.1, 0.01])
@pytest.mark.parametrize("cell", [None, 1.0])
def test_steps_shorter_than_a_cell(speed, cell):
    """Poses of one heading in one cell are one node, so that a step which stays in its cell would lead nowhere."""
    empty = random_worlds(1, 0, seed=1)
    made = plan(empty, speed=speed, cell=cell)
    assert made.found
    assert made.length == pytest.approx(speed * len(made.actions))
    assert 1 < made.length < 1.01 * np.linalg.norm(empty.starts[0] - empty.targets[0])


def test_slow_robots_find_their_way_between_obstacles():
    for world in random_worlds(10, 15, seed=3):
        made = plan(world, speed=0.1)
        assert made.found
        assert clearance(world, made.points) >= 2.0 - 1e-3


def test_plan_of_a_slow_robot_is_what_it_does():
    world = random_worlds(1, 20, seed=8)
    made = plan(world, speed=0.15)
    robot = Simulator(world, speed=0.15)
    for k, action in enumerate(made.actions):
        pose = np.array([*made.points[k], made.headings[k]])
        assert robot.poses[0] == pytest.approx(pose, abs=1e-9)
        assert robot.outcome[0] == 0
        robot.step(np.array([action]))
    assert robot.outcome[0] == 1


def test_cells_larger_than_a_move_are_named_where_no_path_is_found():
    with pytest.warns(UserWarning, match="cell should be at most 1"):
        assert not plan(random_worlds(1, 0, seed=1), speed=0.1, cell=5.0).found
    with pytest.raises(ValueError, match=r"speed must be at least 0\.001"):
        plan(random_worlds(1, 0, seed=1), speed=1e-9)


def test_algorithm_4_names_cells_larger_than_a_step_where_it_finds_no_path():
    world = random_worlds(1, 0, seed=1)
    with pytest.warns(
        UserWarning, match=r"modified_astar .* cell should be at most 0\.1"
    ):
        found, *_ = modified_astar(
            world, world.start_poses[0], speed=0.1, margin=2.0, caution=0.0, cell=1.0, limit=1000
        )  # fmt: skip
    assert not found


def test_smallest_cells():
    small = make_world(start=(5, 5), target=(15, 15), size=20)
    assert plan(small, speed=0.1, cell=0.1).found
    assert plan(random_worlds(1, 0, seed=1), speed=0.1, cell=0.2).found
