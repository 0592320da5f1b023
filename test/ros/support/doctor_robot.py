#!/usr/bin/env python3
"""A robot for `hires doctor --robot`: nodes that offer what a PR2 offers, less or other where a test
says so. It has no physics: it says the same all the time.

    doctor_robot.py robot '{"without": ["base_scan", "r_wrist_roll_joint"], "halted": true}'
    doctor_robot.py move_base_node '{"drives": "base_guard/cmd_vel"}'

Faults of the robot: without (topics, commands, joints, frames, parameters), types ({topic: type}),
offset ({topic or frame: seconds added to stamps}), rate ({topic: Hz}), silent (topics that are
advertised and never sent), halted, odometry_frame (name), between (frames from map to it),
more_parents ({frame: parent}), served_map (a service instead of the topic), clock (seconds by which
all clocks of this process are ahead), tells_no_time (its HTTP answers have no date, as those of
roscpp).
Of move_base: without (action, planner, updates), drives (topic of its velocities), parameters,
goal_type, clock, tells_no_time."""

import http.server
import json
import os
import sys
import time

SPEC = json.loads(sys.argv[2]) if len(sys.argv) > 2 else {}
if SPEC.get('tells_no_time'):
    http.server.BaseHTTPRequestHandler.date_time_string = lambda *_: ''
if SPEC.get('clock'):
    _time = time.time
    time.time = lambda: _time() + SPEC['clock']  # before anybody else takes it

import genpy.dynamic  # noqa: E402
import roslib.message  # noqa: E402
import rospy  # noqa: E402
import yaml  # noqa: E402
from dynamic_reconfigure.msg import Config, DoubleParameter  # noqa: E402
from dynamic_reconfigure.srv import Reconfigure, ReconfigureResponse  # noqa: E402
from geometry_msgs.msg import TransformStamped  # noqa: E402
from nav_msgs.srv import GetMap, GetMapResponse  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

CONFIG = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', '..', 'config', 'robots')
RATE = 100.0  # [Hz] of a PR2's odometry
SCAN_RATE = 20.0

TOPICS = {'base_odometry/odom': 'nav_msgs/Odometry', 'joint_states': 'sensor_msgs/JointState',
          'base_scan': 'sensor_msgs/LaserScan'}
LATCHED = {'amcl_pose': 'geometry_msgs/PoseWithCovarianceStamped',
           'pr2_ethercat/motors_halted': 'std_msgs/Bool', 'map': 'nav_msgs/OccupancyGrid'}
COMMANDS = {'navigation/cmd_vel': 'geometry_msgs/Twist',
            'torso_controller/command': 'trajectory_msgs/JointTrajectory',
            'head_traj_controller/command': 'trajectory_msgs/JointTrajectory',
            'l_arm_controller/command': 'trajectory_msgs/JointTrajectory',
            'r_arm_controller/command': 'trajectory_msgs/JointTrajectory',
            'l_gripper_controller/command': 'pr2_controllers_msgs/Pr2GripperCommand',
            'r_gripper_controller/command': 'pr2_controllers_msgs/Pr2GripperCommand'}
# Not in Debian; the definition is what makes the type.
GRIPPER = {'pr2_controllers_msgs/Pr2GripperCommand': 'float64 position\nfloat64 max_effort\n'}
PARAMETERS = ['max_vel_x', 'max_trans_vel', 'max_rot_vel', 'acc_lim_x', 'acc_lim_y', 'acc_lim_th']


def lacks(what):
    return what in SPEC.get('without', [])


def message_class(kind):
    if kind in GRIPPER:
        return genpy.dynamic.generate_dynamic(kind, GRIPPER[kind])[kind]
    return roslib.message.get_message_class(kind)


def read_profile():
    with open(os.path.join(CONFIG, 'pr2.yaml')) as file:
        return yaml.safe_load(file)


def joints_of(profile):
    body = profile['upper_body']
    names = [body['torso']['joint'], body['head']['pan_joint'], body['head']['tilt_joint']]
    for arm in body['arms'].values():
        names += arm['joints'] + [arm['gripper_joint']]
    return [name for name in names if not lacks(name)]


def links_of(profile):
    body = profile['upper_body']
    links = [profile['tray_link'], profile['laser_link'], body['camera']['link']]
    for arm in body['arms'].values():
        links += [arm['palm_link'], arm['tool_link']]
    return links


def stamp_of(what):
    return rospy.Time.from_sec(time.time() + SPEC.get('offset', {}).get(what, 0.0))


