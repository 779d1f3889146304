"""Opens pages of affskel-client view that hold made-up numbers, see made_up_page.cc, in Chromium.

Usage: made_up_page_test.py AFFSKEL-MADE-UP-PAGE [TEST...]"""
import os
import subprocess
import sys
import tempfile
import unittest

from view_page import WithPage, tick_numbers  # first: it skips

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from browser import Page, colours


class MadeUpPage(WithPage):
    KIND = ""

    def file(self):
        directory = self.enterContext(tempfile.TemporaryDirectory(prefix="affskel-browser-page-"))
        file = os.path.join(directory, "page.html")
        subprocess.run([sys.argv[1], self.KIND, file], check=True)
        return file


class Sheet(MadeUpPage):
    """The page of operator chords, with made-up numbers: see made_up_page.cc."""

    KIND = "sheet"

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
        self.assertFalse(self.page.element("panes").is_displayed())

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


class Curve(MadeUpPage):
    """A strip of a sheet and a curve of eight segments: see made_up_page.cc."""

    KIND = "curve"

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


class Parts(MadeUpPage):
    """A cube whose upper half is another part than the lower one, and twice as thick: see made_up_page.cc."""

    KIND = "parts"

    def setUp(self):
        super().setUp()
        self.page.click("view-front")

    def halves(self):
        """The colours of both halves."""
        picture = self.page.canvas_picture()
        column = picture.width // 2
        return [picture.getpixel((column, int(picture.height / 2 + up))) for up in (-60, 60)]

    def test_the_mesh_is_coloured_by_part(self):
        self.assertFalse(self.page.element("parts").is_displayed())
        self.page.choose("body-colour", "part")
        self.page.slide("opacity", 100)
        upper, lower = self.halves()
        # Light blue and sand, see part_colours().
        self.assertGreater(upper[2], upper[0])
        self.assertGreater(lower[0], lower[2])
        rows = [row.text for row in self.page.element("parts").find_elements("tag name", "tr")]
        self.assertEqual(rows, ["part volume length radius", "1 link 75 % 6 0.75", "2 limb 25 % 2 0.25"])

    def test_a_row_lights_its_part(self):
        self.page.choose("body-colour", "part")
        self.page.slide("opacity", 100)
        before = self.halves()
        row = self.page.element("parts").find_elements("tag name", "tr")[2]
        ActionChains(self.driver).move_to_element(row).perform()
        upper, lower = self.halves()
        self.assertEqual(upper, before[0])
        self.assertLess(max(lower) - min(lower), 20, "grey")
        self.leave()
        self.assertEqual(self.halves(), before)

    def test_thickness_has_a_scale_of_its_own(self):
        self.page.choose("body-colour", "thickness")
        legend = self.page.element("legend")
        self.assertIn("Thickness", legend.text)
        self.assertIn("0.75", legend.text)
        self.assertFalse(self.page.element("parts").is_displayed())
        upper, lower = self.halves()
        self.assertGreater(upper[0], upper[2], "yellow")
        self.assertGreater(lower[2], lower[0], "the middle of viridis")
        self.page.click("reset")
        self.assertIn("Erosion level", legend.text)
        self.assertEqual(self.page.state()["opacity"], 20)

    def test_tells_of_the_part_under_the_pointer(self):
        self.page.choose("body-colour", "thickness")
        size = self.page.element("canvas").size
        x, y = size["width"] / 2, size["height"] / 2
        upper = self.page.script("return affskel.valuesAt(arguments[0], arguments[1])", x, y - 60)
        self.assertEqual(upper["what"], "part 2, a limb")
        self.assertEqual(upper["volume"], "25 %")
        self.assertEqual(upper["thickness here"], "1")
        self.assertEqual(self.page.script("return affskel.valuesAt(arguments[0], arguments[1])", x, y + 60)["length"], "6")

    def test_a_link_keeps_the_choice(self):
        self.page.choose("body-colour", "thickness")
        address = self.page.wait(lambda s: "body=thickness" in self.driver.current_url) and self.driver.current_url
        page = Page(self.driver, self.page.file, "#" + address.split("#")[1])
        self.assertEqual(page.state()["body"], "thickness")
        self.assertEqual(page.state()["opacity"], 100)


