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
SCENE = "glass"  # breaks within two seconds


class Player(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.made.cleanup)
        cls.page = Path(cls.made.name, "x.html")
        subprocess.run([PROGRAM, "view", SCENE, "--frames", "120", "-o", cls.page], check=True,
                       capture_output=True)
        cls.browser = cls.enterClassContext(chromium.Chromium(960, 540))

    def open(self, fragment=""):
        self.browser.open("/dev/null")
        self.browser.events.clear()
        self.browser.open(self.page, fragment)
        self.browser.wait("!!(document.body && document.body.dataset.openMs)")

    def data(self, name):
        return float(self.browser.evaluate(f"document.body.dataset.{name}"))

    def pieces_at(self, time):
        self.browser.evaluate(f"player.seek({time})")
        return self.data("pieces")

    def tearDown(self):
        wrong = [line for line in self.browser.console() if line[0] not in ("log", "info")]
        self.assertEqual(wrong, [])

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


if __name__ == "__main__":
    for is_there, name, package in ((THREE.exists(), "three.js", "libjs-three"),
                                    (chromium.find(), "Chromium", "chromium")):
        if not is_there:
            print(f"skipped: {name} is missing; install {package}")
            sys.exit(77)
    unittest.main()
