#!/usr/bin/env python3
"""The translator as a real node beside a real Blackboard. Run alone, or by `rostest hires
translator.test`."""

import os
import sys
import unittest

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
CONFIG = os.path.join(ROOT, 'config')


class TranslatorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        cls.blackboard = cls.start_blackboard('first.db')
        cls.node = cls.processes.start(
            [executable('translator'), '_config:=' + os.path.join(CONFIG, 'translator.yaml')],
            cls.main)
        import rospy
        from hires import msg, srv
        cls.rospy, cls.msg, cls.srv = rospy, msg, srv
        rospy.init_node('translator_test', disable_signals=True)
        rospy.wait_for_service('generate_imagine_state', LIMIT)

    @classmethod
    def start_blackboard(cls, store):
        node = cls.processes.start(
            [executable('blackboard'), '_config:=' + os.path.join(CONFIG, 'blackboard.yaml'),
             '_store:=' + os.path.join(cls.processes.folder.name, store)], cls.main)
        wait_until(lambda: '/blackboard/query' in cls.main.services(), 'the Blackboard')
        return node

    @classmethod
    def restart_blackboard(cls, store, meanwhile=lambda: None):
        cls.blackboard.kill()
        meanwhile()
        cls.blackboard = cls.start_blackboard(store)
        wait_until(cls.answers, 'the new Blackboard')

    @classmethod
    def answers(cls):
        try:
            answer = cls.rospy.ServiceProxy('blackboard/query', cls.srv.QueryFluents)(
                query=cls.msg.FluentQuery(limit=1))
            return answer.error.code == 0
        except cls.rospy.ServiceException:
            return False

    def tearDown(self):
        self.assertTrue(self.node.is_running(), self.node.output())

    def ask(self, *atoms, whole=False):
        return self.rospy.ServiceProxy('generate_imagine_state', self.srv.GenerateImagineState)(
            updated_fluents=[self.msg.Atom(atom[0], list(atom[1:])) for atom in atoms],
            is_whole_state=whole)

    def state(self, *atoms, **fields):
        answer = self.ask(*atoms, **fields)
        self.assertEqual(answer.error, '')
        return answer, {thing.name: thing for thing in answer.world_state.objects}

    def add_pose(self, instance, x, y, z):
        fluent = self.msg.Fluent(concept_name='Pose', instance=instance, properties=[
            self.msg.FluentProperty(role=role, type='xsd:float', real=value)
            for role, value in zip(('hasX', 'hasY', 'hasZ'), (x, y, z))])
        answer = self.rospy.ServiceProxy('blackboard/add', self.srv.WriteFluents)(fluents=[fluent])
        self.assertEqual(answer.error.code, 0, answer.error.message)

    def test_what_differs_is_put_over_what_the_blackboard_says(self):
        answer, things = self.state(('RobotAt', 'preManipulationAreaNorthTable1'),
                                    ('HasTorsoPosture', 'TorsoUpPosture'),
                                    ('Holding', 'rightArm1', 'mug1'))
        pose = answer.robot_state.pose.position
        self.assertAlmostEqual(pose.x, 7.81)
        self.assertAlmostEqual(pose.y, 12.79)
        self.assertEqual(answer.world_state.header.frame_id, 'map')
        self.assertEqual(things['mug1'].attached_to, 'r_gripper_palm_link')
        self.assertEqual(things['mug1'].model, 'coffee_cup')
        self.assertEqual(things['mug2'].attached_to, '')
        joints = dict(zip(answer.robot_state.joints.name, answer.robot_state.joints.position))
        self.assertAlmostEqual(joints['torso_lift_joint'], 0.295)
        postures = {posture.name: posture.value for posture in answer.robot_state.postures}
        self.assertEqual(postures['torso'], 'torsoupposture')

    def test_what_is_put_down_is_held_no_more(self):
        _, things = self.state(('Holding', 'rightArm1', 'mug1'))
        self.assertNotEqual(things['mug1'].attached_to, '')
        _, things = self.state(('On', 'mug1', 'placingAreaWestLeftTable1'))
        self.assertEqual(things['mug1'].attached_to, '')
        self.assertAlmostEqual(things['mug1'].pose.position.x, 7.48)

    def test_a_whole_state_has_the_blackboards_poses_alone(self):
        _, things = self.state(('RobotAt', 'home'), whole=True)
        self.assertEqual(sorted(things), ['mug1', 'mug2', 'peppermill1'])
        _, things = self.state(('RobotAt', 'home'), ('On', 'mug1', 'trayArea1'), whole=True)
        self.assertAlmostEqual(things['mug1'].pose.position.z, 0.3462, places=3)

    def test_what_was_just_written_counts(self):
        for i in range(20):
            self.add_pose('poseMug2', 5.40 + 0.005 * i, 9.95, 0.75)
            _, things = self.state()
            self.assertAlmostEqual(things['mug2'].pose.position.x, 5.40 + 0.005 * i)

    def test_errors_name_the_atom_and_what_comes_near(self):
        for atoms, text in (
                ([('RobotAt', 'hme')], "area 'hme' is unknown; did you mean 'home'"),
                ([('Holding', 'rightArm1')], 'Holding(rightArm1)'),
                ([('Grasps', 'rightArm1', 'mug1')], "predicate 'Grasps' is unknown"),
                ([('On', 'mug1', '')], 'has an empty predicate or argument'),
                ([('HasArmPosture', 'rightArm1', 'ArmTuckPosture')], 'ArmTuckedPosture'),
                ([('On', 'mug1', 'trayArea1'), ('Holding', 'leftArm1', 'mug1')], 'contradicts')):
            answer = self.ask(*atoms)
            self.assertIn(text, answer.error, atoms)
            self.assertEqual(answer.world_state.objects, [])
        self.assertIn('RobotAt(area) is missing', self.ask(whole=True).error)

    def test_the_blackboard_may_be_killed_and_come_back(self):
        self.add_pose('poseMug2', 5.45, 9.95, 0.75)
        self.state()

        def while_it_is_away():
            _, things = self.state(('RobotAt', 'home'))
            self.assertAlmostEqual(things['mug2'].pose.position.x, 5.45)

        self.restart_blackboard('first.db', while_it_is_away)
        self.add_pose('poseMug2', 5.46, 9.95, 0.75)
        _, things = self.state()
        self.assertAlmostEqual(things['mug2'].pose.position.x, 5.46)

    def test_another_store_in_the_blackboards_place_is_read_anew(self):
        self.add_pose('poseMug2', 5.44, 9.95, 0.75)
        self.state()
        self.restart_blackboard('second.db')
        _, things = self.state()
        self.assertAlmostEqual(things['mug2'].pose.position.x, 5.37)  # of the knowledge file
        self.restart_blackboard('first.db')

    def test_bad_parameters_end_the_node(self):
        for argument, text in (('_config:=/nowhere.yaml', '/nowhere.yaml'),
                               ('_confg:=x', 'confg'),
                               ('_world:=/nowhere.world', '/nowhere.world')):
            arguments = [executable('translator'), '__name:=other', argument]
            if not argument.startswith('_config'):
                arguments.append('_config:=' + os.path.join(CONFIG, 'translator.yaml'))
            node = self.processes.start(arguments, self.main)
            self.assertNotEqual(node.wait(), 0)
            self.assertIn(text, node.output())
            for name in ('config', 'confg', 'world'):
                self.main._call('deleteParam', '/other/' + name)


if __name__ == '__main__':
    run_test('translator_node', TranslatorTest)
