"""The manifests for Kubernetes: against the API's schema, against each other, and against what the programs know.

Usage: manifests_test.py DEPLOY-FOLDER PROGRAMS"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.request
from pathlib import Path

import yaml

import engine
import kubernetes_schema
import manifests

DEPLOY, PROGRAMS = engine.paths(2)
KUBERNETES = DEPLOY / "kubernetes"


def documents(folder):
    """As the API would get them: by kubectl kustomize where it is installed."""
    return manifests.rendered(KUBERNETES / folder)


def by_kind(kind, folder="base"):
    return {document["metadata"]["name"]: document for document in documents(folder) if document["kind"] == kind}


def containers(folder="base"):
    """Of every pod, with its pod's specification and metadata."""
    for document in documents(folder):
        if document["kind"] in ("StatefulSet", "Deployment"):
            template = document["spec"]["template"]
            for kind in ("initContainers", "containers"):
                for container in template["spec"].get(kind, []):
                    yield container, template["spec"], template["metadata"], document


def folders():
    """Overlays take a kubectl of 1.21 or later, whose kustomize knows patches of this form."""
    return ("base", "autoscale") if manifests.renders_overlays() else ("base",)


class Schema(unittest.TestCase):
    def test_every_document_is_one_of_the_api(self):
        for folder in folders():
            for document in documents(folder):
                with self.subTest(folder=folder, kind=document["kind"]):
                    kubernetes_schema.check(document)
        kubernetes_schema.check(yaml.safe_load((KUBERNETES / "autoscale/autoscaler.yaml").read_text()))

    def test_schema_finds_faults(self):
        (server,) = by_kind("StatefulSet").values()
        def container(document):
            return document["spec"]["template"]["spec"]["containers"][0]
        for fault, spoil in {
                "no field replica ": lambda d: d["spec"].update(replica=1),
                "replicas: not of type int": lambda d: d["spec"].update(replicas="1"),
                "`container_port`, must not": lambda d: container(d)["ports"][0].pop("containerPort"),
                "drop: not a list": lambda d: container(d)["securityContext"]["capabilities"].update(drop="ALL"),
                "no kind StatefulSets": lambda d: d.update(kind="StatefulSets"),
        }.items():
            spoilt = json.loads(json.dumps(server))
            spoil(spoilt)
            with self.assertRaises(kubernetes_schema.Fault, msg=fault) as caught:
                kubernetes_schema.check(spoilt)
            self.assertIn(fault.strip(), str(caught.exception))


class Relations(unittest.TestCase):
    def test_everything_is_in_one_namespace(self):
        for folder in folders():
            (namespace,) = by_kind("Namespace", folder)
            self.assertEqual({document["metadata"]["namespace"] for document in documents(folder)
                              if document["kind"] != "Namespace"}, {namespace})

    def test_selectors_find_their_pods(self):
        labels = {document["metadata"]["name"]: document["spec"]["template"]["metadata"]["labels"]
                  for document in documents("base") if document["kind"] in ("StatefulSet", "Deployment")}
        for document in documents("base"):
            spec = document.get("spec", {})
            selector = spec.get("podSelector") or spec.get("selector")
            if selector:
                self.assertEqual(selector.get("matchLabels", selector), labels[document["metadata"]["name"]],
                                 document["kind"])

    def test_ports_are_those_that_the_server_listens_on(self):
        server = next(c for c, *_ in containers() if c["name"] == "server")
        ports = {port["name"]: port["containerPort"] for port in server["ports"]}
        self.assertIn(f"--listen=0.0.0.0:{ports['grpc']}", server["args"])
        service = by_kind("Service")["affskel-server"]["spec"]
        self.assertEqual([(port["targetPort"], port["port"]) for port in service["ports"]], [("grpc", ports["grpc"])])
        self.assertEqual(by_kind("StatefulSet")["affskel-server"]["spec"]["serviceName"], "affskel-server")
        worker = next(c for c, *_ in containers() if c["name"] == "worker")
        self.assertIn(f"--server=affskel-server:{service['ports'][0]['port']}", worker["args"])
        policies = by_kind("NetworkPolicy")
        opened = [port["port"] for rule in policies["affskel-server"]["spec"]["ingress"] for port in rule["ports"]]
        self.assertEqual(opened, [7060, 9464])
        self.assertEqual(policies["affskel-worker"]["spec"]["egress"][0]["ports"], [{"port": ports["grpc"]}])

    def test_volumes_are_there(self):
        for container, spec, _, document in containers():
            volumes = {volume["name"] for volume in spec["volumes"]}
            volumes |= {claim["metadata"]["name"] for claim in document["spec"].get("volumeClaimTemplates", [])}
            self.assertLessEqual({mount["name"] for mount in container["volumeMounts"]}, volumes)

    def test_nothing_may_be_done_or_written(self):
        for folder in folders():
            for container, spec, *_ in containers(folder):
                pod = spec["securityContext"]
                self.assertEqual((pod["runAsNonRoot"], pod["runAsUser"], pod["runAsGroup"], pod["seccompProfile"]["type"]),
                                 (True, 760, 760, "RuntimeDefault"))
                self.assertFalse(spec["automountServiceAccountToken"])
                own = container["securityContext"]
                self.assertEqual((own["allowPrivilegeEscalation"], own["readOnlyRootFilesystem"], own["capabilities"]),
                                 (False, True, {"drop": ["ALL"]}))
                written = {mount["mountPath"] for mount in container["volumeMounts"] if not mount.get("readOnly")}
                self.assertLessEqual(written, {"/var/lib/affskel", "/var/backups"})

    def test_ends_are_given_their_time(self):
        # What compose gives them: see there.
        for name, least in (("server", 20), ("worker", 60)):
            spec = next(spec for container, spec, *_ in containers() if container["name"] == name)
            self.assertGreaterEqual(spec["terminationGracePeriodSeconds"], least)


