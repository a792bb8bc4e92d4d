"""Pages that the command writes, as what objects of Python show."""

from __future__ import annotations

import html
import os
from pathlib import Path


class Page:
    """What has a page in its attribute `html`."""

    html: str

    def report_html(self, path: str | os.PathLike[str] | None = None) -> str:
        """The page that the command writes, as a text; with a path, written there too, whole or not at all."""
        if path is not None:
            target = Path(path)
            part = target.with_name(f".{target.name}.{os.getpid()}.part")
            try:
                part.write_text(self.html, encoding="utf-8")
                part.replace(target)
            finally:
                part.unlink(missing_ok=True)
        return self.html

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="600"></iframe>'
