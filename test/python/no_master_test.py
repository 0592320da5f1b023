#!/usr/bin/env python3
"""hires.init_node where no master answers: no_master_test.py"""

import os
import socket
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


if __name__ == '__main__':
    unittest.main()
