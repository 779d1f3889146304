"""A page of affskel-client view in Chromium, for the tests of one; ends the program where there is no browser."""
import atexit
import contextlib
import os
import sys
import unittest

if not all(os.path.isfile(os.environ.get(program, "")) for program in ["CHROMIUM", "CHROMEDRIVER"]):
    print("no chromium or chromedriver: skipped")
    sys.exit(77)

from selenium.webdriver.common.actions.action_builder import ActionBuilder

from browser import Page, chromium


def number(text):
    """A number as pages write it."""
    mantissa, *power = text.replace("−", "-").replace(",", "").split(" × 10")
    digits = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
    return float(mantissa) * 10 ** int(power[0].translate(digits)) if power else float(mantissa)


def tick_numbers(page):
    """The numbers at the box that are shown: axis, text, sides and height of the letters, pixels."""
    return page.script("""
        return Array.from(document.querySelectorAll('.tick-numbers span'), (span) => {
          const { left, top, right, bottom } = span.getBoundingClientRect();
          return { axis: span.className, text: span.textContent, shown: !span.hidden, left, top, right, bottom,
                   size: parseFloat(getComputedStyle(span).fontSize) };
        }).filter((span) => span.shown)""")


class Browsers:
    """The browser of one test after the other: another one only where the window changes."""

    def __init__(self):
        self.window, self.driver = None, None
        self.running = contextlib.ExitStack()

    def of(self, window):
        if window != self.window:
            self.running.close()
            self.driver = self.running.enter_context(chromium(**window))
            self.window = window
        return self.driver


browsers = Browsers()
atexit.register(browsers.running.close)


class WithPage(unittest.TestCase):
    """Loads its page anew for every test, in one browser: pages keep nothing there, and starting it takes seconds."""
    window = dict(width=1200, height=800)

    @classmethod
    def setUpClass(cls):
        cls.driver = browsers.of(cls.window)

    def setUp(self):
        self.driver.get("about:blank")
        self.leave()
        self.page = Page(self.driver, self.file())

    def leave(self):
        """Lets go of buttons and keys, and has the pointer where the page has nothing to tell."""
        actions = ActionBuilder(self.driver, duration=0)  # else the pointer takes a quarter of a second
        actions.clear_actions()
        actions.pointer_action.move_to_location(0, 0)
        actions.perform()

    def file(self):
        """The page's place."""
        raise NotImplementedError

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])
        asked = self.page.requests()
        self.assertIn("file://" + self.page.file, asked)
        self.assertEqual([url for url in asked if not url.startswith(("file:///", "data:"))], [])

    def touch(self, kind, *points):
        self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})
