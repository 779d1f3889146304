"""Looks at jobs on the page of affskel-client web in Chromium, on a real server with its worker.

Usage: web_jobs_test.py AFFSKEL-CLIENT AFFSKEL-SERVER [TEST...]
"""
import io
import subprocess
import zipfile

from web_case import PHONE, OnThePage, main, setUpModule  # first: it skips without a browser

from selenium.webdriver.common.keys import Keys


class Jobs(OnThePage):
    def test_downloads_what_the_command_line_writes(self):
        self.submit_body(3000, "files")
        job = self.page.driver.current_url.split("/")[-1]
        buttons = [b.get_attribute("data-file") for b in self.page.all("button[data-file]")]
        self.assertEqual(len(buttons), 42)
        for name in buttons:
            artefact, extension = name.split(".")
            self.page.find(f"button[data-file='{name}']").click()
            here = self.page.downloaded(f"files.{name}")
            self.bench.run("fetch", job, artefact, "-o", self.bench.path(name))
            with open(self.bench.path(name), "rb") as file:
                self.assertEqual(here, file.read(), name)

    def test_other_parameters(self):
        self.submit_body(3000, "parameters")
        job = self.page.driver.current_url.split("/")[-1]
        self.page.click("summary")
        self.page.type("#download-threshold", 3)
        self.page.find("button[data-file='skeleton.csv']").click()
        here = self.page.downloaded("parameters.skeleton.csv")
        self.bench.run("skeleton", job, "--threshold", "3", "-o", self.bench.path("t.csv"))
        with open(self.bench.path("t.csv"), "rb") as file:
            self.assertEqual(here, file.read())
        # What cannot be made is said beside the buttons.
        self.page.type("#download-level", 99.9)
        self.page.find("button[data-file='eroded.stl']").click()
        self.page.wait(lambda: any("eroded" in e.text for e in self.page.all(".card [role=status]")) or
                       self.page.all(".card .error:not([hidden])"))

    def test_back_and_escape_close_the_turning_view(self):
        page = self.page
        self.submit_body(2000, "closed")
        for close in ("back", "escape", "escape within"):
            with page.turning_view():
                if close == "escape within":
                    page.find("#canvas").send_keys(Keys.ESCAPE)
            if close == "back":
                page.driver.back()
            elif close == "escape":
                page.find("#close-interactive").send_keys(Keys.ESCAPE)
            page.wait(lambda: not page.all("dialog"))
            self.assertIn("#job/", page.driver.current_url)
            page.heading("closed")

    def test_the_threshold_changes_while_the_view_is_turned(self):
        page = self.page
        self.submit_body(20000, "threshold")
        page.click("#interactive")

        def within(script):
            page.driver.switch_to.frame(page.shown("dialog iframe"))
            value = page.wait(lambda: page.script("return window.affskel && affskel.state().skeletonShown > 0 && " + script))
            page.driver.switch_to.default_content()
            return value

        usual = within("affskel.state().skeletonShown")
        page.driver.switch_to.frame(page.shown("dialog iframe"))
        page.click("#view-side")
        page.wait(lambda: "view=side" in page.script("return location.hash"))
        page.driver.switch_to.default_content()
        page.type("#view-threshold", 1)
        page.find("dialog strong").click()
        page.wait(lambda: within("affskel.state().skeletonShown") > usual)
        self.assertAlmostEqual(within("affskel.state().looking.azimuth"), 90, 1)
        page.screenshot("desktop-12-threshold")
        for wrong in (-2, "1e"):
            page.type("#view-threshold", 1)
            page.find("dialog strong").click()
            page.wait(lambda: page.find("dialog [role=status]").text == "")
            page.type("#view-threshold", wrong)
            page.find("dialog strong").click()
            page.wait(lambda: "above 0" in page.find("dialog [role=status]").text)
        page.driver.back()
        page.wait(lambda: not page.all("dialog"))
        page.heading("threshold")

    def test_pictures_follow_the_theme(self):
        page = self.page
        self.submit_body(2000, "theme")
        before = page.find(".results .picture").get_attribute("src")
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        page.wait(lambda: page.find(".results .picture").get_attribute("src") != before)
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})

    def test_several_jobs_are_cancelled_and_tell_the_time_left(self):
        page = self.page
        ids = [self.submit_endless(f"long {n}", 3000000 + n) for n in range(2)]
        page.wait(lambda: all(page.all(f"#job-{job}") for job in ids))
        page.wait(lambda: any("left" in e.text and "per second" in e.text for e in page.all(".job .numbers")))
        for job in ids:
            page.click(f"#job-{job} input")
        page.click("#cancel-selected")
        page.click("dialog .danger")
        page.wait(lambda: all(page.find(f"#job-{job} .badge").text == "cancelled" for job in ids))

    def test_a_job_that_is_deleted_meanwhile_is_told(self):
        page = self.page
        self.submit_body(2000, "deleted")
        job = page.driver.current_url.split("/")[-1]
        self.bench.run("delete", job)
        page.wait(lambda: "It was deleted meanwhile" in page.text())
        for left in ("skeleton in", "resume", "Download", "About this job", "Trying again"):
            self.assertNotIn(left, page.text())
        page.screenshot("desktop-17-deleted")
        page.script("location.hash = '#job/noid'")
        page.wait(lambda: "There is no such job" in page.text())
        self.assertNotIn("Trying again", page.text())
        self.assertEqual([e for e in page.errors() if "404" not in e and "/api/jobs/noid " not in e], [])

    def test_the_list_is_searched_ordered_and_cleaned(self):
        page = self.page
        names = ["zebra one", "zebra two", "ape"]
        ids = [self.bench.run("submit", self.bench.path("box.off"), "--points", str(500 + 300 * n), "--name", name,
                              "--wait").strip()
               for n, name in enumerate(names)]
        cards = [f"#job-{job}" for job in ids]
        shown = lambda: [name for name, card in zip(names, cards) if page.all(card) and page.find(card).is_displayed()]
        page.wait(lambda: shown() == names)
        page.type("#search", "ridge spacing")
        page.wait(lambda: shown() == names)
        page.type("#search", "1152")  # the row says 1,152 points
        page.wait(lambda: shown() == names[2:])
        page.type("#search", "chords")
        page.wait(lambda: shown() == [])
        page.type("#search", "ZEBRA")
        page.wait(lambda: shown() == names[:2])
        page.find("#state option[value=running]").click()
        page.wait(lambda: shown() == [] and "No job shown here is like that." in page.text())
        page.find("#state option[value='']").click()
        page.find("#order option[value=points]").click()
        page.wait(lambda: [e.text for e in page.all(".job h2 a") if e.is_displayed()] == ["zebra two", "zebra one"])
        page.wait(lambda: len([e for e in page.all(".thumbnail") if e.is_displayed()]) == 2)
        page.screenshot("desktop-11-list")
        for card in cards[:2]:
            page.find(card + " input").click()
        page.wait(lambda: "2 jobs selected" in page.text())
        page.click("#download-selected")
        with zipfile.ZipFile(io.BytesIO(page.downloaded("affskel.zip"))) as archive:
            self.assertIsNone(archive.testzip())
            self.assertEqual(len(archive.namelist()), 8, archive.namelist())
        page.click("#delete-selected")
        page.click("dialog .danger")
        page.wait(lambda: not any(page.all(card) for card in cards[:2]))
        page.find("#search").clear()
        page.find("#search").send_keys(" ")
        page.wait(lambda: shown() == ["ape"])

    def test_all_rows_of_the_list_have_the_same_columns(self):
        self.submit_uneven()
        for part in ("input", ".place", "h2", ".badge", ".when", "progress", ".numbers", ".what"):
            places = self.page.script("""return Array.from(document.querySelectorAll('.job ' + arguments[0]))
                .filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect())
                .map(({ left, right }) => [left, right])""", part)
            self.assertTrue(places, part)
            self.assertEqual([p for p in places if p != places[0]], [], part)
        self.assertEqual(self.page.cut_off(), [])
        self.page.screenshot("desktop-18-rows")

    def test_turns_the_skeleton(self):
        self.submit_body(8000, "turned")
        with self.page.turning_view():
            state = self.page.script("return affskel.state()")
            self.assertGreater(state["skeletonShown"], 100, "the ridge's sheet")
            self.assertGreaterEqual(len(state["levels"]), 3)
            self.page.find("#view-front").click()
            front = self.page.script("return affskel.state().camera.position")
            self.page.find("#canvas").send_keys(Keys.ARROW_LEFT)
            self.page.wait(lambda: self.page.script("return affskel.state().camera.position") != front)
            self.assertEqual(self.page.script("return window.origin"), "null", "in a sandbox of its own")
        self.page.screenshot("desktop-4-turned")
        self.page.click("#close-interactive")
        self.page.wait(lambda: not self.page.all("dialog"))
        self.assertEqual(self.page.script("return document.activeElement.id"), "interactive")

    def test_deletes_only_what_is_confirmed(self):
        self.submit_body(2000, "unloved")
        job = self.page.driver.current_url.split("/")[-1]
        self.page.click("#delete")
        self.page.click("dialog button")  # keep it
        self.page.wait(lambda: not self.page.all("dialog"))
        self.bench.run("status", job)
        self.page.click("#delete")
        self.page.click("dialog .danger")
        self.page.heading("Jobs")
        self.page.wait(lambda: not self.page.all(f"#job-{job}"))
        gone = subprocess.run([self.client, "--quiet", "status", job], env=self.bench.environment, check=False,
                              stderr=subprocess.DEVNULL)
        self.assertEqual(gone.returncode, 4)

    def test_cancels_and_resumes(self):
        job = self.submit_endless("long")
        self.page.shown(f"#job-{job} a").click()
        self.page.heading("long")
        self.page.wait(lambda: self.page.shown(".badge").text == "running")
        self.page.wait(lambda: "directions" in self.page.text())
        self.page.screenshot("desktop-6-running")
        self.page.click("#cancel")
        self.page.click("dialog .danger")
        self.page.wait(lambda: self.page.shown(".badge").text == "cancelled")
        self.page.click("#resume")
        self.page.wait(lambda: self.page.shown(".badge").text in ("waiting", "running"))
        self.bench.run("cancel", job)
        self.page.wait(lambda: self.page.shown(".badge").text == "cancelled")


