"""Opens the page of a job on a private server, made by affskel-client view, in Chromium.

Usage: page_test.py AFFSKEL-CLIENT [TEST...]"""
import os
import sys
import tempfile
import unittest

from view_page import WithPage, number, tick_numbers  # first: it skips

from PIL import Image
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys

from browser import Page, colours
from job import NAME, Job


def setUpModule():
    global job
    job = Job(sys.argv[1])


def tearDownModule():
    job.close()


class JobPage(WithPage):
    def file(self):
        return job.page


class Desktop(JobPage):
    def test_names_the_job(self):
        self.assertEqual(self.driver.title, NAME + " – affine skeleton")
        self.assertEqual(self.driver.find_element("tag name", "h1").text, NAME)
        self.assertGreaterEqual(self.page.state()["pointsHere"], job.skeleton_points(0.7))
        # The published operator's points are in a few pieces.
        self.assertIn("the solid in 1", self.page.element("warnings").text)

    def test_draws_the_body(self):
        number, background = colours(self.page.canvas_picture())
        self.assertGreater(number, 500)
        self.assertLess(background, 0.97)
        print(f"{self.page.script('return affskel.frameTime(10)'):.1f} ms per frame, drawn without a GPU")
        for layer in ["mesh", "skeleton", "axes"]:
            self.page.click("show-" + layer)
        self.assertEqual(colours(self.page.canvas_picture()), (1, 1.0))
        for layer in ["mesh", "skeleton", "axes", "eroded"]:
            self.page.click("show-" + layer)
            self.assertGreater(colours(self.page.canvas_picture())[0], 1, layer)
            self.page.click("show-" + layer)

    def test_a_new_size_is_drawn_before_it_is_seen(self):
        """Observers run in the order of their making: this one reads what the page leaves to be painted."""
        pixel = self.driver.execute_async_script("""
            const done = arguments[0], canvas = document.getElementById('canvas'), width = canvas.width;
            const gl = canvas.getContext('webgl2') || canvas.getContext('webgl');
            new ResizeObserver(() => {
              if (canvas.width === width) return;
              const pixel = new Uint8Array(4);
              gl.readPixels(1, 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
              done(Array.from(pixel));
            }).observe(canvas.parentElement);
            document.body.style.width = '800px';""")
        self.page.script("document.body.style.width = ''")
        self.assertGreater(sum(pixel[:3]), 0, "black: the canvas was cleared and not drawn")

    def test_the_threshold_chooses_the_skeleton(self):
        self.assertEqual(self.page.state()["threshold"], 7)
        self.assertEqual(self.page.state()["skeletonShown"], job.skeleton_points(7))
        for threshold in [6, 9, 7.5, 3]:
            self.page.type_number("threshold-field", threshold)
            state = self.page.wait(lambda s: s["threshold"] == threshold)
            self.assertEqual(state["skeletonShown"], job.skeleton_points(threshold))

    def test_the_threshold_slider_follows_the_keys(self):
        slider = self.page.element("threshold-range")
        before = self.page.state()
        slider.send_keys(Keys.PAGE_UP)
        fewer = self.page.wait(lambda s: s["threshold"] > before["threshold"])
        self.assertLess(fewer["skeletonShown"], before["skeletonShown"])
        self.assertEqual(fewer["skeletonShown"], job.skeleton_points(fewer["threshold"]))
        slider.send_keys(Keys.HOME)
        most = self.page.wait(lambda s: s["threshold"] < before["threshold"])
        self.assertGreater(most["skeletonShown"], before["skeletonShown"])
        self.assertIn(f"{most['skeletonShown']:,}", self.page.element("threshold-count").text)

    def test_the_level_chooses_the_surface_that_erode_makes(self):
        self.assertFalse(self.page.state()["visible"]["eroded"])
        levels = self.page.state()["levels"]
        self.assertGreaterEqual(len(levels), 3)
        for share in levels[::3]:
            self.page.type_number("level-field", 100 * share)
            state = self.page.wait(lambda s: abs(s["level"] - share) < 1e-12)
            self.assertTrue(state["visible"]["eroded"])
            triangles, volume = job.eroded(share)
            self.assertEqual(state["erodedShown"], [triangles])
            shown = self.page.element("level-count").text
            self.assertIn(f"{triangles:,} triangles", shown)
            self.assertAlmostEqual(float(shown.split(" %")[0]), 100 * volume / job.volume, delta=0.06)
        self.page.element("level-range").send_keys(Keys.HOME)
        self.page.wait(lambda s: s["level"] == levels[0])
        self.page.type_number("level-field", 99)
        self.page.wait(lambda s: s["level"] == levels[-1])

    def test_buttons_change_the_view(self):
        start = self.page.state()["camera"]
        for view, axis, sign in [("front", 1, -1), ("side", 0, 1), ("top", 2, 1)]:
            self.page.click("view-" + view)
            position = self.page.state()["camera"]["position"]
            self.assertAlmostEqual(position[axis] * sign, 12, 3, view)
        self.page.type_number("threshold-field", 9)
        self.page.click("reset")
        state = self.page.wait(lambda s: s["threshold"] == 7)
        self.assertEqual(state["camera"], start)

    def assert_numbers_fit(self):
        """No two numbers of the box overlap, none is cut, and they are large enough to read."""
        numbers = tick_numbers(self.page)
        self.assertGreaterEqual(len(numbers), 4)
        canvas = self.page.script("const b = document.getElementById('canvas').getBoundingClientRect();"
                                  "return [b.left, b.top, b.right, b.bottom]")
        for i, a in enumerate(numbers):
            self.assertGreaterEqual(a["size"], 12)
            self.assertTrue(canvas[0] <= a["left"] and a["right"] <= canvas[2] and
                            canvas[1] <= a["top"] and a["bottom"] <= canvas[3], a)
            for b in numbers[:i]:
                apart = (a["right"] <= b["left"] or b["right"] <= a["left"] or
                         a["bottom"] <= b["top"] or b["bottom"] <= a["top"])
                self.assertTrue(apart, (a, b))

    def test_the_numbers_of_the_box_can_be_read(self):
        for view in ["reset", "view-front", "view-side", "view-top"]:
            self.page.click(view)
            self.page.drawn()
            self.assert_numbers_fit()

    def test_the_view_fits_between_buttons_and_legend(self):
        for view in ["view-front", "view-side", "view-top", "reset"]:
            self.page.click(view)
            picture = self.page.canvas_picture()
            for edge in [picture.crop((0, 0, picture.width, 8)),
                         picture.crop((0, picture.height - 8, picture.width, picture.height))]:
                self.assertEqual(colours(edge)[0], 1, view)

    def test_mouse_and_keys_turn_the_body(self):
        canvas = self.page.element("canvas")
        start = self.page.state()["camera"]
        drag = ActionChains(self.driver).move_to_element(canvas).click_and_hold()
        drag.move_by_offset(80, 30).release().perform()
        dragged = self.page.wait(lambda s: s["camera"]["position"] != start["position"])["camera"]
        self.assertEqual(dragged["zoom"], start["zoom"])
        ActionChains(self.driver).scroll_from_origin(ScrollOrigin.from_element(canvas), 0, -300).perform()
        self.page.wait(lambda s: s["camera"]["zoom"] > start["zoom"])
        canvas.send_keys(Keys.ARROW_LEFT)
        self.page.wait(lambda s: s["camera"]["position"] != dragged["position"])
        canvas.send_keys("1")
        self.page.wait(lambda s: abs(s["camera"]["position"][1] + 12) < 1e-3)
        canvas.send_keys("+")
        self.page.wait(lambda s: s["camera"]["position"][1] < -11)

    def test_tells_the_values_under_the_pointer(self):
        """The skeleton's points, by the command that writes them."""
        points = {tuple(round(float(row[c]), 6) for c in "xyz"): row for row in job.skeleton_rows(7)}
        canvas = self.page.element("canvas")
        size = canvas.size
        found = {}
        for x in range(-60, 61, 6):
            for y in range(-200, 201, 25):
                values = self.page.script("return affskel.valuesAt(arguments[0], arguments[1])",
                                          size["width"] / 2 + x, size["height"] / 2 + y)
                if values and values["what"].startswith("skeleton point"):
                    found[x, y] = values
        self.assertGreater(len(found), 5)
        for values in found.values():
            at = [number(c) for c in values["place"].strip("()").split(", ")]
            near = min(points, key=lambda p: sum((a - b) ** 2 for a, b in zip(p, at)))
            row = points[near]
            for a, b in zip(near, at):
                self.assertAlmostEqual(a, b, delta=2e-4 * 1800)
            self.assertAlmostEqual(number(values["E"]) / float(row["E"]), 1, delta=1e-3)
            self.assertAlmostEqual(number(values["share of v0"].rstrip(" %")) * job.volume / 100 / float(row["E"]),
                                   1, delta=1e-3)
            self.assertAlmostEqual(number(values["|H|"]), abs(float(row["H"])), delta=2e-3 * abs(float(row["H"])))
            direction = [number(c) for c in values["direction"].strip("()").split(", ")]
            for name, c in zip(["nx", "ny", "nz"], direction):
                self.assertAlmostEqual(float(row[name]), c, delta=0.016)
        (x, y), values = next(iter(found.items()))
        probe = self.page.element("probe")
        self.assertFalse(probe.is_displayed())
        ActionChains(self.driver).move_to_element_with_offset(canvas, x, y).perform()
        self.page.wait(lambda _: probe.is_displayed())
        for text in ["skeleton point", "E", "share of v0", "slope", values["E"], values["place"]]:
            self.assertIn(text, probe.text)
        ActionChains(self.driver).move_to_element(self.page.element("theme")).perform()
        self.page.wait(lambda _: not probe.is_displayed())

    def test_a_link_keeps_camera_and_sliders(self):
        self.page.type_number("threshold-field", 8.5)
        self.page.type_number("level-field", 5)
        self.page.click("show-axes")
        self.page.click("view-side")
        self.page.element("canvas").send_keys(Keys.ARROW_LEFT, "+")
        self.page.choose("clip-axis", "y")
        # It begins with most of the skeleton in sight, and some of the body cut off.
        self.assertLess(abs(float(self.page.element("clip-place").get_attribute("value"))), 0.9)
        self.page.slide("clip-place", 0.25)
        self.page.slide("opacity", 60)
        state = self.page.state()
        self.page.wait(lambda s: self.linked(state))
        link = self.linked(state)
        self.page = Page(self.driver, self.file(), link)
        self.assertEqual(self.page.script("return location.hash.length > 1"), True)
        again = self.page.state()
        for key in ["threshold", "level", "visible", "opacity"]:
            self.assertEqual(again[key], state[key], key)
        for key in ["azimuth", "elevation", "zoom"]:
            self.assertAlmostEqual(again["looking"][key], state["looking"][key], 3, key)
        self.assertEqual(self.page.element("clip-axis").get_attribute("value"), "y")
        self.assertEqual(self.page.element("clip-place").get_attribute("value"), "0.25")
        # Opened in the page itself; what is not understood is passed over.
        self.page.script("location.hash = '#view=top&threshold=9&level=x&opacity=&clip=q<1&camera=1,2'")
        state = self.page.wait(lambda s: s["threshold"] == 9)
        self.assertAlmostEqual(state["looking"]["elevation"], 90, 1)
        self.assertEqual(state["level"], again["level"])

    def linked(self, state):
        """The address once it says what is seen; else None."""
        link = self.page.script("return location.hash")
        wanted = "camera=%.6g" % state["looking"]["azimuth"]
        return link if wanted[:12] in link and "opacity=60" in link and "clip=y" in link else None

    def test_saves_what_is_seen_with_its_scale(self):
        self.page.click("view-front")
        self.page.drawn()
        seen = self.page.canvas_picture()
        with tempfile.TemporaryDirectory(prefix="affskel-browser-png-") as directory:
            self.driver.execute_cdp_cmd("Page.setDownloadBehavior", {"behavior": "allow", "downloadPath": directory})
            self.page.click("save")
            names = self.page.wait(lambda _: [n for n in os.listdir(directory) if n.endswith(".png")])
            names = [n for n in os.listdir(directory) if n.endswith(".png")]
            saved = Image.open(os.path.join(directory, names[0])).convert("RGB")
        self.assertEqual(saved.size, seen.size)
        middle = (saved.width // 4, 60, 3 * saved.width // 4, saved.height - 130)
        body, same = saved.crop(middle), seen.crop(middle)
        differing = sum(1 for a, b in zip(body.getdata(), same.getdata()) if max(abs(x - y) for x, y in zip(a, b)) > 8)
        self.assertLess(differing, 0.03 * body.width * body.height, "but for the numbers of the box")
        for part in ["#scale .bar", "#scale .length", "#legend .colours", "#legend .note"]:
            box = self.page.script("""const [a, b] = [document.querySelector(arguments[0]), document.querySelector('main')]
                .map((e) => e.getBoundingClientRect());
                return [a.left - b.left - 2, a.top - b.top - 2, a.right - b.left + 2, a.bottom - b.top + 2]""", part)
            self.assertGreater(colours(saved.crop(tuple(int(c) for c in box)))[0], 1, part)

    def test_opacity_and_clipping_change_what_is_drawn(self):
        self.page.click("view-front")
        for layer in ["skeleton", "axes"]:
            self.page.click("show-" + layer)
        self.page.slide("opacity", 100)
        whole = self.page.canvas_picture()
        background = whole.getpixel((2, 2))
        covered = lambda picture: sum(1 for c in picture.getdata() if c != background)
        self.page.choose("clip-axis", "x")
        half = self.page.canvas_picture()
        self.assertAlmostEqual(covered(half) / covered(whole), 0.5, delta=0.06)
        self.assertEqual(covered(half.crop((half.width // 2 + 3, 0, half.width, half.height))), 0)
        self.page.click("clip-flip")
        other = self.page.canvas_picture()
        self.assertEqual(covered(other.crop((0, 0, other.width // 2 - 3, other.height))), 0)
        self.page.choose("clip-axis", "")
        self.page.slide("opacity", 0)
        self.assertEqual(covered(self.page.canvas_picture()), 0)

    def test_clipping_begins_where_the_skeleton_is_seen(self):
        self.page.click("view-front")
        drawn = lambda: (self.page.drawn(), self.page.canvas_picture())[1]
        whole = drawn()
        self.page.choose("clip-axis", "y")
        self.assertTrue(self.page.element("clip-flip").is_selected(), "the front is at -y")
        self.assertNotEqual(drawn().tobytes(), whole.tobytes())
        self.page.click("show-mesh")
        with_plane = drawn()
        self.page.choose("clip-axis", "")
        background = whole.getpixel((2, 2))
        covered = lambda picture: sum(1 for c in picture.getdata() if c != background)
        self.assertGreater(covered(with_plane), 0.3 * covered(drawn()))
        self.page.click("view-side")
        self.page.choose("clip-axis", "x")
        self.assertFalse(self.page.element("clip-flip").is_selected())

    def test_fills_the_screen(self):
        self.page.click("full")
        self.page.wait(lambda _: self.page.script("return document.fullscreenElement !== null"))
        self.page.click("full")
        self.page.wait(lambda _: self.page.script("return document.fullscreenElement === null"))

    def test_the_background_changes(self):
        before = self.page.state()["theme"]
        light = self.page.canvas_picture().getpixel((2, 2))
        self.page.click("theme")
        self.page.wait(lambda s: s["theme"] != before)
        self.assertNotEqual(self.page.canvas_picture().getpixel((2, 2)), light)


class Fold(JobPage):
    """A usual screen."""
    window = dict(width=1280, height=800)

    def test_the_facts_are_above_the_fold(self):
        last = self.page.script("return document.querySelector('#facts-list').getBoundingClientRect().bottom")
        self.assertLessEqual(last, self.page.script("return innerHeight"))
        facts = self.page.element("facts-list").text
        for text in ["triangles", "500", "pieces", "(solid: 1)", "tunnels", "directions", "v0", "spacing"]:
            self.assertIn(text, facts)


class Phone(JobPage):
    window = dict(width=390, height=844, phone=True)
    ROOM = 250  # pixels

    CONTROLS = ["threshold-range", "threshold-field", "level-range", "level-field", "show-mesh",
                "show-skeleton", "show-eroded", "show-axes", "show-scale", "theme", "opacity", "clip-axis",
                "clip-flip"]
    ALWAYS = ["fold", "view-front", "view-side", "view-top", "reset", "save", "full"]

    def reach(self, name):
        """Scrolls to it; whether a finger in its middle meets it."""
        return self.page.script("""
            const target = document.getElementById(arguments[0]);
            target.scrollIntoView({ block: 'nearest' });
            const box = target.getBoundingClientRect();
            const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
            // Scrolling leaves fractions of a pixel.
            return box.left >= 0 && box.right <= innerWidth && box.bottom < innerHeight + 1 &&
              document.elementFromPoint(x, y) === target;""", name)

    def assert_no_overflow(self):
        width = self.window["width"]
        self.assertEqual(self.page.script("return innerWidth"), width)
        widest = self.page.script("""return Math.max(document.documentElement.scrollWidth, ...Array.from(
            document.querySelectorAll('body *'), (e) => e.getBoundingClientRect().right))""")
        self.assertLessEqual(widest, width)

    def test_everything_is_within_reach(self):
        self.assert_no_overflow()
        for name in self.ALWAYS:
            self.assertTrue(self.reach(name), name)
        self.assertFalse(self.page.element("threshold-range").is_displayed())
        self.page.click("fold")
        self.assert_no_overflow()
        for name in self.ALWAYS + self.CONTROLS:
            self.assertTrue(self.reach(name), name)
        room = self.page.script("return document.getElementById('canvas').clientHeight")
        self.assertGreater(room, self.ROOM, "the body stays in sight while the controls are open")
        self.assertGreater(colours(self.page.canvas_picture())[0], 300)

    def test_the_numbers_of_the_box_can_be_read(self):
        Desktop.test_the_numbers_of_the_box_can_be_read(self)

    assert_numbers_fit = Desktop.assert_numbers_fit

    def test_one_finger_turns_and_two_zoom(self):
        start = self.page.state()["camera"]
        self.touch("touchStart", (195, 400))
        for x in range(200, 260, 10):
            self.touch("touchMove", (x, 410))
        self.touch("touchEnd")
        turned = self.page.wait(lambda s: s["camera"]["position"] != start["position"])["camera"]
        self.assertEqual(turned["zoom"], start["zoom"])
        self.touch("touchStart", (180, 400), (210, 400))
        for spread in range(20, 90, 10):
            self.touch("touchMove", (195 - spread, 400), (195 + spread, 400))
        self.touch("touchEnd")
        self.page.wait(lambda s: s["camera"]["zoom"] > 1.5 * start["zoom"])

    def test_draws_the_body(self):
        number, background = colours(self.page.canvas_picture())
        self.assertGreater(number, 500)
        self.assertLess(background, 0.97)

    def test_a_tap_tells_the_values(self):
        # Somewhere on the body, which need not be in the middle.
        x, y = self.page.script("""
            const { left, top, width, height } = document.getElementById('canvas').getBoundingClientRect();
            for (let y = height / 4; y < height; y += 5) {
              if (affskel.valuesAt(width / 2, y)) return [left + width / 2, top + y];
            }""")
        WithPage.touch(self, "touchStart", (x, y))
        WithPage.touch(self, "touchEnd")
        self.page.wait(lambda _: self.page.element("probe").is_displayed())
        self.assertIn("place", self.page.element("probe").text)


class PhoneOnItsSide(Phone):
    window = dict(width=844, height=390, phone=True)

    def touch(self, kind, *points):
        # The other tests' places, turned with the phone.
        super().touch(kind, *((y, x) for x, y in points))


class WithoutWebGl(JobPage):
    window = dict(width=800, height=600, gl=False)

    def test_says_so(self):
        message = self.page.element("failure")
        self.assertTrue(message.is_displayed())
        self.assertIn("WebGL", message.text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
