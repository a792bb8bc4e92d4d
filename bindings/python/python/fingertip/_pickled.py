"""How objects of the extension module come back from a pickle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fingertip._native import Table


def restore(kind: type, data: bytes) -> Any:
    """Make an object of a class from its bytes."""
    return kind._from_bytes(data)  # type: ignore[attr-defined]


def table(pieces: Sequence[Mapping[str, Any]]) -> Table:
    """Make a table from the columns of its pieces."""
    from fingertip._native import Table

    tables = [Table(dict(piece)) for piece in pieces]
    return tables[0] if len(tables) == 1 else Table.joined(tables, tables[0])
