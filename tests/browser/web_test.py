"""Uses the page of affskel-client web in Chromium, on a real server with its worker.

Usage: web_test.py AFFSKEL-CLIENT AFFSKEL-SERVER [TEST...]
"""
import io
import json
import os
import re
import subprocess
import sys
import unittest
import zipfile

if not all(os.path.isfile(os.environ.get(program, "")) for program in ["CHROMIUM", "CHROMEDRIVER"]):
    print("no chromium or chromedriver: skipped")
    sys.exit(77)

from selenium.webdriver.common.keys import Keys

from web_page import Browsers, Service
from web_servers import Away, Bench, Lab

CLIENT, SERVER = sys.argv[1:3]
DESKTOP = dict(width=1200, height=900)
PHONE = dict(width=390, height=780, phone=True)


def setUpModule():
    global bench, browsers
    bench = Bench(CLIENT)
    unittest.addModuleCleanup(bench.close)
    browsers = Browsers()
    unittest.addModuleCleanup(browsers.running.close)


class OnThePage(unittest.TestCase):
    window = DESKTOP

    def setUp(self):
        self.service = Service(CLIENT, bench.environment)
        self.addCleanup(self.stop)
        self.page = self.enterContext(browsers.visitor(**self.window))
        self.page.open(self.service.address)
        self.page.heading("Jobs")

    def stop(self):
        self.assertEqual(self.service.close(), 0)

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])
        asked = self.page.asked()
        self.assertTrue(asked)
        self.assertEqual([url for url in asked if not url.startswith(self.service.origin + "/")], [])

    def choose(self, name):
        self.page.wait(lambda: self.page.all("#file"))[0].send_keys(bench.path(name))

    def submit_endless(self, name, points=3000000):
        """A job that no worker gets to the end of, however slow the browser is; it does not outlive the test."""
        job = bench.run("submit", bench.path("large.off"), "--points", str(points), "--directions", "sphere:1000000",
                        "--name", name).strip()
        self.addCleanup(bench.drop, job)
        return job

    def submit_body(self, points, name):
        """From the list of jobs to the finished skeleton."""
        self.page.submit(bench.path("body.off"), points, name)
        self.page.skeleton_is_drawn()


