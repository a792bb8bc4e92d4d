"""Shapes that are functions of Python, and contacts that are differentiated."""

from __future__ import annotations

import math
import pickle

import fingertip
import numpy as np
import pytest
from conftest import skipped
from fingertip import ContactModel, Surface, formula
from hypothesis import given, settings
from hypothesis import strategies as st


def egg(x, y, z):
    return np.square(x / 0.008) + (y / 0.01) ** 2 + np.hypot(z / 0.012, 0.5) ** 2 - 1.25


def test_a_function_is_the_shape_that_it_describes():
    written = Surface.from_function(egg, reach_m=0.013, convex=True)
    known = Surface("ellipsoid", semi_axes_m=[0.008, 0.01, 0.012])
    random = np.random.default_rng(5)
    for _ in range(50):
        point, direction = random.normal(0, 0.01, 3), random.normal(size=3)
        found = [surface.crossings(point, direction) for surface in (written, known)]
        assert len(found[0]) == len(found[1])
        for (along, place, normal, _), (other, there, across, _) in zip(*found, strict=True):
            assert math.isclose(along, other, abs_tol=1e-12)
            assert np.allclose(place, there, atol=1e-12) and np.allclose(normal, across, atol=1e-9)
    assert pickle.loads(pickle.dumps(written)) == written
    # It is part of a scene as any shape is, and of what is exported from one.
    surface = {"shape": "formula", "outside": formula(egg), "reach_m": 0.013}
    tip = fingertip.Fingertip(fingertip.Scene.from_dict({"surface": surface}))
    touch = tip.sense([0.0, 0.0, -1.0, 0.0, 0.0, 0.0], 1e-3)
    assert np.allclose(touch.point, [0, 0, 0.012], atol=1e-12)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(-2, 2), min_size=6, max_size=6), st.integers(-3, 4))
def test_a_formula_is_what_the_function_computes(numbers, power):
    a, b, c, x, y, z = numbers

    def outside(x, y, z):
        first = (a - x) * 2 / (1.5 + y * y) + -z + abs(b * x) - np.float64(c) * z
        second = np.minimum(np.sin(x) * np.cos(y), np.exp(-(z**2))) - np.maximum(first, np.sqrt(1 + x**2)) + (3 + x**2) ** power
        return second + (2 + y * y) ** 0.5 + np.fabs(+z)

    text = formula(outside).replace("^", "**")
    names = {"sqrt": math.sqrt, "exp": math.exp, "sin": math.sin, "cos": math.cos, "abs": abs, "min": min, "max": max}
    assert math.isclose(eval(text, names, {"x": x, "y": y, "z": z}), outside(x, y, z), rel_tol=1e-12, abs_tol=1e-12)


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda x, y, z: 1.0 if x > 0 else -1.0, "cannot be followed"),
        (lambda x, y, z: x == y, "cannot be followed"),
        (lambda x, y, z: math.sqrt(x), "numpy.sqrt instead of math.sqrt"),
        (lambda x, y, z: np.tan(x), "numpy.tan is not known"),
        (lambda x, y, z: np.add.reduce([x, y]), "cannot be followed|not known"),
        (lambda x, y, z: x**y, "whole number up to 64"),
        (lambda x, y, z: x**0.3, "whole number up to 64"),
        (lambda x, y, z: 2**x, "numpy.exp"),
        (lambda x, y, z: x + math.nan, "must be finite"),
        (lambda x, y, z: 3.0, "of its coordinates, not 3.0"),
    ],
)
def test_what_a_formula_cannot_do_is_said(function, said):
    with pytest.raises(fingertip.ShapeError, match=said):
        formula(function)


def test_a_root_that_is_zero_on_the_shape_wants_its_steepness():
    def drum(x, y, z):
        return np.hypot(x / 0.008, y / 0.01) ** 2 + (z / 0.012) ** 2 - 1

    with pytest.raises(fingertip.FingertipError, match="steepest_per_m"):
        Surface.from_function(drum, reach_m=0.013)
    surface = Surface.from_function(drum, reach_m=0.013, steepest_per_m=420.0, centre_m=[0, 0, 0])
    assert [along for along, *_ in surface.crossings([0, 0, 0], [1, 0, 0])] == pytest.approx([-0.008, 0.008])


def test_a_formula_that_repeats_itself_without_end_is_refused():
    def doubles(x, y, z):
        for _ in range(60):
            x = x * x + y
        return x

    with pytest.raises(fingertip.ShapeError, match="longer than"):
        formula(doubles)


MODELS = {
    "sphere": lambda: ContactModel(Surface("sphere", radius_m=0.013)),
    "soft egg": lambda: ContactModel(Surface.from_function(egg, reach_m=0.013, convex=True), "soft_finger"),
    "soft capsule": lambda: ContactModel(
        Surface("capsule", half_length_m=0.01, radius_m=0.007), "soft_finger"
    ),
}


@pytest.fixture
def pushes():
    random = np.random.default_rng(8)
    pushes = random.normal(size=(40, 6)) * [0.1, 0.1, 0.1, 5e-4, 5e-4, 5e-4] + [0.1, 0.3, -1.2, 1e-4, -2e-4, 1e-4]
    pushes[3] = 0.0
    pushes[7, 2] = np.nan
    return pushes


