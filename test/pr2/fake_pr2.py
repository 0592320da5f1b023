#!/usr/bin/env python3
"""A PR2 that is none, for tests: names, types and habits of the real one in front of a kinematic
world. It shares no code with HIRES. Parameters: ~world (SDF), ~urdf, ~world_in_map (x y yaw of the
world's frame in the map), ~pose (x y yaw in the world), ~torso [m], ~objects ([name, model, x, y,
z] ...), ~seed, ~latched_map (false: static_map alone).

Besides the PR2's own topics and services there are, under fake_pr2/, the test's hands:
joystick (Twist), halt_motors, freeze_localisation, freeze_scan, lose_localisation (SetBool),
truth (Odometry: where the base really is), objects (WorldState: where things really are)."""

import collections
import ctypes
import os
import signal
import sys
import threading
import time

import numpy
import rospy
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped, Twist
from hires.msg import Detection, Detections, ObjectState, WorldState
from nav_msgs.msg import OccupancyGrid, Odometry
from nav_msgs.srv import GetMap, GetMapResponse
from sensor_msgs.msg import JointState, LaserScan
from std_msgs.msg import Bool
from std_srvs.srv import Empty, EmptyResponse, SetBool, SetBoolResponse
from trajectory_msgs.msg import JointTrajectory

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from fake import base as bases  # noqa: E402
from fake import camera as cameras  # noqa: E402
from fake import hands, joints, laser  # noqa: E402
from fake.messages import Pr2GripperCommand  # noqa: E402
from fake.scene import Grid, Pose2, Scene  # noqa: E402
from pr2_frames import Robot  # noqa: E402

STEP = 0.01         # [s] of the base and of the loop: odometry at 100 Hz
SCAN_PERIOD = 0.05  # [s]
EKF_PERIOD = 1 / 30  # [s] of robot_pose_ekf
SLOW_PERIOD = 0.1   # [s] of what only tests look at
LATEST_START = 0.25  # [s] that the loop may lag behind and still catch up


