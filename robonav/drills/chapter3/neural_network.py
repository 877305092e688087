"""Drills of the page on the neural network."""

from __future__ import annotations

import numpy as np

from robonav import networks

from ..question import Number, Order, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator


def _halves(rng: Rng, size: int) -> np.ndarray:
    """Weights that are easy to multiply by hand, none of them 0."""
    return rng.choice([-2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0], size=size)


@drill("neural-network", "The output of one neuron")
def one_neuron(rng: Rng) -> Question:
    """Compute the activation of a sigmoid unit."""
    weights, bias = _halves(rng, 2), float(_halves(rng, 1)[0])
    x = rng.choice([-1.0, 0.5, 1.0, 2.0], size=2)
    neuron = networks.Network((weights[None],), (np.array([bias]),))
    output, z = float(neuron.forward(x)[0]), float(neuron.logits(x)[0])
    return Question(
        f"A sigmoid unit has the weights ${weights[0]:g}$ and ${weights[1]:g}$ and the bias ${bias:g}$. "
        f"What is its output for the inputs ${x[0]:g}$ and ${x[1]:g}$?",
        Number(
            output,
            wrong={
                "This is the weighted sum $z$. The output is its sigmoid.": z,
                "The bias is missing.": float(networks.sigmoid(np.array(z - bias))),
                "The exponent has the wrong sign: the sigmoid is $1 / (1 + e^{-z})$.": 1
                - output,
                "This is the slope of the sigmoid at $z$.": output * (1 - output),
            },
        ),
        f"$z = {weights[0]:g} \\cdot {x[0]:g} {sign(weights[1])} \\cdot {x[1]:g} {sign(bias)} = {z:g}$, and "
        f"$1 / (1 + e^{{{-z:g}}}) = {output:.4g}$.",
    )


@drill("neural-network", "The error of an output unit")
def output_errors(rng: Rng) -> Question:
    """Compute output errors under two costs."""
    output, label = float(rng.choice([0.2, 0.3, 0.6, 0.7, 0.9])), int(rng.integers(2))
    entropy = output - label
    squared = entropy * float(networks.sigmoid_slope(np.array(output)))
    return Question(
        f"A sigmoid output unit has the activation ${output:g}$, and its label is ${label}$. "
        "What is its error $\\delta$ under each cost? Give three decimals.",
        Table(
            ["squared error", "cross-entropy"],
            ["delta"],
            [[squared], [entropy]],
            tolerance=0.0011,
            wrong={
                "The error is output minus label.": [[-squared], [-entropy]],
                "The two are exchanged: only the squared error has the slope of the sigmoid.": [
                    [entropy],
                    [squared],
                ],
                "Under the cross-entropy the slope of the sigmoid cancels.": [
                    [squared],
                    [squared],
                ],
                "Under the squared error the slope of the sigmoid, $a (1 - a)$, is a factor.": [
                    [entropy],
                    [entropy],
                ],
            },
        ),
        f"Squared error: $(a - y) \\, a (1 - a) = {entropy:.2g} \\cdot {output * (1 - output):.4g} = {squared:.4g}$. "
        f"Cross-entropy: $a - y = {entropy:.2g}$.",
    )


@drill("neural-network", "The error of a hidden unit")
def hidden_error(rng: Rng) -> Question:
    """Propagate the error of two output units back to a hidden one."""
    a = float(rng.choice([0.2, 0.4, 0.5, 0.7]))
    weights, deltas = _halves(rng, 2), np.round(rng.uniform(-0.9, 0.9, size=2), 1)
    layers = [np.array([[1.0]]), np.array([[a]]), np.zeros((1, 2))]
    gradient = networks.backpropagate(
        [np.ones((1, 1)), weights[:, None]], layers, deltas[None]
    )
    answer = float(gradient.biases[0][0])
    back = float(weights @ deltas)
    return Question(
        f"A hidden sigmoid unit has the activation ${a:g}$. Its weights to two output units are ${weights[0]:g}$ and "
        f"${weights[1]:g}$, whose errors are ${deltas[0]:g}$ and ${deltas[1]:g}$. What is its own error $\\delta$? "
        "Give three decimals.",
        Number(
            answer,
            tolerance=0.0011,
            wrong={
                "The slope of the sigmoid, $a (1 - a)$, is missing.": back,
                "The error is multiplied by the slope $a (1 - a)$, not by the activation $a$.": back
                * a,
                "The weights are missing: each error comes back through its own weight.": float(
                    deltas.sum()
                )
                * a
                * (1 - a),
                "Both output units count; this is the first alone.": float(
                    weights[0] * deltas[0]
                )
                * a
                * (1 - a),
            },
        ),
        f"$({weights[0]:g} \\cdot {deltas[0]:g} {sign(weights[1])} \\cdot {deltas[1]:g}) \\cdot {a:g} "
        f"\\cdot {1 - a:.2g} "
        f"= {back:.4g} \\cdot {a * (1 - a):.4g} = {answer:.4g}$.",
    )


@drill("neural-network", "The steps of one iteration of training")
def order_of_training(rng: Rng) -> Question:
    """Put the steps of gradient descent with backpropagation in order."""
    return Question(
        "Put the steps of one iteration of batch gradient descent in order.",
        Order(
            [
                "Forward propagation: the activations of all layers.",
                "The errors of the output units.",
                "Backpropagation: the errors of the hidden units.",
                "The derivatives by the weights: error times activation.",
                "A step of all weights against the gradient.",
            ],
            before={
                (0, 1): "The error of an output needs the output.",
                (
                    1,
                    2,
                ): "Errors of hidden units are computed from those of the output units.",
                (
                    2,
                    3,
                ): "The derivatives by the first layer's weights need the errors of the hidden units.",
                (3, 4): "The step needs all derivatives.",
            },
        ),
        "Activations go forward, errors come back, derivatives are products of both, and then the weights change.",
    )
