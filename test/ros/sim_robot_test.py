#!/usr/bin/env python3
"""The simulated robot as a real process, without a middle layer: what its topics say, that it obeys
its controllers' topics, what services do to it, bad parameters. Run alone, or by
`rostest hires sim_robot.test`."""

import math
import os
import sys
import threading
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from robot_system import RobotSystem  # noqa: E402
from ros_processes import LIMIT, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

START = (12.5, 11.8)


class Listener:
    """Keeps what comes on a topic."""

    def __init__(self, rospy, topic, kind):
        self.messages = []
        self._changed = threading.Condition()
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message, queue_size=1000,
                                            tcp_nodelay=True)

    def _on_message(self, message):
        with self._changed:
            self.messages.append(message)
            self._changed.notify_all()

    def wait(self, count=1, condition=lambda message: True):
        """The messages that are as wanted, once there are `count`."""
        with self._changed:
            fitting = lambda: [m for m in self.messages if condition(m)]  # noqa: E731
            assert self._changed.wait_for(lambda: len(fitting()) >= count, LIMIT), \
                'only %d messages came' % len(self.messages)
            return fitting()

    def close(self):
        self._subscriber.unregister()


class SimRobotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(uncertainty='none', pace=0.0)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('sim_robot_test')

    def setUp(self):
        self.robot = self.system.start_robot()
        self.addCleanup(self.system.end_processes)

    def listen(self, topic, kind):
        listener = Listener(self.system.rospy, topic, kind)
        self.addCleanup(listener.close)
        return listener

    def publisher(self, topic, kind):
        publisher = self.system.rospy.Publisher(topic, kind, queue_size=10, tcp_nodelay=True)
        wait_until(lambda: publisher.get_num_connections() > 0, 'the robot to listen on ' + topic)
        self.addCleanup(publisher.unregister)
        return publisher

    def test_topics_are_those_of_a_pr2(self):
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import OccupancyGrid, Odometry
        from sensor_msgs.msg import JointState, LaserScan
        from tf2_msgs.msg import TFMessage
        joints = self.listen('joint_states', JointState).wait(20)
        self.assertIn('l_wrist_roll_joint', joints[0].name)
        steps = {round((b.header.stamp - a.header.stamp).to_nsec() / 1e6)
                 for a, b in zip(joints, joints[1:])}
        self.assertEqual(steps, {10})
        odometry = self.listen('base_odometry/odom', Odometry).wait()[0]
        self.assertEqual((odometry.header.frame_id, odometry.child_frame_id),
                         ('odom_combined', 'base_footprint'))
        pose = self.listen('amcl_pose', PoseWithCovarianceStamped).wait()[0].pose.pose
        self.assertAlmostEqual(pose.position.x, START[0], places=6)
        scan = self.listen('base_scan', LaserScan).wait()[0]
        self.assertEqual(len(scan.ranges), 640)
        self.assertAlmostEqual(scan.angle_max, 2.2689, places=5)
        self.assertTrue(any(math.isfinite(distance) for distance in scan.ranges))
        grid = self.listen('map', OccupancyGrid).wait()[0]
        self.assertEqual(len(grid.data), grid.info.width * grid.info.height)
        frames = {(t.header.frame_id, t.child_frame_id)
                  for message in self.listen('/tf', TFMessage).wait(4)
                  for t in message.transforms}
        self.assertIn(('map', 'odom_combined'), frames)
        self.assertIn(('odom_combined', 'base_footprint'), frames)
        self.assertIn(('base_footprint', 'base_link'), frames)

    def test_the_base_obeys_and_brakes_when_nobody_speaks(self):
        from geometry_msgs.msg import Twist
        command = Twist()
        command.linear.x = 0.3
        base = self.publisher('base_controller/command', Twist)
        self.system.wait_for_truth(lambda s: True, 'the truth')
        speeds = lambda: [s.twist.linear.x for _, s in self.system.truth]  # noqa: E731
        wait_until(lambda: base.publish(command) or max(speeds()) > 0.25, 'the base to drive')
        self.system.wait_for_truth(lambda s: abs(s.twist.linear.x) < 0.01, 'the base to stand')

    def test_bad_commands_are_told_and_change_nothing(self):
        from geometry_msgs.msg import Twist
        from trajectory_msgs.msg import JointTrajectory
        command = Twist()
        command.linear.x = float('nan')
        self.publisher('base_controller/command', Twist).publish(command)
        self.robot.wait_for('base_controller/command: .*not finite')
        trajectory = JointTrajectory(joint_names=['l_ankle_joint'])
        self.publisher('l_arm_controller/command', JointTrajectory).publish(trajectory)
        self.robot.wait_for('l_arm_controller/command: .*l_ankle_joint')
        self.assertTrue(self.robot.is_running())

    def test_gripper_commands_have_the_type_of_a_pr2(self):
        def kind():
            return self.system.main.topic_types().get('/l_gripper_controller/command')
        wait_until(kind, 'the robot to listen')
        self.assertEqual(kind(), 'pr2_controllers_msgs/Pr2GripperCommand')

    def test_holding_stops_time(self):
        from rosgraph_msgs.msg import Clock
        clock = self.listen('/clock', Clock)
        clock.wait()
        self.assertTrue(self.system.hold(True).success)

        def last_times():
            return [message.clock.to_nsec() for message in clock.messages[-4:]]
        # Running time never says the same twice; time that stands is repeated for latecomers.
        wait_until(lambda: len(last_times()) == 4 and len(set(last_times())) == 1,
                   'time to stand')
        held = last_times()[-1]
        self.assertTrue(self.system.hold(False).success)
        clock.wait(condition=lambda message: message.clock.to_nsec() > held)

    def test_a_held_world_plays_one_tick_when_asked(self):
        from std_srvs.srv import Trigger
        refusal = self.system.call('step', Trigger)
        self.assertFalse(refusal.success)
        self.assertIn('sim_robot/hold', refusal.message)
        self.system.hold(True)
        begin = self.system.wait_for_standstill()
        for _ in range(3):
            self.assertTrue(self.system.call('step', Trigger).success)
        self.system.wait_for_truth(lambda _: self.system.truth[-1][0] >= begin + 150000000,
                                   'three ticks')
        self.assertEqual(self.system.wait_for_standstill(), begin + 150000000)
        self.system.hold(False)
        self.system.wait_for_truth(lambda _: self.system.truth[-1][0] > begin + 500000000,
                                   'time to go on')

    def test_services_push_place_drop_and_remove(self):
        from geometry_msgs.msg import Pose, Pose2D
        from hires.msg import GroundTruth, WorldState
        srv = self.system.srv
        self.system.wait_for_truth(lambda s: True, 'the truth')
        self.assertTrue(self.system.call('push', srv.PushRobot, offset=Pose2D(x=0.2)).success)
        self.system.wait_for_truth(
            lambda s: math.hypot(s.pose.position.x - START[0], s.pose.position.y - START[1]) > 0.15,
            'the robot to be pushed')
        refused = self.system.call('push', srv.PushRobot, offset=Pose2D(x=2.0))
        self.assertFalse(refused.success)
        self.assertIn('chair3', refused.message)

        worlds = self.listen('ground_truth/world_state', WorldState)
        pose = Pose()
        pose.position.x, pose.position.y, pose.orientation.w = 9.0, 11.5, 1.0
        self.assertTrue(self.system.call('place_object', srv.PlaceObject, name='peppermill1',
                                         pose=pose).success)
        worlds.wait(condition=lambda w: any(
            o.name == 'peppermill1' and abs(o.pose.position.x - 9.0) < 0.01 for o in w.objects))
        self.assertTrue(self.system.call('drop', srv.ObjectRequest, name='peppermill1').success)
        summary = self.listen('ground_truth/summary', GroundTruth)
        fate = summary.wait(condition=lambda t: t.falls > 0)[0]
        self.assertEqual([o.name for o in fate.objects if o.falls], ['peppermill1'])
        self.assertTrue(
            self.system.call('remove_object', srv.ObjectRequest, name='peppermill1').success)
        answer = self.system.call('remove_object', srv.ObjectRequest, name='peppermill1')
        self.assertFalse(answer.success)
        self.assertIn('peppermill1', answer.message)
        answer = self.system.call('place_object', srv.PlaceObject, name='unicorn1', pose=pose)
        self.assertIn('unicorn1', answer.message)

    @long_case
    def test_bad_parameters_stop_the_node_with_the_reason(self):
        for argument, reason in (('_role:=dog', 'role is dog'), ('_pace:=-1.0', 'pace is -1'),
                                 ('_area:=nowhere', 'nowhere'), ('_colour:=red', 'colour'),
                                 ('_scenario:=/missing.yaml', '/missing.yaml')):
            with self.subTest(argument=argument):
                process = self.system.processes.start(
                    [executable('sim_worker'), '__name:=bad_robot',
                     *([] if 'role' in argument else ['_role:=robot']), argument],
                    self.system.main)
                self.assertNotEqual(process.wait(), 0)
                self.assertIn(reason, process.output())
                self.system.rospy.delete_param('/bad_robot')


if __name__ == '__main__':
    run_test('sim_robot_node', SimRobotTest)
