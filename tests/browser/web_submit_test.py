"""Submits on the page of affskel-client web in Chromium, on a real server with its worker.

Usage: web_submit_test.py AFFSKEL-CLIENT AFFSKEL-SERVER [TEST...]
"""
import json
import re

from web_case import OnThePage, main, setUpModule  # first: it skips without a browser

from selenium.webdriver.common.keys import Keys


class Submitting(OnThePage):
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
        volume = json.loads(self.bench.run("--json", "inspect", self.bench.path("large.off")))["volume"]
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
        status = json.loads(self.bench.run("--json", "status", job))
        self.assertEqual(status["state"], "done")
        self.assertEqual(status["skeleton"]["operator"], "ridge")
        self.assertIn("skeleton in 1 piece (the ridge of E", page.text())
        page.picture_is_drawn()
        self.assertRegex(page.wait(lambda: [e.text for e in page.all(".card [role=status]") if "Shown" in e.text])[0],
                         r"Shown: sheet of [0-9]+ triangles .*\(ridge, threshold 6\)")
        before = page.find("img.picture").get_attribute("src")
        page.find("#stance option[value='z,x']").click()
        page.wait(lambda: page.find("img.picture").get_attribute("src") != before)
        self.assertEqual(json.loads(self.bench.run("--json", "status", job))["stance"], {"up": "z", "front": "x"})
        page.picture_is_drawn()
        page.screenshot("desktop-3-from-the-side")
        page.find("#stance option[value='shape']").click()
        page.wait(lambda: "stance" not in json.loads(self.bench.run("--json", "status", job)))
        page.click("#history summary")
        happened = page.wait(lambda: [line.text for line in page.all(".history li")])
        self.assertIn("submitted", happened[0])
        # The picture's sheet was made after it.
        self.assertTrue(any("done" in line for line in happened[1:]), happened)
        page.screenshot("desktop-3-done")

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
        self.assertEqual(json.loads(self.bench.run("--json", "status", job))["params"]["minimum"], "infimum")
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
        with page.turning_view("erodedShown?.[0] > 0"):
            self.assertAlmostEqual(page.script("return affskel.state().level"), 0.125)
        page.screenshot("desktop-16-level")
        page.click("#close-interactive")
        page.wait(lambda: not page.all("dialog"))
        page.find("#download-level").clear()
        page.find("#download-threshold").click()
        page.wait(lambda: page.find("img.picture").get_attribute("src") != with_level)
        page.find("#download-threshold").click()
        page.wait(lambda: any("threshold 3" in e.text for e in page.all(".card [role=status]")))
        self.assertFalse(page.find("details .error").is_displayed())

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
        with page.turning_view():
            self.assertEqual(page.script("return affskel.state().shown.length"), 2)
        page.screenshot("desktop-9-beside")
        page.click("#close-interactive")

    def test_again_asks_for_what_the_job_was_asked_for(self):
        page = self.page
        job = self.bench.run("submit", self.bench.path("box.off"), "--spacing", "12.5", "--directions",
                             "triangles+sphere:200", "--frame", "pca",
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
        with open(self.bench.path("open.off"), encoding="ascii") as came:
            self.assertEqual(self.bench.run("fetch", job, "source", "-o", "-"), came.read())
        self.assertTrue(page.all("[data-file='source.off']"))
        with page.turning_view():
            self.assertTrue(page.shown("#show-marks").is_selected())
            self.assertGreater(page.script("return affskel.state().marked"), 2, "the rim of the hole")
            self.assertIn("filled", page.find("#warnings").text)
        page.screenshot("desktop-14-repaired")

    def test_several_files_become_a_job_each(self):
        page = self.page
        page.click("a.button[href='#new']")
        with open(self.bench.path("nothing.off"), "w", encoding="ascii"):
            pass
        page.wait(lambda: page.all("#file"))[0].send_keys(
            "\n".join(self.bench.path(name) for name in ("box.off", "nothing.off", "open.off")))
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
        with open(self.bench.path("box.off"), encoding="ascii") as file:
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
        page.wait(lambda: "Sample points: a number above 0." in page.find("#lattice").text)

    def test_an_image_of_voxels_is_asked_for_the_value_at_its_surface(self):
        def inner(n):
            return 2 < n < 9
        voxels = bytes(200 if inner(i) and inner(j) and inner(k) else 0
                       for k in range(12) for j in range(12) for i in range(12))
        with open(self.bench.path("ct.nrrd"), "wb") as file:
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
        with open(self.bench.path("text.off"), "w", encoding="ascii") as file:
            file.write("this is no mesh\n")
        self.choose("text.off")
        self.page.wait(lambda: "text.off cannot be read: " in self.page.text())
        self.assertNotIn("/tmp", self.page.text())


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


if __name__ == "__main__":
    main()
