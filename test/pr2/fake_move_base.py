#!/usr/bin/env python3
"""A stand-in for a PR2's move_base: the action move_base, the local planner's parameters by
dynamic_reconfigure (move_base_node/DWAPlannerROS), velocities on cmd_vel. It plans on the map and
on what a tilting laser would have marked in ~world (SDF; ~world_in_map: x y yaw of its frame in the
map). ~old_names: parameters are named as before Noetic."""

import ctypes
import math
import os
import signal
import sys
import threading

import actionlib
import rospy
from dynamic_reconfigure.server import Server
from geometry_msgs.msg import PoseStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseFeedback, MoveBaseResult
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from fake.routes import Follower, Router  # noqa: E402
from fake.scene import Pose2, Scene  # noqa: E402

FREQUENCY = 10.0     # [Hz] controller_frequency
OFF_ROUTE = 0.5      # [m] beyond which it plans anew
MARKED = (0.08, 1.35)  # [m] heights of what is an obstacle to a PR2
PATIENCE = 15.0      # [s] controller_patience: that the base may not come nearer

# name, name before Noetic, default of the PR2's configuration, lower, upper bound
PARAMETERS = (
    ('max_vel_trans', 'max_trans_vel', 0.55, 0.0, 20.0),
    ('min_vel_trans', 'min_trans_vel', 0.1, 0.0, 20.0),
    ('max_vel_x', 'max_vel_x', 0.55, -20.0, 20.0),
    ('min_vel_x', 'min_vel_x', 0.0, -20.0, 20.0),
    ('max_vel_y', 'max_vel_y', 0.1, -20.0, 20.0),
    ('min_vel_y', 'min_vel_y', -0.1, -20.0, 20.0),
    ('max_vel_theta', 'max_rot_vel', 1.0, 0.0, 20.0),
    ('min_vel_theta', 'min_rot_vel', 0.3, 0.0, 20.0),
    ('acc_lim_x', 'acc_lim_x', 2.5, 0.0, 20.0),
    ('acc_lim_y', 'acc_lim_y', 2.5, 0.0, 20.0),
    ('acc_lim_theta', 'acc_lim_th', 3.2, 0.0, 20.0),
    ('acc_lim_trans', 'acc_limit_trans', 2.5, 0.0, 20.0),
    ('xy_goal_tolerance', 'xy_goal_tolerance', 0.2, 0.0, 10.0),
    ('yaw_goal_tolerance', 'yaw_goal_tolerance', 0.17, 0.0, 10.0),
)


class PlannerConfig:
    """What a generated configuration class is to dynamic_reconfigure's server."""

    def __init__(self, is_old):
        self.defaults, self.min, self.max, self.level = {}, {}, {}, {}
        self.all_level = 1
        self.noetic = {}
        parameters = []
        for name, old, default, lower, upper in PARAMETERS:
            own = old if is_old else name
            parameters.append(dict(
                name=own, type='double', level=0, description=name.replace('_', ' '),
                default=default, min=lower, max=upper, edit_method='', ctype='double',
                cconsttype='const double', srcline=0, srcfile=''))
            self.noetic[own] = name
            self.defaults[own], self.min[own], self.max[own] = default, lower, upper
            self.level[own] = 0
        self.config_description = dict(
            name='Default', type='', state=True, cstate='true', id=0, parent=0, parentname='',
            parentclass='', field='default', upper='DEFAULT', lower='groups', groups=[],
            parameters=parameters, **{'class': 'DEFAULT'})


