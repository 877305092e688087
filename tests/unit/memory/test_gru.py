"""The gated recurrent unit, against torch's and against numerical gradients."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from robonav.memory import GRU

T, N, INPUTS, UNITS = 6, 3, 4, 5


@pytest.fixture
def sequences():
    draw = torch.Generator().manual_seed(1)
    xs = torch.randn(T, N, INPUTS, generator=draw, dtype=torch.float64)
    h = torch.randn(N, UNITS, generator=draw, dtype=torch.float64)
    return xs.requires_grad_(), h.requires_grad_()


@pytest.fixture
def gru():
    """One whose recurrent matrix of h~ is diagonal: r * (U h) and U (r * h) are then the same."""
    made = GRU(INPUTS, UNITS, seed=0)
    with torch.no_grad():
        made.U[2] = torch.diag(made.U[2].diagonal())
        made.b.copy_(torch.linspace(-1, 1, 3 * UNITS).reshape(3, UNITS))
    return made


@pytest.fixture
def oracle(gru):
    """torch's GRU with the same numbers."""
    made = torch.nn.GRU(INPUTS, UNITS).double()
    with torch.no_grad():
        made.weight_ih_l0.copy_(gru.W.transpose(1, 2).flatten(0, 1))
        made.weight_hh_l0.copy_(gru.U.transpose(1, 2).flatten(0, 1))
        made.bias_ih_l0.copy_(gru.b.flatten())
        made.bias_hh_l0.zero_()
    return made


def test_states_are_those_of_torch(gru, oracle, sequences):
    xs, h = sequences
    expected, _ = oracle(xs, h[None])
    torch.testing.assert_close(gru(xs, h), expected, rtol=0, atol=1e-14)


def test_gradients_are_those_of_torch(gru, oracle, sequences):
    xs, h = sequences
    weights = torch.randn(T, N, UNITS, dtype=torch.float64)
    found = torch.autograd.grad(
        (gru(xs, h) * weights).sum(), [xs, h, gru.W, gru.U, gru.b]
    )
    states, _ = oracle(xs, h[None])
    of = [xs, h, oracle.weight_ih_l0, oracle.weight_hh_l0, oracle.bias_ih_l0]
    expected = torch.autograd.grad((states * weights).sum(), of)
    shape = (3, UNITS, -1)
    W, U = (g.reshape(shape).transpose(1, 2) for g in expected[2:4])
    close = {"rtol": 0, "atol": 1e-12}
    torch.testing.assert_close(found[:2], expected[:2], **close)
    torch.testing.assert_close(found[2], W, **close)
    torch.testing.assert_close(found[3][:2], U[:2], **close)
    torch.testing.assert_close(found[3][2].diagonal(), U[2].diagonal(), **close)
    torch.testing.assert_close(found[4].flatten(), expected[4], **close)


def test_gradients_are_numerical_ones(sequences):
    xs, h = sequences
    gru = GRU(INPUTS, UNITS, seed=3)

    def last(xs, h, W, U, b):
        gru.__dict__.update(W=W, U=U, b=b)
        return GRU.forward(gru, xs, h)[-1]

    parameters = [gru.W.detach(), gru.U.detach(), gru.b.detach()]
    for name in ("W", "U", "b"):
        del gru._parameters[name]
    parameters = [p.clone().requires_grad_() for p in parameters]
    assert torch.autograd.gradcheck(last, (xs, h, *parameters))


def test_the_equations_by_hand():
    """One unit and one input, with numbers that are easy to follow."""
    gru = GRU(1, 1, seed=0)
    with torch.no_grad():
        gru.W[:, 0, 0] = torch.tensor([1.0, 0.0, 0.5])
        gru.U[:, 0, 0] = torch.tensor([0.0, 2.0, 1.0])
    x, h = torch.tensor([[2.0]]).double(), torch.tensor([[0.5]]).double()
    r = 1 / (1 + np.exp(-2.0))
    z = 1 / (1 + np.exp(-1.0))
    expected = z * 0.5 + (1 - z) * np.tanh(1.0 + r * 0.5)
    assert gru.step(x, h).item() == pytest.approx(expected, abs=1e-15)


def test_an_update_gate_of_one_keeps_the_state(sequences):
    xs, h = sequences
    gru = GRU(INPUTS, UNITS, seed=0)
    with torch.no_grad():
        gru.b[1] = 100.0
    assert torch.equal(gru(xs, h)[-1], h)


def test_equal_seeds_give_equal_weights():
    one, same, other = (GRU(3, 4, seed=seed) for seed in (5, 5, 6))
    assert torch.equal(one.W, same.W)
    assert not torch.equal(one.W, other.W)
    assert one.U.abs().max() <= 0.5


def test_the_reset_gate_multiplies_the_state_before_the_matrix():
    """As in the paper; torch multiplies afterwards, which differs if the matrix is not diagonal."""
    gru = GRU(1, 2, seed=0)
    with torch.no_grad():
        gru.W.zero_()
        gru.U.zero_()
        gru.b.zero_()
        gru.b[0] = torch.tensor([100.0, -100.0])  # r is 1 and 0
        gru.b[1] = -100.0  # z is 0
        gru.U[2] = torch.tensor([[0.0, 2.0], [3.0, 0.0]])
    h = torch.tensor([[0.5, 0.7]]).double()
    after = gru.step(torch.zeros(1, 1).double(), h)[0].tolist()
    assert after == pytest.approx([0.0, np.tanh(2.0 * 0.5)], abs=1e-12)
