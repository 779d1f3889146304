"""Opens pages of affskel-client view in Chromium.  Usage: page_test.py AFFSKEL-CLIENT AFFSKEL-MADE-UP-PAGE"""
import os
import subprocess
import sys
import tempfile
import unittest

if not all(os.path.isfile(os.environ.get(program, "")) for program in ["CHROMIUM", "CHROMEDRIVER"]):
    print("no chromium or chromedriver: skipped")
    sys.exit(77)

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys

from browser import Page, chromium, colours
from job import NAME, Job

CLIENT, MADE_UP_PAGE = sys.argv[1:3]


def setUpModule():
    global job
    job = Job(CLIENT)


def tearDownModule():
    job.close()


def tick_numbers(page):
    """The numbers at the box that are shown: axis, text, sides and height of the letters, pixels."""
    return page.script("""
        return Array.from(document.querySelectorAll('#tick-numbers span'), (span) => {
          const { left, top, right, bottom } = span.getBoundingClientRect();
          return { axis: span.className, text: span.textContent, shown: !span.hidden, left, top, right, bottom,
                   size: parseFloat(getComputedStyle(span).fontSize) };
        }).filter((span) => span.shown)""")


class WithPage(unittest.TestCase):
    window = dict(width=1200, height=800)

    def setUp(self):
        self.driver = self.enterContext(chromium(**self.window))
        self.page = Page(self.driver, self.file())

    def file(self):
        return job.page

    def made_up(self, *kind):
        directory = self.enterContext(tempfile.TemporaryDirectory(prefix="affskel-browser-page-"))
        file = os.path.join(directory, "page.html")
        subprocess.run([MADE_UP_PAGE, *kind, file], check=True)
        return file

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])
        asked = self.page.requests()
        self.assertIn("file://" + self.page.file, asked)
        self.assertEqual([url for url in asked if not url.startswith(("file:///", "data:"))], [])


class Desktop(WithPage):
    def test_names_the_job(self):
        self.assertEqual(self.driver.title, NAME + " – affine skeleton")
        self.assertEqual(self.driver.find_element("tag name", "h1").text, NAME)
        self.assertEqual(self.page.state()["pointsHere"], len(job.levels))

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

    def test_the_level_chooses_the_eroded_solid(self):
        self.assertFalse(self.page.state()["visible"]["eroded"])
        for per_cent in [1, 5.5, 20]:
            self.page.type_number("level-field", per_cent)
            state = self.page.wait(lambda s: abs(s["level"] - per_cent / 100) < 1e-12)
            self.assertEqual(state["erodedShown"], job.eroded_points(state["level"]))
            self.assertTrue(state["visible"]["eroded"])
        slider = self.page.element("level-range")
        slider.send_keys(Keys.HOME)
        self.page.wait(lambda s: s["erodedShown"] == len(job.levels))
        slider.send_keys(Keys.END)
        last = self.page.wait(lambda s: s["erodedShown"] < len(job.levels))
        self.assertGreater(last["erodedShown"], 0)
        self.assertEqual(last["erodedShown"], job.eroded_points(last["level"]))

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

    def test_the_background_changes(self):
        before = self.page.state()["theme"]
        light = self.page.canvas_picture().getpixel((2, 2))
        self.page.click("theme")
        self.page.wait(lambda s: s["theme"] != before)
        self.assertNotEqual(self.page.canvas_picture().getpixel((2, 2)), light)


