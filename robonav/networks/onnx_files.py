"""Networks as ONNX files, which run outside Python: on a microcontroller, in C++, in other frameworks."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from robonav import atomic
from robonav.validation import check_instance

from ._checks import check_single
from .multilayer_perceptron import Network

OPSET = 17  # of ONNX's operators; every runtime since 2022 knows it


def save_onnx(path: str | Path, network: Network) -> None:
    """Write a network as an ONNX file. Its input is ``x`` (M, n_0), its output ``y`` (M, n_L), both of float64.

    Each layer is the product with its weights plus its biases, then the sigmoid, as in :func:`propagate`.

    Parameters
    ----------
    path : str or Path
        Of the file, usually with the ending ``.onnx``. The file is written completely or not at all.
    network : Network
        One network, not a stack.

    Raises
    ------
    ModuleNotFoundError
        If onnx is not installed: ``pip install onnx``.
    TypeError
        If ``network`` is not a Network.
    ValueError
        If it is a stack of networks.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> import onnxruntime
    >>> from robonav.networks import random_network, save_onnx
    >>> network = random_network((11, 8, 5), seed=3)
    >>> x = np.ones((1, 11))
    >>> with TemporaryDirectory() as folder:
    ...     save_onnx(Path(folder) / "policy.onnx", network)
    ...     session = onnxruntime.InferenceSession(Path(folder) / "policy.onnx")
    >>> np.allclose(session.run(["y"], {"x": x})[0], network.forward(x))
    True
    """
    from onnx import TensorProto, checker, helper, numpy_helper

    check_single(check_instance("network", network, Network))
    nodes, constants, signal = [], [], "x"
    last = len(network.weights) - 1
    for layer, (weights, biases) in enumerate(
        zip(network.weights, network.biases, strict=True)
    ):
        constants += [
            numpy_helper.from_array(np.asarray(weights), f"weights_{layer}"),
            numpy_helper.from_array(np.asarray(biases), f"biases_{layer}"),
        ]
        inputs = [signal, f"weights_{layer}", f"biases_{layer}"]
        signal = "y" if layer == last else f"a_{layer}"
        nodes += [
            helper.make_node("Gemm", inputs, [f"z_{layer}"], transB=1),
            helper.make_node("Sigmoid", [f"z_{layer}"], [signal]),
        ]
    sizes = network.sizes
    graph = helper.make_graph(
        nodes,
        "robonav",
        [helper.make_tensor_value_info("x", TensorProto.DOUBLE, ["M", sizes[0]])],
        [helper.make_tensor_value_info("y", TensorProto.DOUBLE, ["M", sizes[-1]])],
        constants,
    )
    model = helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=8
    )
    checker.check_model(model)
    with atomic.atomic_write(path) as file:
        file.write(model.SerializeToString())
