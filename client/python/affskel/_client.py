"""A client of one server."""
from __future__ import annotations

import contextlib
import getpass
import hashlib
import numbers
import os
import re
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Optional, Union

from ._checks import (MAX_POINTS, edges_of, longest_side, number_of, require_closed, require_finite, require_off,
                      require_points, share_of, text_of)
from ._errors import AffskelError, BadInputError, LimitError, UsageError
from ._job import Job, skeleton_params
from ._meshes import Mesh, MeshLike, mesh_of
from ._messages import plain, value_of_word, word
from ._programs import find_program, run_program
from ._session import Session
from ._settings import PathLike, choose
from ._status import status_of
from .v1 import client_service_pb2 as service
from .v1 import types_pb2 as types

DEFAULT_POINTS = 100000
SEEN_WITHIN = 5.0  # seconds for the first status of a job that affskel-client has submitted
MAX_NAME, MAX_OWNER = 200, 100  # bytes, by the contract


# How affskel-client tells what would mend a mesh with holes.
_COMMANDS = re.compile(r"; (?:fill them by: .*? --repair (fill=\S+) .*, or )?"
                       "take a new surface round all of it: .* --repair wrap .*")


_CONTROLS = re.compile("[\\0-\\x1f\\x7f-\\x9f]")  # which no name may have


def _own_way(commands: re.Match[str]) -> str:
    """What affskel-client's advice is here."""
    fill = f"fill them by repair='{commands[1]}', or " if commands[1] else ""
    return f"; {fill}take a new surface round all of it by repair='wrap'"


def _short(text: str, most: int) -> str:
    """At most so many bytes, cut between characters; what is no text becomes a question mark."""
    return text.encode("utf-8", "replace")[:most].decode("utf-8", "ignore")


def _one_line(text: str) -> str:
    """As affskel-client has names of files."""
    return _CONTROLS.sub(lambda control: " " if control[0] in "\n\t" else "?", text)


def _user_name() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):  # no entry for the user
        return str(os.geteuid())


_SPACING = ", in units of the mesh, or a share of its length such as '1%'"


def _needs_program(mesh: Mesh, spacing: Union[float, str, None], repair: str) -> bool:
    """Whether affskel-client, which is there, must look at the mesh: it is of a kind that is not read here, or has
    holes or faces too many, which may be mended.

    Raises:
        BadInputError: what a worker would say of the mesh much later.
    """
    if mesh.polygons is None:
        if mesh.file and find_program() is not None:
            return True
        require_off(mesh.text or b"", mesh.file)
        return False
    try:
        require_finite(mesh.polygons, mesh.file)
    except BadInputError:
        if mesh.file and find_program() is not None:  # which tells the line
            return True
        raise
    edges = edges_of(mesh.polygons)
    try:
        require_closed(edges, mesh.file)
    except BadInputError:
        if repair == "auto" and find_program() is not None:
            return True
        raise
    if repair == "auto" and edges.are_crowded and find_program() is not None:
        return True
    if spacing is not None:
        require_points(mesh.polygons, number_of(spacing, "spacing", _SPACING), mesh.file)
    return False


