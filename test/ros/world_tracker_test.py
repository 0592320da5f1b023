#!/usr/bin/env python3
"""The world tracker as a real node beside a real Blackboard; a script plays the robot's sensors. Run
alone, or by `rostest hires world_tracker.test`."""

import math
import os
import sys
import threading
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from pr2_frames import Robot, planar, quaternion, translation  # noqa: E402
from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
CONFIG = os.path.join(ROOT, 'config')
CAMERA = 'head_mount_kinect_ir_link'
UNTUCKED = dict(zip(('shoulder_pan', 'shoulder_lift', 'upper_arm_roll', 'elbow_flex',
                     'forearm_roll', 'wrist_flex', 'wrist_roll'),
                    (-0.4, 1.0, 0.0, -2.05, 0.0, -0.1, 0.0)))
TO_SIDE = dict(zip(UNTUCKED, (2.115, -0.02, 1.64, -2.07, 1.64, -1.68, 1.40)))


class WorldTrackerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from geometry_msgs.msg import Pose, TransformStamped
        from hires import msg, srv
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import JointState, LaserScan, PointCloud2, PointField
        from tf2_msgs.msg import TFMessage
        from trajectory_msgs.msg import JointTrajectory
        from visualization_msgs.msg import MarkerArray
        cls.rospy, cls.msg, cls.srv = rospy, msg, srv
        cls.types = dict(base_odometry=Odometry, joints=JointState, transforms=TFMessage,
                         transform=TransformStamped, trajectory=JointTrajectory, pose=Pose,
                         scan=LaserScan, markers=MarkerArray, cloud=PointCloud2, field=PointField)
        rospy.init_node('world_tracker_test', disable_signals=True)
        cls.robot = Robot(os.path.join(ROOT, 'urdf', 'pr2_tray.urdf'))

    def setUp(self):
        """Everything anew: what one test saw is nothing to the next."""
        self.number = getattr(type(self), 'number', 0) + 1
        type(self).number = self.number
        self.nodes = []
        self.addCleanup(self.stop)
        self.start_blackboard()
        # In lockstep known objects come with looks alone, so that a look can be waited for.
        self.tracker = self.start('world_tracker', '_config:=' + CONFIG + '/world_tracker.yaml',
                                  '_lockstep:=true')
        latch = dict(queue_size=100)
        p = self.rospy.Publisher
        self.publishers = dict(
            odometry=p('base_odometry/odom', self.types['base_odometry'], **latch),
            transforms=p('/tf', self.types['transforms'], **latch),
            joints=p('joint_states', self.types['joints'], **latch),
            detections=p('detections', self.msg.Detections, **latch),
            tray=p('tray_laser_scan', self.types['scan'], **latch),
            cloud=p('tilt_scan_cloud', self.types['cloud'], **latch),
            temperatures=p('object_temperatures', self.msg.ObjectTemperatures, **latch),
            goal=p('execute_action/goal', self.msg.ExecuteActionActionGoal, **latch),
            result=p('execute_action/result', self.msg.ExecuteActionActionResult, **latch))
        self.known, self.turns, self.progress = [], [], []
        self.changed = threading.Condition()
        self.subscribers = [
            self.rospy.Subscriber('known_objects', self.msg.WorldState, self.note(self.known)),
            self.rospy.Subscriber('head_traj_controller/command', self.types['trajectory'],
                                  self.note(self.turns)),
            self.rospy.Subscriber('observation_progress', self.msg.ObservationProgress,
                                  self.note(self.progress))]
        for publisher in self.publishers.values():
            wait_until(lambda: publisher.get_num_connections() > 0, 'the tracker to subscribe')
        wait_until(lambda: all(s.get_num_connections() > 0 for s in self.subscribers), 'its topics')
        self.t, self.base = 1000.0, (12.5, 11.8, 3.14)
        self.joints = dict(torso_lift_joint=0.0115, head_pan_joint=0.0, head_tilt_joint=0.5,
                           l_gripper_joint=0.0, r_gripper_joint=0.0)
        for name, position in TO_SIDE.items():
            self.joints['l_%s_joint' % name] = position
            mirrored = name in ('shoulder_pan', 'upper_arm_roll', 'forearm_roll')
            self.joints['r_%s_joint' % name] = -position if mirrored else position

    def start(self, name, *arguments):
        node = self.processes.start([executable(name), *arguments], self.main)
        self.nodes.append(node)
        return node

    def start_blackboard(self):
        store = os.path.join(self.processes.folder.name, 'store_%d.db' % self.number)
        self.blackboard = self.start('blackboard', '_config:=' + CONFIG + '/blackboard.yaml',
                                     '_store:=' + store)
        self.rospy.wait_for_service('blackboard/add', LIMIT)
        wait_until(self.blackboard_answers, 'the Blackboard')

    def blackboard_answers(self):
        try:
            return bool(self.query(limit=1))
        except self.rospy.ServiceException:
            return False

    def stop(self):
        running = self.tracker.is_running()
        output = self.tracker.output()
        for subscriber in self.subscribers:
            subscriber.unregister()
        for publisher in self.publishers.values():
            publisher.unregister()
        for node in self.nodes:
            node.destroy()
        self.assertTrue(running, output)

    def note(self, where):
        def take(message):
            with self.changed:
                where.append(message)
                self.changed.notify_all()
        return take

    # The robot's sensors.

    def tick(self, seen=None, dt=0.05, frame=CAMERA, is_localised=True):
        """All sensors once; `seen`: {name: (model, pose in the map)}."""
        self.t += dt
        stamp = self.rospy.Time.from_sec(self.t)
        odometry = self.types['base_odometry']()
        odometry.header.stamp, odometry.header.frame_id = stamp, 'odom_combined'
        odometry.pose.pose = self.pose_of(planar(*self.base))
        joints = self.types['joints']()
        joints.header.stamp = stamp
        joints.name, joints.position = list(self.joints), list(self.joints.values())
        self.publishers['odometry'].publish(odometry)
        if is_localised:
            self.tell_transform('map', 'odom_combined', numpy.eye(4))
        self.publishers['joints'].publish(joints)
        if seen is not None:
            self.publishers['detections'].publish(self.detections(seen, frame))

    def tell_transform(self, parent, child, matrix):
        """A word on tf about this moment."""
        transform = self.types['transform']()
        transform.header.stamp, transform.header.frame_id = self.rospy.Time.from_sec(self.t), parent
        transform.child_frame_id = child
        pose = self.pose_of(matrix)
        p = transform.transform.translation
        p.x, p.y, p.z = pose.position.x, pose.position.y, pose.position.z
        transform.transform.rotation = pose.orientation
        self.publishers['transforms'].publish(self.types['transforms'](transforms=[transform]))

    def detections(self, seen, frame=CAMERA):
        """What the camera says of this moment."""
        detections = self.msg.Detections()
        detections.header.stamp = self.rospy.Time.from_sec(self.t)
        detections.header.frame_id = frame
        X_CM = numpy.eye(4) if frame == 'map' else numpy.linalg.inv(self.link(CAMERA))
        for name, (model, X_MO) in seen.items():
            detections.detections.append(self.msg.Detection(
                instance=name, label=model, pose=self.pose_of(X_CM @ X_MO), visible_share=1.0))
        return detections

    def link(self, name):
        root = numpy.linalg.inv(self.robot.link('base_footprint', self.joints))
        return planar(*self.base) @ root @ self.robot.link(name, self.joints)

    def pose_of(self, matrix):
        pose = self.types['pose']()
        p, q = pose.position, pose.orientation
        p.x, p.y, p.z = matrix[:3, 3]
        q.x, q.y, q.z, q.w = quaternion(matrix)
        return pose

    def rest(self, ticks=10):
        for _ in range(ticks):
            self.tick()

    def look(self, seen, times=1):
        """Looks, each waited for until known_objects has its stamp."""
        for _ in range(times):
            self.tick(seen)
            stamp = self.t
            self.wait(lambda: self.known and
                      abs(self.known[-1].header.stamp.to_sec() - stamp) < 1e-3, 'the look')

    def wait(self, condition, what):
        with self.changed:
            if not self.changed.wait_for(condition, LIMIT):
                raise AssertionError('waited in vain for ' + self.with_output(what))

    def with_output(self, what):
        return '%s; the tracker said:\n%s\nthe Blackboard:\n%s' % (
            what, self.tracker.output(), self.blackboard.output())

    def said_until(self):
        """[s] until when the Blackboard has what was sensed."""
        return self.progress[-1].header.stamp.to_sec() if self.progress else 0.0

    # The Blackboard.

    def query(self, **fields):
        return self.rospy.ServiceProxy('blackboard/query', self.srv.QueryFluents)(
            query=self.msg.FluentQuery(**fields)).fluents

    def value(self, instance, role):
        """The first filler of the role: a name or a number; None if nothing holds."""
        for fluent in self.query(instance=instance):
            for p in fluent.properties:
                if p.role == role:
                    return p.real if p.type == 'xsd:float' else p.text.lower()
        return None

    def expect(self, instance, role, wanted, what=None):
        """Goes on sensing until the Blackboard says so."""
        def says():
            self.tick()
            value = self.value(instance, role)
            if isinstance(wanted, float) and value is not None:
                return abs(value - wanted) < 0.02
            return value == wanted
        wait_until(says, lambda: self.with_output(
            what or '%s %s %s' % (instance, role, wanted)))

    def names(self):
        return {thing.name: thing for thing in self.known[-1].objects} if self.known else {}

    # What the robot feels of itself.

    def test_place_and_postures_of_the_robot(self):
        self.expect('robotAtPR21', 'hasArea', 'nearstartarea1')
        def posture(instance):
            found = self.query(instance=instance)
            return found[0].concept_name if found else None
        wait_until(lambda: posture('postureLeftArm1') == 'ArmToSidePosture', 'the left arm')
        wait_until(lambda: posture('postureRightArm1') == 'ArmToSidePosture', 'the right arm')
        self.joints['torso_lift_joint'] = 0.295
        def torso_is_up():
            self.tick()
            return posture('postureTorso1') == 'TorsoUpPosture'
        wait_until(torso_is_up, 'the torso')
        self.base = (7.0, 10.1, 3.14)  # 0.2 m from its pose
        self.expect('robotAtPR21', 'hasArea', 'premanipulationareaeastcounter1')
        self.expect('posePR21', 'hasX', 7.0)

    # What it sees.

    def at_table(self):
        """South of table1, looking at it."""
        self.base = (7.68, 9.9, 1.57)
        self.joints['head_tilt_joint'] = 0.55

    def test_an_obstacle_is_known_once_it_is_seen(self):
        self.at_table()
        self.look({'book1': ('book', translation(7.48, 11.28, 0.73))})
        self.expect('onBook1', 'hasArea', 'placingareawestrighttable1')
        self.assertEqual(self.query(instance='book1')[0].concept_name, 'Book')
        self.expect('poseBook1', 'hasX', 7.48)
        self.assertEqual(self.names()['book1'].model, 'book')
        self.assertEqual(self.known[-1].header.frame_id, 'map')

    def test_what_is_seen_while_localisation_is_away_is_not_remembered_and_holds_up_nothing(self):
        self.at_table()
        book = {'book1': ('book', translation(7.48, 11.28, 0.73))}
        self.look(book)
        bowl = {'bowl1': ('bowl', translation(7.88, 11.28, 0.73))}
        for number in range(40):  # 2 s, far more than a correction may be late
            self.tick(bowl if number in (18, 20, 22) else None, is_localised=False)
        self.look(book)
        self.assertIn('book1', self.names())
        self.assertNotIn('bowl1', self.names())
        self.look({**book, **bowl})
        self.assertIn('bowl1', self.names())

    @long_case
    def test_an_object_may_be_seen_in_another_frame_than_the_cameras(self):
        self.at_table()
        self.rest()
        self.tick({'book1': ('book', translation(7.48, 11.28, 0.73))}, frame='map')
        self.expect('poseBook1', 'hasX', 7.48)
        self.expect('onBook1', 'hasArea', 'placingareawestrighttable1')

    @long_case
    def test_an_object_may_be_recognised_when_the_robot_looks_elsewhere(self):
        self.at_table()
        self.rest()
        late = self.detections({'book1': ('book', translation(7.48, 11.28, 0.73))})
        self.base = (8.68, 9.9, 1.57)
        self.joints['head_pan_joint'] = 0.8
        self.rest(20)
        self.publishers['detections'].publish(late)
        self.expect('poseBook1', 'hasX', 7.48)
        self.expect('poseBook1', 'hasY', 11.28)

    def test_what_is_believed_is_known_to_the_middle_layer_and_corrected_by_looking(self):
        self.wait(lambda: 'mug1' in self.names() or self.tick({}), 'the belief')
        self.assertAlmostEqual(self.names()['mug1'].pose.position.x, 5.37, places=2)
        self.base = (6.8, 10.1, 3.14)
        self.look({'mug1': ('coffee_cup', translation(5.45, 10.30, 0.75))}, 3)
        self.expect('poseMug1', 'hasX', 5.45)
        self.assertEqual(self.value('onMug1', 'hasArea'), 'placingareaeastrightcounter1')

    def test_an_object_that_is_not_where_it_was_has_vanished(self):
        self.at_table()
        mug = {'mug3': ('coffee_cup', translation(7.60, 11.25, 0.73))}
        self.look(mug)
        self.expect('onMug3', 'hasArea', 'placingareawestrighttable1')
        self.look({}, 3)
        self.assertNotIn('mug3', self.names())
        self.expect('onMug3', 'hasArea', None)
        self.expect('poseMug3', 'hasX', None)
        self.look(mug)
        self.expect('onMug3', 'hasArea', 'placingareawestrighttable1')

    def scan_tray(self, mug=None, frame='base_tray_laser_link'):
        """What the tray's laser measures of nothing but a mug of radius 0.04 at (x, y) from it."""
        scan = self.types['scan']()
        scan.header.stamp, scan.header.frame_id = self.rospy.Time.from_sec(self.t), frame
        scan.angle_min, scan.angle_increment = -1.4, 2.8 / 639
        scan.range_min, scan.range_max = 0.08, 10.0
        for i in range(640):
            angle = scan.angle_min + i * scan.angle_increment
            ahead = mug[0] * math.cos(angle) + mug[1] * math.sin(angle) if mug else 0.0
            root = 0.0016 - (mug[0] ** 2 + mug[1] ** 2 - ahead ** 2) if mug else -1.0
            scan.ranges.append(ahead - math.sqrt(root) if root > 0.0 and ahead > 0.0 else math.inf)
        self.publishers['tray'].publish(scan)

    def test_the_trays_laser_tells_what_is_there_and_what_is_gone(self):
        markers = []
        subscriber = self.rospy.Subscriber('tray_markers', self.types['markers'],
                                           self.note(markers))
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: subscriber.get_num_connections() > 0, 'the markers')

        def scanned(condition, mug):
            def comes_true():
                self.tick()
                self.scan_tray(mug)
                return condition()
            wait_until(comes_true, 'what scans say')
        laser = self.link('base_tray_laser_link')
        mug = laser @ translation(0.15, -0.1, -0.0198)
        self.look({'mug3': ('coffee_cup', mug)})
        self.expect('onMug3', 'hasArea', 'trayarea1')
        self.assertEqual(self.value('poseMug3', 'hasFrame'), 'base_footprint')
        there = numpy.linalg.inv(self.link('base_footprint')) @ laser @ translation(0.17, 0.12, 0.0)

        def is_there():
            x, y = self.value('poseMug3', 'hasX'), self.value('poseMug3', 'hasY')
            return x is not None and math.dist((x, y), there[:2, 3]) < 0.01
        scanned(is_there, (0.17, 0.12))
        scanned(lambda: markers and 'mug3' in [m.text for m in markers[-1].markers], (0.17, 0.12))
        last = markers[-1].markers
        self.assertEqual({m.ns for m in last}, {'clusters', 'boxes', 'names'})
        self.assertEqual({m.header.frame_id for m in last}, {'base_footprint'})
        self.assertTrue(all(0.0 < m.lifetime.to_sec() < 1.0 for m in last))
        points = [p for m in last if m.ns == 'clusters' for p in m.points]
        self.assertGreater(len(points), 50)
        scanned(lambda: self.value('onMug3', 'hasArea') is None, None)
        self.assertIsNone(self.value('poseMug3', 'hasX'))
        scanned(lambda: self.value('onUnknown1', 'hasArea') == 'trayarea1', (0.12, 0.0))
        self.until_warned(lambda: self.publishers['tray'].publish(self.types['scan']()),
                          'tray_laser_scan')

        def submarine():
            self.tick()
            self.scan_tray(None, 'submarine')
        self.until_warned(submarine, "frame 'submarine' is unknown to tf")

    def cloud(self, points, frame='base_footprint', stamp=None):
        """What the tilting laser's sweep has measured until now; `points` [m]: N x 3, in the frame."""
        cloud = self.types['cloud']()
        cloud.header.stamp = self.rospy.Time.from_sec(self.t if stamp is None else stamp)
        cloud.header.frame_id = frame
        cloud.height, cloud.width, cloud.point_step = 1, len(points), 12
        cloud.row_step = cloud.point_step * cloud.width
        cloud.fields = [self.types['field'](name, 4 * i, 7, 1) for i, name in enumerate('xyz')]
        cloud.data = numpy.asarray(points, numpy.float32).tobytes()
        return cloud

    def floor_with_box(self):
        """The floor ahead of the robot, and a box 0.2 m wide and high 1.2 m ahead that hides some."""
        x, y = numpy.meshgrid(numpy.arange(0.6, 2.0, 0.025), numpy.arange(-0.8, 0.8, 0.025))
        floor = numpy.stack([x, y, numpy.zeros_like(x)], -1).reshape(-1, 3)
        hidden = (floor[:, 0] > 1.1) & (numpy.abs(floor[:, 1]) < 0.15)
        y, z = numpy.meshgrid(numpy.arange(-0.1, 0.1, 0.02), numpy.arange(0.02, 0.2, 0.02))
        front = numpy.stack([numpy.full_like(y, 1.1), y, z], -1).reshape(-1, 3)
        x, y = numpy.meshgrid(numpy.arange(1.1, 1.3, 0.02), numpy.arange(-0.1, 0.1, 0.02))
        top = numpy.stack([x, y, numpy.full_like(x, 0.2)], -1).reshape(-1, 3)
        return numpy.concatenate([floor[~hidden], front, top])

    @long_case
    def test_clouds_that_cannot_be_are_told_of_and_those_that_can_show_what_stands_there(self):
        self.rest()
        good = self.floor_with_box()
        self.publishers['cloud'].publish(self.cloud(numpy.full_like(good, math.nan)))
        self.rest()
        big = self.cloud(good)
        big.is_bigendian = True

        def after_tick(cloud):
            def send():
                self.tick()
                self.publishers['cloud'].publish(cloud())
            return send

        def bad_messages():
            return int(diagnostics(self.rospy, 'world_tracker', lambda v: True)['bad messages'])
        for cloud, why in ((lambda: big, 'big-endian'),
                           (lambda: self.cloud(good, stamp=0.0), 'header.stamp is 0'),
                           (lambda: self.cloud(good, 'submarine'),
                            "frame 'submarine' is unknown to tf")):
            before = bad_messages()
            self.until_warned(after_tick(cloud), why)
            diagnostics(self.rospy, 'world_tracker', lambda v: int(v['bad messages']) > before)
        self.look({})
        self.assertEqual([name for name in self.names() if name.startswith('obstacle')], [])

        def is_known():
            # A tracker that is held up keeps two clouds and lets older ones go, so two may not do here
            # (FloorByCloudsTest counts them).
            self.tick({})
            self.publishers['cloud'].publish(self.cloud(good))
            return 'obstacle1' in self.names()
        wait_until(is_known, lambda: self.with_output('the obstacle'))
        diagnostics(self.rospy, 'world_tracker', lambda v: v['things on the floor'] == '1')
        p = self.names()['obstacle1'].pose.position
        x, y, yaw = self.base
        self.assertAlmostEqual(p.x, x + 1.2 * math.cos(yaw), delta=0.05)
        self.assertAlmostEqual(p.y, y + 1.2 * math.sin(yaw), delta=0.05)

    @long_case
    def test_what_may_be_either_of_two_objects_is_told_to_be_ambiguous(self):
        def shift(x):
            return translation(7.60 + x, 11.25, 0.73)
        self.at_table()
        self.look({'mug3': ('coffee_cup', shift(-0.08)), 'mug4': ('coffee_cup', shift(0.08))})
        self.look({'': ('coffee_cup', shift(0.0))}, 2)
        ambiguous = 'things ambiguous in the last look'
        diagnostics(self.rospy, 'world_tracker', lambda v: v[ambiguous] == '1')
        self.look({'': ('coffee_cup', shift(0.07))})
        diagnostics(self.rospy, 'world_tracker', lambda v: v[ambiguous] == '0')

    @long_case
    def test_an_object_that_fell_is_on_nothing(self):
        self.at_table()
        upright = translation(7.60, 11.25, 0.73)
        self.look({'mug3': ('coffee_cup', upright)})
        self.expect('onMug3', 'hasArea', 'placingareawestrighttable1')
        lying = translation(7.60, 11.25, 0.77)
        lying[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
        self.look({'mug3': ('coffee_cup', lying)})
        self.expect('onMug3', 'hasArea', None)
        self.assertIsNotNone(self.value('poseMug3', 'hasX'))

    def test_grasp_carry_and_slip(self):
        for name, position in UNTUCKED.items():
            self.joints['r_%s_joint' % name] = position
        self.joints['r_gripper_joint'] = 0.09
        self.base = (12.5, 11.8, 0.0)
        tool = self.link('r_gripper_tool_frame')[:3, 3]
        self.joints['head_pan_joint'], self.joints['head_tilt_joint'] = -0.6, 0.9
        mug = {'mug3': ('coffee_cup', translation(*(tool - (0, 0, 0.04))))}
        self.look(mug)
        self.expect('poseMug3', 'hasX', float(tool[0]))
        self.assertEqual(self.value('holdingRightArm1', 'hasPassiveObject'), 'nothing')
        before = self.detections({'mug3': ('coffee_cup', translation(*(tool - (0.2, 0, 0.04))))})
        self.joints['r_gripper_joint'] = 0.079
        self.rest()
        self.publishers['detections'].publish(before)  # where it stood before it was grasped
        self.rest()
        self.expect('holdingRightArm1', 'hasPassiveObject', 'mug3')
        self.expect('poseMug3', 'hasFrame', 'r_gripper_palm_link')
        self.look(mug)
        self.assertEqual(self.names()['mug3'].attached_to, 'r_gripper_palm_link')
        # It travels with the robot, and nothing new is said of it.
        x_in_hand = self.value('poseMug3', 'hasX')
        self.base = (13.0, 11.3, 3.14)
        self.expect('robotAtPR21', 'hasArea', 'home')
        self.assertEqual(self.value('poseMug3', 'hasX'), x_in_hand)
        self.joints['r_gripper_joint'] = 0.0
        self.expect('holdingRightArm1', 'hasPassiveObject', 'nothing')
        self.expect('poseMug3', 'hasX', None)

    # When things go wrong.

    def until_warned(self, send, text):
        """Of each topic there is one warning a second; so what is wrong is sent until it is told."""
        def is_told():
            send()
            return any(text in line for line in self.tracker.lines)
        wait_until(is_told, 'the warning: ' + text)

    @long_case
    def test_how_warm_objects_are_is_said_unless_it_is_ambiguous_or_no_number(self):
        def told(name, degrees, *mixed_with):
            return self.msg.ObjectTemperature(object=name, temperature=degrees, num_pixels=100,
                                              mixed_with=list(mixed_with))
        temperatures = self.msg.ObjectTemperatures(
            objects=[told('mug2', 62.5), told('mug1', 50.0, 'peppermill1'),
                     told('peppermill1', math.nan)])
        self.at_table()
        self.rest()
        self.until_warned(lambda: self.publishers['temperatures'].publish(temperatures),
                          "object 'peppermill1': temperature is nan")
        self.rest()
        self.assertEqual(self.query(instance='hasTemperatureMug2'), [], 'nobody has seen it yet')
        self.look({'mug2': ('coffee_cup', translation(7.48, 11.28, 0.73))}, times=2)
        self.publishers['temperatures'].publish(temperatures)
        self.expect('hasTemperatureMug2', 'hasDegrees', 62.5)
        self.assertEqual(self.value('hasTemperatureMug2', 'hasPhysicalEntity'), 'mug2')
        self.assertEqual(self.query(instance='hasTemperatureMug1'), [])
        self.assertEqual(self.query(instance='hasTemperaturePeppermill1'), [])

    def test_what_is_told_to_be_on_the_blackboard_is_there(self):
        self.at_table()
        for x in (7.48, 7.58):
            self.look({'book1': ('book', translation(x, 11.28, 0.73))})
            self.rest()  # the moment of the look itself may be told without it
            self.wait(lambda: self.said_until() >= self.t - 1e-3, 'the progress')
            self.assertAlmostEqual(self.value('poseBook1', 'hasX'), x, delta=0.02)
            self.assertGreater(self.progress[-1].sequence, 0)

    @long_case
    def test_the_blackboard_is_away_for_a_while(self):
        self.expect('robotAtPR21', 'hasArea', 'nearstartarea1')
        self.blackboard.kill()
        self.at_table()
        self.rest(20)
        self.look({'book1': ('book', translation(7.48, 11.28, 0.73))})
        self.tick()
        seen = self.t - 1e-3  # stamps are rounded
        wait_until(lambda: any('observation=unwritten' in line for line in self.tracker.lines),
                   'word that nobody takes it')
        self.assertLess(self.said_until(), seen)
        self.start_blackboard()
        self.wait(lambda: self.said_until() >= seen, 'the progress')
        self.assertEqual(self.value('onBook1', 'hasArea'), 'placingareawestrighttable1',
                         'what was seen meanwhile, without another look')
        self.assertEqual(self.value('poseBook1', 'hasFrame'), None)

    @long_case
    def test_what_is_seen_after_the_end_of_an_episode_is_no_fault(self):
        def call(service, kind, **fields):
            answer = self.rospy.ServiceProxy('blackboard/' + service, kind)(**fields)
            self.assertEqual(answer.error.code, 0, answer.error.message)
            return answer
        self.expect('robotAtPR21', 'hasArea', 'nearstartarea1')
        episode = call('start_episode', self.srv.StartEpisode, task='serve').episode.id
        self.add_task(episode)
        self.at_table()
        self.expect('robotAtPR21', 'hasArea', 'premanipulationareasouthtable1')
        written = {fluent.instance for fluent in self.query(in_episode=True, episode=episode)}
        self.assertEqual(written & {'task1', 'robotAtPR21'}, {'task1', 'robotAtPR21'})
        call('finish_episode', self.srv.FinishEpisode, id=episode, outcome='succeeded')
        self.look({'book1': ('book', translation(7.48, 11.28, 0.73))})
        self.expect('onBook1', 'hasArea', 'placingareawestrighttable1')
        self.assertNotIn('unwritten', self.tracker.output())

    def test_bad_input_is_warned_of_and_changes_nothing(self):
        self.at_table()
        self.look({})
        book = translation(7.48, 11.28, 0.73)
        nan = book.copy()
        nan[0, 3] = math.nan
        self.until_warned(lambda: self.tick({'teapot1': ('teapot', book)}),
                          "object model 'teapot' is unknown")
        self.look({'book1': ('book', book), 'vase1': ('vase', nan), '': ('book', book)})
        self.assertEqual(set(self.names()) & {'book1', 'vase1', ''}, {'book1'})
        self.until_warned(lambda: self.tick({'book2': ('book', book)}, frame='submarine'),
                          "frame 'submarine' is unknown to tf")
        self.until_warned(lambda: self.tell_transform('map', 'odom_combined', nan),
                          "'map' -> 'odom_combined': it is not finite")
        odometry = self.types['base_odometry']()
        odometry.header.stamp = self.rospy.Time.from_sec(self.t)
        odometry.header.frame_id, odometry.child_frame_id = 'odom_combined', 'trailer'
        self.until_warned(lambda: self.publishers['odometry'].publish(odometry),
                          "frame 'trailer' is unknown to tf")
        joints = self.types['joints']()
        self.until_warned(lambda: self.publishers['joints'].publish(joints), 'header.stamp is 0')
        joints.header.stamp = self.rospy.Time.from_sec(self.t)
        joints.name, joints.position = ['torso_lift_joint'], [math.nan]
        self.until_warned(lambda: self.publishers['joints'].publish(joints), 'torso_lift_joint')
        joints.name, joints.position = ['torso_lift_joint', 'x'], [0.1]
        self.until_warned(lambda: self.publishers['joints'].publish(joints),
                          '2 names and 1 positions')
        old, self.t = self.t, self.t - 3.5
        self.tick({'book3': ('book', book)})  # a look of long ago
        self.t = old
        self.look({'book1': ('book', book)})
        self.assertEqual(set(self.names()) & {'book1', 'book2', 'book3'}, {'book1'})
        self.expect('onBook1', 'hasArea', 'placingareawestrighttable1')

    def test_bad_parameters_end_the_node(self):
        for argument, text in (('_config:=/nowhere.yaml', '/nowhere.yaml'), ('_swep:=x', 'swep')):
            arguments = ['__name:=other%d' % len(self.nodes), argument]
            if not argument.startswith('_config'):
                arguments.append('_config:=' + CONFIG + '/world_tracker.yaml')
            node = self.start('world_tracker', *arguments)
            self.assertNotEqual(node.wait(), 0)
            self.assertIn(text, node.output())

    # The head.

    def add_task(self, episode=0):
        task = self.msg.Fluent(concept_name='ServeCoffeeToGuestTask', instance='task1', properties=[
            self.msg.FluentProperty(role='hasArgument', type='xsd:string', text='guest1')])
        by = self.msg.Assertion(source=self.msg.Assertion.MONITOR, episode=episode)
        answer = self.rospy.ServiceProxy('blackboard/add', self.srv.WriteFluents)(
            fluents=[task], by=by)
        self.assertEqual(answer.error.code, 0, answer.error.message)

    def test_the_head_sweeps_the_places_of_the_task_unless_an_action_needs_it(self):
        self.at_table()
        self.joints['head_tilt_joint'] = -0.3  # at the ceiling
        goal = self.msg.ExecuteActionActionGoal()
        goal.goal_id.id = 'other-1'
        goal.goal.action.name = '!pick_up_object'
        self.publishers['goal'].publish(goal)
        self.add_task()
        self.look({}, 3)
        self.rest(60)
        self.assertEqual(self.turns, [])
        result = self.msg.ExecuteActionActionResult()
        result.status.goal_id.id = 'other-1'
        self.publishers['result'].publish(result)
        def has_turned():
            self.tick()
            return self.turns
        wait_until(has_turned, 'the head to turn')
        self.assertEqual(self.turns[0].joint_names, ['head_pan_joint', 'head_tilt_joint'])
        self.assertGreater(self.turns[0].points[-1].positions[1], 0.2)  # down at the table


if __name__ == '__main__':
    run_test('world_tracker_node', WorldTrackerTest)