class Phone(OnThePage):
    window = dict(PHONE, dark=True)

    def assert_fits(self):
        self.assertEqual(self.page.script("return innerWidth"), 390)
        self.assertLessEqual(self.page.width(), 390)
        self.assertEqual(self.page.small_targets(), [])
        self.assertEqual(self.page.unnamed(), [])

    def test_everything_fits(self):
        page = self.page
        self.assert_fits()
        page.click("main a.button[href='#new']")
        page.heading("New job")
        self.assert_fits()
        self.choose("body.off")
        page.picture_is_drawn("#found img")
        page.click("summary")
        self.assert_fits()
        page.screenshot("phone-1-new")
        page.type("#points", 5000)
        page.click("#submit")
        page.skeleton_is_drawn()
        self.assert_fits()
        page.screenshot("phone-2-done")
        with page.turning_view():
            pass
        page.screenshot("phone-3-turned")
        page.click("#close-interactive")
        page.click("nav a[href='#jobs']")
        page.heading("Jobs")
        self.submit_uneven()
        self.assert_fits()
        self.assertEqual(page.cut_off(), [])
        page.screenshot("phone-4-jobs")
        page.click("#server-link")
        page.heading("Server")
        page.wait(lambda: page.all("tbody th"))
        self.assert_fits()
        page.screenshot("phone-5-server")


if __name__ == "__main__":
    main()
