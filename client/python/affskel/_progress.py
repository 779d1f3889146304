"""The bar that shows a job's directions, by tqdm where it is installed."""
from __future__ import annotations

import sys
from typing import Any, Optional

from ._status import Status


def _wanted(progress: Optional[bool]) -> bool:
    """By default where a person looks: at a terminal, or in a notebook."""
    if progress is not None:
        return progress
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


class ProgressBar:
    """Nothing is shown without tqdm, or where it is not wanted."""

    def __init__(self, progress: Optional[bool]) -> None:
        self._make: Any = None
        self._bar: Any = None
        if _wanted(progress):
            try:
                from tqdm.auto import tqdm
                self._make = tqdm
            except ImportError:
                pass

    def __enter__(self) -> "ProgressBar":
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def show(self, status: Status) -> None:
        if self._make is None:
            return
        if self._bar is None:
            self._bar = self._make(desc=status.name, total=status.directions_total or None,
                                   initial=status.directions_done, unit="direction")
        refining = status.stage == "refine"
        self._bar.unit = "point" if refining else "direction"
        self._bar.total = (status.points if refining else status.directions_total) or None
        self._bar.set_postfix_str(f"refine, round {status.refine_round}" if refining else status.stage, refresh=False)
        self._bar.n = status.refined_points if refining else status.directions_done
        self._bar.refresh()
