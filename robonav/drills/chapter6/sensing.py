"""Drills of the page on richer sensing."""

from __future__ import annotations

import math

import numpy as np

from robonav.sensing import circular_convolution, weights_of_layers

from ..question import Number, Question, Table
from ..registry import drill

Rng = np.random.Generator
PAGE = "sensing"


@drill(PAGE, "The edge of a circle")
def edge_of_a_circle(rng: Rng) -> Question:
    """Compute the angle at which a robot sees the near edge of a circle."""
    while True:
        ahead, left = int(rng.integers(4, 9)), int(rng.integers(2, 7))
        radius = float(rng.integers(10, 31)) / 10
        distance = math.hypot(ahead, left)
        if radius + 1 < distance < 10 and left > radius:
            break
    middle, half = math.atan2(left, ahead), math.asin(radius / distance)
    answer = math.degrees(middle - half)
    return Question(
        f"The middle of a circle with a radius of {radius:g} m is {ahead} m ahead of the robot and {left} m to its "
        "left. At which angle to its heading does the robot see the edge of the circle that is nearer to its "
        "heading, in degrees?",
        Number(
            answer,
            tolerance=0.06,
            unit="°",
            wrong={
                "This is the angle of the middle of the circle.": math.degrees(middle),
                "This is the other edge.": math.degrees(middle + half),
                "The line of sight touches the circle, so the radius is the opposite leg and the distance of the "
                "middle is the hypotenuse.": math.degrees(
                    middle - math.atan(radius / distance)
                ),
            },
        ),
        f"The middle is {distance:.4g} m away, at $\\arctan({left} / {ahead}) = {math.degrees(middle):.4g}°$. The "
        f"circle covers $\\arcsin({radius:g} / {distance:.4g}) = {math.degrees(half):.4g}°$ to either side, so the "
        f"edge is at ${answer:.3g}°$.",
    )


@drill(PAGE, "Where the last sector ends, the first begins")
def around_a_ring(rng: Rng) -> Question:
    """Convolve a ring of sectors where the window goes round its end."""
    while True:
        x = rng.integers(0, 6, 6)
        w = rng.integers(-2, 4, 3)
        first, last = circular_convolution(
            x[None].astype(float), w[None, None].astype(float), np.zeros(1)
        )[0][[0, 5]]
        cut = w[1] * x[0] + w[2] * x[1], w[0] * x[4] + w[1] * x[5]
        turned = (
            w[2] * x[5] + w[1] * x[0] + w[0] * x[1],
            w[2] * x[4] + w[1] * x[5] + w[0] * x[0],
        )
        if len({(first, last), cut, turned}) == 3:
            break
    numbers, window = (", ".join(str(n) for n in row) for row in (x, w))
    return Question(
        f"A ring of six sectors reads $x = ({numbers})$, beginning with sector 0. A window has the weights "
        f"$w = ({window})$, of which the middle one is for the sector itself and the first for the sector before it. "
        "The bias is 0. What does the convolution around the ring give for sector 0 and for sector 5?",
        Table(
            rows=("$y$",),
            columns=("sector 0", "sector 5"),
            answer=[[float(first), float(last)]],
            wrong={
                "Beyond the end of a ring comes its beginning, not 0.": [
                    [float(n) for n in cut]
                ],
                "The first weight is for the sector before, the last one for the sector after.": [
                    [float(n) for n in turned]
                ],
            },
        ),
        f"$y_0 = w_0 x_5 + w_1 x_0 + w_2 x_1 = {first:g}$ and $y_5 = w_0 x_4 + w_1 x_5 + w_2 x_0 = {last:g}$.",
    )


