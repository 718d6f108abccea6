#!/usr/bin/env python3
"""The page of `sunder view` plays a run in a browser: time, pieces, keys, picking, small screens."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import chromium

PROGRAM = os.environ["SUNDER_PROGRAM"]
THREE = Path("/usr/share/javascript/three")


class Page(unittest.TestCase):
    """A page in a browser; `arguments` say of which run."""
    arguments = []

    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.made.cleanup)
        cls.page = Path(cls.made.name, "x.html")
        subprocess.run([PROGRAM, "view", *cls.arguments, "-o", cls.page], check=True,
                       capture_output=True)
        cls.browser = cls.enterClassContext(chromium.Chromium(960, 540))

    def open(self, fragment=""):
        self.browser.open("/dev/null")
        self.browser.events.clear()
        self.browser.open(self.page, fragment)
        self.browser.wait("!!(document.body && document.body.dataset.openMs)")

    def data(self, name):
        return float(self.browser.evaluate(f"document.body.dataset.{name}"))

    def tearDown(self):
        wrong = [line for line in self.browser.console() if line[0] not in ("log", "info")]
        self.assertEqual(wrong, [])


class Player(Page):
    arguments = ["glass", "--frames", "120"]  # breaks within two seconds

    def test_plays_from_start_to_end_and_reports_its_frame_time(self):
        self.open()
        self.browser.wait("!!document.body.dataset.frameMs", 120)
        self.browser.wait("player.time === player.duration && !player.isPlaying", 120)
        self.assertGreater(self.data("frameMs"), 0)
        lines = [text for _, text in self.browser.console() if text.startswith("sunder: ")]
        self.assertTrue(lines)
        self.assertRegex(lines[0], r"\d ms a frame.*opened in \d+ ms")
        self.assertRegex(self.browser.evaluate("document.getElementById('cost').textContent"),
                         r"\d ms a frame")

    def pieces_at(self, time):
        self.browser.evaluate(f"player.seek({time})")
        return self.data("pieces")

    def test_shows_the_pieces_of_a_time_in_any_order(self):
        self.open("#t=0")
        first, last = self.data("pieces"), self.pieces_at(2)
        self.assertGreater(last, first + 10)
        middle = self.pieces_at(1)
        self.assertEqual(self.pieces_at(0), first)
        self.assertEqual(self.pieces_at(2), last)
        self.assertEqual(self.pieces_at(1), middle)

    def test_draws_other_pixels_at_another_time(self):
        self.open("#t=0")
        before = self.browser.screenshot()
        self.browser.evaluate("player.seek(1.9)")
        self.browser.evaluate("player.stage.draw(); player.stage.finish()")
        self.assertNotEqual(self.browser.screenshot(), before)

    def test_keys_step_and_play(self):
        self.open("#t=0.5")
        self.browser.press("ArrowRight")
        self.assertAlmostEqual(self.data("time"), 0.5 + 1 / 60, places=3)
        self.browser.press(",")
        self.browser.press("ArrowLeft")
        self.assertAlmostEqual(self.data("time"), 0.5 - 1 / 60, places=3)
        self.browser.press("End")
        self.assertAlmostEqual(self.data("time"), 2, places=3)
        self.browser.press("Home")
        self.browser.press(" ")
        self.browser.wait("player.time > 0.05")
        self.browser.press(" ")
        self.assertFalse(self.browser.evaluate("player.isPlaying"))

    def test_a_click_selects_a_body(self):
        self.open("#t=0")
        spot = self.browser.evaluate("""(() => {
          for (let y = 30; y < 400; y += 10) for (let x = 10; x < 950; x += 10) {
            if (player.stage.pick(2 * x / 960 - 1, 1 - 2 * y / 540)) return [x, y];
          }
          return null;
        })()""")
        self.assertIsNotNone(spot)
        self.browser.click(*spot)
        card = self.browser.evaluate("document.getElementById('card').innerText")
        self.assertRegex(card, r"(?s)\w+.*since\s+0\.00 s")
        self.browser.press("Escape")
        self.assertTrue(self.browser.evaluate("document.getElementById('card').hidden"))

    def test_fits_a_phone(self):
        self.browser.resize(390, 844, mobile=True)
        self.addCleanup(self.browser.resize, 960, 540)
        self.open("#t=1")
        self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), 390)
        self.assertGreaterEqual(self.browser.evaluate(
            "Math.min(...['play', 'back', 'next', 'home'].map("
            "id => document.getElementById(id).getBoundingClientRect().height))"), 40)

    def test_times_frames_without_the_display(self):
        self.open("#t=0")
        self.browser.evaluate("player.timeFrames(0, 4).then(time => { window.timed = time; }); 0")
        self.browser.wait("window.timed > 0")


class MovingPicture(Page):
    """What is left out while the picture moves is hardly missed."""
    arguments = ["brick_wall", "--frames", "90"]

    def draw(self, is_playing):
        """Draws a frame. Returns the number of its triangles."""
        return self.browser.evaluate("""(() => {
          const {stage} = player, {gl, canvas: {width, height}} = stage;
          stage.isDirty = stage.shadowsDirty = true;
          stage.draw(%s);
          window.before = window.pixels;
          window.pixels = new Uint8Array(4 * width * height);
          gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, window.pixels);
          return stage.batches.reduce((sum, batch) => sum + batch.mesh.geometry.drawRange.count, 0) / 3;
        })()""" % str(is_playing).lower())

    def share_of_different_pixels(self):
        """Returns the share of pixels that differ between the last two frames."""
        return self.browser.evaluate("""(() => {
          const {before, pixels} = window;
          let different = 0;
          for (let at = 0; at < pixels.length; at += 4) {
            if ([0, 1, 2].some(c => Math.abs(before[at + c] - pixels[at + c]) > 12)) ++different;
          }
          return 4 * different / pixels.length;
        })()""")

    def test_is_nearly_that_of_all_triangles(self):
        self.open("#t=0")
        # However few triangles there are, those that others hide are found.
        self.browser.evaluate("player.frame = () => {}; player.stage.crowd = 0; 0")
        for quality in (0, 2):
            self.browser.evaluate(f"player.stage.setQuality({quality}); 0")
            for frame in range(12):
                self.browser.evaluate(f"player.stage.setTime({1 + frame / 60}); 0")
                drawn = self.draw(True)
            self.assertTrue(self.browser.evaluate("player.stage.grid.image !== null"))
            self.assertLess(drawn, 0.8 * self.draw(False), quality)
            self.assertLess(self.share_of_different_pixels(), 0.003, quality)


if __name__ == "__main__":
    for is_there, name, package in ((THREE.exists(), "three.js", "libjs-three"),
                                    (chromium.find(), "Chromium", "chromium")):
        if not is_there:
            print(f"skipped: {name} is missing; install {package}")
            sys.exit(77)
    unittest.main()
