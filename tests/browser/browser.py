"""A real headless Chromium with a page in it, and what tests ask of both."""
import contextlib
import io
import json
import os
import tempfile

from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

PATIENCE = 60  # seconds, for a loaded machine; nothing waits for it when all is well

FLAGS = [
    "--headless", "--no-sandbox", "--hide-scrollbars", "--disable-quic", "--no-first-run", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage",
]
# The scene alone by software GL: all else of a page costs less without.
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"]
NO_GL = ["--disable-gpu", "--disable-3d-apis"]


@contextlib.contextmanager
def chromium(width, height, phone=False, gl=True):
    """A browser with an empty profile, closed at the end."""
    with tempfile.TemporaryDirectory(prefix="affskel-browser-", ignore_cleanup_errors=True) as profile:
        options = Options()
        options.binary_location = os.environ["CHROMIUM"]
        for flag in FLAGS + (SOFTWARE_GL if gl else NO_GL):
            options.add_argument(flag)
        options.add_argument(f"--user-data-dir={profile}")
        options.add_argument(f"--window-size={width},{height}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        if phone:
            metrics = {"width": width, "height": height, "pixelRatio": 2, "touch": True}
            options.add_experimental_option("mobileEmulation", {"deviceMetrics": metrics})
        driver = webdriver.Chrome(service=Service(os.environ["CHROMEDRIVER"]), options=options)
        try:
            driver.set_script_timeout(PATIENCE)
            driver.set_page_load_timeout(PATIENCE)
            yield driver
        finally:
            driver.quit()


class Page:
    """A page of affskel-client view."""

    def __init__(self, driver, file, fragment=""):
        self.driver = driver
        self.file = file
        if fragment:
            self.driver.get("about:blank")  # else only the fragment would change
        self.driver.get("file://" + file + fragment)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def state(self):
        return self.script("return affskel.state()")

    def element(self, name):
        return self.driver.find_element(By.ID, name)

    def click(self, name):
        self.element(name).click()

    def wait(self, condition):
        """Until condition(state) holds; the state as it was then."""
        waiting = WebDriverWait(self.driver, PATIENCE, 0.02)
        return waiting.until(lambda _: condition(self.state()) and self.state())

    def type_number(self, field, value):
        box = self.element(field)
        box.send_keys(Keys.CONTROL, "a")
        box.send_keys(str(value), Keys.ENTER)

    def choose(self, name, value):
        """An option of a select element."""
        Select(self.element(name)).select_by_value(value)

    def slide(self, name, value):
        self.script("const range = document.getElementById(arguments[0]); range.value = arguments[1];"
                    "range.dispatchEvent(new Event('input', { bubbles: true }))", name, value)

    def drawn(self):
        """Waits until what was asked for so far is on the screen."""
        self.driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def canvas_picture(self):
        """The screenshot where nothing lies over the canvas."""
        self.drawn()
        self.script("document.querySelectorAll('nav, .foot, #panes').forEach((e) => (e.style.opacity = 0))")
        picture = Image.open(io.BytesIO(self.element("canvas").screenshot_as_png)).convert("RGB")
        self.script("document.querySelectorAll('nav, .foot, #panes').forEach((e) => (e.style.opacity = ''))")
        return picture

    def errors(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def requests(self):
        """Addresses of everything that the page asked for, itself included."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        asked = [m["params"] for m in messages if m["method"] == "Network.requestWillBeSent"]
        return [a["request"]["url"] for a in asked if a["documentURL"].split("#")[0] == "file://" + self.file]


def colours(picture):
    """The number of different colours, and the share of the most frequent one."""
    counts = picture.getcolors(picture.width * picture.height)
    return len(counts), max(count for count, _ in counts) / (picture.width * picture.height)
