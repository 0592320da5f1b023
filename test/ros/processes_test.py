#!/usr/bin/env python3
"""What tests start as processes leaves nothing behind at a master that other tests could meet."""

import os
import socket
import subprocess
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
# A node's server that says it is a process which nobody here started.
ANSWERS = """
import xmlrpc.server
server = xmlrpc.server.SimpleXMLRPCServer(('127.0.0.1', %d), logRequests=False)
server.register_function(lambda caller: (1, '', 1), 'getPid')
print('there', flush=True)
server.serve_forever()
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

    def test_a_port_that_a_connection_took_is_nobodys_node(self):
        uri = self.main.node_uri('/one')
        port = int(uri.strip('/').rsplit(':', 1)[1])
        self.nodes['one'].kill()
        with socket.create_server(('127.0.0.1', 0)) as server, socket.socket() as connection:
            connection.bind(('127.0.0.1', port))
            connection.connect(server.getsockname())
            self.main.forget_the_gone()
        self.assertEqual(self.main.publishers('/said'), ['/other'])

    def test_a_port_that_a_node_of_another_master_took_is_nobodys_node(self):
        uri = self.main.node_uri('/one')
        self.nodes['one'].kill()
        port = int(uri.strip('/').rsplit(':', 1)[1])
        answers = subprocess.Popen([sys.executable, '-c', ANSWERS % port], stdout=subprocess.PIPE)
        self.addCleanup(answers.stdout.close)
        self.addCleanup(answers.wait)
        self.addCleanup(answers.kill)
        answers.stdout.readline()
        self.main.forget_the_gone()
        self.assertEqual(self.main.publishers('/said'), ['/other'])

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
