"""Results as files, written by the installed affskel-client: it knows every format, and this package none."""
from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple, Optional, Tuple, TypeVar, Union

from ._errors import UsageError
from ._programs import run_program
from ._settings import Settings, path_of


class Origin(NamedTuple):
    """What writes a result: a command of affskel-client without its -o."""

    settings: Settings
    command: Tuple[str, ...]


class Saveable:
    """A result of a job."""

    _origin: Optional[Origin] = None

    def save(self, file: Union[str, "os.PathLike[str]"]) -> Path:
        """Writes the result, in the format of the file's extension, and returns where.

        The installed affskel-client asks the job's server for it again.  Fields: .csv .dat .vti .vts .vtkhdf .hdf;
        skeletons and eroded solids: .vtp .ply .obj .stl .off, as points .csv .xyz .ply .vtp; measures: .csv .json.

        Raises:
            UsageError: the extension is none of these, affskel-client is not there, or the result is not a job's.

        Example:
            >>> job.skeleton().save("body.vtp")
        """
        if self._origin is None:
            raise UsageError("this does not come from a job, so that affskel-client cannot write it")
        path = path_of(file, "file")
        run_program(self._origin.settings, [*self._origin.command, "-o", str(path.absolute())],
                    "files are written by affskel-client")
        return path


Result = TypeVar("Result", bound=Saveable)


def with_origin(result: Result, settings: Settings, *command: str) -> Result:
    """The result, which then can be saved."""
    object.__setattr__(result, "_origin", Origin(settings, command))  # results are frozen
    return result
