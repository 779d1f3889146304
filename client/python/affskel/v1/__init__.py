"""The messages and the stub of the service, generated from its contract when the package was built."""
from importlib.util import find_spec

if find_spec(__name__ + ".types_pb2") is None:
    raise ImportError("this is the source of affskel, without its messages, which are made when it is built: "
                      "install it by pip, see its README.md")
