"""Contacts as a function that PyTorch differentiates. Needs PyTorch, as `pip install fingertip[torch]` brings it.

>>> import fingertip, fingertip.torch, torch
>>> model = fingertip.ContactModel(fingertip.Surface("sphere", radius_m=0.013))
>>> touch = fingertip.torch.touch(model)
>>> wrench = torch.tensor([0.2, 0.0, -1.0, 0.0, 0.0, 0.0], requires_grad=True)
>>> touch(wrench)[2].backward()
>>> wrench.grad.shape
torch.Size([6])
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import torch

from fingertip._native import ContactModel

__all__ = ["touch"]


class _Touch(torch.autograd.Function):
    """Touches with their Jacobian, which is kept for the way back."""

    @staticmethod
    def forward(wrenches: torch.Tensor, model: ContactModel) -> tuple[torch.Tensor, torch.Tensor]:
        rows = wrenches.detach().to("cpu", torch.float64)
        touches, jacobian = model.touch_and_jacobian(rows.reshape(-1, 6).numpy())
        shape = rows.shape[:-1]
        return (
            torch.from_numpy(touches).reshape(*shape, 8).to(wrenches),
            torch.from_numpy(jacobian).reshape(*shape, 8, 6).nan_to_num(nan=0.0).to(wrenches),
        )

    @staticmethod
    def setup_context(ctx: Any, inputs: tuple[torch.Tensor, ContactModel], output: tuple[torch.Tensor, torch.Tensor]) -> None:
        jacobian = output[1]
        ctx.mark_non_differentiable(jacobian)
        ctx.save_for_backward(jacobian)

    @staticmethod
    def backward(ctx: Any, *changes: torch.Tensor) -> tuple[torch.Tensor, None]:
        (jacobian,) = ctx.saved_tensors
        # What is made of a touch that is none may be NaN: there the wrench has no part in it.
        none = (jacobian == 0).all(-1).all(-1)[..., None]
        back = torch.einsum("...i,...ij->...j", changes[0], jacobian)
        return torch.where(none, torch.zeros_like(back), back), None

    @staticmethod
    def vmap(info: Any, in_dims: tuple[int | None, None], wrenches: torch.Tensor, model: ContactModel) -> Any:
        if in_dims[0] is not None:
            wrenches = wrenches.movedim(in_dims[0], 0)
        dim = None if in_dims[0] is None else 0
        return _Touch.apply(wrenches, model), (dim, dim)


def touch(model: ContactModel) -> Callable[[torch.Tensor], torch.Tensor]:
    """Where wrenches touch, as a function that PyTorch differentiates, by `backward` and by `torch.func`.

    Parameters
    ----------
    model : ContactModel

    Returns
    -------
    callable
        Takes wrenches on the fingertip, shape (..., 6) [N, N·m]; gives, shape (..., 8), the point [m], the outward normal,
        the normal force [N] and the spin torque [N·m], with the precision and on the device of what it takes. Where nothing
        touches all are NaN and their derivatives zero, so that `torch.where` can leave such rows out of a sum and its
        gradient. Contacts are found by the library itself, on the processor, in double precision. There are first
        derivatives only.
    """

    def touched(wrenches: torch.Tensor) -> torch.Tensor:
        found: torch.Tensor = _Touch.apply(wrenches, model)[0]
        return found

    return touched