class Phone(WithPage):
    window = dict(width=390, height=844, phone=True)

    CONTROLS = ["threshold-range", "threshold-field", "level-range", "level-field", "show-mesh",
                "show-skeleton", "show-eroded", "show-axes", "show-scale", "theme"]
    ALWAYS = ["fold", "view-front", "view-side", "view-top", "reset"]

    def reach(self, name):
        """Scrolls to it; whether a finger in its middle meets it."""
        return self.page.script("""
            const target = document.getElementById(arguments[0]);
            target.scrollIntoView({ block: 'nearest' });
            const box = target.getBoundingClientRect();
            const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
            return box.left >= 0 && box.right <= innerWidth && box.bottom <= innerHeight &&
              document.elementFromPoint(x, y) === target;""", name)

    def assert_no_overflow(self):
        self.assertEqual(self.page.script("return innerWidth"), 390)
        widest = self.page.script("""return Math.max(document.documentElement.scrollWidth, ...Array.from(
            document.querySelectorAll('body *'), (e) => e.getBoundingClientRect().right))""")
        self.assertLessEqual(widest, 390)

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
        self.assertGreater(room, 250, "the body stays in sight while the controls are open")
        self.assertGreater(colours(self.page.canvas_picture())[0], 300)

    def test_the_numbers_of_the_box_can_be_read(self):
        Desktop.test_the_numbers_of_the_box_can_be_read(self)

    assert_numbers_fit = Desktop.assert_numbers_fit

    def touch(self, kind, *points):
        self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})

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


class Sheet(WithPage):
    """The page of operator chords, with made-up numbers: see made_up_page.cc."""

    def file(self):
        return self.made_up("sheet")

    # Columns of eight squares, two triangles each, and the strength of their corners.
    PIECES = [(1, 0.5), (5, 0.5), (2, 1.0)]

    def expected(self, least):
        """Triangles and pieces with at least that share of the area weighted by strength."""
        weights = [columns * strength for columns, strength in self.PIECES]
        shares = [weight / sum(weights) for weight in weights]
        kept = [columns for (columns, _), share in zip(self.PIECES, shares) if share >= least]
        return 16 * sum(kept), len(kept)

    def test_the_threshold_is_for_the_pieces(self):
        self.assertEqual(self.page.element("threshold-symbol").text, "share ≥")
        self.assertEqual(self.page.state()["skeletonShown"], 128, "at first the whole sheet")
        # The shares are 0.1, 0.5 and 0.4; of the area alone they were 0.125, 0.625 and 0.25.
        for least in [0.09, 0.11, 0.39, 0.45, 0]:
            triangles, pieces = self.expected(least)
            self.page.type_number("threshold-field", least)
            self.page.wait(lambda s: s["threshold"] == least)
            self.assertEqual(self.page.state()["skeletonShown"], triangles, least)
            self.assertEqual(self.page.element("threshold-count").text,
                             f"{triangles} triangles in {pieces} of 3 pieces")
        slider = self.page.element("threshold-range")
        slider.send_keys(Keys.END)
        last = self.page.wait(lambda s: s["threshold"] > 0.4)
        self.assertEqual(last["skeletonShown"], 80, "the heaviest piece stays")

    def test_the_numbers_of_the_box_are_coordinates(self):
        # The cube goes from 0 to 4; from the front x goes right and z up, and y points at the viewer.
        self.page.click("view-front")
        self.page.drawn()
        numbers = tick_numbers(self.page)
        unit = self.page.state()["camera"]["zoom"] * self.page.element("canvas").size["height"] / 4
        for axis, low, high, sign in [("x", "left", "right", 1), ("z", "top", "bottom", -1)]:
            values = {float(n["text"]): (n[low] + n[high]) / 2 for n in numbers if n["axis"] == axis}
            # Where the axes meet one of the two may make room for the other.
            self.assertTrue({1, 2, 3, 4} <= set(values), values)
            for value, place in values.items():
                self.assertAlmostEqual((place - values[2]) * sign, (value - 2) * unit, delta=1)
        self.assertEqual([n for n in numbers if n["axis"] == "y"], [])
        self.page.click("view-top")
        self.page.drawn()
        self.assertEqual({n["axis"] for n in tick_numbers(self.page)}, {"x", "y"})
        self.page.click("show-axes")
        self.assertFalse(self.page.element("tick-numbers").is_displayed())

    def test_hides_what_is_too_light(self):
        self.page.click("view-top")
        for layer in ["mesh", "axes"]:
            self.page.click("show-" + layer)
        covered = lambda: 1 - colours(self.page.canvas_picture())[1]
        whole = covered()
        self.page.type_number("threshold-field", 0.45)
        self.page.wait(lambda s: s["skeletonShown"] == 80)
        self.assertAlmostEqual(covered() / whole, 5 / 8, 1)

    def test_draws_the_sheet(self):
        self.page.click("view-top")
        for layer in ["mesh", "axes"]:
            self.page.click("show-" + layer)
        picture = self.page.canvas_picture()
        # Left E is low, violet; right high, yellow.
        left = picture.getpixel((int(picture.width / 2 - 100), int(picture.height / 2)))
        right = picture.getpixel((int(picture.width / 2 + 100), int(picture.height / 2)))
        self.assertGreater(left[2], left[1])
        self.assertGreater(right[1], right[2])


