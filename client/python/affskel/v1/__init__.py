"""The messages and the stub of the service, generated from its contract when the package was built."""
