"""The model of the robot's body, and MuJoCo models of one robot in one world."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

import mujoco
import numpy as np

from robonav.robot import Worlds
from robonav.robot._fast import CIRCLE, NOTHING
from robonav.validation import check_integer, check_positive, check_real

HEIGHT = 1.0  # m of everything that stands on the floor
IN_SIGHT = 3  # the group of geoms that the range finders see
COLOUR = [0.5, 0.5, 0.5, 1.0]


@dataclass(frozen=True)
class Body:
    """What differs from one robot, and from one floor, to another.

    Attributes
    ----------
    friction : float
        Between wheels and floor, in the direction in which a wheel rolls. Rubber has 0.9 on a dry floor, and 0.3 on a
        wet one.
    torque : float
        The most that a motor gives, in N m.
    delay : int
        After how many twentieths of a second the motors get what the control tells them.
    noise : float
        Standard deviation in metres of an error on every range that sees something.

    Raises
    ------
    ValueError
        If friction or torque is not positive, or delay or noise is negative.

    Examples
    --------
    >>> from robonav.body import Body
    >>> Body(friction=0.3)
    Body(friction=0.3, torque=20.0, delay=1, noise=0.0)
    """

    friction: float = 0.9
    torque: float = 20.0
    delay: int = 1
    noise: float = 0.0

    def __post_init__(self) -> None:
        check_positive("friction", self.friction)
        check_positive("torque", self.torque)
        check_integer("delay", self.delay, at_least=0, at_most=20)
        check_real("noise", self.noise, at_least=0)


def model_file() -> str:
    """Return the text of the robot's model, an MJCF file that MuJoCo's viewer also opens.

    Returns
    -------
    str

    Examples
    --------
    >>> from robonav.body import model_file
    >>> "<mujoco" in model_file()
    True
    """
    return (files("robonav.body") / "robot.xml").read_text(encoding="utf-8")


def build(worlds: Worlds, body: Body) -> mujoco.MjModel:
    """Return the model of the robot in the first world of a batch.

    Obstacles are bodies that only the simulation moves: the first is obstacle 0, and an empty slot has no body.

    Parameters
    ----------
    worlds : Worlds
        A batch of one.
    body : Body
        The robot's.

    Returns
    -------
    mujoco.MjModel

    Examples
    --------
    >>> from robonav.body import Body, build
    >>> from robonav.robot import random_worlds
    >>> model = build(random_worlds(1, obstacles=20, seed=1), Body())
    >>> model.nmocap, model.nu
    (20, 3)
    """
    spec = mujoco.MjSpec.from_string(model_file())
    half = worlds.size / 2
    for k, (x, y) in enumerate([(0, -1), (1, 0), (0, 1), (-1, 0)]):
        spec.worldbody.add_geom(
            name=f"border{k}", type=mujoco.mjtGeom.mjGEOM_BOX, group=IN_SIGHT, rgba=COLOUR,
            pos=[half + x * (half + 0.5), half + y * (half + 0.5), HEIGHT / 2],
            size=[0.5 if x else half + 1, 0.5 if y else half + 1, HEIGHT / 2],
        )  # fmt: skip
    for kind, shape, centre in zip(
        worlds.kinds[0], worlds.shapes[0], worlds.centres[0], strict=True
    ):
        if kind != NOTHING:
            _add_obstacle(spec, kind, shape, centre)
    model = spec.compile()
    model.pair_friction[:, 1] = body.friction
    model.actuator_forcerange[:] = [-body.torque, body.torque]
    return model


def _add_obstacle(
    spec: mujoco.MjSpec, kind: int, shape: np.ndarray, centre: np.ndarray
) -> None:
    """Add a circle as a pillar, or a rectangle as a block."""
    place = spec.worldbody.add_body(
        mocap=True,
        pos=[*centre, HEIGHT / 2],
        quat=[np.cos(shape[2] / 2), 0, 0, np.sin(shape[2] / 2)],
    )
    if kind == CIRCLE:
        form, size = mujoco.mjtGeom.mjGEOM_CYLINDER, [shape[0], HEIGHT / 2, 0]
    else:
        form, size = mujoco.mjtGeom.mjGEOM_BOX, [shape[0], shape[1], HEIGHT / 2]
    place.add_geom(type=form, size=size, group=IN_SIGHT, rgba=COLOUR)
