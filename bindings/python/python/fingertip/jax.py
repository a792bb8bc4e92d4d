"""Contacts as a function that JAX differentiates. Needs `pip install fingertip[jax]`.

>>> import fingertip, fingertip.jax
>>> import jax, jax.numpy as jnp
>>> model = fingertip.ContactModel(fingertip.Surface("sphere", radius_m=0.013))
>>> touch = fingertip.jax.touch(model)
>>> height = jax.grad(lambda wrench: touch(wrench)[2])(jnp.array([0.2, 0.0, -1.0, 0.0, 0.0, 0.0]))
>>> height.shape
(6,)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from fingertip._native import ContactModel

__all__ = ["touch"]


def touch(model: ContactModel) -> Callable[[jax.Array], jax.Array]:
    """Where wrenches touch, as a function that JAX differentiates, vectorises and compiles into others.

    Parameters
    ----------
    model : ContactModel

    Returns
    -------
    callable
        Takes wrenches on the fingertip, shape (..., 6) [N, N·m]; gives, shape (..., 8), the point [m], the outward normal,
        the normal force [N] and the spin torque [N·m]. Where nothing touches all are NaN and their derivatives zero, so
        that `jax.numpy.where` can leave such rows out of a sum and its gradient. Contacts are found by the library itself, on the
        processor, in double precision whatever the precision of the array.
    """

    def found(wrenches: Any) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
        rows = np.asarray(wrenches, np.float64)
        touches, jacobian = model.touch_and_jacobian(rows.reshape(-1, 6))
        dtype = np.asarray(wrenches).dtype
        return (
            touches.reshape(*rows.shape[:-1], 8).astype(dtype),
            np.nan_to_num(jacobian.reshape(*rows.shape[:-1], 8, 6), nan=0.0).astype(dtype),
        )

    def forward(wrenches: jax.Array) -> tuple[jax.Array, jax.Array]:
        shape = wrenches.shape[:-1]
        parts = (
            jax.ShapeDtypeStruct((*shape, 8), wrenches.dtype),
            jax.ShapeDtypeStruct((*shape, 8, 6), wrenches.dtype),
        )
        touches, jacobian = jax.pure_callback(found, parts, wrenches, vmap_method="expand_dims")
        return touches, jacobian

    def backward(jacobian: jax.Array, change: jax.Array) -> tuple[jax.Array]:
        # What is made of a touch that is none may be NaN: there the wrench has no part in it.
        none = (jacobian == 0).all(axis=(-2, -1))[..., None]
        return (jnp.where(none, 0.0, jnp.einsum("...i,...ij->...j", change, jacobian)),)

    @jax.custom_vjp
    def touched(wrenches: jax.Array) -> jax.Array:
        return forward(wrenches)[0]

    touched.defvjp(forward, backward)
    return touched
