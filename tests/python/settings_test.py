"""Addresses, environment and configuration file mean what they mean to affskel-client.

Usage: settings_test.py PROGRAMS PROJECT"""
import sys
import unittest

import affskel
from affskel import _settings

from lab import Directory

ADDRESSES = ["", "unix:", "unix:/" + "x" * 107, "host", "host:", ":70", "host:70000", "host:-1", "host:7x", "::1:70",
             "[]:70", "[::1]", "unix:///a", "unix:/a", "unix:a", "[::1]:1", "localhost:1", "127.0.0.1:0", "a:b:70"]
CONFIGURATIONS = [
    "server = nowhere", "# server\n\nserver=", "servers = a:1", "just words", "token_file = ", "server = a:1\nx = 1",
    "\t server\t=\thost:99999 \r\n",
]


class SameAsTheCommandLine(unittest.TestCase):
    def setUp(self):
        self.directory = Directory()
        self.addCleanup(self.directory.remove)
        self.directory.use_environment(self.addCleanup)
        self.config = self.directory / "config/affskel/config"
        self.config.parent.mkdir(parents=True)

    def assert_same_error(self, code, said, error):
        self.assertEqual((code, said["code"]), (error.exit_code, error.code))
        self.assertEqual((said.get("file", ""), said.get("line", 0)), (error.file, error.line))
        return said["message"], error.message

    def test_a_url_is_no_address(self):
        with self.assertRaisesRegex(affskel.UsageError, "that is a URL"):
            affskel.Client("http://localhost:7060").jobs()

    def test_patience_is_a_number_of_seconds(self):
        for patience in (float("nan"), -1, "5", None):
            with self.subTest(patience), self.assertRaisesRegex(affskel.UsageError, "patience is"):
                affskel.Client("localhost:7060", patience=patience)

    def test_malformed_addresses(self):
        refused = 0
        for text in filter(None, ADDRESSES):
            with self.subTest(text):
                code, said = self.directory.client_error("--server", text, "server-info")
                if code == 2:
                    refused += 1
                    with self.assertRaises(affskel.UsageError) as failure:
                        affskel.Client(text)
                    theirs, ours = self.assert_same_error(code, said, failure.exception)
                    self.assertEqual(theirs.partition(": ")[2], ours.partition(": ")[2])
                else:  # no server is there
                    with self.assertRaises(affskel.UnreachableError) as failure:
                        affskel.Client(text).server_info()
                    self.assert_same_error(code, said, failure.exception)
        self.assertEqual(refused, 12)

    def test_malformed_configurations(self):
        for text in CONFIGURATIONS:
            with self.subTest(text):
                self.config.write_text(text + "\n")
                code, said = self.directory.client_error("server-info")
                with self.assertRaises(affskel.UsageError) as failure:
                    affskel.Client()
                theirs, ours = self.assert_same_error(code, said, failure.exception)
                self.assertEqual(theirs, ours)

    def test_files_that_are_no_tokens_or_certificates(self):
        for name, content in (("empty", ""), ("two words", "a b\n"), ("bytes", "tök\n")):
            (self.directory / name).write_text(content)
        server = f"unix:{self.directory / 'no.sock'}"
        for option, file, argument in (
            ("--token-file", "missing", "token_file"), ("--token-file", "empty", "token_file"),
            ("--token-file", "two words", "token_file"), ("--token-file", "bytes", "token_file"),
            ("--client-cert", "empty", "client_cert"),
        ):
            path = self.directory / file
            with self.subTest(option, file=file):
                code, said = self.directory.client_error("--server", server, option, path, "server-info")
                with self.assertRaises(affskel.UsageError) as failure:
                    affskel.Client(server, **{argument: path}).server_info()
                self.assertEqual((code, said["code"]), (2, failure.exception.code))
                self.assertIn(str(path), said["message"])
                self.assertIn(str(path), str(failure.exception))

    def test_a_token_does_not_leave_this_machine_in_the_clear(self):
        file = self.directory / "token"
        file.write_text("secret\n")
        for address, leaves in (("lab.example.org:1", True), ("10.0.0.7:1", True), ("127.example.org:1", True),
                                ("localhost:1", False), ("127.9.9.9:1", False), ("[::1]:1", False)):
            with self.subTest(address):
                code, said = self.directory.client_error("--server", address, "--token-file", file, "server-info")
                self.assertEqual("in the clear" in said["message"], leaves)
                if leaves:
                    with self.assertRaisesRegex(affskel.UsageError, "in the clear") as failure:
                        affskel.Client(address, token_file=file)
                    self.assertNotIn("secret", str(failure.exception))
                else:
                    affskel.Client(address, token_file=file)


class Precedence(unittest.TestCase):
    """By affskel-client's words: arguments, then the environment, then the configuration of the same server."""

    def setUp(self):
        directory = Directory()
        self.addCleanup(directory.remove)
        self.file = directory / "affskel/config"
        self.file.parent.mkdir()
        self.environment = {"XDG_CONFIG_HOME": str(directory.path)}

    def choose(self, server=None, **files):
        return _settings.choose(server, files, self.environment)

    def test_nothing_said_is_the_private_server_which_is_shown_no_token(self):
        self.environment["AFFSKEL_TOKEN_FILE"] = "/token"
        chosen = self.choose(tls_ca="/ca")
        self.assertEqual((chosen.address, chosen.token_file, chosen.tls_ca), (None, "", ""))

    def test_the_configuration_names_server_and_files_beside_itself(self):
        self.file.write_text("# lab\nserver = lab.example.org:7060\ntoken_file = ada.token\ntls_ca = /etc/ca.pem\n")
        chosen = self.choose()
        self.assertEqual(chosen.address.target, "lab.example.org:7060")
        self.assertEqual(chosen.token_file, str(self.file.parent / "ada.token"))
        self.assertEqual(chosen.tls_ca, "/etc/ca.pem")
        self.assertEqual(chosen.origin, str(self.file))

    def test_another_server_gets_none_of_its_files(self):
        self.file.write_text("server = lab.example.org:7060\ntoken_file = ada.token\n")
        self.assertEqual(self.choose("unix:/s").token_file, "")
        self.environment["AFFSKEL_SERVER"] = "unix:/e"
        chosen = self.choose()
        self.assertEqual((chosen.address.target, chosen.token_file), ("unix:/e", ""))
        self.assertEqual(self.choose("unix:/s").address.target, "unix:/s")

    def test_arguments_win_over_the_environment_and_that_over_the_configuration(self):
        self.file.write_text("server = h:1\ntoken_file = c\ntls_ca = c\nclient_cert = c\nclient_key = c\n")
        self.environment.update(AFFSKEL_TOKEN_FILE="e", AFFSKEL_TLS_CA="e", AFFSKEL_CLIENT_CERT="")
        chosen = self.choose(token_file="a")
        beside = str(self.file.parent / "c")
        self.assertEqual((chosen.token_file, chosen.tls_ca, chosen.client_cert, chosen.client_key),
                         ("a", "e", beside, beside))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
