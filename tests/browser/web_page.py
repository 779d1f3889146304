"""The page of affskel-client web: its service, and a browser in which people use it."""
import base64
import contextlib
import json
import os
import signal
import subprocess
import tempfile
import urllib.parse

from selenium.common.exceptions import StaleElementReferenceException, TimeoutException
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from browser import PATIENCE, chromium


class Service:
    """affskel-client web, at HTTP or on any free port."""

    def __init__(self, client, environment, *arguments, http="127.0.0.1:0"):
        self.process = subprocess.Popen([client, "--json", *arguments, "web", "--no-open", "--http", http], env=environment,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        if not line:
            raise AssertionError("no address: " + self.process.stderr.read())
        answer = json.loads(line)
        self.address, self.mode = answer["address"], answer["mode"]
        self.origin = "{0.scheme}://{0.netloc}".format(urllib.parse.urlsplit(self.address))

    def close(self):
        """Its exit code, after SIGTERM."""
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=PATIENCE)  # closes the pipes
        return self.process.returncode


class Visitor:
    """A browser on the page."""

    def __init__(self, driver, downloads):
        self.driver = driver
        self.downloads = downloads

    def open(self, address):
        # A change of what is behind '#' alone would load nothing.
        self.driver.get("about:blank")
        self.driver.get(address)

    def find(self, selector):
        """The first such element, once there is one."""
        return self.wait(lambda: next(iter(self.all(selector)), None), selector)

    def all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def wait(self, condition, message=""):
        """Until condition() holds; what it gave."""
        def tried(_):
            with contextlib.suppress(StaleElementReferenceException):
                return condition()
        try:
            return WebDriverWait(self.driver, PATIENCE, 0.05).until(tried, message)
        except TimeoutException as ended:
            ended.msg = f"{message}: the page says:\n{self.text()}"
            raise

    @contextlib.contextmanager
    def turning_view(self, shows="skeletonShown > 0"):
        """Opens the view that is turned, and is in it once its state shows that; it stays open."""
        self.click("#interactive")
        self.driver.switch_to.frame(self.shown("dialog iframe"))
        self.wait(lambda: self.script(f"return window.affskel && affskel.state().{shows}"))
        yield
        self.driver.switch_to.default_content()

    def shown(self, selector):
        """The first element of that kind that is seen, once there is one."""
        return self.wait(lambda: next((e for e in self.all(selector) if e.is_displayed()), None), selector)

    def click(self, selector):
        """On the first such element that is seen, of the page as it is then: it may be written anew meanwhile."""
        self.wait(lambda: self.shown(selector).click() is None, selector)

    def heading(self, text):
        self.wait(lambda: any(e.text == text for e in self.all("h1")), text)

    def type(self, selector, text):
        box = self.shown(selector)
        box.send_keys(Keys.CONTROL, "a")
        box.send_keys(str(text))

    def text(self):
        return self.driver.find_element(By.TAG_NAME, "body").text

    def tab_to(self, selector, most=60):
        """Presses Tab until the element has the focus, which must be seen."""
        for _ in range(most):
            self.driver.switch_to.active_element.send_keys(Keys.TAB)
            if self.script("return document.activeElement.matches(arguments[0])", selector):
                visible = self.script("""
                    const shown = document.activeElement.id === 'file' ? document.querySelector('.drop')
                                                                       : document.activeElement;
                    return getComputedStyle(shown).outlineStyle !== 'none';""")
                assert visible, "no outline at " + selector
                return self.driver.switch_to.active_element
        raise AssertionError("Tab does not lead to " + selector)

    def press(self, selector, key=Keys.ENTER):
        self.tab_to(selector).send_keys(key)

    def picture_is_drawn(self, selector="img.picture"):
        image = self.shown(selector)
        self.wait(lambda: self.script("return arguments[0].complete && arguments[0].naturalWidth > 0", image))

    def submit(self, mesh, points, name):
        """From the list of jobs to the page of the new one."""
        self.click("main a[href='#new']")
        self.heading("New job")
        self.wait(lambda: self.all("#file"))[0].send_keys(mesh)
        self.picture_is_drawn("#found img")
        self.type("#points", points)
        self.type("#name", name)
        self.click("#submit")
        self.heading(name)

    def skeleton_is_drawn(self):
        """On the page of a job, once it is done."""
        self.wait(lambda: self.shown(".badge").text == "done")
        self.picture_is_drawn()

    def width(self):
        """Of the widest thing in the page."""
        return self.script("""return Math.max(document.documentElement.scrollWidth, ...Array.from(
            document.querySelectorAll('body *:not(.visually-hidden):not(.visually-hidden *)'),
            (e) => e.closest('.scroll') && !e.matches('.scroll') ? 0 : e.getBoundingClientRect().right))""")

    def cut_off(self):
        """What in the list of jobs is wider than its place."""
        return self.script("""return Array.from(document.querySelectorAll('.job, .job *'))
            .filter((e) => e.clientWidth > 0 && e.scrollWidth > e.clientWidth).map((e) => e.outerHTML)""")

    def small_targets(self):
        """What a finger misses: links of text aside."""
        return self.script("""return Array.from(document.querySelectorAll('button, input, select, summary, .button'))
            .filter((e) => e.checkVisibility() && !e.matches('.visually-hidden, [type=checkbox]'))
            .filter((e) => e.getBoundingClientRect().height < 44).map((e) => e.outerHTML)""")

    def unnamed(self):
        """Controls and pictures without a name for screen readers."""
        return self.script("""return Array.from(document.querySelectorAll('button, input, select, a, img, iframe'))
            .filter((e) => e.checkVisibility())
            .filter((e) => !(e.ariaLabel || e.title || e.textContent.trim() || e.labels?.length ||
                             (e.tagName === 'IMG' && e.hasAttribute('alt'))))
            .map((e) => e.outerHTML)""")

    def downloaded(self, name):
        """The bytes of a file, which are not none, once it is there."""
        path = os.path.join(self.downloads, name)
        try:
            # Chromium reserves the name by an empty file, and renames what it has received.
            self.wait(lambda: os.path.isfile(path) and os.path.getsize(path) > 0)
        except TimeoutException as ended:
            raise AssertionError(f"{name}: there are {os.listdir(self.downloads)}, the page says:\n"
                                 + self.text()) from ended
        with open(path, "rb") as file:
            return file.read()

    def errors(self):
        return [e["message"] for e in self.driver.get_log("browser") if e["level"] in ("SEVERE", "WARNING")]

    def asked(self):
        """Addresses of all that pages of a service asked for; the browser has pages of its own."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        sent = [m["params"] for m in messages if m["method"] == "Network.requestWillBeSent"]
        return [s["request"]["url"] for s in sent
                if s["documentURL"].startswith("http") and not s["request"]["url"].startswith("data:")]

    def screenshot(self, name):
        """For people: into $AFFSKEL_SCREENSHOTS, where that is set."""
        if folder := os.environ.get("AFFSKEL_SCREENSHOTS"):
            self.script("scrollTo(0, 0)")
            height = self.script("return document.documentElement.scrollHeight")
            width = self.script("return innerWidth")
            clip = {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}
            shot = self.driver.execute_cdp_cmd("Page.captureScreenshot",
                                               {"clip": clip, "captureBeyondViewport": True})
            with open(os.path.join(folder, name + ".png"), "wb") as file:
                file.write(base64.b64decode(shot["data"]))


# The page waits before it asks again, and after a key for the next one: no test needs to wait as long.
HURRY = "{ const wait = setTimeout; window.setTimeout = (call, pause) => wait(call, pause / 8); }"


class Browsers:
    """Those that no visitor has are kept for the next: starting one takes seconds."""

    def __init__(self):
        self.idle = {}
        self.running = contextlib.ExitStack()

    def start(self, width, height, phone=False, dark=False):
        driver = self.running.enter_context(chromium(width, height, phone=phone))
        driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": HURRY})
        if dark:
            features = [{"name": "prefers-color-scheme", "value": "dark"}]
            driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        return driver

    @contextlib.contextmanager
    def visitor(self, **window):
        """One whom no service knows, and of whose predecessor nothing is left."""
        idle = self.idle.setdefault(tuple(window.items()), [])
        driver = idle.pop() if idle else self.start(**window)
        with tempfile.TemporaryDirectory(prefix="affskel-downloads-") as downloads:
            driver.execute_cdp_cmd("Network.clearBrowserCookies", {})
            driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": downloads})
            page = Visitor(driver, downloads)
            page.errors()
            page.asked()
            yield page
            driver.get("about:blank")  # nothing asks a service that has gone
        idle.append(driver)
