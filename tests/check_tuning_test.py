#!/usr/bin/env python3
"""check_tuning.py must find each violation, and nothing in what is right."""
import unittest

from check_tuning import ALLOWED, check_header, check_source

GOOD = "/// Of it.\ninline constexpr double kPush = 4;\ninline constexpr float kSlow = 1, kFast = 2;  ///< Both.\n"


class CheckTuning(unittest.TestCase):
    def test_good_is_good(self):
        self.assertEqual(check_header("tuning.h", GOOD), [])
        text = "constexpr int kMost = 7;\nx = 0.5 * y + 1e-9; // 0.3"
        for module in ALLOWED:
            self.assertEqual(check_source(module, "a.cpp", text), [])
        self.assertEqual(check_source("fracture", "vacd/tree.cpp", "constexpr double kInfinity = 1;"), [])
        self.assertEqual(check_source("fracture", "a.cpp", "x = 0.3f * y;"), [])

    def test_the_header_says_what_numbers_are(self):
        self.assertEqual(len(check_header("tuning.h", "")), 1)
        self.assertIn("kPush", check_header("tuning.h", GOOD + "\ninline constexpr double kPush = 4;\n")[0])
        self.assertIn("kPull", check_header("tuning.h", GOOD + "\ninline constexpr double kPull = kPush;\n")[0])

    def test_numbers_outside_the_header_are_found(self):
        for bad in ("constexpr float kMost = 1;", "inline constexpr double kA = 1, kB = 2;"):
            for module in ALLOWED:
                self.assertTrue(check_source(module, "a.cpp", bad), bad)
        for bad in ("x = 0.3f * y;", "if (x > 1e-3) return;"):
            self.assertTrue(check_source("solver/rigid", "a.cpp", bad), bad)


if __name__ == "__main__":
    unittest.main()
