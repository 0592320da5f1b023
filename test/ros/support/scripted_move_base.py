#!/usr/bin/env python3
"""A move_base that does as it is told, and its local planner as far as dynamic_reconfigure shows it.

~behaviour, looked up at each goal: "arrive" says after ~duration [s], 0, that it is there, "abort" gives up with
~text, "drive" sends ~speed ahead until it is told to stop, and then a zero.
~old_names: parameters are named as before Noetic. ~lower: {name: bound}, a value below is clamped.
~ignored: [name], changes of these are not taken. ~refuses: every change is an error."""

import os
import sys

import actionlib
import rospy
from dynamic_reconfigure.server import Server
from geometry_msgs.msg import Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseResult

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'pr2'))

from fake_move_base import PlannerConfig  # noqa: E402


class ScriptedMoveBase:
    def __init__(self):
        self.ignored = rospy.get_param('~ignored', [])
        self.refuses = rospy.get_param('~refuses', False)
        self.before = self.now = None
        config = PlannerConfig(rospy.get_param('~old_names', False))
        config.min.update(rospy.get_param('~lower', {}))
        self.planner = Server(config, self.on_parameters, 'DWAPlannerROS')
        self.velocity = rospy.Publisher('cmd_vel', Twist, queue_size=1, tcp_nodelay=True)
        self.action = actionlib.SimpleActionServer('move_base', MoveBaseAction, self.execute, False)
        self.action.start()

    def on_parameters(self, config, _):
        if self.before is None:
            self.before = self.now = dict(config)
            return config
        changed = {name for name in self.before
                   if name != 'groups' and config[name] != self.now[name]}
        if self.refuses and changed:
            raise RuntimeError('this planner is not to be changed')
        for name in changed & set(self.ignored):
            config[name] = self.before[name]
        self.now = dict(config)
        return config

    def execute(self, _):
        behaviour = rospy.get_param('~behaviour', 'arrive')
        if behaviour == 'arrive':
            rospy.sleep(rospy.get_param('~duration', 0.0))
            self.action.set_succeeded(MoveBaseResult(), 'Goal reached.')
        elif behaviour == 'abort':
            self.action.set_aborted(MoveBaseResult(), rospy.get_param('~text'))
        else:
            self.drive(rospy.get_param('~speed', 0.2))

    def drive(self, speed):
        ahead = Twist()
        ahead.linear.x = speed
        rate = rospy.Rate(20)
        while not rospy.is_shutdown() and not self.action.is_preempt_requested():
            self.velocity.publish(ahead)
            rate.sleep()
        self.velocity.publish(Twist())
        self.action.set_preempted(MoveBaseResult(), '')


if __name__ == '__main__':
    rospy.init_node('move_base_node')
    ScriptedMoveBase()
    rospy.spin()