class FakePr2:
    def __init__(self):
        get = rospy.get_param
        self.X_MW = Pose2(*get('~world_in_map', [0.0, 0.0, 0.0]))
        seed = get('~seed', 1)
        scene = Scene(get('~world'), self.X_MW)
        at_laser = scene.slice(laser.HEIGHT)
        self.laser = laser.Laser(at_laser, seed)
        self.map = map_message(Grid(at_laser))
        with open(get('~urdf')) as file:
            urdf = file.read()
        self.robot = Robot(get('~urdf'))
        self.limits = joints.Limits(urdf)
        self.positions = joints.initial_positions()
        self.positions['torso_lift_joint'] = get('~torso', joints.TORSO_DOWN)
        self.controllers = {name: joints.TrajectoryController(own, self.limits, self.positions)
                            for name, own in joints.CONTROLLERS.items()}
        self.base = bases.Base(self.X_MW * Pose2(*get('~pose')))
        self.wheels = bases.Odometer(bases.WHEEL_SLIP, bases.WHEEL_TURN_SLIP)
        self.ekf = bases.Odometer(bases.WHEEL_SLIP, 0.0)
        self.amcl = bases.Amcl(seed + 1)
        self.mux = bases.Multiplexer()
        self.world = hands.World(scene, lambda link: self.robot.link(link, self.positions))
        for name, model, x, y, z in get('~objects', []):
            self.world.add(name, model, *self.X_MW.apply(x, y), z, self.X_MW.yaw)
        self.camera = cameras.Camera(self.world, seed + 2)
        self.frozen = set()          # of 'scan', 'localisation'
        self.is_halted = False
        self.commands = collections.deque()  # (what to do) from the threads of subscribers
        self.mux_lock = threading.Lock()
        self.due = {}
        self.advertise()
        self.subscribe()

    # Wiring -------------------------------------------------------------------------------------

    def advertise(self):
        publisher = rospy.Publisher
        fast = dict(queue_size=100, tcp_nodelay=True)
        self.base_command = publisher('base_controller/command', Twist, **fast)
        self.odometry = publisher('base_odometry/odom', Odometry, **fast)
        self.ekf_pose = publisher('robot_pose_ekf/odom_combined', PoseWithCovarianceStamped, **fast)
        self.joint_states = publisher('joint_states', JointState, **fast)
        self.scan = publisher('base_scan', LaserScan, **fast)
        self.amcl_pose = publisher('amcl_pose', PoseWithCovarianceStamped, latch=True, queue_size=2)
        self.halted = publisher('pr2_ethercat/motors_halted', Bool, latch=True, queue_size=1)
        self.detections = publisher('detections', Detections, queue_size=10)
        self.truth = publisher('fake_pr2/truth', Odometry, **fast)
        self.objects = publisher('fake_pr2/objects', WorldState, queue_size=10)
        self.broadcaster = tf2_ros.TransformBroadcaster()
        if rospy.get_param('~latched_map', True):
            self.map_topic = publisher('map', OccupancyGrid, latch=True, queue_size=1)
            self.map_topic.publish(self.map)
        rospy.Service('static_map', GetMap, lambda _: GetMapResponse(self.map))
        self.halted.publish(False)

    def subscribe(self):
        subscriber = rospy.Subscriber
        more = dict(queue_size=100, tcp_nodelay=True)
        subscriber('base_controller/command', Twist, self.later(self.on_base), **more)
        subscriber('navigation/cmd_vel', Twist, self.on_navigation, **more)
        subscriber('fake_pr2/joystick', Twist, self.on_joystick, **more)
        for name in self.controllers:
            subscriber(name + '/command', JointTrajectory,
                       self.later(lambda m, n=name: self.on_trajectory(n, m)), **more)
        for side in ('l', 'r'):
            subscriber(side + '_gripper_controller/command', Pr2GripperCommand,
                       self.later(lambda m, s=side: self.world.hands[s].command(m.position)),
                       **more)
        for name, action in (('halt_motors', self.halt),
                             ('freeze_localisation', lambda on: self.freeze('localisation', on)),
                             ('freeze_scan', lambda on: self.freeze('scan', on)),
                             ('lose_localisation', self.lose)):
            rospy.Service('fake_pr2/' + name, SetBool, lambda r, a=action: self.now(a, r.data))
        for name, on in (('halt_motors', True), ('reset_motors', False)):
            rospy.Service('pr2_ethercat/' + name, Empty,
                          lambda _, o=on: EmptyResponse() if self.now(self.halt, o) else None)

    def later(self, function):
        """A callback whose work is done by the loop."""
        return lambda message: self.commands.append(lambda: function(message))

    def now(self, action, on):
        """The answer of a service once the loop has done the action."""
        done = threading.Event()
        self.commands.append(lambda: (action(on), done.set()))
        done.wait()
        return SetBoolResponse(True, '')

    # What others want ---------------------------------------------------------------------------

    def on_navigation(self, twist):
        with self.mux_lock:
            admitted = self.mux.admits_navigation(time.monotonic())
        if admitted:
            self.base_command.publish(twist)

    def on_joystick(self, twist):
        with self.mux_lock:
            self.mux.joystick(time.monotonic())
        self.base_command.publish(twist)

    def on_base(self, twist):
        self.base.command(twist.linear.x, twist.linear.y, twist.angular.z)

    def on_trajectory(self, name, trajectory):
        if self.is_halted:
            return
        refusal = self.controllers[name].command(self.time, trajectory)
        if refusal:
            rospy.logerr('%s: %s', name, refusal)

    def halt(self, on):
        self.is_halted = self.base.is_halted = on
        for hand in self.world.hands.values():
            hand.is_halted = on
        for controller in self.controllers.values():
            controller.hold()
        self.halted.publish(on)

    def freeze(self, what, on):
        (self.frozen.add if on else self.frozen.discard)(what)

    def lose(self, on):
        """Off: somebody told it where it is (initialpose); then amcl speaks at once."""
        self.amcl.is_lost = on
        if not on:
            self.amcl.forget()

    # The loop -----------------------------------------------------------------------------------

    def run(self):
        self.time = rospy.get_time()
        while not rospy.is_shutdown():
            now = rospy.get_time()
            if now < self.time + STEP:
                time.sleep(self.time + STEP - now)
                continue
            self.time = max(self.time, now - LATEST_START)
            self.base.begin_turn(now - self.time)
            while self.commands:
                self.commands.popleft()()
            while self.time + STEP <= now:
                self.step()

    def step(self):
        self.time += STEP
        self.base.step(STEP)
        self.wheels.step(self.base.V_B, STEP)
        self.ekf.step(self.base.V_B, STEP)
        for controller in self.controllers.values():
            controller.step(self.time, STEP)
        self.world.move_base(self.base.X_MB)
        self.world.step(STEP)
        self.publish()

    def is_due(self, what, period):
        if self.time < self.due.get(what, 0.0) - 1e-6:
            return False
        self.due[what] = max(self.due.get(what, 0.0) + period, self.time)
        return True

    def publish(self):
        stamp = rospy.Time.from_sec(self.time)
        self.odometry.publish(self.odometry_message(stamp))
        self.truth.publish(self.truth_message(stamp))
        self.joint_states.publish(self.joint_message(stamp))
        if self.is_due('ekf', EKF_PERIOD):
            self.publish_ekf(stamp)
        if self.is_due('scan', SCAN_PERIOD):
            if 'scan' not in self.frozen:
                self.scan.publish(self.scan_message(stamp))
            if 'localisation' not in self.frozen:
                self.localise(stamp)
        if self.is_due('look', cameras.PERIOD) and self.is_head_still():
            self.detections.publish(self.detections_message(stamp))
        if self.is_due('slow', SLOW_PERIOD):
            self.objects.publish(self.objects_message(stamp))

    def is_head_still(self):
        speeds = self.controllers['head_traj_controller'].velocities.values()
        return all(abs(speed) <= cameras.STILL for speed in speeds)

    def publish_ekf(self, stamp):
        pose = PoseWithCovarianceStamped()
        pose.header.stamp, pose.header.frame_id = stamp, 'odom_combined'
        fill_pose(pose.pose.pose, self.ekf.X_OB)
        self.ekf_pose.publish(pose)
        self.broadcaster.sendTransform(
            transform('odom_combined', 'base_footprint', self.ekf.X_OB, stamp))

    def localise(self, stamp):
        corrected = self.amcl.update(self.base.X_MB, self.ekf.X_OB)
        if corrected:
            believed, spread = corrected
            pose = PoseWithCovarianceStamped()
            pose.header.stamp, pose.header.frame_id = stamp, 'map'
            fill_pose(pose.pose.pose, believed)
            for index, sd in zip((0, 7, 35), spread):
                pose.pose.covariance[index] = sd * sd
            self.amcl_pose.publish(pose)
        ahead = stamp + rospy.Duration(self.amcl.TOLERANCE)
        self.broadcaster.sendTransform(transform('map', 'odom_combined', self.amcl.X_MO, ahead))

    # Messages -----------------------------------------------------------------------------------

    def odometry_message(self, stamp):
        """As pr2_odometry: the frame "odom" of the wheels alone, and no child frame."""
        message = Odometry()
        message.header.stamp, message.header.frame_id = stamp, 'odom'
        fill_pose(message.pose.pose, self.wheels.X_OB)
        fill_twist(message.twist.twist, self.wheels.V_B)
        is_still = not numpy.any(numpy.abs(self.wheels.V_B) > 1e-8)
        for index, sd in ((0, 0.002), (7, 0.002), (35, 0.017)):
            message.pose.covariance[index] = 1e-12 if is_still else sd * sd
        for index in (14, 21, 28):
            message.pose.covariance[index] = sys.float_info.max
        message.twist.covariance = message.pose.covariance
        return message

    def truth_message(self, stamp):
        message = Odometry()
        message.header.stamp, message.header.frame_id = stamp, 'map'
        fill_pose(message.pose.pose, self.base.X_MB)
        fill_twist(message.twist.twist, self.base.V_B)
        return message

    def joint_message(self, stamp):
        positions = self.positions
        speeds = {}
        for controller in self.controllers.values():
            speeds.update(controller.velocities)
        for side, hand in self.world.hands.items():
            angle = joints.finger_angle(hand.gap)
            for finger in ('l_finger', 'r_finger', 'l_finger_tip', 'r_finger_tip'):
                positions['%s_gripper_%s_joint' % (side, finger)] = angle
            positions[side + '_gripper_joint'] = hand.gap
            speeds[side + '_gripper_joint'] = hand.velocity
        message = JointState()
        message.header.stamp = stamp
        message.name = joints.NAMES
        message.position = [positions[name] for name in joints.NAMES]
        message.velocity = [speeds.get(name, 0.0) for name in joints.NAMES]
        message.effort = [0.0] * len(joints.NAMES)
        return message

    def scan_message(self, stamp):
        message = LaserScan()
        message.header.stamp, message.header.frame_id = stamp, 'base_laser_link'
        message.angle_min, message.angle_max = -laser.ANGLE, laser.ANGLE
        message.angle_increment = 2 * laser.ANGLE / (laser.NUM_BEAMS - 1)
        message.scan_time = SCAN_PERIOD
        message.range_min, message.range_max = laser.RANGE_MIN, laser.RANGE_MAX
        message.ranges = self.laser.scan(self.base.X_MB)
        return message

    def detections_message(self, stamp):
        message = Detections()
        message.header.stamp, message.header.frame_id = stamp, cameras.LINK
        for thing, X_CO, share in self.camera.look():
            seen = Detection(instance=thing.name, label=thing.model, confidence=1.0,
                             visible_share=share)
            fill_frame(seen.pose, X_CO)
            message.detections.append(seen)
        return message

    def objects_message(self, stamp):
        message = WorldState()
        message.header.stamp, message.header.frame_id = stamp, 'map'
        for thing in self.world.things.values():
            state = ObjectState(name=thing.name, model=thing.model,
                                attached_to='' if thing.parent is None else
                                'base_footprint' if thing.parent == 'base' else thing.parent)
            fill_frame(state.pose, self.world.pose(thing))
            message.objects.append(state)
        return message


