"""Files of every kind from jobs in two frames, for the tests that open them with the programs of others.

Usage: make_files.py AFFSKEL-CLIENT DIRECTORY

DIRECTORY/FRAME holds the files of a body, FRAME being axis and affine, with facts.json: what the client told.
DIRECTORY/ball.vti is the field of a ball of radius 3000 on a coarse lattice, ball.json its job.
"""
import json
import os
import shutil
import subprocess
import sys

CLIENT, DIRECTORY = sys.argv[1:]
FRAMES = ("axis", "affine")
LEVEL = "5%"
POINTS = "500000"


def client(*arguments):
    environment = dict(os.environ, AFFSKEL_HOME=os.path.join(DIRECTORY, "home"), XDG_CONFIG_HOME=DIRECTORY)
    environment.pop("AFFSKEL_SERVER", None)
    done = subprocess.run([CLIENT, "--json", *arguments], env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def write_all(frame):
    folder = os.path.join(DIRECTORY, frame)
    os.mkdir(folder)
    job = client("submit", os.path.join(DIRECTORY, "body.off"), "--frame", frame, "--points", POINTS, "--wait")

    def write(command, name, *options):
        return client(*command.split(), job["id"], *options, "-o", os.path.join(folder, name))

    def fetch(artefact, name, *options):
        return client("fetch", job["id"], artefact, *options, "-o", os.path.join(folder, name))

    grids = ["vts", "hdf", "vtkhdf"] + (["vti"] if frame == "axis" else [])
    for extension in grids + ["csv"]:
        fetch("field", "field." + extension)
        fetch("divergence", "divergence." + extension)
    for extension in ("vtp", "ply", "csv"):
        write("skeleton", "skeleton." + extension, "--operator", "zucker-hummel")
        write("erode", "eroded_points." + extension, "--fraction", LEVEL, "--as", "points")
    fetch("curve", "curve.glb")
    fetch("thickness", "thickness.vtp")
    for extension in ("vtp", "ply", "stl", "obj", "off"):
        fetch("mesh", "mesh." + extension)
        write("skeleton", "alpha." + extension, "--operator", "zucker-hummel", "--as", "complex")
        write("skeleton", "ridge." + extension)
        write("skeleton", "sheet." + extension, "--operator", "chords")
        eroded = write("erode", "eroded." + extension, "--fraction", LEVEL, "--as", "surface")
    with open(os.path.join(folder, "facts.json"), "w", encoding="utf-8") as facts:
        json.dump({"job": job, "eroded": eroded}, facts)


shutil.rmtree(DIRECTORY, ignore_errors=True)
os.makedirs(DIRECTORY)
client("make", "body", "--triangles", "2000", "-o", os.path.join(DIRECTORY, "body.off"))
for one in FRAMES:
    write_all(one)
client("make", "sphere", "--radius", "3000", "--triangles", "5120", "-o", os.path.join(DIRECTORY, "ball.off"))
ball = client("submit", os.path.join(DIRECTORY, "ball.off"), "--spacing", "1000", "--wait")
client("fetch", ball["id"], "field", "-o", os.path.join(DIRECTORY, "ball.vti"))
with open(os.path.join(DIRECTORY, "ball.json"), "w", encoding="utf-8") as told:
    json.dump(ball, told)
