"""Backup diagrams show what an update looks at."""

import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from robonav.plots.backups import BACKUPS, draw_backup


def drawn(name):
    """The numbers of nodes, branches and arcs in the diagram of an update."""
    axes = Figure().add_subplot()
    draw_backup(axes, name)
    nodes = [line for line in axes.lines if len(line.get_xdata()) == 1]
    arcs = [patch for patch in axes.patches if isinstance(patch, Arc)]
    return len(nodes), len(axes.lines) - len(nodes), len(arcs)


@pytest.mark.parametrize(
    ("name", "nodes", "branches", "arcs"),
    [
        ("V", 10, 9, 0),
        ("V*", 10, 9, 1),
        ("Q", 9, 8, 0),
        ("Q*", 9, 8, 2),
        ("Monte Carlo", 5, 4, 0),
        ("TD(0)", 3, 2, 0),
        ("SARSA", 3, 2, 0),
        ("expected SARSA", 5, 4, 0),
        ("Q-learning", 5, 4, 1),
    ],
)
def test_a_diagram_has_the_nodes_branches_and_maxima_of_its_update(
    name, nodes, branches, arcs
):
    assert drawn(name) == (nodes, branches, arcs)


def test_every_level_has_a_label_and_branches():
    for backup in BACKUPS.values():
        assert len(backup.labels) == len(backup.levels) == len(backup.branches) + 1


def test_unknown_update():
    with pytest.raises(ValueError, match="name"):
        draw_backup(Figure().add_subplot(), "TD(1)")