class Guide(unittest.TestCase):
    """The section on Kubernetes, as far as it can be typed without a cluster."""

    def setUp(self):
        text = re.search(r"^## Kubernetes\n(.*?)^## ", (DEPLOY / "README.md").read_text(), re.M | re.S)[1]
        self.text, self.blocks = text, re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S)

    def test_certificate_has_the_names_by_which_the_server_is_called(self):
        names = re.search(r"subjectAltName=(\S+)", self.blocks[0])[1].split(",")
        self.assertIn("port-forward", self.text)
        self.assertLessEqual({f"DNS:{name}" for name in (*by_kind("Service"), "lab.example.org", "localhost")}, set(names))

    def test_secrets_are_written_for_their_owner_alone(self):
        self.assertLess(self.blocks[0].index("umask 077\n"), self.blocks[0].index("openssl"))

    def test_backup_may_be_there_from_yesterday(self):
        self.assertRegex(self.text, r"affskel-server backup [^`]* --force`")

    @unittest.skipUnless(manifests.KUBECTL, "SKIPPED: no kubectl (package kubernetes-client)")
    def test_restore_lets_the_server_sleep_on_its_volume(self):
        patch = re.search(r"kubectl -n affskel patch statefulset affskel-server -p '(.*?)'", self.blocks[2], re.S)[1]
        (server,) = by_kind("StatefulSet").values()
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(server, file)
            file.flush()
            patched = json.loads(manifests.kubectl("patch", "--local", "-o", "json", "-f", file.name, "-p", patch))
        kubernetes_schema.check(patched)
        (container,) = patched["spec"]["template"]["spec"]["containers"]
        (before,) = server["spec"]["template"]["spec"]["containers"]
        self.assertEqual(container["command"], ["sleep", "infinity"])
        self.assertIn("worker.token", self.blocks[2])  # of the database that first-start made in an empty volume
        self.assertEqual(set(before) - set(container), {"args", "startupProbe", "readinessProbe", "livenessProbe"})
        self.assertEqual(container["volumeMounts"], before["volumeMounts"])


