"""Submits a mesh to an affskel-server, follows the job across restarts of the server, and writes the field as CSV.

    protoc -I proto --python_out=OUT --grpc_python_out=OUT \\
           --plugin=protoc-gen-grpc_python=/usr/bin/grpc_python_plugin proto/affskel/v1/{types,client_service}.proto
    PYTHONPATH=OUT python3 proto/examples/erode.py unix:/srv/affskel/server.sock body.off field.csv

Debian 12: protobuf-compiler-grpc and python3-grpcio (the protoc of python3-grpc-tools is too old).
"""
import hashlib
import struct
import sys
import time

import grpc
from affskel.v1 import client_service_pb2 as service, client_service_pb2_grpc as rpc, types_pb2 as types

MIB = 1 << 20


def submit(stub, name, mesh):
    """A job id; equal submissions give equal jobs, so that this may be tried again after any error."""
    params = types.ErosionParams(sampling=types.Sampling(target_points=10000), repair=True)
    header = service.SubmitJobHeader(name=name, priority=5, params=params, mesh_bytes=len(mesh),
                                     mesh_sha256=hashlib.sha256(mesh).hexdigest())

    def messages():
        yield service.SubmitJobRequest(header=header)
        for begin in range(0, len(mesh), MIB):
            yield service.SubmitJobRequest(data=mesh[begin:begin + MIB])
    return stub.SubmitJob(messages(), wait_for_ready=True).job.id


def follow(stub, job):
    """The job in its final state."""
    while True:
        try:
            for state in stub.WatchJob(service.WatchJobRequest(job=job), wait_for_ready=True):
                print(f"{state.directions_done} of {state.directions_total} directions", file=sys.stderr)
            return state
        except grpc.RpcError as error:
            if error.code() not in (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.CANCELLED):
                raise  # these two: the server is closing, or away
            time.sleep(1)


def fetch(stub, job, kind):
    """The bytes of an artefact, its hash checked."""
    answers = stub.FetchArtifact(service.FetchArtifactRequest(job=job, kind=kind), timeout=3600)
    header = next(answers).header
    data = b"".join(answer.data for answer in answers)
    if len(data) != header.bytes or hashlib.sha256(data).hexdigest() != header.sha256:
        raise IOError("the artefact was cut short")
    return data


def places(lattice):
    """The sample points in the order of their ranks."""
    origin, (a, b, c) = lattice.origin, (lattice.axes[0:3], lattice.axes[3:6], lattice.axes[6:9])
    _, ny, nz = lattice.dims
    for start, length in zip(lattice.run_start, lattice.run_length):
        for index in range(start, start + length):
            i, j, k = index // nz // ny, index // nz % ny, index % nz
            yield tuple(origin[n] + (i * a[n] + (j * b[n] + k * c[n])) for n in range(3))


def write_field(stub, job, file):
    lattice = types.Lattice.FromString(fetch(stub, job, service.ARTIFACT_KIND_LATTICE))
    normals = types.Directions.FromString(fetch(stub, job, service.ARTIFACT_KIND_DIRECTIONS)).xyz
    records = struct.iter_unpack("<ddI", fetch(stub, job, service.ARTIFACT_KIND_FIELD))
    print("x,y,z,E,nx,ny,nz,direction", file=file)
    for place, (erosion, _, direction) in zip(places(lattice), records):
        numbers = (*place, erosion, *normals[3 * direction:3 * direction + 3])
        print(",".join(f"{number:.17g}" for number in numbers) + f",{direction}", file=file)


def main(address, mesh, field):
    with open(mesh, "rb") as file, grpc.insecure_channel(address) as channel:
        stub = rpc.ErosionServiceStub(channel)
        job = submit(stub, mesh, file.read())
        final = follow(stub, job)
        if final.state != types.JOB_STATE_DONE:
            sys.exit(f"{job}: {types.JobState.Name(final.state)} {final.error.message}")
        with open(field, "w") as out:
            write_field(stub, job, out)
        print(job)


if __name__ == "__main__":
    main(*sys.argv[1:])
