"""A server with TLS and tokens: which caller is which, tokens that change, certificates of clients.

Usage: access_test.py PROGRAMS PROJECT"""
import os
import shutil
import subprocess
import sys
import unittest

import affskel

from lab import SERVER, Directory, Server

CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n").encode()

if shutil.which("openssl") is None:
    print("no openssl: skipped")
    sys.exit(77)


class Authority:
    """Certificates signed by one's own authority, NAME.pem and NAME.key."""

    def __init__(self, directory, name="ca"):
        self.directory, self.name = directory, name
        self.openssl("req", "-x509", "-subj", f"/CN={name}", "-keyout", self.key(name), "-out", self.certificate(name))

    def certificate(self, name):
        return str(self.directory / f"{name}.pem")

    def key(self, name):
        return str(self.directory / f"{name}.key")

    def openssl(self, *arguments):
        subprocess.run(["openssl", arguments[0], "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                        "-days", "1", *arguments[1:]], check=True, stderr=subprocess.DEVNULL)

    def sign(self, name):
        self.openssl("req", "-x509", "-subj", f"/CN={name}", "-CA", self.certificate(self.name), "-CAkey",
                     self.key(self.name), "-addext", "subjectAltName=IP:127.0.0.1,DNS:localhost",
                     "-addext", "basicConstraints=critical,CA:FALSE",
                     "-keyout", self.key(name), "-out", self.certificate(name))


class Access(unittest.TestCase):
    def setUp(self):
        self.directory = Directory()
        self.addCleanup(self.directory.remove)
        self.directory.use_environment(self.addCleanup)
        self.authority = Authority(self.directory)
        self.authority.sign("server")

    def token(self, owner, role="user"):
        """A file with a new token, and the token's id."""
        command = [SERVER, "token", "add", "--data-dir", str(self.directory / "data"), "--owner", owner, "--role", role]
        file = self.directory / f"{owner}.token"
        file.write_text(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
        return file

    def start(self, *options):
        """A server with TLS, and the port at which it has it."""
        server = Server(self.directory, "--listen", "127.0.0.1:0", "--tls-cert", self.authority.certificate("server"),
                        "--tls-key", self.authority.key("server"), *options, listeners=2)
        self.addCleanup(server.end)
        (self.address,) = (address for address in server.addresses if not address.startswith("unix:"))

    def client(self, **files):
        files.setdefault("tls_ca", self.authority.certificate("ca"))
        return self.enterContext(affskel.Client(self.address, **files))

    def test_users_see_their_own_jobs_and_strangers_none(self):
        ada, bob = self.token("ada"), self.token("bob")
        self.start()
        hers, his = self.client(token_file=ada), self.client(token_file=bob)
        self.assertEqual(hers.server_info()["caller"], {"owner": "ada", "role": "user"})
        job = hers.submit(CUBE, spacing=.1).wait()
        self.assertEqual(job.status().owner, "ada")
        self.assertEqual(len(job.field()), 1000)
        self.assertEqual(his.jobs(), [])
        with self.assertRaises(affskel.NotFoundError):
            his.job(job.id)
        with self.assertRaises(affskel.NotAllowedError):
            self.client().jobs()

    def test_a_worker_may_not_submit(self):
        self.start()
        with self.assertRaises(affskel.NotAllowedError):
            self.client(token_file=self.token("crew", "worker")).submit(CUBE, spacing=.1)

    def test_a_token_that_is_replaced_in_its_file_is_used(self):
        ada = self.token("ada")
        self.start()
        client = self.client(token_file=ada)
        job = client.submit(CUBE, spacing=.1).wait()
        ada.write_text("revoked\n")
        with self.assertRaises(affskel.NotAllowedError) as failure:
            job.status()
        self.assertNotIn("revoked", str(failure.exception).split())
        self.token("ada")
        self.assertEqual(job.status().state, "done")
        ada.unlink()
        self.assertEqual(job.status().state, "done")

    def test_a_server_that_others_signed_for_is_not_talked_to(self):
        self.start()
        other = Authority(self.directory, "other")
        with self.assertRaises(affskel.UnreachableError):
            self.client(tls_ca=other.certificate("other"), token_file=self.token("ada")).jobs()

    def test_a_server_with_tls_is_told_as_such_and_what_is_no_certificate_too(self):
        self.start()
        with self.assertRaisesRegex(affskel.UnreachableError, "if it speaks TLS, name who signed its certificate: tls_ca"):
            self.client(tls_ca=None).jobs()
        file = self.directory / "damaged.pem"
        file.write_text("-----BEGIN CERTIFICATE-----\nbm9uZQ==\n-----END CERTIFICATE-----\n")
        with self.assertRaisesRegex(affskel.UsageError, "no certificate that can be read"):
            self.client(tls_ca=file).jobs()

    def test_certificates_of_clients(self):
        self.authority.sign("ada")
        self.start("--tls-client-ca", self.authority.certificate("ca"))
        token = self.token("ada")
        with self.assertRaises((affskel.UnreachableError, affskel.NotAllowedError)):
            self.client(token_file=token).jobs()
        client = self.client(token_file=token, client_cert=self.authority.certificate("ada"),
                             client_key=self.authority.key("ada"))
        self.assertEqual(client.jobs(), [])

    def test_the_configuration_says_it_all_and_the_programs_are_told_it(self):
        ada = self.token("ada")
        self.start()
        file = self.directory / "config/affskel/config"
        file.parent.mkdir(parents=True)
        ada.rename(file.parent / "ada.token")
        shutil.copy(self.authority.certificate("ca"), file.parent / "ca.pem")
        file.write_text(f"server = {self.address}\ntoken_file = ada.token\ntls_ca = ca.pem\n")
        client = self.enterContext(affskel.Client())
        job = client.submit(CUBE, spacing=.1).wait()
        self.assertIn("<canvas", job.view().page)
        self.directory.client("make", "box", "--size", "1,1,1", "-o", self.directory / "box.stl")
        self.assertEqual(client.submit(self.directory / "box.stl", spacing=.1).wait().status().owner, "ada")
        self.assertEqual({job.seen.owner for job in client.jobs()}, {"ada"})
        self.assertEqual(os.environ.get("AFFSKEL_SERVER", ""), "")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
