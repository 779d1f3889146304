"""The page of affskel-client view, as a notebook shows it."""
from __future__ import annotations

import html
import os
from pathlib import Path
from typing import Union

from ._settings import path_of


class View:
    """The body and its skeleton to turn, with sliders: one page that needs no network.

    The last expression of a notebook's cell shows it in a frame.

    Attributes:
        page: the HTML document.
        height: of the frame, CSS pixels.
    """

    def __init__(self, page: str, height: int = 640) -> None:
        self.page = page
        self.height = height

    def __repr__(self) -> str:
        return f"<affskel.View, {len(self.page)} characters; save(FILE) it for a browser>"

    def _repr_html_(self) -> str:
        # The page has a sandbox of its own: it runs its script, hands out a picture and reaches nothing of the
        # notebook.
        return (f'<iframe sandbox="allow-scripts allow-downloads" allow="fullscreen *" width="100%" '
                f'height="{self.height}" style="border: 0" '
                f'srcdoc="{html.escape(self.page)}"></iframe>')

    def save(self, file: Union[str, "os.PathLike[str]"]) -> Path:
        """Writes the page, and returns where."""
        path = path_of(file, "file")
        path.write_text(self.page, encoding="utf-8")
        return path
