"""What the files of make_files.py hold, whatever opens them."""
import json
import math
import os

FIELD_ARRAYS = {"E", "E_share", "normal", "direction", "inside"}
DIVERGENCE_ARRAYS = {"H", "inside"}
FACTS = ("job", "mesh_sha256", "v0", "spacing", "directions", "minimum", "frame", "core_version", "units")
# The arrays of points and of surfaces.
POINT_ARRAYS = {
    "skeleton": {"E", "normal", "direction", "H"},
    "eroded_points": {"E", "normal", "direction"},
    "mesh": set(),
    "alpha": {"E", "area"},
    "eroded": {"E", "area"},
    "sheet": {"E", "area", "strength", "normal_a", "normal_b"},
    "ridge": {"E", "area", "strength", "ratio", "kind", "part", "normal_a", "normal_b"},
}
RADIUS_OF_CURVES = {"radius"}  # of their sections; beside these where ridge gives curves, too
POINTS_ALONE = ("skeleton", "eroded_points")
LEVEL = 0.05


class Job:
    """A job's files, and what the client told of it."""

    def __init__(self, directory, frame):
        self.folder, self.frame = os.path.join(directory, frame), frame
        with open(self.path("facts.json"), encoding="utf-8") as told:
            facts = json.load(told)
        self.id, self.sha256 = facts["job"]["id"], facts["job"]["mesh_sha256"]
        prepared = facts["job"]["prepared"]
        self.v0, self.spacing, self.points = prepared["volume"], prepared["spacing"], prepared["points"]
        axes = prepared["frame"]
        # The longest of the lattice's steps.
        self.step = self.spacing * max(math.dist((0, 0, 0), axes[3 * a:3 * a + 3]) for a in range(3))
        self.eroded_volume = facts["eroded"]["volume"]
        self.triangles = prepared["triangles"]

    def path(self, name):
        return os.path.join(self.folder, name)

    def grids(self, extensions):
        """The extensions under which this job's field was written."""
        return [e for e in extensions if os.path.exists(self.path("field." + e))]


def check_facts(job, texts):
    """texts: what a file says of itself, by key, numbers as they are."""
    missing = [key for key in FACTS if not texts.get(key)]
    assert not missing, missing
    assert texts["job"] == job.id and texts["mesh_sha256"] == job.sha256 and texts["frame"] == job.frame, texts
    assert float(texts["v0"]) == job.v0 and float(texts["spacing"]) == job.spacing, texts


def facts_of_comments(lines):
    return dict(line.partition(" ")[::2] for line in lines)


def ball_level_radius(share):
    """Radius of the ball {E >= share v0} in the unit ball: (1 - p)^2 (2 + p) / 4 = share, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if (1 - middle) ** 2 * (2 + middle) / 4 > share else (low, middle)
    return low
