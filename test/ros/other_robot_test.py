#!/usr/bin/env python3
"""A robot that is no PR2, by two files alone: a Fetch in simulation, whose controllers are the actions
of control_msgs, picks, drives and places by the same middle layer. Run alone, or by
`rostest hires other_robot.test`."""

import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from failures import text_of  # noqa: E402
from robot_system import MUG, RobotSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

ROBOTS = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config',
                                      'robots'))
FILES = {'robot': os.path.join(ROBOTS, 'fetch.yaml'), 'names': os.path.join(ROBOTS, 'fetch_names.yaml')}
AT_COUNTER = """
task: none
knowledge: []
robot:
  pose: [6.0, 10.11, 3.14]  # manipulationAreaEastCounter1
  torso: torsoupposture
  arms: {rightarm1: armtosideposture}
objects:
  - {name: mug1, pose: [%g, %g, %g, 0.0]}
hidden: []
""" % MUG
AREA = 'placingAreaEastRightCounter1'
GOALS = {'/arm_controller/follow_joint_trajectory/goal': 'control_msgs/FollowJointTrajectoryActionGoal',
         '/torso_controller/follow_joint_trajectory/goal': 'control_msgs/FollowJointTrajectoryActionGoal',
         '/gripper_controller/gripper_action/goal': 'control_msgs/GripperCommandActionGoal'}


class OtherRobotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(uncertainty='none', lockstep=True, pace=0.0, **FILES)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('other_robot_test')

    def setUp(self):
        self.system.tell({'mug1': ('coffee_cup', *MUG)})
        self.system.start_robot(scenario=self.system.processes.write('counter.yaml', AT_COUNTER))
        self.system.start_middle_layer('cmd_vel:=base_controller/command', **FILES)
        self.system.require_ready()
        self.held = None

        def note(state):
            self.held = {thing.name: thing.attached_to for thing in state.objects if thing.attached_to}
        self.subscriber = self.system.rospy.Subscriber('ground_truth/world_state',
                                                       self.system.msg.WorldState, note)

    def tearDown(self):
        self.subscriber.unregister()
        self.assertTrue(self.system.robot.is_running(), self.system.robot.output())
        self.system.end_processes()

    def execute(self, *words):
        result = self.system.execute(*words).result()
        self.assertEqual((result.code, text_of(result.failure)), (self.system.codes.SUCCEEDED, ''),
                         ' '.join(words) + '\n' + self.system.output())

    def test_it_picks_drives_and_places(self):
        self.execute('pick_up_object', 'mug1', 'rightArm1')
        wait_until(lambda: self.held == {'mug1': 'gripper_link'}, 'the mug to be held')
        self.execute('move_base_blind', 'preManipulationAreaEastCounter1')
        self.execute('move_base_param', 'preManipulationAreaSouthTable1', 'slow')
        self.execute('move_base_param', 'preManipulationAreaEastCounter1', 'slow')
        self.execute('move_base_blind', 'manipulationAreaEastCounter1')
        self.execute('place_object', 'mug1', 'rightArm1', AREA)
        wait_until(lambda: not self.held, 'the mug to be let go')
        sideways = max(abs(state.twist.linear.y) for _, state in self.system.truth)
        self.assertLess(sideways, 1e-9, 'two driven wheels')

    def test_its_controllers_are_led_by_goals_of_actions(self):
        self.execute('move_torso', 'TorsoMiddlePosture')
        types = dict(self.system.rospy.get_published_topics())
        self.assertEqual({topic: types.get(topic) for topic in GOALS}, GOALS)


if __name__ == '__main__':
    run_test('other_robot', OtherRobotTest)