class Stretched(MadeUpPage):
    """Points of a lattice whose steps are four times as long along z: see made_up_page.cc."""

    KIND = "stretched"

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


class Eroded(MadeUpPage):
    """Eroded solids that are cubes: see made_up_page.cc."""

    KIND = "eroded"

    def test_draws_the_surface_of_a_level(self):
        self.page.click("view-front")
        for layer in ["mesh", "axes", "skeleton"]:
            self.page.click("show-" + layer)
        unit = self.page.state()["camera"]["zoom"] * self.page.element("canvas").size["height"] / 4
        for per_cent, edge in [(2, 3), (5, 2), (10, 1), (7, 2)]:
            self.page.type_number("level-field", per_cent)
            self.page.wait(lambda s: s["erodedShown"] == [12] and s["visible"]["eroded"])
            picture = self.page.canvas_picture()
            background = picture.getpixel((2, 2))
            drawn = [x for x in range(picture.width) for y in range(0, picture.height, 8)
                     if picture.getpixel((x, y)) != background]
            self.assertAlmostEqual(max(drawn) - min(drawn) + 1, edge * unit, delta=3)
            self.assertIn(f"{100 * edge ** 3 / 64:.3g} % of the volume, 12 triangles",
                          self.page.element("level-count").text)

    def values(self, x, y):
        return self.page.script("return affskel.valuesAt(arguments[0], arguments[1])", x, y)

    def test_tells_the_values_of_each_layer(self):
        self.page.click("view-front")
        self.page.drawn()
        state = self.page.state()
        size = self.page.element("canvas").size
        unit = state["camera"]["zoom"] * size["height"] / 4
        # From the front the middle is (2, 2) in x and z; y of what is met first.
        centre = self.page.script("""const all = affskel.state().panes[0];
            for (let y = 0; y < all.height; ++y) {
              const v = affskel.valuesAt(all.width / 2, y);
              if (v && v.what.startsWith('skeleton')) return [all.width / 2, y];
            }""")
        point = self.values(*centre)
        self.assertEqual(point["E"], "8")
        self.assertEqual(point["share of v0"], "12.5 %")
        self.assertEqual(point["slope |∇E|"], "1.5")
        self.assertEqual(point["|H|"], "9")
        self.assertEqual(point["place"], "(2, 2, 2)")
        self.assertEqual(point["direction"], "(0, 0, 1)")
        self.page.click("show-skeleton")
        aside = centre[0] + 0.5 * unit
        body = self.values(aside, centre[1])
        self.assertEqual(body["what"], "surface of the body")
        self.assertEqual(body["E"], "0")
        self.page.type_number("level-field", 2)
        self.page.wait(lambda s: s["visible"]["eroded"])
        eroded = self.values(aside, centre[1])
        self.assertEqual(eroded["what"], "eroded solid")
        self.assertEqual(eroded["share of v0"], "2 %")
        self.assertEqual(eroded["slope |∇E|"], "9")
        self.assertIn(", 0.5", eroded["place"])
        self.page.slide("opacity", 100)
        self.assertEqual(self.values(aside, centre[1])["what"], "surface of the body")
        self.assertIsNone(self.values(centre[0] + 2.2 * unit, centre[1]))

    def test_tells_warnings_and_pieces(self):
        self.assertIn("made up", self.page.element("warnings").text)
        self.assertIn("1 (solid: 1)", self.page.element("facts-list").text)

    def test_the_colours_are_said_not_to_be_linear(self):
        self.assertEqual(self.driver.find_element("css selector", "#legend .note").text,
                         "Not linear: the colour follows the cube root of E")


