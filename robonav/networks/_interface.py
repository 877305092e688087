"""The functions of :mod:`robonav.networks.multilayer_perceptron` as the package offers them.

That file holds the arithmetic and nothing else. Here its functions get the rest of what ``help`` shows: parameters,
results and examples. Those that take a user's examples first check them; code inside the package, which has checked
them already, calls the functions in that file.
"""

from __future__ import annotations

from operator import attrgetter

from robonav.documentation import add_sections

from . import multilayer_perceptron
from ._checks import checked, checked_random

HELP: dict[str, str] = {}

HELP["random_network"] = """
Parameters
----------
sizes : sequence of int
    Units of each layer, without bias units; at least two layers.
seed : int or Generator
    Of the random numbers.
spread : float, optional
    Weights and biases are uniform in [-spread, spread]. By default it is sqrt(6 / (inputs + outputs)) of each
    layer (Glorot and Bengio 2010). With 0 all hidden units are equal.

Returns
-------
Network

Raises
------
ValueError
    If there are fewer than two layers, a layer is empty, or ``spread`` is negative.

Examples
--------
>>> from robonav.networks import random_network
>>> random_network((11, 8, 5), seed=0).sizes
(11, 8, 5)
"""

HELP["sigmoid"] = """
Parameters
----------
z : array
    Weighted sums, of any size: ``1 / (1 + exp(-z))`` is computed without overflow.

Returns
-------
array
    Of the same shape.

Examples
--------
>>> import numpy as np
>>> from robonav.networks import sigmoid
>>> sigmoid(np.array([-1000.0, 0.0, 1000.0])).tolist()
[0.0, 0.5, 1.0]
"""

HELP["sigmoid_slope"] = """
Parameters
----------
a : array
    Activations ``f(z)``, which the forward pass has computed already.

Returns
-------
array
    The derivatives ``f'(z)``.

Examples
--------
>>> import numpy as np
>>> from robonav.networks import sigmoid_slope
>>> sigmoid_slope(np.array([0.0, 0.5])).tolist()
[0.0, 0.25]
"""

HELP["propagate"] = """
Parameters
----------
weights, biases : sequences of (s[l + 1], s[l]) and (s[l + 1],) arrays
    Of one network.
x : (m, s[0]) array
    Inputs.
f : callable
    The activation function; ``torch.sigmoid`` for tensors.

Returns
-------
a : list of (m, s[l]) arrays
    Activations of each layer, the input first.
z : (m, s[-1]) array
    Weighted sums of the output layer.

Examples
--------
>>> import numpy as np
>>> from robonav.networks import propagate, random_network
>>> network = random_network((3, 4, 2), seed=0)
>>> a, z = propagate(network.weights, network.biases, np.ones((5, 3)))
>>> [layer.shape for layer in a], z.shape
([(5, 3), (5, 4), (5, 2)], (5, 2))
"""

HELP["squared_error"] = """
Parameters
----------
output, label : (..., K) arrays
    Outputs of the network, and what they should have been.

Returns
-------
(...) array

Examples
--------
>>> import numpy as np
>>> from robonav.networks import squared_error
>>> float(squared_error(np.array([0.5, 1.0]), np.array([1.0, 1.0])))
0.125
"""

HELP["squared_error_cost"] = """
Returns
-------
float

Examples
--------
>>> from robonav.networks import random_network, squared_error_cost
>>> network = random_network((2, 1), seed=0, spread=0)  # its output is 1/2
>>> squared_error_cost(network, [[0, 0], [1, 1]], [[0], [1]])
0.125
"""

HELP["cross_entropy_cost"] = """
Returns
-------
float

Examples
--------
>>> from robonav.networks import cross_entropy_cost, random_network
>>> network = random_network((2, 1), seed=0, spread=0)  # its output is 1/2
>>> round(cross_entropy_cost(network, [[0, 0], [1, 1]], [[0], [1]]), 6)
0.693147
"""

HELP["Gradient"] = """
Attributes
----------
weights : list of (s[l + 1], s[l]) arrays
    Derivatives by the weights of each layer but the last.
biases : list of (s[l + 1],) arrays
    Derivatives by the biases.

Examples
--------
>>> import numpy as np
>>> from robonav.networks import Gradient
>>> Gradient([np.zeros((2, 3))], [np.zeros(2)]).weights[0].shape
(2, 3)
"""

HELP["backpropagate"] = """
Parameters
----------
weights : sequence of (s[l + 1], s[l]) arrays
    Of one network.
a : list of (m, s[l]) arrays
    Activations of every layer, from :func:`propagate`.
delta : (m, s[-1]) array
    Errors of the output layer: the derivative of the cost by its weighted sums z.

Returns
-------
Gradient
    Summed over the examples.

Examples
--------
>>> import numpy as np
>>> from robonav.networks import backpropagate, propagate, random_network
>>> network, x = random_network((2, 3, 1), seed=0), np.ones((4, 2))
>>> a, z = propagate(network.weights, network.biases, x)
>>> backpropagate(network.weights, a, a[-1] - 1).biases[1].shape
(1,)
"""

HELP["squared_error_gradient"] = """
Returns
-------
Gradient

Examples
--------
>>> from robonav.networks import random_network, squared_error_gradient
>>> network = random_network((2, 1), seed=0, spread=0)
>>> squared_error_gradient(network, [[1, 2]], [[1]]).weights[0].tolist()
[[-0.125, -0.25]]
"""

