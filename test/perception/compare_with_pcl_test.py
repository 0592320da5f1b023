#!/usr/bin/python3
"""What benchmark/perception/compare_with_pcl makes of scores; needs neither PCL nor a build."""

import importlib.machinery
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.realpath(os.path.join(os.path.dirname(__file__), "../../benchmark/perception/compare_with_pcl"))


def load():
    loader = importlib.machinery.SourceFileLoader("compare_with_pcl", SCRIPT)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


COMPARE = load()


def scene(number, kind, ours, peer, points=100.0, peer_name="PCL LCCP"):
    """Both are shares of overlap; the best segments have as much of their things, and nothing beyond."""
    def method(name, share, seconds):
        return {"method": name, "points": points, "overlap": share * points, "inside": share * points,
                "outside": 0.0, "seconds": seconds, "is_table_found": name == "ours" or None}
    return {"scene": f"s{number}", "number": number, "kind": kind,
            "methods": [method("ours", ours, 0.1), method(peer_name, peer, 0.1 * (number + 1))]}


class CompareTest(unittest.TestCase):
    def test_scores_are_pooled_over_points(self):
        scenes = [scene(0, "boxes", 1.0, 0.5, points=300.0), scene(1, "boxes", 0.6, 0.5, points=100.0)]
        told, = COMPARE.compare(scenes, 200, 1)
        ours, peer = told["methods"]
        self.assertAlmostEqual(ours["overlap"]["estimate"], 0.9)
        self.assertAlmostEqual(ours["over"]["estimate"], 0.1)
        self.assertAlmostEqual(ours["under"]["estimate"], 0.0)
        self.assertAlmostEqual(peer["overlap"]["estimate"], 0.5)

    def test_scenes_that_are_alike_leave_nothing_open(self):
        told, = COMPARE.compare([scene(i, "boxes", 0.9, 0.8) for i in range(5)], 200, 1)
        difference = told["differences"][0]["overlap"]
        for key in ("estimate", "lower", "upper"):
            self.assertAlmostEqual(told["methods"][0]["overlap"][key], 0.9)
            self.assertAlmostEqual(difference[key], 0.1)

    def test_intervals_are_those_of_two_scenes_drawn_twice(self):
        # Means of two draws of {0, 1} are 0, 0.5, 1 with 1/4, 1/2, 1/4.
        told, = COMPARE.compare([scene(0, "boxes", 0.0, 0.5), scene(1, "boxes", 1.0, 0.5)], 2000, 1)
        overlap = told["methods"][0]["overlap"]
        self.assertEqual((overlap["lower"], overlap["estimate"], overlap["upper"]), (0.0, 0.5, 1.0))

    def test_intervals_are_about_as_wide_as_the_normal_ones_of_many_scenes(self):
        shares = [0.5 + 0.4 * ((7 * i) % 100 - 49.5) / 50.0 for i in range(100)]
        told, = COMPARE.compare([scene(i, "boxes", share, 0.5) for i, share in enumerate(shares)], 4000, 1)
        mean = sum(shares) / 100
        error = (sum((share - mean) ** 2 for share in shares) / 100) ** 0.5 / 10
        overlap = told["methods"][0]["overlap"]
        self.assertAlmostEqual(overlap["lower"], mean - 1.96 * error, delta=0.15 * error)
        self.assertAlmostEqual(overlap["upper"], mean + 1.96 * error, delta=0.15 * error)

    def test_differences_are_paired(self):
        # Scenes differ by far more than the two methods do on any of them.
        scenes = [scene(i, "boxes", 0.1 * i + 0.05, 0.1 * i) for i in range(9)]
        difference = COMPARE.compare(scenes, 500, 1)[0]["differences"][0]
        self.assertAlmostEqual(difference["overlap"]["lower"], 0.05)
        self.assertAlmostEqual(difference["overlap"]["upper"], 0.05)
        self.assertEqual((difference["better"], difference["worse"]), (9, 0))

    def test_the_same_seed_gives_the_same_intervals(self):
        scenes = [scene(i, "boxes", 0.1 * i, 0.5) for i in range(9)]
        self.assertEqual(COMPARE.compare(scenes, 300, 5), COMPARE.compare(scenes, 300, 5))
        self.assertNotEqual(COMPARE.compare(scenes, 300, 5), COMPARE.compare(scenes, 300, 6))

    def test_kinds_stay_apart_and_come_together_in_all(self):
        scenes = [scene(i, "boxes", 1.0, 0.5) for i in range(3)]
        scenes += [scene(i, "round", 0.4, 0.5) for i in range(3, 6)]
        boxes, others, both = COMPARE.compare(scenes, 300, 1)
        self.assertEqual([told["kind"] for told in (boxes, others, both)], ["boxes", "round", "all"])
        self.assertAlmostEqual(both["methods"][0]["overlap"]["estimate"], 0.7)
        # As many scenes of each kind are drawn as there are.
        self.assertAlmostEqual(both["methods"][0]["overlap"]["lower"], 0.7)

    def test_goals_let_stacked_things_tie_with_lccp_alone(self):
        scenes = [scene(i, "stacked boxes", 0.9, 0.9) for i in range(3)]
        goal, = COMPARE.goals_of(COMPARE.compare(scenes, 200, 1))
        self.assertEqual((goal["is_met"], goal["is_shown"]), (True, False))
        for kind, peer in (("stacked boxes", "PCL Euclidean"), ("boxes", "PCL LCCP")):
            scenes = [scene(i, kind, 0.9, 0.9, peer_name=peer) for i in range(3)]
            self.assertFalse(COMPARE.goals_of(COMPARE.compare(scenes, 200, 1))[0]["is_met"], kind)

    def test_times_are_compared_cloud_by_cloud(self):
        ours, peer = COMPARE.times_of([scene(i, "boxes", 1.0, 1.0) for i in range(3)])
        self.assertEqual((ours["tables_found"], peer["tables_found"]), (3, None))
        self.assertAlmostEqual(peer["times_ours"], 2.0)
        self.assertAlmostEqual(peer["highest_times_ours"], 3.0)

    def test_kinds_are_read_or_refused(self):
        kinds = COMPARE.kinds_in("boxes:0-1, stacked boxes:2-3")
        self.assertEqual(kinds, [("boxes", 0, 1), ("stacked boxes", 2, 3)])
        scenes = COMPARE.with_kinds([scene(i, "scenes", 1.0, 1.0) for i in (3, 0, 7)], kinds)
        self.assertEqual([(one["number"], one["kind"]) for one in scenes], [(0, "boxes"), (3, "stacked boxes")])
        for text in ("boxes", "boxes:3-1", ":1-2", ""):
            with self.assertRaisesRegex(SystemExit, "NAME:FIRST-LAST"):
                COMPARE.kinds_in(text)

    def test_scenes_without_a_score_are_refused(self):
        two = [scene(i, "boxes", 1.0, 1.0) for i in range(2)]
        COMPARE.refuse_what_has_no_score(two)
        for scenes, why in ((two[:1], "1 scene"), ([], "no scene"),
                            (two + [scene(7, "boxes", 1.0, 1.0, points=0.0)], "s7: no point")):
            with self.assertRaisesRegex(SystemExit, why):
                COMPARE.refuse_what_has_no_score(scenes)

    def test_a_build_without_pcl_is_left_out_with_what_to_do(self):
        with tempfile.TemporaryDirectory() as folder:
            for more, code in (((), 0), (("--scenes", folder), 1)):
                done = subprocess.run([sys.executable, "-B", SCRIPT, folder, *more], stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT, text=True, check=False)
                self.assertEqual(done.returncode, code)
                self.assertIn("scripts/setup", done.stdout)


if __name__ == "__main__":
    unittest.main()
