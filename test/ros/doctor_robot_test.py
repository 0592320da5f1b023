#!/usr/bin/env python3
"""`hires doctor --robot` beside real nodes, healthy ones and such as lack something: run alone, or by
`rostest hires doctor_robot.test`."""

import json
import os
import socket
import sys
import threading
import unittest
import xmlrpc.client
import xmlrpc.server


SUPPORT = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support')
sys.path.insert(0, SUPPORT)

from ros_processes import LIMIT, Processes, executable, free_port  # noqa: E402
from test_run import run_test  # noqa: E402

ROBOT = os.path.join(SUPPORT, 'doctor_robot.py')


class Report:
    def __init__(self, code, output, json_text):
        self.code = code
        self.output = output
        self.json = json.loads(json_text) if json_text else None

    def found(self):
        """{(code, subject): finding}"""
        return {(finding['code'], finding['subject']): finding for finding in self.json['findings']}


class DoctorRobotTest(unittest.TestCase):
    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        self.main = self.processes.master()

    def start(self, role, **spec):
        node = self.processes.start(['/usr/bin/python3', ROBOT, role, json.dumps(spec)], self.main)
        node.wait_for('^ready')
        return node

    def ask(self, *more, **environment):
        path = self.processes.write('report.json', '')
        doctor = self.processes.start([executable('hires'), 'doctor', '--robot', '--seconds', '1.5',
                                       '--json', path, *more], self.main, **environment)
        code = doctor.wait(2 * LIMIT)
        with open(path) as file:
            return Report(code, doctor.output(), file.read())

    def register(self, node, topic, uri):
        """At the master, as a node of that address would."""
        with xmlrpc.client.ServerProxy(self.main.uri) as master:
            self.assertEqual(master.registerPublisher(node, topic, 'std_msgs/String', uri)[0], 1)

    def start_node_with_data_at(self, port):
        """A node that answers, and says that its data comes from `port`; its address."""
        server = xmlrpc.server.SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False)
        server.register_function(lambda *_: [1, '', ['TCPROS', '127.0.0.1', port]], 'requestTopic')
        server.register_function(lambda *_: [1, '', 0], 'publisherUpdate')
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        self.addCleanup(lambda: (server.shutdown(), thread.join(), server.server_close()))
        return 'http://127.0.0.1:%d/' % server.server_address[1]

    def require_found(self, report, wanted):
        self.assertEqual(sorted(report.found()), sorted(wanted), report.output)
        for finding in report.json['findings']:
            self.assertGreater(len(finding['remedy']), 15, finding)
            self.assertIn(finding['text'], report.output)

    def test_a_healthy_robot_has_no_findings(self):
        self.start('robot')
        self.start('move_base_node')
        report = self.ask()
        self.require_found(report, [])
        self.assertEqual(report.code, 0, report.output)
        self.assertTrue(report.json['ok'])
        self.assertIn('all is well', report.output)
        scan = report.json['topics']['/base_scan']['/robot']
        self.assertEqual(scan['type'], 'sensor_msgs/LaserScan')
        self.assertEqual(scan['md5'], '90c7ef2dc6895d81024acba2ac42f369')
        self.assertGreater(scan['rate'], 10.0)
        self.assertLess(abs(scan['age']), 0.3)

    def test_whatever_is_missing_is_named(self):
        self.start('robot', without=[
            'base_scan', 'amcl_pose', 'map', 'l_arm_controller/command', 'navigation/cmd_vel',
            'odom_combined', 'r_wrist_roll_joint', 'l_gripper_joint', 'base_laser_link',
            'base_tray_link', 'robot_description'], halted=True)
        report = self.ask()
        self.require_found(report, [
            ('topic_missing', 'topic /base_scan'), ('topic_missing', 'topic /amcl_pose'),
            ('topic_missing', 'topic /map'),
            ('listener_missing', 'command /l_arm_controller/command'),
            ('listener_missing', 'command /navigation/cmd_vel'),
            ('frame_missing', 'frame odom_combined'), ('link_missing', 'link base_laser_link'),
            ('link_missing', 'link base_tray_link'),
            ('joint_missing', 'joint r_wrist_roll_joint'),
            ('joint_missing', 'joint l_gripper_joint or l_gripper_l_finger_joint'),
            ('motors_halted', 'motors'),
            ('robot_description_missing', 'parameter /robot_description'),
            ('move_base_missing', 'action /move_base')])
        self.assertEqual(report.code, 1, report.output)
        self.assertFalse(report.json['ok'])
        self.assertEqual(report.found()['link_missing', 'link base_tray_link']['level'], 'note')
        self.assertIn('something needs attention', report.output)

    def test_wrong_types_are_told_from_missing_things(self):
        self.start('robot', types={'base_odometry/odom': 'std_msgs/String',
                                   'amcl_pose': 'geometry_msgs/PoseStamped',
                                   'r_gripper_controller/command': 'std_msgs/Float64'},
                   silent=['amcl_pose'], served_map=True, without=['map'])
        self.start('move_base_node', goal_type='std_msgs/String')
        report = self.ask()
        self.require_found(report, [
            ('topic_type', 'topic /base_odometry/odom'), ('topic_type', 'topic /amcl_pose'),
            ('listener_type', 'command /r_gripper_controller/command'),
            ('move_base_missing', 'action /move_base')])
        self.assertIn('sends std_msgs/String (992ce8a1687cec8c8bd883ec73ca41d1), wanted is '
                      'nav_msgs/Odometry (cd5e73d190d741a2f92e81eda573aca7)', report.output)

    def test_messages_that_come_late_seldom_or_never_are_named(self):
        self.start('robot', offset={'base_odometry/odom': -0.5, 'joint_states': 0.5,
                                    'base_footprint': -1.0},
                   rate={'base_scan': 4.0}, silent=['amcl_pose'],
                   more_parents={'base_laser_link': 'odom_combined'})
        report = self.ask('--navigation', 'own')
        self.require_found(report, [
            ('topic_stale', 'topic /base_odometry/odom'), ('topic_future', 'topic /joint_states'),
            ('topic_slow', 'topic /base_scan'), ('topic_silent', 'topic /amcl_pose'),
            ('frame_stale', 'frame base_footprint'),
            ('frame_two_parents', 'frame base_laser_link')])

    def test_another_frame_than_the_one_that_was_named_is_told(self):
        self.start('robot', odometry_frame='odom')
        report = self.ask('--navigation', 'own')
        self.require_found(report, [('frame_missing', 'frame odom_combined')])
        self.assertEqual(report.found()['frame_missing', 'frame odom_combined']['level'], 'warning')
        self.assertIn('base_footprint < odom < map says alone', report.output)

    def test_frames_may_lead_to_each_other_over_others(self):
        self.start('robot', between=['hall', 'world'])
        self.require_found(self.ask('--navigation', 'own'), [])

    def test_a_planner_that_cannot_be_set_and_drives_past_the_guard_is_named(self):
        self.start('robot')
        self.start('move_base_node', drives='navigation/cmd_vel',
                   parameters=['max_vel_x', 'max_vel_trans', 'acc_lim_x', 'acc_lim_y',
                               'acc_lim_theta'])
        report = self.ask('--navigation', 'move_base')
        self.require_found(report, [
            ('planner_parameter_missing', 'server /move_base_node/DWAPlannerROS'),
            ('move_base_unguarded', 'node /move_base_node')])
        self.assertIn('max_angular_velocity (max_vel_theta, max_rot_vel)', report.output)
        self.assertEqual(report.code, 1)

    def test_a_planner_without_server_is_named(self):
        self.start('robot')
        self.start('move_base_node', without=['planner'])
        report = self.ask()
        self.require_found(report, [('planner_missing', 'server /move_base_node/DWAPlannerROS')])
        self.assertEqual(report.code, 0, 'undecided who drives, so no failure')

    def test_a_planner_that_says_nothing_is_named(self):
        self.start('robot')
        self.start('move_base_node', without=['updates'])
        self.require_found(self.ask(),
                           [('planner_silent', 'server /move_base_node/DWAPlannerROS')])

    def test_unreachable_nodes_are_named_with_what_keeps_them(self):
        self.start('robot')
        with socket.socket() as deaf, socket.socket() as first, socket.socket() as second:
            # A queue that is full drops what comes, as a firewall does.
            deaf.bind(('127.0.0.1', 0))
            deaf.listen(0)
            for caller in (first, second):
                caller.setblocking(False)
                caller.connect_ex(deaf.getsockname())
            self.register('/deaf', '/x', 'http://127.0.0.1:%d/' % deaf.getsockname()[1])
            self.register('/gone', '/x', 'http://localhost:%d/' % free_port())
            self.register('/nameless', '/x', 'http://no-such-host.invalid:4711/')
            report = self.ask('--navigation', 'own')
        found = report.found()
        self.assertIn(('node_unreachable', 'host 127.0.0.1'), found, report.output)
        self.assertIn(('node_gone', 'host localhost'), found, report.output)
        self.assertIn(('unresolvable', 'host no-such-host.invalid'), found, report.output)
        self.assertIn('/deaf (port ', report.output)
        self.assertIn("'ADDRESS no-such-host.invalid' to /etc/hosts", report.output)
        # A node elsewhere makes loopback addresses wrong.
        self.assertIn(('loopback', 'address 127.0.0.1'), found, report.output)

    def test_a_node_whose_data_cannot_be_fetched_is_named(self):
        self.start('robot')
        with xmlrpc.client.ServerProxy(self.main.uri) as master:
            master.registerPublisher('/walled', '/base_scan', 'sensor_msgs/LaserScan',
                                     self.start_node_with_data_at(free_port()))
        report = self.ask('--navigation', 'own')
        self.require_found(report, [('data_unreachable', 'topic /base_scan')])
        self.assertIn('/walled sends its data from 127.0.0.1 port', report.output)

    def test_simulated_time_is_named(self):
        self.main.set_param('/use_sim_time', True)
        self.assertIn(('sim_time', 'parameter /use_sim_time'),
                      self.ask('--navigation', 'own').found())

    def test_without_a_master_it_says_so(self):
        report = self.ask(ROS_MASTER_URI='http://127.0.0.1:%d/' % free_port())
        self.assertEqual(report.code, 1)
        self.assertIn('no ROS master answers at', report.output)
        self.assertIn('set ROS_MASTER_URI', report.output)

    def test_a_names_file_that_is_none_is_an_error(self):
        path = self.processes.write('names.yaml', 'frames: {map: map}\n')
        report = self.ask('--names', path)
        self.assertEqual(report.code, 1)
        self.assertIn(path, report.output)

    def test_its_options_need_the_robot(self):
        doctor = self.processes.start([executable('hires'), 'doctor', '--names', 'x.yaml'], self.main)
        self.assertEqual(doctor.wait(LIMIT), 1)
        self.assertIn('--robot', doctor.output())


if __name__ == '__main__':
    run_test('doctor_robot', DoctorRobotTest)
