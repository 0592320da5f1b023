#!/usr/bin/env python3
"""What tests start as processes leaves nothing behind at a master that other tests could meet."""

import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import Processes, wait_until  # noqa: E402

NODE = """
import rospy, std_msgs.msg, std_srvs.srv
rospy.init_node('%s')
rospy.Publisher('said', std_msgs.msg.Empty, queue_size=1)
rospy.Subscriber('heard', std_msgs.msg.Empty, lambda _: None)
rospy.Service('%s/asked', std_srvs.srv.Empty, lambda _: [])
rospy.spin()
"""


class ProcessesTest(unittest.TestCase):
    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        self.main = self.processes.master()
        self.nodes = {name: self.processes.start([sys.executable, '-c', NODE % (name, name)],
                                                 self.main) for name in ('one', 'other')}
        wait_until(lambda: {'/one/asked', '/other/asked'} <= self.main.services().keys(), 'nodes')

    def test_a_master_forgets_what_is_destroyed_and_nothing_else(self):
        self.nodes['one'].destroy()
        self.assertEqual(self.main.publishers('/said'), ['/other'])
        self.assertEqual(self.main.subscribers('/heard'), ['/other'])
        self.assertNotIn('/one/asked', self.main.services())
        self.assertIn('/other/asked', self.main.services())

    def test_what_is_killed_stays_registered_as_after_a_crash(self):
        self.nodes['one'].kill()
        self.assertEqual(sorted(self.main.subscribers('/heard')), ['/one', '/other'])
        self.assertIn('/one/asked', self.main.services())

    def test_a_master_that_is_gone_holds_nothing_up(self):
        self.main.kill()
        self.nodes['one'].destroy()
        self.assertFalse(self.nodes['one'].is_running())


if __name__ == '__main__':
    unittest.main()