@drill(PAGE, "How many weights has each layer?")
def numbers_of_weights(rng: Rng) -> Question:
    """Count the weights of a fully connected layer and of a convolutional one."""
    sectors = int(rng.choice([18, 24, 36, 48, 72]))
    units = int(rng.choice([8, 10, 16, 20, 32]))
    channels, window = int(rng.choice([4, 6, 8, 12])), int(rng.choice([3, 5, 7]))
    counted = weights_of_layers((sectors,), units, channels, window)
    full, convolutional = counted["fully connected"], counted["convolutional"]
    return Question(
        f"A ring has {sectors} sectors, with one number each. One layer is fully connected and has {units} units. "
        f"Another one is convolutional and has {channels} windows, each {window} sectors wide. Units and windows have "
        "a bias. How many weights and biases does each layer have?",
        Table(
            rows=("numbers",),
            columns=("fully connected", "convolutional"),
            answer=[[float(full), float(convolutional)]],
            wrong={
                "Each unit and each window also has a bias.": [
                    [float(sectors * units), float(channels * window)]
                ],
                "A window has the same weights at all sectors.": [
                    [float(full), float(sectors * channels * (window + 1))]
                ],
            },
        ),
        f"${units} \\cdot ({sectors} + 1) = {full}$ and ${channels} \\cdot ({window} + 1) = {convolutional}$. The "
        "second number does not depend on the number of sectors.",
    )


@drill(PAGE, "How far does a unit see?")
def cells_that_a_unit_sees(rng: Rng) -> Question:
    """Compute the receptive field of a unit after some convolutional layers."""
    cells, seen = 0, 1
    while seen > cells:  # a unit sees a part of the picture
        layers, stride = int(rng.integers(2, 5)), int(rng.integers(1, 4))
        window = int(rng.choice([3, 5, 7]))
        cells = int(rng.choice([24, 32, 40, 48, 64, 80, 96, 128]))
        seen = 1 + sum((window - 1) * stride**k for k in range(layers))
    width = float(rng.choice([0.25, 0.5, 1.0]))
    answer = seen * width
    return Question(
        f"A network has {layers} convolutional layers, one after the other. Each has windows of "
        f"${window} \\times {window}$ cells, and a stride of {stride}. A cell of the picture, which has "
        f"${cells} \\times {cells}$ of them, is {width:g} m wide. If the edges of the picture are left aside, how wide "
        "is the part of the picture on which a unit of the last layer depends, in metres?",
        Number(
            answer,
            unit="m",
            wrong={
                "This is what a unit of the first layer sees.": window * width,
                "This is the number of cells. How wide are they?": float(seen),
                "Windows of neighbouring units overlap.": window**layers * width,
            },
        ),
        f"$1 + {window - 1} \\cdot ({' + '.join(str(stride**k) for k in range(layers))}) = {seen}$ cells, which are "
        f"{answer:g} m wide.",
    )


@drill(PAGE, "What does randomising cost, and bring?")
def price_of_randomising(rng: Rng) -> Question:
    """Compare two trainings in two worlds."""
    plain_clean = float(rng.integers(930, 996)) / 10
    plain_noisy = plain_clean - float(rng.integers(30, 300)) / 10
    random_clean = plain_clean - float(rng.integers(1, 30)) / 10
    random_noisy = plain_noisy + float(rng.integers(10, 30)) / 10
    cost = plain_clean - random_clean
    avoided = (random_noisy - plain_noisy) / (100 - plain_noisy)
    return Question(
        f"A policy that was trained in an exact world arrives in {plain_clean:.1f} % of the exact worlds and in "
        f"{plain_noisy:.1f} % of the noisy ones. After training in randomised worlds it is {random_clean:.1f} % and "
        f"{random_noisy:.1f} %. How many points of success does randomising cost in the exact worlds, and which share "
        "of the failures in the noisy ones does it avoid, in per cent?",
        Table(
            rows=("randomising",),
            columns=("cost in points", "failures avoided in %"),
            answer=[[cost, 100 * avoided]],
            tolerance=0.06,
            wrong={
                "A share of the failures is asked for: divide by the failures of the first policy.": [
                    [cost, random_noisy - plain_noisy]
                ],
                "Divide by the failures, not by the successes.": [
                    [cost, 100 * (random_noisy - plain_noisy) / plain_noisy]
                ],
            },
        ),
        f"It costs ${plain_clean:.1f} - {random_clean:.1f} = {cost:.1f}$ points. Of the {100 - plain_noisy:.1f} % that "
        f"failed, {100 - random_noisy:.1f} % are left: {100 * avoided:.3g} % are avoided.",
    )