class Client:
    """A connection to a server, made when it is first needed.  Thread-safe; a context manager closes it.

    Without arguments it meets the server that affskel-client would: $AFFSKEL_SERVER, else the one of the configuration
    file (~/.config/affskel/config), else a private server under $AFFSKEL_HOME, which affskel-client starts and which
    leaves when idle.

    Args:
        server: "unix:PATH" or "HOST:PORT".
        token_file: its first line is the token to show; else $AFFSKEL_TOKEN_FILE or the configuration's `token_file`.
            It is read again when it has changed.
        tls_ca: who signed the server's certificate, PEM: speak TLS; else $AFFSKEL_TLS_CA or `tls_ca`.
        client_cert, client_key: own certificate and its key, PEM, for servers that ask for one; else
            $AFFSKEL_CLIENT_CERT and $AFFSKEL_CLIENT_KEY, or `client_cert` and `client_key`.
        patience: seconds for which a server that went away is waited for, in every call.

    Raises:
        UsageError: an address, a file, the patience or the configuration is wrong, or the token would leave this
            machine in the clear.
    """

    def __init__(self, server: Optional[str] = None, *, token_file: Optional[PathLike] = None,
                 tls_ca: Optional[PathLike] = None, client_cert: Optional[PathLike] = None,
                 client_key: Optional[PathLike] = None, patience: float = 300.0) -> None:
        files = {"token_file": token_file, "tls_ca": tls_ca, "client_cert": client_cert, "client_key": client_key}
        patience = number_of(patience, "patience", " of seconds")
        if not patience >= 0:
            raise UsageError(f"patience is {patience!r} seconds, and at least 0 is taken")
        self._session = Session(choose(server, files), patience)

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connection, and the calls under way; the next call opens another."""
        self._session.close()

    def submit(self, mesh: MeshLike, *, spacing: Union[float, str, None] = None, points: Optional[int] = None,
               directions: str = "triangles", minimum: str = "set", frame: str = "axis",
               operator: str = "ridge", threshold: Optional[float] = None, name: Optional[str] = None,
               priority: int = 5, request_id: str = "", repair: str = "auto",
               isovalue: Optional[float] = None) -> Job:
        """Submits a mesh.  The same mesh and parameters give the same job, computed once.

        A mesh that bounds no solid is repaired as `affskel-client submit` does, where that is installed: `Status.notes`
        tells the steps, `Job.source` gives it as it came.  What cannot be repaired unasked is refused at once.

        Args:
            mesh: a path (OFF; other formats are read by the installed affskel-client), OFF text as bytes, a pair of
                vertices (n, 3) and faces (m, 3) or sequences of indices, or a mesh of trimesh, pyvista or VTK.
            spacing: of the lattice, mesh units, or a share of the mesh's longest side: "1%".
            points: number of sample points to aim at, instead of a spacing; default 100000.
            directions: "triangles", "sphere:N", "random:N:SEED", joined by "+".
            minimum: "set": E is the least volume over the directions; "infimum": over all, beginning from these.
            frame: axes of the lattice: "axis", "pca", "obb" or "affine".
            operator, threshold: of the job's own skeleton; see `Job.skeleton`.
            name: for people; default the file's stem.
            priority: 0 .. 9, higher first.
            request_id: submitting again with the same key and content gives the same job; other content is refused.
            repair: "auto" welds, turns, drops and fills what needs it, and `Status.notes` tells so; "none" refuses;
                "fill=LENGTH", in mesh units, "wrap" and "wrap=ALPHA" submit what the installed affskel-client makes of
                it.
            isovalue: of an image of voxels (.nrrd, .mha, .nii): the value at the surface of the solid.

        Raises:
            UsageError: an argument is wrong.
            BadInputError: the arrays are no mesh, it has holes, the spacing leaves no points in it, or affskel-client
                could not read the file.
            LimitError: the mesh, or what the owner has, exceeds a limit.
            OSError: the file cannot be read.

        Example:
            >>> job = affskel.submit("body.off", points=100000).wait()
        """
        if spacing is not None and points is not None:
            raise UsageError("spacing and points exclude each other")
        given = mesh_of(mesh)
        if given.text == b"":
            raise BadInputError(f"{given.file or 'the mesh'} is empty", file=given.file)
        share = share_of(spacing)
        if share is not None and given.polygons is not None:
            require_finite(given.polygons, given.file)
            spacing = share * longest_side(given.polygons)
            share = None
        operator = "ridge" if operator is None else operator
        for value, what in ((directions, "directions"), (minimum, "minimum"), (frame, "frame"), (operator, "operator"),
                            (repair, "repair"), (request_id, "request_id"), ("" if name is None else name, "name")):
            text_of(value, what)
        header = self._header(share or spacing, points, directions, minimum, frame, repair)
        by_program = given.text is None or share is not None or isovalue is not None or repair not in ("auto", "none")
        if not by_program:
            by_program = _needs_program(given, spacing, repair)
        header.skeleton.CopyFrom(skeleton_params(operator, threshold))
        header.name = name or _short(_one_line(given.name), MAX_NAME)
        if isinstance(priority, bool) or not isinstance(priority, numbers.Integral) or priority not in range(10):
            raise UsageError(f"the priority {priority!r} is not a whole number 0 .. 9")
        header.priority = int(priority)
        header.request_id = request_id
        if by_program or given.text is None:
            return self._submit_file(given, header, operator, repair, isovalue, share)
        self._complete(header, given.text)
        response = self._session.submit(header, given.text)
        return Job(self._session, response.job.id, response.existed, given.file, status_of(response.job))

    def job(self, job: str) -> Job:
        """A job that is there.

        Args:
            job: its id, a unique prefix of at least 6 characters, or "@last", the caller's own last one.

        Raises:
            NotFoundError: there is none, or it is another owner's.
            UsageError: the text is no id.

        Example:
            >>> affskel.job("@last").status().state
        """
        known = self._session.get_job(text_of(job, "job"))
        return Job(self._session, known.id, seen=status_of(known))

    def jobs(self, *, state: Optional[str] = None, owner: Optional[str] = None, limit: int = 50) -> List[Job]:
        """Jobs, newest first; `seen` is the status of each.

        Args:
            state: "queued", "running", "done", "failed" or "cancelled"; None = all.
            owner: None = all that the caller may see.
            limit: how many at most, at least 1.

        Raises:
            UsageError: the state is no state, the owner no text, or the limit no such number.

        Example:
            >>> pandas.DataFrame(job.seen for job in affskel.jobs(state="done"))
        """
        if isinstance(limit, bool) or not isinstance(limit, numbers.Integral) or limit < 1:
            raise UsageError(f"the limit {limit!r} is not a whole number above 0")
        request = service.ListJobsRequest(owner="" if owner is None else text_of(owner, "owner"))
        if state is not None:
            request.states.append(value_of_word(types.JobState, state, "state"))
        return [Job(self._session, job.id, seen=status_of(job)) for job in self._session.list_jobs(request, int(limit))]

    def server_info(self) -> Dict[str, Any]:
        """Version, workers and queue of the server, by the names of ServerInfo in the contract, and its address.

        Raises:
            UnreachableError: no server answers.

        Example:
            >>> affskel.server_info()["version"]
        """
        info = plain(self._session.server_info())
        info["address"] = self._session.address()
        return info

    @staticmethod
    def _header(spacing: Union[float, str, None], points: Optional[int], directions: str, minimum: str,
                frame: str, repair: str) -> service.SubmitJobHeader:
        header = service.SubmitJobHeader()
        if spacing is not None:
            step = number_of(spacing, "spacing", _SPACING)
            if not 0 < step < float("inf"):
                raise UsageError(f"the spacing {spacing} is not above 0")
            header.params.sampling.spacing = step
        else:
            wanted = DEFAULT_POINTS if points is None else points
            if not 1 <= number_of(wanted, "points") <= MAX_POINTS or int(wanted) != wanted:
                raise UsageError(f"the number of points {wanted} is not 1 .. 2^31")
            header.params.sampling.target_points = int(wanted)
        header.params.directions = directions
        header.params.minimum = value_of_word(types.Minimum, minimum, "minimum")
        header.params.frame = value_of_word(types.Frame, frame, "frame")
        header.params.repair = repair != "none"
        return header

    def _complete(self, header: service.SubmitJobHeader, text: bytes) -> None:
        """What depends on the mesh and on the server."""
        info = self._session.server_info()
        if 0 < info.max_mesh_bytes < len(text):
            raise LimitError(f"the mesh has {len(text)} bytes; the server takes at most {info.max_mesh_bytes}")
        if not info.caller.owner:  # a server that does not know its callers is told
            header.owner = _short(_user_name(), MAX_OWNER)
        header.mesh_sha256 = hashlib.sha256(text).hexdigest()
        header.mesh_bytes = len(text)

    def _submit_file(self, given: Mesh, header: service.SubmitJobHeader, operator: str, repair: str,
                     isovalue: Optional[float], share: Optional[float]) -> Job:
        """By affskel-client, which reads the file, checks and repairs it, and submits it as OFF text."""
        params, sampling = header.params, header.params.sampling
        spacing = repr(sampling.spacing) if share is None else f"{100 * share!r}%"
        density = ["--spacing", spacing] if sampling.HasField("spacing") else [
            "--points", str(sampling.target_points)]
        options = [*density, "--directions", params.directions or "triangles",
                   "--minimum", word(types.Minimum, params.minimum), "--frame", word(types.Frame, params.frame),
                   "--operator", operator,
                   "--priority", str(header.priority), "--repair", repair]
        if isovalue is not None:
            options += ["--isovalue", repr(float(number_of(isovalue, "isovalue")))]
        if header.skeleton.threshold:
            options += ["--threshold", repr(header.skeleton.threshold)]
        if header.name:
            options += ["--name", header.name]
        if header.request_id:
            options += ["--request-id", header.request_id]
        with tempfile.TemporaryDirectory() as folder:
            file = given.file
            if not file:
                file = os.path.join(folder, "mesh.off")
                Path(file).write_bytes(given.text or b"")
            try:
                document = run_program(self._session.reached(), ["submit", *options, "--", file],
                                       f"{given.file or 'the mesh'}: formats other than OFF, images and repair are "
                                       "affskel-client's")
            except AffskelError as error:
                message = _COMMANDS.sub(_own_way, error.message)
                if given.file:
                    raise type(error)(message, file=error.file, line=error.line) from None
                if message.startswith("is "):
                    message = "the mesh " + message
                raise type(error)(message.replace(file, "the mesh")) from None  # the caller has no such file
        job = Job(self._session, document["id"], bool(document["existed"]), given.file)
        with contextlib.suppress(AffskelError):  # the job is there whatever becomes of this call
            job.seen = status_of(self._session.get_job(job.id, SEEN_WITHIN))
        return job
