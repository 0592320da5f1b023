#!/usr/bin/env python3
"""Requests that make no sense: each is answered with what is wrong, and the next good request as if
nothing had been. Run alone, or by `rostest hires imagination_bad_input.test`."""

import io
import math
import os
import struct
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from action_goal import ActionGoal  # noqa: E402
from failures import text_of  # noqa: E402
from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import LIMIT, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

EAST_COUNTER = 'preManipulationAreaEastCounter1'
SOUTH_TABLE = 'preManipulationAreaSouthTable1'
NAN = float('nan')


class ImaginationBadInputTest(unittest.TestCase):
    """One client and one worker answer all of them, one after the other."""

    @classmethod
    def setUpClass(cls):
        cls.system = ImaginationSystem(workers=1)
        cls.addClassCleanup(cls.system.destroy)
        cls.system.start_client(arguments=['_localisation:=where'])
        cls.system.start_host(1)
        cls.system.wait_until_joined(1)
        os.environ.update(ROS_MASTER_URI=cls.system.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.system.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import actionlib
        import rospy
        from hires import msg
        cls.rospy, cls.msg = rospy, msg
        rospy.init_node('imagination_bad_input_test', disable_signals=True)
        cls.client = actionlib.ActionClient('imagine', msg.ImagineAction)
        assert cls.client.wait_for_server(rospy.Duration(LIMIT))
        cls.good = cls.ask(cls.goal())
        assert cls.good.outcome in (msg.ImagineResult.RANKED, msg.ImagineResult.CLOSE), cls.good.why

    @classmethod
    def goal(cls, name='move_base_blind', alternatives=((SOUTH_TABLE,),), **fields):
        msg = cls.msg
        goal = msg.ImagineGoal()
        step = msg.ActionTemplate(name=name)
        step.alternatives = [msg.StringList(values=list(a)) for a in alternatives]
        goal.steps = [step]
        goal.updated_fluents = [msg.Atom('RobotAt', [EAST_COUNTER]),
                                msg.Atom('On', ['peppermill1', 'trayArea1'])]
        goal.rollouts = 12
        goal.min_success = 0.3  # none of 12: at most 27 %; 8 of 12: at least 34 %
        goal.seed = 7
        for field, value in fields.items():
            setattr(goal, field, value)
        return goal

    @classmethod
    def ask(cls, goal):
        return ActionGoal(cls.client, goal).result()

    def tearDown(self):
        self.assertTrue(self.system.client.is_running(), self.system.client.output())
        self.assertEqual(self.system.times_joined(1), 1)  # the worker never went away
        if os.environ.get('HIRES_LONG_TESTS'):
            self.require_the_answer_of_the_beginning()

    @classmethod
    def tearDownClass(cls):
        cls('require_the_answer_of_the_beginning').require_the_answer_of_the_beginning()

    def require_the_answer_of_the_beginning(self):
        result = self.ask(self.goal())
        for field in ('outcome', 'recommended', 'predictions', 'why', 'simulated_seconds'):
            self.assertEqual(getattr(result, field), getattr(self.good, field), field)

    def require_invalid(self, goal, *texts):
        asked = ActionGoal(self.client, goal)
        result = asked.result()
        self.assertEqual(result.outcome, self.msg.ImagineResult.INVALID, result.why)
        self.assertEqual(asked.state(), 4)  # aborted
        self.assertEqual((result.recommended, result.predictions), (-1, []))
        self.assertEqual(asked.status_text(), result.why)
        for text in texts:
            self.assertIn(text, result.why)

    def require_failure(self, goal, *reasons, rollouts=12):
        result = self.ask(goal)
        self.assertEqual(result.outcome, self.msg.ImagineResult.ALL_FAILED, result.why)
        self.assertEqual(result.recommended, -1)
        failures = result.predictions[0].failures
        found = {text_of(f.failure).split(':')[0] for f in failures}
        self.assertLessEqual(found, set(reasons))
        self.assertEqual(sum(f.count for f in failures), rollouts)
        self.assertTrue(any(reason in result.why for reason in found), result.why)

    # The action.

    def test_an_unknown_action_is_named_with_one_like_it(self):
        self.require_invalid(self.goal('move_bse_blind'), 'move_bse_blind', "'move_base_blind'")

    def test_a_long_request_id_is_logged_in_short(self):
        for goal in (self.goal(request_id='i' * 100000),
                     self.goal('move_bse_blind', request_id='i' * 100000)):
            self.ask(goal)
        self.assertIn('i' * 1000, self.system.client.output())
        self.assertNotIn('i' * 3000, self.system.client.output())

    def test_no_action_at_all(self):
        self.require_invalid(self.goal('', []), "action")

    def test_an_unknown_area_is_named_with_one_like_it(self):
        self.require_invalid(self.goal(alternatives=[['preManipulationAreaSouthTabel1']]),
                             'premanipulationareasouthtabel1', "'premanipulationareasouthtable1'")

    def test_one_bad_alternative_among_good_ones_is_named(self):
        self.require_invalid(self.goal(alternatives=[[SOUTH_TABLE, 'moon']]), "'moon'")

    def test_a_wrong_number_of_arguments(self):
        for alternatives, number in (([], '0'), ([[SOUTH_TABLE], ['slow']], '2')):
            self.require_invalid(self.goal(alternatives=alternatives),
                                 'has %s arguments, wanted 1 (area)' % number)

    def test_an_argument_without_alternatives(self):
        self.require_invalid(self.goal('move_base_param', [[SOUTH_TABLE], []]),
                             'argument 2 has no alternatives')

    def test_too_many_combinations(self):
        many = ['area%d' % i for i in range(5000)]
        self.require_invalid(self.goal(alternatives=[many]), 'more than 4096 combinations')

    def test_an_unknown_motion_set(self):
        self.require_invalid(self.goal('move_base_param', [[SOUTH_TABLE], ['fsat']]),
                             'fsat', "'fast'")

    def test_bytes_that_are_no_goal_do_no_harm(self):
        whole = io.BytesIO()
        self.msg.ImagineActionGoal(goal=self.goal()).serialize(whole)
        whole = whole.getvalue()
        # rospy sends the like after a message that it could not write.
        for length in (0, 0, 1, 4, 20, 60, len(whole) - 1, 0):
            frame = struct.pack('<I', length) + whole[:length]
            self.client.pub_goal.impl.connections[0].socket.sendall(frame)
            self.rospy.sleep(0.02)
        self.require_the_answer_of_the_beginning()

    def test_a_localisation_that_says_nothing_of_use_is_told(self):
        from geometry_msgs.msg import PoseWithCovarianceStamped
        self.assertIn('topic=/where awaited why=nothing came yet', self.system.client.output())
        publisher = self.rospy.Publisher('where', PoseWithCovarianceStamped, queue_size=10)
        wait_until(publisher.get_num_connections, 'the client')
        for field, value, text in (('position.y', NAN, 'dropped why=pose.pose.position is 0, nan'),
                                   ('orientation.w', 0.0, 'dropped why=pose.pose.orientation has length 0'),
                                   ('position.x', 100.0, "taken for a pose in the map why=header.frame_id is 'odom'")):
            pose = PoseWithCovarianceStamped()
            pose.header.frame_id = 'odom'
            pose.pose.pose.orientation.w = 1.0
            part, member = field.split('.')
            setattr(getattr(pose.pose.pose, part), member, value)
            self.rospy.sleep(1.1)  # a topic is warned of once a second
            publisher.publish(pose)
            self.system.client.wait_for('topic=/where ' + text)

    # The state.

    def fluents(self, *atoms):
        return [self.msg.Atom(predicate, list(arguments)) for predicate, *arguments in atoms]

    def test_a_start_area_that_is_unknown_missing_or_there_twice(self):
        at = self.fluents
        for atoms, text in (
                (at(('RobotAt', 'nowhere')), "'nowhere'"),
                (at(('On', 'peppermill1', 'trayArea1')), 'RobotAt(area) is missing'),
                (at(('RobotAt', EAST_COUNTER), ('RobotAt', SOUTH_TABLE)), 'contradicts'),
                (at(('RobotAt',)), 'has 0 arguments, wanted 1')):
            self.require_invalid(self.goal(updated_fluents=atoms), text)

    def test_an_object_that_is_unknown(self):
        self.require_invalid(
            self.goal(updated_fluents=self.fluents(('RobotAt', EAST_COUNTER),
                                                   ('On', 'pepermill1', 'trayArea1'))),
            'pepermill1', "'peppermill1'")

    def test_more_objects_than_the_tray_holds(self):
        on = [('On', f'bowl{i}', 'trayArea1') for i in range(1, 13)]
        self.require_invalid(
            self.goal(updated_fluents=self.fluents(('RobotAt', EAST_COUNTER), *on)),
            'there is no room left on the tray')

    def test_an_atom_that_is_not_understood(self):
        self.require_invalid(
            self.goal(updated_fluents=self.fluents(('RobotAt', EAST_COUNTER), ('Flies', 'mug1'))),
            "Flies(mug1): predicate 'Flies' is unknown")

    def test_hands_that_contradict_each_other(self):
        at = self.fluents
        for atoms, text in (
                (at(('Holding', 'rightArm1', 'mug1'), ('Holding', 'leftArm1', 'mug1')),
                 'who holds this object'),
                (at(('Holding', 'rightArm1', 'mug1'), ('Holding', 'rightArm1', 'mug2')),
                 'this hand'),
                (at(('Holding', 'rightArm1', 'mug1'), ('On', 'mug1', 'trayArea1')),
                 'an object has one place'),
                (at(('Holding', 'rightArm2', 'mug1')), "'rightarm1'"),
                (at(('HasArmPosture', 'rightArm1', 'ArmToSidPosture')), "'armtosideposture'")):
            self.require_invalid(
                self.goal(updated_fluents=self.fluents(('RobotAt', EAST_COUNTER)) + atoms), text)

    def state_goal(self, x=10.0, y=9.0, yaw=0.0, objects=()):
        goal = self.goal(updated_fluents=[])
        goal.world_state.header.frame_id = 'map'
        goal.robot_state.pose.position.x = x
        goal.robot_state.pose.position.y = y
        goal.robot_state.pose.orientation.w = 1.0
        goal.robot_state.yaw = yaw
        goal.world_state.objects = list(objects)
        return goal

    def mill(self, x, y, z, w=1.0, model='peppermill_thesis'):
        mill = self.msg.ObjectState(name='peppermill1', model=model)
        mill.pose.position.x, mill.pose.position.y, mill.pose.position.z = x, y, z
        mill.pose.orientation.w = w
        return mill

    def test_a_robot_pose_that_is_not_finite_or_far_away(self):
        for x, text in ((NAN, 'not finite'), (float('inf'), 'not finite'), (1e6, '1000000 m'),
                        (1e300, 'at most 1000 m')):
            self.require_invalid(self.state_goal(x=x), 'the robot', text)

    def test_an_object_pose_that_is_not_finite_or_far_away(self):
        for x, text in ((NAN, 'not finite'), (-1e7, '10000000 m')):
            self.require_invalid(self.state_goal(objects=[self.mill(x, 0.0, 0.0)]),
                                 "object 'peppermill1'", text)

    def test_an_object_rotation_that_is_not_finite(self):
        self.require_invalid(self.state_goal(objects=[self.mill(0.0, 0.0, 0.0, w=NAN)]),
                             "object 'peppermill1'", 'not finite')

    def test_an_object_velocity_that_is_not_finite(self):
        mill = self.mill(0.0, 0.0, 0.0)
        mill.twist.angular.z = NAN
        self.require_invalid(self.state_goal(objects=[mill]), 'velocity is not finite')

    def test_an_object_of_an_unknown_model(self):
        self.require_invalid(
            self.state_goal(objects=[self.mill(0.0, 0.0, 0.0, model='peppermil_thesis')]),
            'peppermil_thesis', "'peppermill_thesis'")

    def held_mug(self, name='mug1', link='r_gripper_palm_link', x=6.5):
        mug = self.mill(x, 10.2, 0.9, model='coffee_cup')
        mug.name, mug.attached_to = name, link
        return mug

    def test_objects_that_no_hand_can_hold(self):
        for objects, text in (
                ([self.held_mug(link='r_griper_palm_link')], "'r_gripper_palm_link'"),
                ([self.held_mug(x=8.5)], 'm away from it'),
                ([self.held_mug(), self.held_mug(link='l_gripper_palm_link')], 'is there twice'),
                ([self.held_mug(), self.held_mug('mug2', x=6.4)], 'a link holds one object')):
            with self.subTest(text=text):
                goal = self.state_goal(x=6.8, y=10.1, yaw=math.pi, objects=objects)
                goal.robot_state.pose.orientation.z, goal.robot_state.pose.orientation.w = 1.0, 0.0
                self.require_invalid(goal, text)

    def test_joints_beyond_their_limits_and_unknown_ones(self):
        for name, position in (('r_elbow_flex_joint', 1.0), ('torso_lift_joint', -0.2),
                               ('r_elbw_flex_joint', -1.0)):
            goal = self.state_goal()
            goal.robot_state.joints.name = [name]
            goal.robot_state.joints.position = [position]
            self.require_invalid(goal, name)

    def test_joints_that_do_not_pair_up(self):
        goal = self.state_goal()
        goal.robot_state.joints.name = ['torso_lift_joint']
        self.require_invalid(goal, 'robot_state.joints', 'differ in number')

    def test_numbers_of_the_robots_state_that_are_none(self):
        for field, text in (('yaw', 'robot_state.yaw'), ('twist', 'robot_state.twist'),
                            ('joint', 'robot_state.joints: position 0')):
            goal = self.state_goal()
            if field == 'yaw':
                goal.robot_state.yaw = NAN
            elif field == 'twist':
                goal.robot_state.twist.linear.x = NAN
            else:
                goal.robot_state.joints.name = ['torso_lift_joint']
                goal.robot_state.joints.position = [NAN]
            self.require_invalid(goal, text, 'not finite')

    def test_a_state_in_another_frame_and_no_state_at_all(self):
        goal = self.state_goal()
        goal.world_state.header.frame_id = 'odom_combined'
        self.require_invalid(goal, "world_state.header.frame_id is 'odom_combined', wanted 'map'")
        self.require_invalid(self.goal(updated_fluents=[]), 'nothing says where it begins', 'updated_fluents')

    def test_a_good_state_is_played_as_the_atoms_are(self):
        goal = self.state_goal(x=6.8, y=10.1, yaw=3.14)
        goal.robot_state.pose.orientation.z = math.sin(3.14 / 2)
        goal.robot_state.pose.orientation.w = math.cos(3.14 / 2)
        with_mill = self.good.predictions[0]
        without = self.ask(goal).predictions[0]
        self.assertEqual(without.success_share, with_mill.success_share)
        self.assertEqual(without.duration_mean, with_mill.duration_mean)
        self.assertEqual(without.max_tilt_p95, 0.0)

    # The numbers.

    def test_no_rollouts_and_a_million(self):
        for rollouts in (0, 1000000, 4294967295):
            self.require_invalid(self.goal(rollouts=rollouts), 'rollouts is',
                                 'wanted between 1 and 100000')

    def test_a_deadline_in_the_past(self):
        self.require_invalid(self.goal(deadline=self.rospy.Duration(-1)), 'deadline is -1')

    def test_an_unknown_ranking(self):
        self.require_invalid(self.goal(ranking='tehsis'), 'tehsis', 'thesis')

    def test_uncertainty_that_cannot_be_read(self):
        for text, wanted in (
                ('{', 'uncertainty of the request'),
                ('object_mas: {distribution: fixed, value: 1, unit: factor, source: x}',
                 "'object_mass'"),
                ('object_mass: {distribution: fixed, value: 1, unit: kg, source: x}', 'unit'),
                ('object_mass: {distribution: fixed, value: .nan, unit: factor, source: x}',
                 'value'),
                ('object_mass: 3', 'object_mass'),
                ('[1, 2]', 'uncertainty of the request'),
                ('a: &a [*a, *a]', 'uncertainty of the request'),
                ('[' * 10000, 'uncertainty of the request')):
            with self.subTest(text=text[:40]):
                self.require_invalid(self.goal(uncertainty=text), wanted)

    def test_text_of_any_length_and_kind_is_only_text(self):
        for name in ('x' * 1000000, '{0} %s %n', '\u00e4\u2603', 'a\nb'):
            result = self.ask(self.goal(name))
            self.assertEqual(result.outcome, self.msg.ImagineResult.INVALID)
            self.assertLess(len(result.why), 3000)

    # The world says no.

    def test_a_robot_that_starts_in_collision(self):
        self.require_invalid(self.state_goal(x=7.48, y=11.62, objects=[]),
                             'robot starts in collision', 'move the start')

    def test_a_place_that_is_none_for_the_robot(self):
        self.require_invalid(
            self.goal(updated_fluents=self.fluents(('RobotAt', 'placingAreaWestLeftTable1'))),
            'RobotAt(placingAreaWestLeftTable1)', 'no area for the robot')

    def test_an_object_that_starts_inside_a_table(self):
        self.require_invalid(self.state_goal(x=6.8, y=10.1, objects=[self.mill(7.48, 11.62, 0.7)]),
                             "object 'peppermill1' starts inside", 'put it on a free place')

    def test_a_goal_inside_a_table_fails_as_blocked(self):
        self.require_failure(self.goal('move_base', [['placingAreaWestLeftTable1']]),
                             'goal_blocked')

    def test_driving_blindly_towards_a_table_fails(self):
        # It stops before the legs, which the laser sees; the top, above that plane, it may touch.
        self.require_failure(self.goal(alternatives=[['placingAreaWestLeftTable1']]), 'stuck', 'robot_collision')


if __name__ == '__main__':
    run_test('imagination_bad_input', ImaginationBadInputTest)
