"""The network of this package as a torch module, for methods that train with ``torch.optim``."""

from __future__ import annotations

import torch

from .multilayer_perceptron import Network


def as_module(network: Network) -> torch.nn.Sequential:
    """Copy a network into a torch module in double precision, whose outputs are the logits.

    Parameters
    ----------
    network : Network
        A single network.

    Returns
    -------
    torch.nn.Sequential
        Linear layers with sigmoids in between; none after the last.

    Examples
    --------
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module
    >>> [type(layer).__name__ for layer in as_module(random_network((4, 8, 2), seed=0))]
    ['Linear', 'Sigmoid', 'Linear']
    """
    layers: list[torch.nn.Module] = []
    for weight, bias in zip(network.weights, network.biases, strict=True):
        outputs, inputs = weight.shape
        layer = torch.nn.Linear(inputs, outputs, dtype=torch.float64)
        layer.weight.data, layer.bias.data = torch.tensor(weight), torch.tensor(bias)
        layers += [layer, torch.nn.Sigmoid()]
    return torch.nn.Sequential(*layers[:-1])


def as_network(module: torch.nn.Sequential) -> Network:
    """Copy a module made by :func:`as_module` back into a network.

    Examples
    --------
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module, as_network
    >>> network = random_network((4, 8, 2), seed=0)
    >>> bool((as_network(as_module(network)).weights[0] == network.weights[0]).all())
    True
    """
    parameters = [part.detach().numpy() for part in module.parameters()]
    return Network(tuple(parameters[::2]), tuple(parameters[1::2]))
