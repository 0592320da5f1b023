#!/usr/bin/env python3
"""What launch/pr2.launch publishes and subscribes, by name and type, is what a PR2 listens to and
says. The tables are the PR2's own: its bring-up, its controllers' configuration, its navigation.
Run by `rostest hires pr2_names.test`."""

import os
import sys
import unittest
import xmlrpc.client

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from lab import NODES, Lab, wait_for  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

TRAJECTORY = 'trajectory_msgs/JointTrajectory'
GRIPPER = 'pr2_controllers_msgs/Pr2GripperCommand'

# What a PR2 is told.
COMMANDS = {
    '/navigation/cmd_vel': 'geometry_msgs/Twist',
    '/l_arm_controller/command': TRAJECTORY,
    '/r_arm_controller/command': TRAJECTORY,
    '/torso_controller/command': TRAJECTORY,
    '/head_traj_controller/command': TRAJECTORY,
    '/l_gripper_controller/command': GRIPPER,
    '/r_gripper_controller/command': GRIPPER,
}
# What a PR2 and its localisation say.
SENSORS = {
    '/tf': 'tf2_msgs/TFMessage',
    '/tf_static': 'tf2_msgs/TFMessage',
    '/joint_states': 'sensor_msgs/JointState',
    '/base_odometry/odom': 'nav_msgs/Odometry',
    '/base_scan': 'sensor_msgs/LaserScan',
    '/amcl_pose': 'geometry_msgs/PoseWithCovarianceStamped',
    '/pr2_ethercat/motors_halted': 'std_msgs/Bool',
    '/map': 'nav_msgs/OccupancyGrid',
}
# With navigation:=move_base alone.
MOVE_BASE = {
    '/move_base/goal': 'move_base_msgs/MoveBaseActionGoal',
    '/move_base/cancel': 'actionlib_msgs/GoalID',
}
MOVE_BASE_SAYS = {
    '/move_base/status': 'actionlib_msgs/GoalStatusArray',
    '/move_base/feedback': 'move_base_msgs/MoveBaseActionFeedback',
    '/move_base/result': 'move_base_msgs/MoveBaseActionResult',
    '/move_base_node/DWAPlannerROS/parameter_updates': 'dynamic_reconfigure/Config',
    '/move_base_node/DWAPlannerROS/parameter_descriptions':
        'dynamic_reconfigure/ConfigDescription',
}
# The laboratory's own recogniser.
RECOGNISER = {'/detections': 'hires/Detections'}
MD5 = {'geometry_msgs/Twist': '9f195f881246fdfa2798d1d3eebca84a',
       TRAJECTORY: '65b4f94a94d1ed67169da35a02f33d3f',
       GRIPPER: '680acaff79486f017132a7f198d40f08',
       'move_base_msgs/MoveBaseActionGoal': '660d6895a1b9a16dce51fbdd9a64a56b',
       'actionlib_msgs/GoalID': '302881f31927c1df708a2dbab0e80ee8'}
PR2_NODES = ('/fake_pr2', '/move_base_node', '/robot_state_publisher')