class Programs(unittest.TestCase):
    def options(self, program, *command):
        told = subprocess.run([PROGRAMS / program, *command, "--help"], check=True, stdout=subprocess.PIPE, text=True)
        return set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", told.stdout))

    def assert_known(self, words):
        program, *arguments = words
        if program == "affskel-first-start":
            usage = (DEPLOY / "containers/first-start").read_text()
            return self.assertRegex(usage, rf"(?m)^  {arguments[0]}\) ")
        for argument in arguments:
            if argument.startswith("-"):
                self.assertIn(argument.partition("=")[0], self.options(program), words)
        return None

    def test_every_option_is_one_that_the_programs_know(self):
        seen = set()
        for folder in folders():
            for container, *_ in containers(folder):
                self.assert_known([*container["command"], *container.get("args", [])])
                for kind in ("startupProbe", "readinessProbe", "livenessProbe"):
                    if probe := container.get(kind):
                        program, option, _, command = probe["exec"]["command"]
                        self.assertIn(option, self.options(program))
                        self.assertIn("health service", subprocess.run(
                            [PROGRAMS / program, command, "--help"], check=True, stdout=subprocess.PIPE, text=True).stdout)
                seen.add(container["command"][0])
        self.assertEqual(seen, {"affskel-first-start", "affskel-server", "affskel-worker"})

    def test_compose_file_too(self):
        services = yaml.safe_load((DEPLOY / "containers/compose.yaml").read_text())["services"]
        for name in ("server", "worker", "web"):
            program, *words = services[name]["command"]
            known = self.options(program) | (self.options(program, "web") if name == "web" else set())
            self.assertLessEqual({word for word in words if word.startswith("-")}, known, name)

    def test_image_is_made_of_all_that_the_packages_take(self):
        copied = re.findall(r"(?m)^COPY (.*) \S+$", (DEPLOY / "containers/Containerfile").read_text())
        copied = {f"{place}/" for place in " ".join(copied).split()}
        packaging = (DEPLOY / "packaging/CMakeLists.txt").read_text()
        for variable, place in re.findall(r"set\((\w+) (\$\{PROJECT_SOURCE_DIR\}\S+)\)", packaging):
            packaging = packaging.replace(f"${{{variable}}}", place)
        taken = set(re.findall(r"\$\{PROJECT_SOURCE_DIR\}/([^\s)]+)", packaging))
        self.assertGreater(len(taken), 5)
        for file in taken:
            self.assertTrue(any(f"{file}/".startswith(place) for place in copied), file)

    def test_options_that_nobody_knows_are_found(self):
        with self.assertRaises(AssertionError):
            self.assert_known(["affskel-worker", "--treads=2"])

    def test_autoscaler_asks_for_metrics_that_the_server_has(self):
        autoscaler = yaml.safe_load((KUBERNETES / "autoscale/autoscaler.yaml").read_text())
        asked = {metric["external"]["metric"]["name"] for metric in autoscaler["spec"]["metrics"]}
        adapter = yaml.safe_load((KUBERNETES / "autoscale/prometheus-adapter.yaml").read_text())["rules"]["external"]
        self.assertEqual({rule["name"]["as"] for rule in adapter}, asked)
        for rule in adapter:
            for text in (rule["seriesQuery"], rule["metricsQuery"]):
                self.assertIn(rule["name"]["as"], text)
        self.assertLessEqual(asked, self.metrics())
        self.assertIn(autoscaler["spec"]["scaleTargetRef"]["name"], by_kind("Deployment"))

    def metrics(self):
        with tempfile.TemporaryDirectory(prefix="affskel-kube-") as data:
            server = subprocess.Popen([PROGRAMS / "affskel-server", "--data-dir", data, "--metrics", "127.0.0.1:0"],
                                      stderr=subprocess.PIPE, text=True, env=engine.bare_environment())
            try:
                line = next(line for line in server.stderr if "event=metrics" in line)
                address = re.search(r"address=(\S+)", line)[1]
                with urllib.request.urlopen(f"http://{address}/metrics", timeout=60) as answer:
                    return set(re.findall(r"(?m)^# TYPE (\w+) ", answer.read().decode()))
            finally:
                server.terminate()
                server.communicate()


@unittest.skipUnless(manifests.KUBECTL, "SKIPPED: no kubectl (package kubernetes-client)")
class Secrets(unittest.TestCase):
    def test_they_are_what_the_pods_mount_and_come_from_files_alone(self):
        files = {"tls": ("tls.crt", "tls.key", "ca.crt"), "worker": ("token",)}
        made = {}
        for folder, names in files.items():
            self.assertLessEqual({path.name for path in (KUBERNETES / "secrets" / folder).iterdir()},
                                 {"kustomization.yaml", *names})
            with tempfile.TemporaryDirectory(prefix="affskel-secrets-") as place:
                shutil.copy(KUBERNETES / "secrets" / folder / "kustomization.yaml", place)
                for name in names:
                    (Path(place) / name).write_text(name)
                (secret,) = manifests.rendered(Path(place))
                made[secret["metadata"]["name"]] = secret
        for secret in made.values():
            kubernetes_schema.check(secret)
            self.assertEqual(secret["metadata"]["namespace"], "affskel")
        mounted = {}
        for container, spec, *_ in containers():
            for volume in spec["volumes"]:
                if name := volume.get("secret", {}).get("secretName"):
                    place = next((mount["mountPath"] for mount in container["volumeMounts"]
                                  if mount["name"] == volume["name"]), None)
                    for key in made[name]["data"]:
                        mounted[f"{place}/{key}"] = name
        files = [argument.partition("=")[2] for container, *_ in containers() for argument in container.get("args", [])
                 if argument.startswith(("--tls-", "--token-file"))]
        self.assertEqual(len(files), 4)
        for file in files:
            self.assertIn(file, mounted)


class Overlay(unittest.TestCase):
    @unittest.skipUnless(manifests.renders_overlays(), "SKIPPED: no kubectl of 1.21 or later")
    def test_autoscaler_has_the_number_of_workers_for_itself(self):
        self.assertNotIn("replicas", by_kind("Deployment", "autoscale")["affskel-worker"]["spec"])
        server = next(c for c, *_ in containers("autoscale") if c["name"] == "server")
        self.assertIn({"name": "metrics", "containerPort": 9464}, server["ports"])
        self.assertEqual([a for a in server["args"] if a.startswith("--tls")],
                         ["--tls-cert=/etc/affskel/tls/tls.crt", "--tls-key=/etc/affskel/tls/tls.key"])


if __name__ == "__main__":
    sys.exit(unittest.main())
