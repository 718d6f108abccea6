#!/usr/bin/env python3
"""Tests of the list of faults and of the table: what plant.py refuses, and what it keeps."""
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import plant

SOURCE = b"int a = 1;\nint b = 1;\nreturn a - b;\n"


def fault(**changes):
    entry = {"id": "sign", "kind": "wrong sign", "file": "a.cpp", "old": "a - b", "new": "a + b",
             "wrong": "The sum is a difference.", "guard": "Sum"}
    return plant.Fault("solver", entry | changes)


def problems(*faults):
    """Returns the problems of a list, but for its length."""
    found = plant.problems(faults, {"a.cpp": SOURCE}.get)
    return [message for message in found if "fewer than" not in message]


class List(unittest.TestCase):
    def test_a_fault_replaces_its_text(self):
        self.assertEqual(fault().applied(SOURCE), SOURCE.replace(b"a - b", b"a + b"))
        self.assertEqual(problems(fault()), [])

    def test_a_text_that_is_gone_or_occurs_twice_is_refused_by_name(self):
        for old, times in ("a * b", 0), ("= 1;", 2):
            message, = problems(fault(old=old))
            self.assertIn("sign: a.cpp", message)
            self.assertIn(f"occurs {times} times", message)

    def test_a_file_that_is_gone_is_refused_by_name(self):
        self.assertIn("gone.cpp: no such file", problems(fault(file="gone.cpp"))[0])

    def test_a_change_of_nothing_or_of_several_lines_is_refused(self):
        self.assertEqual(len(problems(fault(new="a - b"))), 1)
        self.assertEqual(len(problems(fault(new="a +\nb"))), 1)

    def test_two_faults_of_one_name_are_refused(self):
        self.assertIn("two faults", problems(fault(), fault(new="b - a"))[0])

    def test_a_golden_that_does_not_exist_is_refused(self):
        self.assertIn("no golden nowhere", problems(fault(guard="golden tower nowhere"))[0])

    def test_a_short_list_is_refused(self):
        self.assertTrue(any("fewer than" in message
                            for message in plant.problems([fault()], {"a.cpp": SOURCE}.get)))


class Table(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        patch = mock.patch.object(plant, "TABLE", Path(self.folder.name) / "table.md")
        patch.start()
        self.addCleanup(patch.stop)

    def test_results_are_read_as_they_were_written(self):
        faults = [fault(), fault(id="other")]
        plant.Table(faults).record(faults[0], "Sum.IsASum", 12.4)
        plant.Table(faults).record(faults[1], "", 700)
        table = plant.Table(faults)
        self.assertEqual(table.of(faults[0]), ["Sum.IsASum", "12"])
        self.assertEqual(table.of(faults[1]), [plant.ESCAPED, "700"])
        self.assertIn("2 of 2 faults are tried: 1 are caught, 1 escaped", plant.TABLE.read_text())

    def test_a_fault_that_is_changed_is_not_tried(self):
        plant.Table([fault()]).record(fault(), "Sum.IsASum", 1)
        changed = fault(new="b - a")
        self.assertEqual(plant.Table([changed]).of(changed)[0], plant.UNTRIED)


class Progress(unittest.TestCase):
    def test_an_interrupted_run_goes_on_with_the_faults_that_are_left(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "tried.json"
            plant.Progress(file).add(fault())
            progress = plant.Progress(file)
            self.assertTrue(progress.has(fault()))
            self.assertFalse(progress.has(fault(new="b - a")))


if __name__ == "__main__":
    unittest.main()