class Desktop(OnThePage):
    def test_from_a_mesh_to_its_skeleton(self):
        page = self.page
        page.screenshot("desktop-1-jobs")
        page.click("a.button[href='#new']")
        page.heading("New job")
        self.choose("large.off")
        page.picture_is_drawn("#found img")
        found = page.shown("#found").text
        self.assertIn("5,000", found)
        # The number of points follows the spacing, and the spacing the points.
        page.script("const go = window.fetch; let count; window.held = new Promise((done) => { count = done; });"
                    "window.fetch = (url, ...more) => url.includes('/lattice')"
                    " ? window.held.then(() => go(url, ...more)) : go(url, ...more);"
                    "window.letCount = () => { window.fetch = go; count(); };")
        page.type("#points", 20000)
        self.assertIn("about 20,000 sample points at spacing", page.find("#lattice").text)
        # The button does not move when the count comes.
        place = page.find("#submit").rect
        page.script("window.letCount()")
        page.wait(lambda: "about" not in page.find("#lattice").text)
        self.assertEqual(page.find("#submit").rect, place)
        spacing = float(page.find("#spacing").get_attribute("value"))
        volume = json.loads(bench.run("--json", "inspect", bench.path("large.off")))["volume"]
        self.assertAlmostEqual(volume / spacing ** 3 / 20000, 1, delta=0.1)
        page.screenshot("desktop-2-new")
        page.type("#spacing", 2 * spacing)
        page.wait(lambda: "about" not in page.find("#lattice").text)
        self.assertTrue(2000 < float(page.find("#points").get_attribute("value")) < 3000)
        # The lattice is counted later, and leaves alone what is selected to be typed over.
        counted = page.find("#lattice").text
        page.script("const [spacing, points] = ['spacing', 'points'].map((id) => document.getElementById(id));"
                    f"spacing.value = {1.5 * spacing}; spacing.dispatchEvent(new Event('input'));"
                    "points.focus(); points.select();")
        page.wait(lambda: "about" not in page.find("#lattice").text)
        self.assertNotEqual(page.find("#lattice").text, counted)
        page.find("#points").send_keys("100000")
        self.assertEqual(page.find("#points").get_attribute("value"), "100000")
        page.type("#name", "Subject <b>7</b> ü")
        page.click("#submit")
        page.heading("Subject <b>7</b> ü")
        page.wait(lambda: page.shown(".badge").text == "done")
        self.assertNotIn("key=", page.driver.current_url)
        job = page.driver.current_url.split("/")[-1]
        status = json.loads(bench.run("--json", "status", job))
        self.assertEqual(status["state"], "done")
        self.assertEqual(status["skeleton"]["operator"], "ridge")
        self.assertIn("skeleton in 1 piece (the ridge of E", page.text())
        page.picture_is_drawn()
        self.assertRegex(page.wait(lambda: [e.text for e in page.all(".card [role=status]") if "Shown" in e.text])[0],
                         r"Shown: sheet of [0-9]+ triangles .*\(ridge, threshold 6\)")
        before = page.find("img.picture").get_attribute("src")
        page.find("#stance option[value='z,x']").click()
        page.wait(lambda: page.find("img.picture").get_attribute("src") != before)
        self.assertEqual(json.loads(bench.run("--json", "status", job))["stance"], {"up": "z", "front": "x"})
        page.picture_is_drawn()
        page.screenshot("desktop-3-from-the-side")
        page.find("#stance option[value='shape']").click()
        page.wait(lambda: "stance" not in json.loads(bench.run("--json", "status", job)))
        page.click("#history summary")
        happened = page.wait(lambda: [line.text for line in page.all(".history li")])
        self.assertIn("submitted", happened[0])
        # The picture's sheet was made after it.
        self.assertTrue(any("done" in line for line in happened[1:]), happened)
        page.screenshot("desktop-3-done")

    def test_downloads_what_the_command_line_writes(self):
        self.submit_body(3000, "files")
        job = self.page.driver.current_url.split("/")[-1]
        buttons = [b.get_attribute("data-file") for b in self.page.all("button[data-file]")]
        self.assertEqual(len(buttons), 42)
        for name in buttons:
            artefact, extension = name.split(".")
            self.page.find(f"button[data-file='{name}']").click()
            here = self.page.downloaded(f"files.{name}")
            bench.run("fetch", job, artefact, "-o", bench.path(name))
            with open(bench.path(name), "rb") as file:
                self.assertEqual(here, file.read(), name)

    def test_other_parameters(self):
        self.submit_body(3000, "parameters")
        job = self.page.driver.current_url.split("/")[-1]
        self.page.click("summary")
        self.page.type("#download-threshold", 3)
        self.page.find("button[data-file='skeleton.csv']").click()
        here = self.page.downloaded("parameters.skeleton.csv")
        bench.run("skeleton", job, "--threshold", "3", "-o", bench.path("t.csv"))
        with open(bench.path("t.csv"), "rb") as file:
            self.assertEqual(here, file.read())
        # What cannot be made is said beside the buttons.
        self.page.type("#download-level", 99.9)
        self.page.find("button[data-file='eroded.stl']").click()
        self.page.wait(lambda: any("eroded" in e.text for e in self.page.all(".card [role=status]")) or
                       self.page.all(".card .error:not([hidden])"))

    def test_the_infimum_over_all_directions(self):
        page = self.page
        page.click("a.button[href='#new']")
        page.heading("New job")
        self.choose("body.off")
        page.picture_is_drawn("#found img")
        page.type("#points", 1500)
        page.type("#name", "infimum")
        page.click("summary")
        page.click("#minimum option[value='infimum']")
        page.screenshot("desktop-2-infimum")
        page.click("#submit")
        page.heading("infimum")
        page.wait(lambda: page.shown(".badge").text == "done")
        job = page.driver.current_url.split("/")[-1]
        self.assertEqual(json.loads(bench.run("--json", "status", job))["params"]["minimum"], "infimum")
        self.assertIn("all, beginning from these", page.text())
        page.find("button[data-file='field.csv']").click()
        self.assertTrue(page.downloaded("infimum.field.csv").startswith(b"x,y,z,E,nx,ny,nz,slope,saddles"))

    def test_wrong_parameters_are_refused_beside_their_fields(self):
        page = self.page
        self.submit_body(3000, "wrong")
        page.click("summary")
        page.type("#download-threshold", -3)
        page.find("button[data-file='skeleton.csv']").click()
        refusal = "The threshold must be a number above 0"
        page.wait(lambda: refusal in page.find("details .error").text)
        row = page.find("button[data-file='skeleton.csv']").find_element("xpath", "ancestor::*[@class='artefact']")
        page.wait(lambda: refusal in row.text)
        page.type("#download-threshold", 3)
        page.type("#download-level", 150)
        page.find("#download-threshold").click()
        page.wait(lambda: "above 0 and below 100 %" in page.find("details .error").text)
        # What is no number is told at once, and is not another one.
        page.type("#download-threshold", "1e")
        page.find("#download-level").click()
        page.wait(lambda: refusal in page.find("details .error").text)
        page.type("#download-threshold", 3)
        # Picture and turning view are by the same parameters as the files.
        page.type("#download-level", "12,5")
        page.find("#download-threshold").click()
        page.wait(lambda: any("threshold 3" in e.text for e in page.all(".card [role=status]")))
        with_level = page.find("img.picture").get_attribute("src")
        page.click("#interactive")
        page.driver.switch_to.frame(page.shown("dialog iframe"))
        page.wait(lambda: page.script("return window.affskel && affskel.state().erodedShown?.[0] > 0"))
        self.assertAlmostEqual(page.script("return affskel.state().level"), 0.125)
        page.driver.switch_to.default_content()
        page.screenshot("desktop-16-level")
        page.click("#close-interactive")
        page.wait(lambda: not page.all("dialog"))
        page.find("#download-level").clear()
        page.find("#download-threshold").click()
        page.wait(lambda: page.find("img.picture").get_attribute("src") != with_level)
        page.find("#download-threshold").click()
        page.wait(lambda: any("threshold 3" in e.text for e in page.all(".card [role=status]")))
        self.assertFalse(page.find("details .error").is_displayed())

    def test_back_and_escape_close_the_turning_view(self):
        page = self.page
        self.submit_body(2000, "closed")
        for close in ("back", "escape", "escape within"):
            page.click("#interactive")
            frame = page.shown("dialog iframe")
            page.driver.switch_to.frame(frame)
            page.wait(lambda: page.script("return window.affskel && affskel.state().skeletonShown > 0"))
            if close == "escape within":
                page.find("#canvas").send_keys(Keys.ESCAPE)
            page.driver.switch_to.default_content()
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

    def test_a_job_again_with_other_parameters_and_beside_the_first(self):
        page = self.page
        self.submit_body(3000, "first")
        first = page.driver.current_url.split("/")[-1]
        page.click("#again")
        page.heading("New job")
        page.picture_is_drawn("#found img")
        self.assertEqual(page.find("#name").get_attribute("value"), "first")
        page.wait(lambda: page.find("#points").get_attribute("value") == "3000")  # as that job was asked for
        page.click("#submit")
        page.wait(lambda: "The same was submitted before" in page.text())
        page.type("#points", 2000)
        page.click("#submit")
        page.heading("first")
        page.skeleton_is_drawn()
        self.assertNotEqual(page.driver.current_url.split("/")[-1], first)
        page.click("#beside")
        page.wait(lambda: page.all(f"#beside option[value='{first}']"))[0].click()
        page.click("#interactive")
        page.driver.switch_to.frame(page.shown("dialog iframe"))
        page.wait(lambda: page.script("return window.affskel && affskel.state().skeletonShown"))
        self.assertEqual(page.script("return affskel.state().shown.length"), 2)
        page.driver.switch_to.default_content()
        page.screenshot("desktop-9-beside")
        page.click("#close-interactive")

    def test_again_asks_for_what_the_job_was_asked_for(self):
        page = self.page
        job = bench.run("submit", bench.path("box.off"), "--spacing", "12.5", "--directions", "triangles+sphere:200", "--frame", "pca",
                        "--minimum", "infimum", "--operator", "chords", "--name", "other", "--wait").strip()
        page.script(f"location.hash = '#new/{job}'")
        page.picture_is_drawn("#found img")
        values = {name: page.wait(lambda: page.find(f"#{name}").get_attribute("value"))
                  for name in ("spacing", "directions", "how-many", "frame", "minimum", "operator")}
        self.assertEqual(values, {"spacing": "12.5", "directions": "triangles+sphere", "how-many": "200", "frame": "pca",
                                  "minimum": "infimum", "operator": "chords"})
        page.click("#submit")
        page.wait(lambda: "The same was submitted before" in page.text())

    def test_a_repaired_mesh_is_kept_as_it_came(self):
        page = self.page
        page.click("a.button[href='#new']")
        self.choose("open.off")
        page.click("#fill-holes")
        page.picture_is_drawn("#found img")
        self.assertLessEqual(page.find("#submit").rect["y"] + page.find("#submit").rect["height"], self.window["height"])
        page.type("#points", 2000)
        page.click("#submit")
        page.heading("open")
        page.skeleton_is_drawn()
        self.assertIn("1 hole filled", page.text())
        job = page.driver.current_url.split("/")[-1]
        with open(bench.path("open.off"), encoding="ascii") as came:
            self.assertEqual(bench.run("fetch", job, "source", "-o", "-"), came.read())
        self.assertTrue(page.all("[data-file='source.off']"))
        page.click("#interactive")
        page.driver.switch_to.frame(page.shown("dialog iframe"))
        page.wait(lambda: page.script("return window.affskel && affskel.state().skeletonShown"))
        self.assertTrue(page.shown("#show-marks").is_selected())
        self.assertGreater(page.script("return affskel.state().marked"), 2, "the rim of the hole")
        self.assertIn("filled", page.find("#warnings").text)
        page.driver.switch_to.default_content()
        page.screenshot("desktop-14-repaired")

    def test_pictures_follow_the_theme(self):
        page = self.page
        self.submit_body(2000, "theme")
        before = page.find(".results .picture").get_attribute("src")
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        page.wait(lambda: page.find(".results .picture").get_attribute("src") != before)
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})

    def test_several_files_become_a_job_each(self):
        page = self.page
        page.click("a.button[href='#new']")
        with open(bench.path("nothing.off"), "w", encoding="ascii"):
            pass
        page.wait(lambda: page.all("#file"))[0].send_keys(
            "\n".join(bench.path(name) for name in ("box.off", "nothing.off", "open.off")))
        page.wait(lambda: len(page.all("#several li")) == 3 and "sending" not in page.find("#several").text)
        texts = [line.text for line in page.all("#several li")]
        self.assertRegex(texts[0], "^box (is submitted|was there already)$")
        self.assertEqual(texts[1], "nothing.off: the file is empty")
        self.assertIn("hole is left", texts[2])
        page.screenshot("desktop-10-several")
        self.choose("nothing.off")
        page.wait(lambda: "nothing.off cannot be read: the file is empty" in page.text())
        page.script("location.hash = '#jobs'")
        page.heading("Jobs")
        page.wait(lambda: "box" in page.text())

    def drop(self, items):
        """Drops files by name, with a folder where the items have one: FOLDER/NAME."""
        self.page.script("""
            const entryOf = (file) => ({ name: file.name, isDirectory: false, file: (done) => done(file) });
            const dropped = new DataTransfer();
            const folders = {};
            for (const [path, text] of arguments[0]) {
              const [name, folder] = path.split('/').reverse();
              const file = new File([text], name);
              if (folder) (folders[folder] ??= []).push(entryOf(file));
              else dropped.items.add(file);
            }
            const items = [...Array(dropped.files.length)].map(() => ({ webkitGetAsEntry: () => ({ isDirectory: false }) }));
            for (const [name, entries] of Object.entries(folders)) {
              const parts = [entries, []];
              items.push({ webkitGetAsEntry: () => ({ name, isDirectory: true,
                                                      createReader: () => ({ readEntries: (done) => done(parts.shift()) }) }) });
            }
            const event = new Event('drop', { bubbles: true, cancelable: true });
            event.dataTransfer = { items, files: dropped.files };
            document.querySelector('.drop').dispatchEvent(event);""", items)

    def test_files_and_folders_are_dropped(self):
        page = self.page
        with open(bench.path("box.off"), encoding="ascii") as file:
            text = file.read()
        page.click("a.button[href='#new']")
        page.heading("New job")
        self.drop([("alone.off", text)])
        page.wait(lambda: page.all("#name") and page.find("#name").get_attribute("value") == "alone")
        self.drop([("one.off", text), ("scans/two.off", text), ("scans/notes.txt", "no mesh"), ("scans/three.ply", "none")])
        page.wait(lambda: len(page.all("#several li")) == 3 and "sending" not in page.find("#several").text)
        texts = [line.text for line in page.all("#several li")]
        self.assertRegex(texts[0], "^one (is submitted|was there already)$")
        self.assertIn("three.ply: ", texts[1])
        self.assertRegex(texts[2], "(is submitted|was there already)$")

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
        bench.run("delete", job)
        page.wait(lambda: "It was deleted meanwhile" in page.text())
        for left in ("skeleton in", "resume", "Download", "About this job", "Trying again"):
            self.assertNotIn(left, page.text())
        page.screenshot("desktop-17-deleted")
        page.script("location.hash = '#job/noid'")
        page.wait(lambda: "There is no such job" in page.text())
        self.assertNotIn("Trying again", page.text())
        self.assertEqual([e for e in page.errors() if "404" not in e and "/api/jobs/noid " not in e], [])

    def test_numbers_are_taken_as_they_are_typed(self):
        page = self.page
        page.click("a.button[href='#new']")
        self.choose("box.off")
        page.wait(lambda: page.all("#spacing"))
        page.type("#spacing", "5,5")
        page.wait(lambda: "at spacing 5.5" in page.find("#lattice").text)
        page.type("#points", "1,000")
        # About as many at once, then as the lattice counts, within a tenth.
        page.wait(lambda: re.search("(9[0-9]{2}|1,0[0-9]{2}) sample points", page.find("#lattice").text))
        page.type("#points", "1e")
        page.wait(lambda: "Give a number above 0." in page.find("#lattice").text)

    def test_the_list_is_searched_ordered_and_cleaned(self):
        page = self.page
        names = ["zebra one", "zebra two", "ape"]
        ids = [bench.run("submit", bench.path("box.off"), "--points", str(500 + 300 * n), "--name", name, "--wait").strip()
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

    def test_turns_the_skeleton(self):
        self.submit_body(8000, "turned")
        self.page.click("#interactive")
        frame = self.page.shown("dialog iframe")
        self.page.driver.switch_to.frame(frame)
        state = self.page.wait(lambda: self.page.script("return window.affskel && affskel.state()"))
        self.assertGreater(state["skeletonShown"], 100, "the ridge's sheet")
        self.assertGreaterEqual(len(state["levels"]), 3)
        self.page.find("#view-front").click()
        front = self.page.script("return affskel.state().camera.position")
        self.page.find("#canvas").send_keys(Keys.ARROW_LEFT)
        self.page.wait(lambda: self.page.script("return affskel.state().camera.position") != front)
        self.assertEqual(self.page.script("return window.origin"), "null", "in a sandbox of its own")
        self.page.driver.switch_to.default_content()
        self.page.screenshot("desktop-4-turned")
        self.page.click("#close-interactive")
        self.page.wait(lambda: not self.page.all("dialog"))
        self.assertEqual(self.page.script("return document.activeElement.id"), "interactive")

    def test_an_image_of_voxels_is_asked_for_the_value_at_its_surface(self):
        def inner(n):
            return 2 < n < 9
        voxels = bytes(200 if inner(i) and inner(j) and inner(k) else 0
                       for k in range(12) for j in range(12) for i in range(12))
        with open(bench.path("ct.nrrd"), "wb") as file:
            file.write(b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n" + voxels)
        self.page.click("a.button[href='#new']")
        self.choose("ct.nrrd")
        self.page.type("#isovalue", 100)
        self.assertEqual([e.text for e in self.page.all(".error") if e.is_displayed()], [], "it is no error")
        self.assertIn("values from 0 to 200", self.page.text())
        self.page.screenshot("desktop-14-voxels")
        self.page.click("#make-surface")
        self.page.picture_is_drawn("#found img")
        self.assertIn("the solid is where values are above", self.page.find("#found").text)
        self.page.screenshot("desktop-15-surface")
        self.page.type("#points", 500)
        self.page.click("#submit")
        self.page.heading("ct")

    def test_says_what_is_wrong_with_a_mesh(self):
        self.page.click("a.button[href='#new']")
        self.choose("open.off")
        self.page.wait(lambda: "bounds no solid" in self.page.shown("#found").text)
        found = self.page.find("#found").text
        self.assertIn("edges", found)
        self.assertIn("line", found)
        self.page.picture_is_drawn("#found img")
        self.assertEqual(self.page.all("#submit"), [])
        self.page.screenshot("desktop-5-defects")
        self.page.click("#turn-mesh")
        self.page.driver.switch_to.frame(self.page.shown("dialog iframe"))
        state = self.page.wait(lambda: self.page.script("return window.affskel && affskel.state()"))
        self.assertGreater(state["marked"], 2, "defects")
        self.assertIn("triangle on one side only", self.page.find("#warnings").text)
        for hidden in ["#threshold", "#level", "#legend"]:
            self.assertFalse(self.page.find(hidden).is_displayed(), hidden)
        self.page.driver.switch_to.default_content()
        self.page.screenshot("desktop-13-defects-turned")
        self.page.click("#close-interactive")
        self.page.wait(lambda: not self.page.all("dialog"))
        self.page.click("#wrap")
        self.page.wait(lambda: "wrapped by" in self.page.find("#found").text and self.page.all("#submit"))
        with open(bench.path("text.off"), "w", encoding="ascii") as file:
            file.write("this is no mesh\n")
        self.choose("text.off")
        self.page.wait(lambda: "text.off cannot be read: " in self.page.text())
        self.assertNotIn("/tmp", self.page.text())

    def test_deletes_only_what_is_confirmed(self):
        self.submit_body(2000, "unloved")
        job = self.page.driver.current_url.split("/")[-1]
        self.page.click("#delete")
        self.page.click("dialog button")  # keep it
        self.page.wait(lambda: not self.page.all("dialog"))
        bench.run("status", job)
        self.page.click("#delete")
        self.page.click("dialog .danger")
        self.page.heading("Jobs")
        self.page.wait(lambda: not self.page.all(f"#job-{job}"))
        gone = subprocess.run([CLIENT, "--quiet", "status", job], env=bench.environment, check=False,
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
        bench.run("cancel", job)
        self.page.wait(lambda: self.page.shown(".badge").text == "cancelled")

    def test_administrators_see_the_server(self):
        self.page.click("#server-link")
        self.page.heading("Server")
        self.page.wait(lambda: "Throughput" in self.page.text() and self.page.all("tbody th"))
        self.assertIn("Free on its disk", self.page.text())
        self.page.screenshot("desktop-7-server")

    def test_the_address_opens_the_page_once(self):
        other = self.enterContext(browsers.visitor(**DESKTOP))
        other.open(self.service.address)
        other.heading("This page is locked")
        self.assertIn("has been used before", other.text())
        other.screenshot("desktop-8-locked")
        refused = [message for message in other.errors() if "401" not in message]
        self.assertEqual(refused, [])
        # The address of the next start, pasted into the same tab.
        self.page.driver.get("about:blank")  # which would ask on
        self.stop()
        self.service = Service(CLIENT, bench.environment, http=self.service.origin.removeprefix("http://"))
        other.script(f"location.href = '{self.service.address}'")
        other.heading("Jobs")


class WhereTheServerComesAndGoes(unittest.TestCase):
    def test_the_page_waits_for_it(self):
        away = Away(CLIENT, SERVER, bench.environment)
        self.addCleanup(lambda: self.assertEqual(away.close(), 0))
        away.go()
        page = self.enterContext(browsers.visitor(**DESKTOP))
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


class SigningIn(unittest.TestCase):
    def setUp(self):
        self.lab = Lab(CLIENT, SERVER, bench.environment)
        self.addCleanup(lambda: self.assertEqual(self.lab.close(), 0))

    def visit(self, **window):
        page = self.enterContext(browsers.visitor(**(window or DESKTOP)))
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
        page.submit(bench.path("body.off"), 20000, "body of ada")
        page.skeleton_is_drawn()
        page.click("#interactive")
        page.driver.switch_to.frame(page.shown("dialog iframe"))
        page.wait(lambda: page.script("return window.affskel && affskel.state().skeletonShown > 0"))
        page.driver.switch_to.default_content()
        page.click("#close-interactive")
        page.wait(lambda: not page.all("dialog"))
        # By key: Chromium may still send the mouse to the frame that has just gone.
        page.find("button[data-file='mesh.off']").send_keys(Keys.ENTER)
        with open(bench.path("body.off"), "rb") as file:
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
        other.submit(bench.path("box.off"), 1000, "box of root")
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
        page.submit(bench.path("box.off"), 1000, "box of bob")
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


class ByKeyboardAlone(OnThePage):
    def test_from_a_mesh_to_its_files(self):
        page = self.page
        page.press("main a[href='#new']")
        page.heading("New job")
        page.tab_to("#file")
        self.choose("box.off")
        page.wait(lambda: page.script("return document.activeElement.id") == "found-heading")
        name = page.tab_to("#name")
        name.send_keys(Keys.CONTROL, "a")
        name.send_keys("by keyboard")
        points = page.tab_to("#points")
        points.send_keys(Keys.CONTROL, "a")
        points.send_keys("2000")
        page.press("summary")
        page.tab_to("#directions").send_keys("e")  # evenly from all sides
        page.wait(lambda: page.find("#how-many").is_displayed())
        page.press("#submit")
        page.heading("by keyboard")
        self.assertEqual(page.script("return document.activeElement.tagName"), "H1")
        page.wait(lambda: page.shown(".badge").text == "done")
        page.wait(lambda: page.find("#announcement").text or page.script(
            "return document.getElementById('announcement').textContent"))
        page.press("button[data-file='skeleton.ply']")
        self.assertTrue(page.downloaded("by keyboard.skeleton.ply").startswith(b"ply"))
        page.script("document.querySelector('h1').focus()")
        page.press("#delete")
        self.assertTrue(page.script("return document.activeElement.closest('dialog') !== null"))
        page.driver.switch_to.active_element.send_keys(Keys.ESCAPE)
        page.wait(lambda: not page.all("dialog"))
        self.assertEqual(page.script("return document.activeElement.id"), "delete")


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
        page.click("#interactive")
        page.driver.switch_to.frame(page.shown("dialog iframe"))
        page.wait(lambda: page.script("return window.affskel && affskel.state().skeletonShown > 0"))
        page.driver.switch_to.default_content()
        page.screenshot("phone-3-turned")
        page.click("#close-interactive")
        page.click("nav a[href='#jobs']")
        page.heading("Jobs")
        page.shown(".job")
        self.assert_fits()
        page.screenshot("phone-4-jobs")
        page.click("#server-link")
        page.heading("Server")
        page.wait(lambda: page.all("tbody th"))
        self.assert_fits()
        page.screenshot("phone-5-server")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