HELP["cross_entropy_gradient"] = """
Returns
-------
Gradient

Examples
--------
>>> from robonav.networks import cross_entropy_gradient, random_network
>>> network = random_network((2, 1), seed=0, spread=0)
>>> cross_entropy_gradient(network, [[1, 2]], [[1]]).weights[0].tolist()
[[-0.5, -1.0]]
"""

HELP["gradient_descent_step"] = """
Parameters
----------
network : Network
    A single network.
gradient : Gradient
    The derivatives of the cost by its weights and biases.
gradient_step : float
    alpha, which the thesis calls the learning rate; sigma in chapter 4.

Returns
-------
Network
    One step further down.

Examples
--------
>>> import numpy as np
>>> from robonav.networks import Gradient, Network, gradient_descent_step
>>> network = Network((np.array([[3.0]]),), (np.array([1.0]),))
>>> gradient_descent_step(network, Gradient([np.array([[4.0]])], [np.array([0.0])]), 0.5).weights
(array([[1.]]),)
"""

HELP["batch_gradient_descent"] = """
Parameters
----------
network : Network
    Where to start.
x, y : (m, s[0]) and (m, s[-1]) arrays
    Inputs, and labels in [0, 1].
gradient_step : float
    alpha. With too large a step the cost rises or jumps.
iterations : int
    Steps to take.
cost_gradient : callable
    ``squared_error_gradient`` or ``cross_entropy_gradient``.

Returns
-------
Network
    The trained one.

Raises
------
ValueError
    If shapes do not fit, a label lies outside [0, 1], or the weights grow beyond all bounds.

Examples
--------
>>> from robonav.networks import batch_gradient_descent, random_network, squared_error_cost
>>> from robonav.networks.toy_datasets import disc
>>> (x, y), start = disc(50, seed=0), random_network((2, 4, 1), seed=0)
>>> trained = batch_gradient_descent(start, x, y, gradient_step=1, iterations=20)
>>> squared_error_cost(trained, x, y) < squared_error_cost(start, x, y)
True
"""

HELP["stochastic_gradient_descent"] = """
Parameters
----------
gradient_step : float
    Positive. Each step is the gradient times this number.
epochs : int
    How often to go through the examples.
batch_size : int
    Examples in each step; the last step of an epoch may have fewer.
seed : int or Generator
    Of the random orders.
cost_gradient : callable
    Computes the gradient of the cost from network, inputs and labels.

Returns
-------
Network
    The trained one.

Examples
--------
>>> from robonav.networks import random_network, squared_error_cost, stochastic_gradient_descent
>>> from robonav.networks.toy_datasets import disc
>>> (x, y), start = disc(50, seed=0), random_network((2, 4, 1), seed=0)
>>> trained = stochastic_gradient_descent(start, x, y, gradient_step=1, epochs=5, batch_size=10, seed=0)
>>> squared_error_cost(trained, x, y) < squared_error_cost(start, x, y)
True
"""

HELP["Network.forward"] = """
Parameters
----------
x : (s[0],) or (..., m, s[0]) array
    One input, or m in rows.

Returns
-------
(s[-1],) or (..., m, s[-1]) array

Examples
--------
>>> from robonav.networks import Network
>>> Network(weights=[[[1.0, 1.0]]], biases=[[0.0]]).forward([2.0, -2.0])
array([0.5])
"""

HELP["Network.activations"] = """
Parameters
----------
x : (s[0],) or (..., m, s[0]) array
    One input, or m in rows.

Returns
-------
list of arrays
    One for each layer.

Examples
--------
>>> from robonav.networks import Network
>>> Network(weights=[[[1.0, 1.0]]], biases=[[0.0]]).activations([2.0, -2.0])
[array([ 2., -2.]), array([0.5])]
"""

HELP["Network.logits"] = """
Parameters
----------
x : (s[0],) or (..., m, s[0]) array
    One input, or m in rows.

Returns
-------
(s[-1],) or (..., m, s[-1]) array

Examples
--------
>>> from robonav.networks import Network
>>> Network(weights=[[[1.0, 1.0]]], biases=[[0.5]]).logits([3.0, 4.0])
array([7.5])
"""

HELP["Network.decide"] = """
Parameters
----------
x : (s[0],) or (..., m, s[0]) array
    One input, or m in rows.

Returns
-------
int or (..., m) array of int

Examples
--------
>>> from robonav.networks import Network
>>> Network(weights=[[[1.0], [-1.0]]], biases=[[0.0, 0.0]]).decide([[2.0], [-2.0]])
array([0, 1])
"""

for name, sections in HELP.items():
    add_sections(attrgetter(name)(multilayer_perceptron), sections)

random_network = checked_random(multilayer_perceptron.random_network)
squared_error_cost = checked(multilayer_perceptron.squared_error_cost)
squared_error_gradient = checked(multilayer_perceptron.squared_error_gradient)
cross_entropy_cost = checked(multilayer_perceptron.cross_entropy_cost)
cross_entropy_gradient = checked(multilayer_perceptron.cross_entropy_gradient)
batch_gradient_descent = checked(multilayer_perceptron.batch_gradient_descent)
stochastic_gradient_descent = checked(multilayer_perceptron.stochastic_gradient_descent)