def fill_pose(message, pose):
    message.position.x, message.position.y = pose.x, pose.y
    message.orientation.z = numpy.sin(pose.yaw / 2)
    message.orientation.w = numpy.cos(pose.yaw / 2)


def fill_frame(message, X):
    message.position.x, message.position.y, message.position.z = X[:3, 3]
    (message.orientation.x, message.orientation.y, message.orientation.z,
     message.orientation.w) = quaternion(X)


def quaternion(X):
    """x, y, z, w of any rotation: the largest of the four first."""
    m = X[:3, :3]
    squares = numpy.array([1 + m[0, 0] - m[1, 1] - m[2, 2], 1 - m[0, 0] + m[1, 1] - m[2, 2],
                           1 - m[0, 0] - m[1, 1] + m[2, 2], 1 + numpy.trace(m)])
    k = int(numpy.argmax(squares))
    products = numpy.array([
        [squares[0], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
        [m[0, 1] + m[1, 0], squares[1], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
        [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], squares[2], m[1, 0] - m[0, 1]],
        [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], squares[3]]])
    return products[k] / numpy.linalg.norm(products[k])


def fill_twist(message, V):
    message.linear.x, message.linear.y, message.angular.z = V


def transform(parent, child, pose, stamp):
    message = TransformStamped()
    message.header.stamp, message.header.frame_id, message.child_frame_id = stamp, parent, child
    message.transform.translation.x, message.transform.translation.y = pose.x, pose.y
    message.transform.rotation.z = numpy.sin(pose.yaw / 2)
    message.transform.rotation.w = numpy.cos(pose.yaw / 2)
    return message


def map_message(grid):
    """As map_server says it."""
    message = OccupancyGrid()
    message.header.frame_id = 'map'
    message.header.stamp = message.info.map_load_time = rospy.Time.now()
    message.info.resolution = grid.resolution
    message.info.width, message.info.height = grid.width, grid.height
    message.info.origin.position.x, message.info.origin.position.y = grid.x, grid.y
    message.info.origin.orientation.w = 1.0
    message.data = (grid.is_occupied * 100).astype(numpy.int8).ravel().tolist()
    return message


if __name__ == '__main__':
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG: not without its roslaunch
    rospy.init_node('fake_pr2')
    FakePr2().run()
