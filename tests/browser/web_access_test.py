"""Comes to the page of affskel-client web in Chromium, signed in or not, on a real server with its worker.

Usage: web_access_test.py AFFSKEL-CLIENT AFFSKEL-SERVER [TEST...]
"""
from web_case import DESKTOP, PHONE, OnABench, OnThePage, main, setUpModule  # first: it skips without a browser

from selenium.webdriver.common.keys import Keys

from web_page import Service
from web_servers import Away, Lab


class Visiting(OnThePage):
    def test_administrators_see_the_server(self):
        self.page.click("#server-link")
        self.page.heading("Server")
        self.page.wait(lambda: "Throughput" in self.page.text() and self.page.all("tbody th"))
        self.assertIn("Free on its disk", self.page.text())
        self.page.screenshot("desktop-7-server")

    def test_the_address_opens_the_page_once(self):
        other = self.enterContext(self.browsers.visitor(**DESKTOP))
        other.open(self.service.address)
        other.heading("This page is locked")
        self.assertIn("has been used before", other.text())
        other.screenshot("desktop-8-locked")
        refused = [message for message in other.errors() if "401" not in message]
        self.assertEqual(refused, [])
        # The address of the next start, pasted into the same tab.
        self.page.driver.get("about:blank")  # which would ask on
        self.stop()
        self.service = Service(self.client, self.bench.environment, http=self.service.origin.removeprefix("http://"))
        other.script(f"location.href = '{self.service.address}'")
        other.heading("Jobs")


class WhereTheServerComesAndGoes(OnABench):
    def test_the_page_waits_for_it(self):
        away = Away(self.client, self.server, self.bench.environment)
        self.addCleanup(lambda: self.assertEqual(away.close(), 0))
        away.go()
        page = self.enterContext(self.browsers.visitor(**DESKTOP))
        for _ in range(2):  # the key is as new as before
            page.open(away.service.address)
            page.wait(lambda: "Trying again" in page.text())
        away.come()
        page.heading("Jobs")
        self.assertNotIn("key=", page.driver.current_url)
        away.go()
        page.wait(lambda: "Trying again" in page.text())
        page.driver.refresh()
        page.heading("Jobs")
        page.wait(lambda: "Trying again" in page.text())
        away.come()
        page.wait(lambda: "Trying again" not in page.text())


class SigningIn(OnABench):
    def setUp(self):
        self.lab = Lab(self.client, self.server, self.bench.environment)
        self.addCleanup(lambda: self.assertEqual(self.lab.close(), 0))

    def visit(self, **window):
        page = self.enterContext(self.browsers.visitor(**(window or DESKTOP)))
        page.open(self.lab.service.address)
        page.heading("Sign in")
        return page

    def sign_in(self, page, who):
        page.type("#token", self.lab.tokens[who])
        page.driver.switch_to.active_element.send_keys(Keys.ENTER)
        page.heading("Jobs")

    def errors(self, page, expected=()):
        return [error for error in page.errors() if not any(part in error for part in expected)]

    def test_from_sign_in_to_the_skeleton(self):
        self.assertEqual(self.lab.service.mode, "sign-in")
        page = self.visit()
        page.screenshot("lab-1-sign-in")
        self.sign_in(page, "ada")
        self.assertFalse(page.find("#server-link").is_displayed())
        page.submit(self.bench.path("body.off"), 20000, "body of ada")
        page.skeleton_is_drawn()
        with page.turning_view():
            pass
        page.click("#close-interactive")
        page.wait(lambda: not page.all("dialog"))
        # By key: Chromium may still send the mouse to the frame that has just gone.
        page.find("button[data-file='mesh.off']").send_keys(Keys.ENTER)
        with open(self.bench.path("body.off"), "rb") as file:
            self.assertEqual(page.downloaded("body of ada.mesh.off"), file.read())
        self.assertEqual(page.errors(), [])
        self.assertEqual(page.script("return document.cookie"), "", "no script sees the session")
        self.assertEqual(page.script("return JSON.stringify([localStorage, sessionStorage])"), "[{},{}]")
        job = page.driver.current_url.split("/")[-1]

        # Another user sees nothing of it, an administrator all.
        other = self.visit()
        self.sign_in(other, "bob")
        other.shown(".empty")
        other.open(f"{self.lab.service.address}#job/{job}")
        other.wait(lambda: "no job" in other.text())
        self.assertNotRegex(other.text(), r"\bada\b")  # the digits of an id can spell it
        other.find("#sign-out").click()
        other.heading("Sign in")
        self.sign_in(other, "root")
        other.click("#everybody")
        other.wait(lambda: other.all(f"#job-{job}"))
        self.assertIn("ada", other.find(f"#job-{job}").text)
        other.submit(self.bench.path("box.off"), 1000, "box of root")
        other.click("a[href='#jobs']")
        other.click("#everybody")
        other.wait(lambda: other.all("#owner option[value=ada]"))[0].click()
        names = lambda: [e.text for e in other.all(".job h2 a") if e.is_displayed()]
        other.wait(lambda: names() == ["body of ada"])
        other.find("#owner option[value=root]").click()
        other.wait(lambda: names() == ["box of root"])
        other.find("#owner option[value='']").click()
        other.wait(lambda: len(names()) >= 2)
        other.click("#server-link")
        other.wait(lambda: other.all("tbody th"))
        self.assertEqual(self.errors(other, [job]), [])

        # Signed out is signed out, also for an address that was kept.
        page.find("#sign-out").click()
        page.heading("Sign in")
        page.open(f"{self.lab.service.address}#job/{job}")
        page.heading("Sign in")

    def test_keeps_what_would_be_removed(self):
        page = self.visit()
        self.sign_in(page, "bob")
        page.submit(self.bench.path("box.off"), 1000, "box of bob")
        page.wait(lambda: "Its results will be removed on" in page.find(".notes").text)
        self.assertIn("the lattice is coarse", page.find(".notes").text)
        page.screenshot("lab-3-removal")
        page.click("#pin")
        page.shown("#unpin")
        page.wait(lambda: "removed" not in page.find(".notes").text)
        self.assertEqual(self.errors(page), [])

    def test_wrong_and_revoked_tokens(self):
        page = self.visit(**PHONE)
        page.type("#token", "this is no token")
        page.click("form button")
        page.wait(lambda: "That did not work" in page.text())
        page.screenshot("lab-2-refused-phone")
        self.sign_in(page, "ada")
        ada = next(line.split()[0] for line in self.lab.token("list").splitlines() if "ada" in line)
        self.lab.token("revoke", ada)
        page.wait(lambda: "The session has ended" in page.text())
        page.heading("Sign in")
        page.type("#token", self.lab.tokens["ada"])
        page.click("form button")
        page.wait(lambda: "That did not work" in page.text())
        self.assertEqual(self.errors(page, ["/api/session", "/api/jobs"]), [])


if __name__ == "__main__":
    main()
