"""Reads folders of manifests, by kubectl kustomize where that is installed."""
import re
import shutil
import subprocess

import yaml

KUBECTL = shutil.which("kubectl")


def kubectl(*words):
    return subprocess.run([KUBECTL, *words], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout


def renders_overlays():
    if not KUBECTL:
        return False
    major, minor = re.search(r'(?:v|"v)(\d+)\.(\d+)', kubectl("version", "--client")).groups()
    return (int(major), int(minor)) >= (1, 21)


def rendered(folder):
    """The documents of a kustomization; without kubectl, of one that sets only namespace and image."""
    if KUBECTL:
        return list(yaml.safe_load_all(kubectl("kustomize", str(folder))))
    how = yaml.safe_load((folder / "kustomization.yaml").read_text())
    image = f"{how['images'][0]['newName']}:{how['images'][0]['newTag']}"
    documents = []
    for name in how["resources"]:
        documents += yaml.safe_load_all(re.sub(r"(?m)image: affskel$", f"image: {image}", (folder / name).read_text()))
    for document in documents:
        if document["kind"] != "Namespace":
            document["metadata"]["namespace"] = how["namespace"]
    return documents
