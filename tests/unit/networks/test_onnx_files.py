"""Networks as ONNX files, run by a library that nobody here wrote."""

import numpy as np
import onnxruntime
import pytest

from robonav.networks import random_network, save_onnx, stacked


@pytest.mark.parametrize("sizes", [(2, 1), (11, 8, 5), (16, 8, 6, 5)])
def test_onnxruntime_gives_the_same_outputs(tmp_path, sizes):
    network = random_network(sizes, seed=3, spread=2.0)
    x = np.random.default_rng(0).normal(size=(50, sizes[0]))
    save_onnx(tmp_path / "policy.onnx", network)
    session = onnxruntime.InferenceSession(tmp_path / "policy.onnx")
    (outputs,) = session.run(["y"], {"x": x})
    np.testing.assert_allclose(outputs, network.forward(x), rtol=1e-12)


def test_a_stack_and_what_is_no_network_are_refused(tmp_path):
    one = random_network((2, 1), seed=0)
    with pytest.raises(ValueError, match="network must be a single one, got a stack"):
        save_onnx(tmp_path / "policy.onnx", stacked([one, one]))
    with pytest.raises(TypeError, match="network must be Network, got str"):
        save_onnx(tmp_path / "policy.onnx", "nnql")
    assert list(tmp_path.iterdir()) == []