class Two(MadeUpPage):
    """A cube beside one of half the edge: see made_up_page.cc."""

    KIND = "two"

    def test_both_turn_with_one_camera_at_one_scale(self):
        self.page.click("view-front")
        for layer in ["skeleton", "axes"]:
            self.page.click("show-" + layer)
        self.page.slide("opacity", 100)
        picture = self.page.canvas_picture()
        background = picture.getpixel((2, 2))
        middle = picture.width // 2
        width = lambda part: len({x for x in range(part.width) for y in range(part.height)
                                  if part.getpixel((x, y)) != background})
        left = width(picture.crop((0, 100, middle - 3, picture.height)))
        right = width(picture.crop((middle + 3, 100, picture.width, picture.height)))
        self.assertAlmostEqual(left / right, 2, delta=0.05)
        self.page.element("canvas").send_keys(*[Keys.ARROW_LEFT] * 3)
        self.page.drawn()
        turned = self.page.canvas_picture()
        for part in [(0, 100, middle - 3, picture.height), (middle + 3, 100, picture.width, picture.height)]:
            self.assertGreater(width(turned.crop(part)), 1.2 * width(picture.crop(part)))

    def test_has_a_slider_for_each_kind_of_skeleton_and_names_both(self):
        self.assertEqual(len(self.page.state()["thresholds"]), 2)
        self.assertEqual(self.page.element("threshold-name").text, "Shock threshold A")
        self.assertFalse(self.page.element("threshold-range-2").is_displayed(), "the sheet is one piece")
        self.assertEqual(self.page.element("threshold-count-2").text, "16 triangles in one piece")
        self.page.type_number("threshold-field", 9.5)
        self.page.wait(lambda s: s["shown"][0] == 0 and s["shown"][1] == 16)
        names = [e.text for e in self.driver.find_elements("class name", "pane-name")]
        self.assertEqual(names, ["A: zucker-hummel, eroded", "B: chords, half"])
        self.assertEqual(self.driver.find_element("tag name", "h1").text, "eroded and half")

    def test_values_are_of_the_body_under_the_pointer(self):
        self.page.click("view-front")
        self.page.drawn()
        for pane, centre in zip(self.page.state()["panes"], ["2", "1"]):
            values = self.page.script("""const [p] = arguments;
                for (let y = p.top; y < p.top + p.height; ++y) {
                  const v = affskel.valuesAt(p.left + p.width / 2, y);
                  if (v && v.what === 'surface of the body') return v;
                }""", pane)
            self.assertTrue(values["place"].startswith(f"({centre}, 0, "), values)


class TwoOnAPhone(Two):
    window = dict(width=390, height=844, phone=True)

    def test_both_turn_with_one_camera_at_one_scale(self):
        upper, lower = self.page.state()["panes"]
        self.assertEqual(upper["left"], lower["left"])
        self.assertEqual(upper["height"], lower["height"])
        self.assertGreaterEqual(lower["top"], upper["top"] + upper["height"] - 1e-6)

    def test_has_a_slider_for_each_kind_of_skeleton_and_names_both(self):
        self.page.click("fold")
        super().test_has_a_slider_for_each_kind_of_skeleton_and_names_both()


class Many(MadeUpPage):
    """A hundred thousand balls: see made_up_page.cc."""

    KIND = "many"

    def test_turns(self):
        self.assertEqual(self.page.state()["skeletonShown"], 47 ** 3)
        self.assertGreater(colours(self.page.canvas_picture())[0], 500)
        whole = self.page.script("return affskel.frameTime(5)")
        canvas = self.page.element("canvas")
        ActionChains(self.driver).move_to_element(canvas).click_and_hold().move_by_offset(40, 0).perform()
        state = self.page.state()
        resolution, every = state["resolution"], state["every"]
        turning = self.page.script("return affskel.frameTime(5)")
        print(f"{47 ** 3} points: {1000 / whole:.1f} frames per second, {1000 / turning:.1f} while they turn at "
              f"{100 * resolution:.0f} % of the resolution, one ball of {every}, drawn without a GPU")
        if whole > 200:  # four times what a frame may take, however the machine is loaded
            self.assertLess(resolution, 1)
        ActionChains(self.driver).release().perform()
        self.assertEqual([self.page.state()[name] for name in ("resolution", "every")], [1, 1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
