"""The pods of the manifests for Kubernetes, played by podman: a server with its volume, two workers, a person beside them; a
worker's and the server's containers are killed while a job is half done.

What podman 4.3 has no word for is done here as Kubernetes does it: a pod for each replica, the volume of a claim template,
what resourceFieldRef and $(NAME) stand for, the name of the Service, and files of secrets, which podman gives out undecoded:
folders with the same keys, owners and modes stand for them.

Usage: play_kube_test.py KUBERNETES-FOLDER PROGRAMS STORAGE"""
import json
import os
import shutil
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import yaml

import engine
import jobs
import manifests

engine.enter()
KUBERNETES, PROGRAMS, STORAGE = engine.paths(3)

NETWORK, SERVICE = "affskel", "affskel-server"
SERVER, WORKERS = "affskel-server-0-server", ("affskel-worker-0-worker", "affskel-worker-1-worker")


def pod(document, number, secrets, place):
    """The pod that a StatefulSet or a Deployment would make; secrets are contents by name and key."""
    template = json.loads(json.dumps(document["spec"]["template"]))
    name = f"{document['metadata']['name']}-{number}"
    spec = template["spec"]
    for volume in spec["volumes"]:
        if not (source := volume.pop("secret", None)):
            continue
        folder = Path(tempfile.mkdtemp(prefix="secret-", dir=place))
        os.chmod(folder, 0o755)
        contents = secrets[source["secretName"]]
        for item in source.get("items", [{"key": key, "path": key} for key in contents]):
            (folder / item["path"]).write_bytes(contents[item["key"]])
            os.chown(folder / item["path"], 0, spec["securityContext"]["fsGroup"])
            (folder / item["path"]).chmod(source["defaultMode"])
        volume["hostPath"] = {"path": str(folder), "type": "Directory"}
    for claim in document["spec"].get("volumeClaimTemplates", []):
        volume = claim["metadata"]["name"]
        spec["volumes"].append({"name": volume, "persistentVolumeClaim": {"claimName": f"{volume}-{name}"}})
    for container in spec["containers"]:
        values = {}
        for variable in container.pop("env", []):
            _, limit = variable["valueFrom"]["resourceFieldRef"]["resource"].split(".")
            values[variable["name"]] = container["resources"]["limits"][limit]
        for variable, value in values.items():
            container["args"] = [word.replace(f"$({variable})", value) for word in container["args"]]
    # Of a kind that podman does not remove: on a busy machine 4.3 tries before it knows that they have ended.
    annotations = {"io.podman.annotations.init.container.type": "always"}
    return {"apiVersion": "v1", "kind": "Pod", "spec": spec,
            "metadata": {"name": name, "labels": template["metadata"]["labels"], "annotations": annotations}}


class Kubernetes(unittest.TestCase):
    """In order: each step needs those before it."""

    @classmethod
    def setUpClass(cls):
        cls.engine = engine.Engine(STORAGE)
        cls.addClassCleanup(cls.engine.close)
        cls.secrets = {}
        cls.place = Path(tempfile.mkdtemp(prefix="affskel-kube-"))
        cls.addClassCleanup(shutil.rmtree, cls.place)
        cls.place.chmod(0o755)
        cls.documents = {document["metadata"]["name"]: document for document in manifests.rendered(KUBERNETES / "base")
                         if document["kind"] in ("StatefulSet", "Deployment")}
        cls.engine.podman("network", "create", NETWORK)

    def play(self, document):
        file = self.place / "pod.yaml"
        file.write_text(yaml.safe_dump(document))
        self.engine.podman("play", "kube", "--network", NETWORK, file)

    def person(self):
        settings = engine.bare_environment(HOME=str(self.place), AFFSKEL_SERVER=f"{SERVICE}:7060",
                                           AFFSKEL_TLS_CA=f"{self.place}/ca.crt", AFFSKEL_TOKEN_FILE=f"{self.place}/token")
        return jobs.Person(self, self.engine, PROGRAMS, self.place, settings)

    def test_1_server(self):
        self.engine.run("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days",
                        "1", "-subj", "/CN=test", "-addext", f"subjectAltName=DNS:{SERVICE}", "-keyout",
                        self.place / "tls.key", "-out", self.place / "ca.crt")
        certificate, key = (self.place / "ca.crt").read_bytes(), (self.place / "tls.key").read_bytes()
        self.secrets["affskel-tls"] = {"tls.crt": certificate, "tls.key": key, "ca.crt": certificate}
        self.play(pod(self.documents["affskel-server"], 0, self.secrets, self.place))
        for _ in range(100):
            if self.engine.health(SERVER):
                break
        self.assertTrue(self.engine.health(SERVER), self.engine.log(SERVER))

    def test_2_workers(self):
        token = self.engine.podman("exec", SERVER, "cat", "/var/lib/affskel/worker.token").encode()
        networks = self.engine.inspect(self.engine.podman("pod", "inspect", "affskel-server-0", "--format",
                                                          "{{.InfraContainerID}}").strip())["NetworkSettings"]["Networks"]
        address = networks[NETWORK]["IPAddress"]
        hosts = self.place / "hosts"
        hosts.write_text(f"127.0.0.1 localhost\n{address} {SERVICE}\n")
        subprocess.run(["mount", "--bind", hosts, "/etc/hosts"], check=True)
        self.secrets["affskel-worker"] = {"token": token}
        for number in range(self.documents["affskel-worker"]["spec"]["replicas"]):
            worker = pod(self.documents["affskel-worker"], number, self.secrets, self.place)
            worker["spec"]["hostAliases"] = [{"ip": address, "hostnames": [SERVICE]}]
            self.play(worker)
        for name in (SERVER, *WORKERS):
            status = Path(f"/proc/{self.engine.process(name)}/status").read_text()
            self.assertRegex(status, r"(?m)^Uid:\t760\t760\t760\t760$")
            self.assertRegex(status, r"(?m)^CapEff:\t0+$")
            self.assertTrue(self.engine.inspect(name)["HostConfig"]["ReadonlyRootfs"])

    def test_3_killed_containers_come_back_and_the_field_is_the_same(self):
        said = self.engine.podman("exec", SERVER, "affskel-server", "token", "add", "--data-dir", "/var/lib/affskel",
                                  "--owner", "ada")
        (self.place / "token").write_text(said)
        (self.place / "token").chmod(0o600)
        person = self.person()
        person.client("--quiet", "make", "body", "--triangles", "5000", "-o", "body.off")
        options = ("--points", "300000", *jobs.DIRECTIONS)
        job, watch = person.half_done(*options)
        before = {name: self.engine.process(name) for name in (WORKERS[0], SERVER)}
        for process in before.values():
            os.kill(process, signal.SIGKILL)
        person.assert_undisturbed(job, watch, options)
        for name, process in before.items():
            self.assertNotIn(self.engine.process(name), (0, process), name)

    def test_4_they_end_in_the_time_that_they_are_given(self):
        for name in (*WORKERS, SERVER):
            self.engine.podman("stop", "--time", "60", name)
            self.assertEqual(self.engine.inspect(name)["State"]["ExitCode"], 0, self.engine.log(name))


if __name__ == "__main__":
    unittest.main(failfast=True)
