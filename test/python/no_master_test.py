#!/usr/bin/env python3
"""hires.init_node where no master answers: no_master_test.py"""

import os
import socket
import subprocess
import sys
import unittest

import hires


class NoMasterTest(unittest.TestCase):
    def test_who_joins_no_master_is_told_so_at_once(self):
        with socket.socket() as taken:  # bound, so that nobody else can listen there, but not listening
            taken.bind(('127.0.0.1', 0))
            os.environ['ROS_MASTER_URI'] = uri = 'http://127.0.0.1:%d' % taken.getsockname()[1]
            with self.assertRaisesRegex(hires.ImaginationError,
                                        'no master answers at %s .*; start one' % uri):
                hires.init_node('nobody')

    def test_who_is_no_node_yet_is_told_how_to_become_one(self):
        with self.assertRaisesRegex(hires.ImaginationError, 'no node yet; call hires.init_node'):
            hires.Imagination()

    def test_the_example_that_drives_says_how_it_is_called(self):
        example = os.path.join(os.path.dirname(__file__), '..', '..', 'examples', 'ask_before_driving.py')

        def called(*arguments):
            return subprocess.run([sys.executable, '-B', example, *arguments], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True, check=False)
        told = called('kitchen', '7.0', '12.2')
        self.assertEqual(told.returncode, 2, told.stderr)
        self.assertRegex(told.stderr, '(?s)^usage: .* area x y yaw.*required: yaw, --from')
        told = called('--help')
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn('as fast as imagination recommends', told.stdout)


if __name__ == '__main__':
    unittest.main()
