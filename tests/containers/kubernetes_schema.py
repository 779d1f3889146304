"""The API's schema as Debian has it: the classes of python3-kubernetes, which are generated from the API's OpenAPI document.

Each class names its fields, their types, and which are required.  The package is of Kubernetes 1.22: autoscaling/v2 came
with 1.23, as v2beta2 under another name, and is read as such.
"""
import re

from kubernetes import client
from kubernetes.client import models

CONFIGURATION = client.Configuration()
SIMPLE = {"str": str, "int": int, "bool": bool, "float": (int, float)}


class Fault(Exception):
    """Place and cause."""


def model_of(document):
    group, _, version = document["apiVersion"].rpartition("/")
    if (group, version) == ("autoscaling", "v2"):
        version = "v2beta2"
    name = version[0].upper() + version[1:] + document["kind"]
    if not hasattr(models, name):
        raise Fault(f"{document['apiVersion']}: no kind {document['kind']}")
    return getattr(models, name)


def check(document):
    """Throws Fault where a document has a field that its kind has not, a value of another type, or lacks what is required."""
    built(document, model_of(document), document["kind"])


def built(value, model, place):
    if not isinstance(value, dict):
        raise Fault(f"{place}: not an object but {value!r}")
    fields = {written: name for name, written in model.attribute_map.items()}
    if unknown := value.keys() - fields.keys():
        raise Fault(f"{place}: no field {', '.join(sorted(unknown))} in {model.__name__}")
    given = {fields[key]: typed(part, model.openapi_types[fields[key]], f"{place}.{key}") for key, part in value.items()}
    try:
        return model(local_vars_configuration=CONFIGURATION, **given)
    except ValueError as error:  # what is required, and the bounds of numbers
        raise Fault(f"{place}: {error}") from error


def typed(value, name, place):
    if match := re.fullmatch(r"list\[(.*)\]", name):
        if not isinstance(value, list):
            raise Fault(f"{place}: not a list but {value!r}")
        return [typed(part, match[1], f"{place}[{i}]") for i, part in enumerate(value)]
    if match := re.fullmatch(r"dict\(str, (.*)\)", name):
        if not isinstance(value, dict):
            raise Fault(f"{place}: not a map but {value!r}")
        return {key: typed(part, match[1], f"{place}.{key}") for key, part in value.items()}
    if name == "object":  # a number or a text, as ports and percentages are
        if not isinstance(value, (int, str)):
            raise Fault(f"{place}: neither number nor text but {value!r}")
        return value
    if name in SIMPLE:
        if not isinstance(value, SIMPLE[name]) or (name != "bool" and isinstance(value, bool)):
            raise Fault(f"{place}: not of type {name} but {value!r}")
        return value
    return built(value, getattr(models, name), place)