class Curve(WithPage):
    """A strip of a sheet and a curve of eight segments: see made_up_page.cc."""

    def file(self):
        return self.made_up("curve")

    def test_counts_its_segments(self):
        self.assertEqual(self.page.element("threshold-count").text,
                         "16 triangles and 8 segments of curves in one piece")

    def test_draws_a_tube(self):
        self.page.click("view-top")
        for layer in ["mesh", "axes"]:
            self.page.click("show-" + layer)
        picture = self.page.canvas_picture()
        background = picture.getpixel((2, 2))
        unit = self.page.state()["camera"]["zoom"] * self.page.element("canvas").size["height"] / 4
        # The curve goes from 0.5 to 2.5 of the edge of 4; the middle of the picture is 2.
        for x in (1, 2, 2.4):
            column = int(picture.width / 2 + (x - 2) * unit)
            drawn = [y for y in range(picture.height) if picture.getpixel((column, y)) != background]
            # Six sides round a circle of 0.3 spacings of 0.5.
            self.assertGreater(len(drawn), 0.25 * unit, x)
            self.assertLess(len(drawn), 0.35 * unit, x)


class Stretched(WithPage):
    """Points of a lattice whose steps are four times as long along z: see made_up_page.cc."""

    def file(self):
        return self.made_up("stretched")

    def test_points_are_as_large_as_their_cells(self):
        self.page.click("view-front")
        for layer in ["mesh", "axes"]:
            self.page.click("show-" + layer)
        picture = self.page.canvas_picture()
        background = picture.getpixel((2, 2))
        drawn = [(x, y) for x in range(picture.width) for y in range(picture.height)
                 if picture.getpixel((x, y)) != background]
        columns, rows = [{place[axis] for place in drawn} for axis in (0, 1)]
        unit = self.page.state()["camera"]["zoom"] * self.page.element("canvas").size["height"] / 4
        # Six cells of 1/8 x 1/2 above each other, each drawn a tenth larger: without a gap.
        self.assertAlmostEqual(max(columns) - min(columns) + 1, 1.1 / 8 * unit, delta=2)
        self.assertAlmostEqual(max(rows) - min(rows) + 1, (5 + 1.1) / 2 * unit, delta=2)
        self.assertEqual(len(rows), max(rows) - min(rows) + 1)


class Thinned(WithPage):
    """Pages of which the whole eroded solid is left, evenly thinned."""

    def file(self):
        return self.made_up("thinned", "2")

    def test_page_and_client_thin_alike(self):
        for thinning in [2, 4, 8, 16, 32]:
            self.page = Page(self.driver, self.made_up("thinned", str(thinning)))
            self.assertTrue(self.page.element("thinned").is_displayed())
            self.page.element("level-range").send_keys(Keys.HOME)
            state = self.page.wait(lambda s: s["visible"]["eroded"])
            self.assertEqual(state["thinning"], thinning)
            self.assertEqual(state["erodedShown"], state["pointsHere"])
            self.assertIn("about 100 %", self.page.element("level-count").text)
            self.assertGreater(colours(self.page.canvas_picture())[0], 5)


class WithoutWebGl(WithPage):
    window = dict(width=800, height=600, gl=False)

    def test_says_so(self):
        message = self.page.element("failure")
        self.assertTrue(message.is_displayed())
        self.assertIn("WebGL", message.text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
