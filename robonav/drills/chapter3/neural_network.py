"""Drills of the page on the neural network."""

from __future__ import annotations

import numpy as np

from robonav import networks

from ..question import Number, Question, Table
from ..registry import drill
from ..runs import Line, as_list, some_in_order
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
    output, label = float(rng.integers(10, 96)) / 100, int(rng.integers(2))
    # a unit without inputs, whose activation is that of its bias: its error is the gradient with respect to the bias
    bias = np.array([np.log(output / (1 - output))])
    unit = networks.Network((np.zeros((1, 1)),), (bias,))
    example = np.zeros((1, 1)), np.array([[float(label)]])
    squared, entropy = (
        float(gradient(unit, *example).biases[0][0])
        for gradient in (
            networks.squared_error_gradient,
            networks.cross_entropy_gradient,
        )
    )
    return Question(
        f"A sigmoid output unit has the activation ${output:g}$, and its label is ${label}$. "
        "What is its error $\\delta$ under each cost, the squared error $(a - y)^2 / 2$ and the cross-entropy? "
        "Give three decimals.",
        Table(
            ["squared error", "cross-entropy"],
            ["$\\delta$"],
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


def _iteration(
    number: int, network: networks.Network, x: np.ndarray, y: np.ndarray, step: float
) -> tuple[list[Line], networks.Network]:
    """The lines of one iteration of gradient descent, and the network after it."""
    _, hidden, output = (float(a.squeeze()) for a in network.activations(x))
    gradient = networks.cross_entropy_gradient(network, x, y)
    slopes = [float(slope.squeeze()) for slope in gradient.weights]
    after = networks.gradient_descent_step(network, gradient, step)
    kept = networks.Network(after.weights, network.biases)  # there are no biases
    new = [float(weight.squeeze()) for weight in kept.weights]
    errors = [float(error.squeeze()) for error in gradient.biases]
    lines = [
        (
            f"the hidden unit has the activation ${hidden:.3f}$.",
            "It is computed with the weights at the beginning of the iteration, so the iteration before has ended.",
        ),
        (
            f"the output is ${output:.3f}$.",
            "Activations go forward: the output needs that of the hidden unit.",
        ),
        (
            f"the error of the output unit is ${errors[1]:.3f}$.",
            "The error of an output needs the output, which comes last on the way forward.",
        ),
        (
            f"the error of the hidden unit is ${errors[0]:.3f}$.",
            "Errors come back: that of a hidden unit is computed from those of the output units.",
        ),
        (
            f"the derivatives with respect to the two weights are ${slopes[0]:.3f}$ and ${slopes[1]:.3f}$.",
            "A derivative is an error times an activation, so all errors come first.",
        ),
        (
            f"the weights become ${new[0]:.3f}$ and ${new[1]:.3f}$.",
            "The step needs the derivatives, for which activations and errors come first.",
        ),
    ]
    return [Line(f"Iteration {number}: {text}", why) for text, why in lines], kept


@drill("neural-network", "A run of training")
def order_of_training(rng: Rng) -> Question:
    """Put the steps of gradient descent with backpropagation in order."""
    first, second = _halves(rng, 2)
    x, label = float(rng.choice([0.5, 1.0, 2.0])), int(rng.integers(2))
    step = float(rng.choice([0.5, 1.0, 2.0]))
    network = networks.Network(
        (np.array([[first]]), np.array([[second]])), (np.zeros(1), np.zeros(1))
    )
    lines = []
    for number in (1, 2):
        made, network = _iteration(
            number, network, np.array([[x]]), np.array([[float(label)]]), step
        )
        lines += made
    asked = some_in_order(rng, lines, 5)
    return Question(
        f"A network has one input, one hidden unit, one output unit, the weights ${first:g}$ and ${second:g}$, and no "
        f"biases. It is trained on the cross-entropy with the input ${x:g}$, the label ${label}$ and the step size "
        f"${step:g}$. Put these lines of the run in order.",
        asked,
        "Activations go forward, errors come back, derivatives are products of both, and then the weights change. "
        f"{as_list(asked)}",
    )
