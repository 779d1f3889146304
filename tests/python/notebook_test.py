"""A view in the frame that a notebook shows, in Chromium.

Usage: notebook_test.py PROGRAMS PROJECT"""
import io
import os
import sys
import unittest

if not all(os.path.isfile(os.environ.get(program, "")) for program in ["CHROMIUM", "CHROMEDRIVER"]):
    print("no chromium or chromedriver: skipped")
    sys.exit(77)

import affskel

from lab import PROJECT, Directory, Server

sys.path.append(str(PROJECT / "tests/browser"))
from browser import PATIENCE, chromium, colours
from PIL import Image
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait


class Notebook(unittest.TestCase):
    def test_the_frame_shows_the_body_and_cannot_reach_the_notebook(self):
        directory = Directory()
        self.addCleanup(directory.remove)
        directory.use_environment(self.addCleanup)
        server = Server(directory)
        self.addCleanup(server.end)
        with affskel.Client(server.address) as client:
            job = client.submit(directory.make("body", "--triangles", 500), spacing=300, name='a "body" & <b>').wait()
            count = len(job.skeleton())
            cell = job.view(height=500)._repr_html_()
        page = directory / "notebook.html"
        page.write_text(f"<!DOCTYPE html><meta charset=utf-8><h1>Notebook</h1>{cell}", encoding="utf-8")
        driver = self.enterContext(chromium(1200, 800))
        driver.get(f"file://{page}")
        frame = driver.find_element(By.TAG_NAME, "iframe")
        self.assertEqual(frame.size["height"], 500)
        driver.switch_to.frame(frame)
        state = WebDriverWait(driver, PATIENCE, .02).until(
            lambda _: driver.execute_script("return window.affskel && affskel.state()"))
        self.assertEqual(driver.find_element(By.TAG_NAME, "h1").text, 'a "body" & <b>')
        self.assertIn(f"{count} triangles", driver.find_element(By.ID, "threshold-count").text.replace(",", ""), state)
        driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
        picture = Image.open(io.BytesIO(driver.find_element(By.ID, "canvas").screenshot_as_png)).convert("RGB")
        number, most = colours(picture)
        self.assertGreater(number, 100)
        self.assertLess(most, .99)
        self.assertEqual(driver.execute_script("try { return parent.document.title } catch (e) { return e.name }"),
                         "SecurityError")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