class Robot:
    def __init__(self):
        profile = read_profile()
        self.joints = joints_of(profile)
        self.publishers, self.next = {}, {}
        for topic, kind in list(TOPICS.items()) + list(LATCHED.items()):
            self.advertise(topic, SPEC.get('types', {}).get(topic, kind))
        for topic, kind in COMMANDS.items():
            if not lacks(topic):
                rospy.Subscriber(topic, message_class(SPEC.get('types', {}).get(topic, kind)),
                                 lambda _: None)
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        self.tf_static = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.tf_static.publish([transform('base_footprint', link) for link in links_of(profile)
                                if not lacks(link)])
        if 'served_map' in SPEC:
            rospy.Service('static_map', GetMap, lambda _: GetMapResponse())
        if not lacks('robot_description'):
            rospy.set_param('robot_description', '<robot name="pr2"/>')
        for topic in LATCHED:
            self.send(topic)

    def advertise(self, topic, kind):
        if lacks(topic):
            return
        self.publishers[topic] = rospy.Publisher(topic, message_class(kind), queue_size=10,
                                                 latch=topic in LATCHED)

    def send(self, topic):
        if topic not in self.publishers or topic in SPEC.get('silent', []):
            return
        message = self.publishers[topic].data_class()
        if hasattr(message, 'header'):
            message.header.stamp = stamp_of(topic)
        if message._type == 'sensor_msgs/JointState':
            message.name = self.joints
            message.position = [0.0] * len(self.joints)
        if message._type == 'std_msgs/Bool':
            message.data = SPEC.get('halted', False)
        self.publishers[topic].publish(message)

    def send_frames(self):
        odometry = SPEC.get('odometry_frame', 'odom_combined')
        line = ['map', *SPEC.get('between', []), odometry, 'base_footprint']
        frames = list(zip(line, line[1:]))
        frames += [(parent, child) for child, parent in SPEC.get('more_parents', {}).items()]
        self.tf.publish([transform(parent, child) for parent, child in frames if not lacks(child)])

    def turn(self):
        now = time.monotonic()
        for topic in TOPICS:
            rate = SPEC.get('rate', {}).get(topic, SCAN_RATE if topic == 'base_scan' else RATE)
            due = self.next.setdefault(topic, now)
            if now >= due:
                self.next[topic] = max(due + 1.0 / rate, now - 1.0 / rate)
                self.send(topic)
        if now >= self.next.setdefault('/tf', now):
            self.next['/tf'] = now + 1.0 / SCAN_RATE
            self.send_frames()


def transform(parent, child):
    message = TransformStamped()
    message.header.stamp, message.header.frame_id = stamp_of(child), parent
    message.child_frame_id = child
    message.transform.rotation.w = 1.0
    return message


class MoveBase:
    def __init__(self):
        kinds = {'goal': SPEC.get('goal_type', 'move_base_msgs/MoveBaseActionGoal'),
                 'cancel': 'actionlib_msgs/GoalID'}
        sent = {'status': 'actionlib_msgs/GoalStatusArray',
                'feedback': 'move_base_msgs/MoveBaseActionFeedback',
                'result': 'move_base_msgs/MoveBaseActionResult'}
        self.keep = []
        if not lacks('action'):
            for name, kind in kinds.items():
                self.keep.append(rospy.Subscriber('move_base/' + name, message_class(kind),
                                                  lambda _: None))
            for name, kind in sent.items():
                self.keep.append(rospy.Publisher('move_base/' + name, message_class(kind),
                                                 queue_size=1))
        drives = SPEC.get('drives', 'base_guard/cmd_vel')
        self.keep.append(rospy.Publisher(drives, message_class('geometry_msgs/Twist'), queue_size=1))
        self.offer_parameters()

    def offer_parameters(self):
        config = Config(doubles=[DoubleParameter(name=name, value=1.0)
                                 for name in SPEC.get('parameters', PARAMETERS)])
        server = 'move_base_node/DWAPlannerROS'
        if not lacks('planner'):
            rospy.Service(server + '/set_parameters', Reconfigure,
                          lambda _: ReconfigureResponse(config))
        updates = rospy.Publisher(server + '/parameter_updates', Config, queue_size=1, latch=True)
        if not lacks('updates'):
            updates.publish(config)
        self.keep.append(updates)

    def turn(self):
        pass


def main():
    role = sys.argv[1]
    rospy.init_node(role)
    node = MoveBase() if role == 'move_base_node' else Robot()
    print('ready', flush=True)
    while not rospy.is_shutdown():
        node.turn()
        time.sleep(0.3 / RATE)


if __name__ == '__main__':
    main()