class Pr2NamesTest(unittest.TestCase):
    navigation = 'own'

    @classmethod
    def setUpClass(cls):
        cls.lab = Lab(navigation=cls.navigation)
        cls.addClassCleanup(cls.lab.stop)
        cls.lab.start()
        cls.nodes = ['/' + node for node in NODES]
        for node in cls.nodes:
            wait_for(lambda: cls.lab.main.node_uri(node), node)
        cls.lab.connect('pr2_names')
        cls.state = wait_for(cls.complete_state, 'all topics')

    @classmethod
    def complete_state(cls):
        """Who publishes and who subscribes what, once all nodes have begun."""
        publishers, subscribers, _ = cls.lab.main._call('getSystemState')
        publishers, subscribers = dict(publishers), dict(subscribers)
        begun = {node for nodes in publishers.values() for node in nodes}
        topics = set(publishers) | set(subscribers)
        is_there = set(cls.nodes) <= begun and set(cls.expected_commands()) <= topics
        return (publishers, subscribers) if is_there else None

    @classmethod
    def expected_commands(cls):
        return dict(COMMANDS, **(MOVE_BASE if cls.navigation == 'move_base' else {}))

    def ours(self, table):
        return {topic for topic, nodes in table.items()
                if any(node in self.nodes or node.startswith('/worker_host') for node in nodes)}

    def of_pr2(self, table):
        return {topic for topic, nodes in table.items() if any(n in PR2_NODES for n in nodes)}

    def test_nothing_but_a_pr2s_commands_goes_to_the_robot(self):
        publishers, subscribers = self.state
        told = self.ours(publishers) & self.of_pr2(subscribers)
        self.assertEqual(told, set(self.expected_commands()))

    def test_the_base_is_told_by_the_guard_alone(self):
        publishers, _ = self.state
        self.assertEqual([n for n in publishers['/navigation/cmd_vel'] if n in self.nodes],
                         ['/base_guard'])
        self.assertNotIn('/base_controller/command', self.ours(publishers))

    def test_what_is_heard_is_what_a_pr2_says(self):
        publishers, subscribers = self.state
        heard = self.ours(subscribers) & self.of_pr2(publishers)
        allowed = dict(SENSORS, **RECOGNISER)
        allowed['/base_guard/cmd_vel'] = 'geometry_msgs/Twist'  # move_base's, as its launch remaps
        if self.navigation == 'move_base':
            allowed.update(MOVE_BASE_SAYS)
        self.assertEqual(heard - set(allowed), set())
        needed = set(SENSORS) | set(RECOGNISER)
        self.assertEqual(needed - heard, set())

    def test_no_other_name_of_a_pr2_is_wanted(self):
        """What nobody says, of all that is subscribed: only our own."""
        publishers, subscribers = self.state
        waited_for = {topic for topic in self.ours(subscribers) if topic not in publishers}
        self.assertEqual({topic for topic in waited_for if not self.is_own(topic)}, set())

    @staticmethod
    def is_own(topic):
        """Also of the laser that was built on to look over the tray, and clouds that show the floor: a
        PR2 has none as it is, and may lack them."""
        return topic.startswith(('/execute_action/', '/achieve/', '/imagine/', '/plan/',
                                 '/worker_', '/base_guard/', '/blackboard/', '/clock',
                                 '/object_temperatures', '/tray_laser_scan', '/tilt_scan_cloud'))

    def test_types_are_those_of_a_pr2(self):
        types = self.lab.main.topic_types()
        for table in (self.expected_commands(), SENSORS, RECOGNISER):
            for topic, kind in table.items():
                self.assertEqual(types.get(topic), kind, topic)

    def test_checksums_of_commands_are_those_of_a_pr2(self):
        """As they go over the wire: each publisher tells its own when somebody connects."""
        publishers, _ = self.state
        for topic, kind in self.expected_commands().items():
            for node in publishers[topic]:
                if node in self.nodes:
                    self.assertEqual(header_of(self.lab.main.node_uri(node), topic),
                                     (kind, MD5[kind]), topic)

    def test_every_sensor_is_connected(self):
        """A type or checksum that differs would keep a subscriber unconnected."""
        _, subscribers = self.state
        for topic in set(SENSORS) | set(RECOGNISER):
            for node in set(subscribers.get(topic, ())) & set(self.nodes):
                wait_until(lambda: is_connected(self.lab.main.node_uri(node), topic),
                           '%s to hear %s' % (node, topic))


def header_of(uri, topic):
    """Type and checksum that a publisher tells."""
    import socket
    import struct
    with xmlrpc.client.ServerProxy(uri) as proxy:
        _, _, (_, host, port) = proxy.requestTopic('/pr2_names', topic, [['TCPROS']])
    fields = ('callerid=/pr2_names', 'topic=' + topic, 'type=*', 'md5sum=*', 'tcp_nodelay=1')
    header = b''.join(struct.pack('<I', len(f)) + f.encode() for f in fields)
    with socket.create_connection((host, port), 10.0) as wire:
        wire.sendall(struct.pack('<I', len(header)) + header)
        stream = wire.makefile('rb')
        rest = struct.unpack('<I', stream.read(4))[0]
        answer = {}
        while rest > 0:
            size = struct.unpack('<I', stream.read(4))[0]
            key, _, value = stream.read(size).decode().partition('=')
            answer[key] = value
            rest -= 4 + size
    return answer.get('type'), answer.get('md5sum')


def is_connected(uri, topic):
    with xmlrpc.client.ServerProxy(uri) as proxy:
        _, _, connections = proxy.getBusInfo('/pr2_names')
    return any(c[2] == 'i' and c[4] == topic and (len(c) < 6 or c[5]) for c in connections)


class Pr2NamesMoveBaseTest(Pr2NamesTest):
    navigation = 'move_base'


if __name__ == '__main__':
    run_test('pr2_names',
             Pr2NamesMoveBaseTest if '--move_base' in sys.argv else Pr2NamesTest)