@pytest.mark.parametrize("name", MODELS)
def test_derivatives_are_differences(name, pushes):
    model = MODELS[name]()
    touches, jacobian = model.touch_and_jacobian(pushes)
    assert touches.shape == (40, 8) and jacobian.shape == (40, 8, 6)
    compared = 0
    for push, touch, derivatives in zip(pushes, touches, jacobian, strict=True):
        contact = model.resolve(push)
        if not isinstance(contact, fingertip.Contact):
            assert np.isnan(touch).all() and np.isnan(derivatives).all()
            continue
        assert np.array_equal(touch, [*contact.point, *contact.normal, contact.normal_force, contact.spin_torque])
        steps = np.diag([1e-6, 1e-6, 1e-6, 1e-8, 1e-8, 1e-8])
        ahead, back = (model.touch_and_jacobian(push + sign * steps)[0] for sign in (1, -1))
        differences = ((ahead - back) / (2 * steps.diagonal()[:, None])).T
        if np.isfinite(differences).all():
            scale = np.abs(derivatives).max(axis=1, keepdims=True) + 1e-9
            assert (np.abs(differences - derivatives) / scale).max() < 1e-4
            compared += 1
    assert compared >= 20
    # Whatever holds the numbers.
    assert np.array_equal(model.touch_and_jacobian(pushes.tolist())[0], touches, equal_nan=True)
    assert model.touch_and_jacobian(np.zeros((0, 6)))[1].shape == (0, 8, 6)
    with pytest.raises(fingertip.FingertipError, match="6 columns, not 5"):
        model.touch_and_jacobian(pushes[:, :5])
    with pytest.raises(fingertip.FingertipError, match=r"shape \(n, 6\)"):
        model.touch_and_jacobian(pushes[0])


def test_jax_differentiates_vectorises_and_compiles(pushes):
    try:
        import jax
        import jax.numpy as jnp
    except ImportError:
        skipped("jax is not installed")
    import fingertip.jax

    with jax.enable_x64(True):
        model = MODELS["soft egg"]()
        touch = fingertip.jax.touch(model)
        touches, jacobian = model.touch_and_jacobian(pushes)
        assert np.array_equal(touch(jnp.array(pushes)), touches, equal_nan=True)
        found = jax.jit(jax.vmap(jax.jacrev(touch)))(jnp.array(pushes))
        assert np.allclose(found, np.nan_to_num(jacobian), rtol=1e-12, atol=0)
        assert np.array_equal(jax.vmap(jax.jit(touch))(jnp.array(pushes)), touches, equal_nan=True)

        # The push that touches where it was asked, by descent; rows that touch nothing are left out.
        def miss(wrenches):
            point = touch(wrenches)[:, :3]
            return jnp.where(jnp.isfinite(point), (point * 1e3 - jnp.array([1.0, 2.0, 11.0])) ** 2, 0.0).sum()

        wrenches = jnp.array([[0.0, 0.0, -1.0, 0.0, 0.0, 0.0], [0.0] * 6])
        for _ in range(300):
            wrenches = wrenches - jnp.array([1e-3] * 3 + [1e-7] * 3) * jax.grad(miss)(wrenches)
        assert jnp.isfinite(wrenches).all() and float(miss(wrenches)) < 0.2 * float(miss(wrenches[:1] * 0 + jnp.eye(6)[2] * -1))


def test_pytorch_differentiates_and_vectorises(pushes):
    try:
        import torch
    except ImportError:
        skipped("PyTorch is not installed: fingertip.torch is not tested")
    import fingertip.torch

    model = MODELS["soft egg"]()
    touch = fingertip.torch.touch(model)
    touches, jacobian = model.touch_and_jacobian(pushes)
    given = torch.tensor(pushes)
    assert np.array_equal(touch(given), touches, equal_nan=True)
    assert np.array_equal(touch(given.reshape(5, 8, 6)).reshape(40, 8), touches, equal_nan=True)
    # By the one way of differentiating and by the other.
    found = torch.func.vmap(torch.func.jacrev(touch))(given)
    assert np.allclose(found, np.nan_to_num(jacobian), rtol=1e-12, atol=0)
    assert np.array_equal(torch.func.vmap(touch, in_dims=1)(given.T), touches, equal_nan=True)
    for row in range(8):
        wrenches = given.clone().requires_grad_()
        torch.where(torch.isfinite(touch(wrenches)), touch(wrenches), 0.0)[:, row].sum().backward()
        assert np.allclose(wrenches.grad, np.nan_to_num(jacobian)[:, row], rtol=1e-12, atol=0)
    touching = torch.tensor(pushes[np.isfinite(touches).all(1)][:3])
    scale = torch.tensor([1.0] * 3 + [1e-3] * 3, dtype=torch.float64)
    assert torch.autograd.gradcheck(lambda w: 1e2 * touch(w * scale), (touching / scale).requires_grad_(), eps=1e-5, atol=1e-4)

    # The precision of what it takes, and learning in it: the push that touches where it was asked.
    wrenches = torch.tensor([[0.0, 0.0, -1.0, 0.0, 0.0, 0.0], [0.0] * 6], requires_grad=True)
    assert touch(wrenches).dtype == torch.float32
    steps, missed = torch.tensor([1e-3] * 3 + [1e-7] * 3), []
    for _ in range(300):
        point = touch(wrenches)[:, :3]
        miss = torch.where(torch.isfinite(point), (point * 1e3 - torch.tensor([1.0, 2.0, 11.0])) ** 2, 0.0).sum()
        missed.append(miss.item())
        (gradient,) = torch.autograd.grad(miss, wrenches)
        with torch.no_grad():
            wrenches -= steps * gradient
    assert torch.isfinite(wrenches).all() and missed[-1] < 0.2 * missed[0]