class FakeMoveBase:
    def __init__(self):
        self._lock = threading.Lock()
        self._transforms = {}
        self._router = None
        scene = Scene(rospy.get_param('~world'),
                      Pose2(*rospy.get_param('~world_in_map', [0.0, 0.0, 0.0])))
        self._marked = scene.within(*MARKED)
        self._limits = {}
        self._config = PlannerConfig(rospy.get_param('~old_names', False))
        self._reconfigure = Server(self._config, self._on_parameters, 'DWAPlannerROS')
        self._velocity = rospy.Publisher('cmd_vel', Twist, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber('/tf', TFMessage, self._on_transforms, queue_size=100, tcp_nodelay=True)
        rospy.Subscriber('map', OccupancyGrid, self._on_map, queue_size=1)
        self._server = actionlib.SimpleActionServer('move_base', MoveBaseAction, self._execute,
                                                    False)
        self._server.start()

    def _on_parameters(self, config, _):
        self._limits = {noetic: config[own] for own, noetic in self._config.noetic.items()}
        return config

    def _on_transforms(self, message):
        for t in message.transforms:
            if t.child_frame_id in ('odom_combined', 'base_footprint'):
                move, turn = t.transform.translation, t.transform.rotation
                self._transforms[t.child_frame_id] = Pose2(
                    move.x, move.y, 2 * math.atan2(turn.z, turn.w))

    def _on_map(self, message):
        router = Router(message, self._marked)
        with self._lock:
            self._router = router

    def _pose(self):
        try:
            return self._transforms['odom_combined'] * self._transforms['base_footprint']
        except KeyError:
            return None

    def _map_router(self):
        with self._lock:
            if self._router is None:
                self._router = Router(rospy.ServiceProxy('static_map', GetMap)().map, self._marked)
            return self._router

    # The action ---------------------------------------------------------------------------------

    def _execute(self, goal):
        target = goal.target_pose
        if target.header.frame_id.lstrip('/') != 'map':
            self._end('aborted', 'the goal is in the frame "%s", not in map' %
                      target.header.frame_id)
            return
        q = target.pose.orientation
        wanted = Pose2(target.pose.position.x, target.pose.position.y, 2 * math.atan2(q.z, q.w))
        follower = self._plan(wanted)
        if follower is None:
            self._end('aborted', 'Failed to find a valid plan. Even after executing recovery '
                      'behaviors.')
            return
        self._drive(follower, wanted)

    def _plan(self, goal):
        pose = self._pose()
        points = self._map_router().plan(pose, goal) if pose else None
        return Follower(points, goal) if points else None

    def _drive(self, follower, goal):
        rate = rospy.Rate(FREQUENCY)
        nearest, since = math.inf, rospy.get_time()
        while not rospy.is_shutdown():
            if self._server.is_preempt_requested():
                self._end('preempted', '')
                return
            pose = self._pose()
            if follower.distance_to_route(pose) > OFF_ROUTE:
                follower = self._plan(goal) or follower
            velocity = follower.update(pose, self._limits, 1 / FREQUENCY)
            if velocity is None:
                self._end('succeeded', 'Goal reached.')
                return
            rest = math.hypot(goal.x - pose.x, goal.y - pose.y) + 0.3 * abs(velocity[1])
            if rest < nearest - 0.05 or abs(velocity[1]) > 0.0 and velocity[0] == 0.0:
                nearest, since = min(rest, nearest), rospy.get_time()
            if rospy.get_time() - since > PATIENCE:
                self._end('aborted', 'Failed to find a valid control. Even after executing '
                          'recovery behaviors.')
                return
            self._send(*velocity)
            self._feedback(pose)
            rate.sleep()

    def _send(self, speed, turn):
        twist = Twist()
        twist.linear.x, twist.angular.z = speed, turn
        self._velocity.publish(twist)

    def _feedback(self, pose):
        base = PoseStamped()
        base.header.frame_id, base.header.stamp = 'map', rospy.Time.now()
        base.pose.position.x, base.pose.position.y = pose.x, pose.y
        base.pose.orientation.z = math.sin(pose.yaw / 2)
        base.pose.orientation.w = math.cos(pose.yaw / 2)
        self._server.publish_feedback(MoveBaseFeedback(base_position=base))

    def _end(self, how, text):
        """Like move_base it ends with a zero velocity."""
        self._send(0.0, 0.0)
        getattr(self._server, 'set_' + how)(MoveBaseResult(), text)


if __name__ == '__main__':
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG: not without its roslaunch
    rospy.init_node('move_base_node')
    FakeMoveBase()
    rospy.spin()
