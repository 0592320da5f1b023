#!/usr/bin/env python3
"""Drives by move_base, as fast as imagination recommends.

    rosrun hires ask_before_driving.py AREA X Y YAW --from AREA --object NAME

AREA: where to, as the imagined world calls it; X Y YAW: the same [m, rad] in the map. What stands on
the tray is said by --object. Beside it run: the robot's navigation, and imagination.launch. Exit code 2:
imagination recommends nothing, and nothing was driven; 1: move_base did not get there.
"""

import argparse
import math

import actionlib
import dynamic_reconfigure.client
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point, Pose, Quaternion
from hires import Imagination, init_node
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

LIMITS = {'slow': {'max_vel_x': 0.30, 'acc_lim_x': 1.4}, 'fast': {'max_vel_x': 0.55, 'acc_lim_x': 2.5}}


def drive(planner, x, y, yaw, motion_set):
    dynamic_reconfigure.client.Client(planner).update_configuration(LIMITS[motion_set])
    goal = MoveBaseGoal()
    goal.target_pose.header.frame_id = 'map'
    goal.target_pose.pose = Pose(Point(x, y, 0.0),
                                 Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))
    move_base = actionlib.SimpleActionClient('move_base', MoveBaseAction)
    move_base.wait_for_server()
    return move_base.send_goal_and_wait(goal) == GoalStatus.SUCCEEDED


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('area')
    for name in ('x', 'y', 'yaw'):
        parser.add_argument(name, type=float)
    parser.add_argument('--from', dest='begin', required=True)
    parser.add_argument('--object', action='append', default=[])
    parser.add_argument('--planner', default='move_base/DWAPlannerROS')
    arguments = parser.parse_args(rospy.myargv()[1:])
    init_node('ask_before_driving', anonymous=True)
    answer = Imagination().ask('move_base_param', arguments.area, list(LIMITS),
                               robot_at=arguments.begin, on_tray=arguments.object)
    print(*answer.ranking, answer.why, sep='\n')
    if answer.recommended is None:
        return 2
    motion_set = answer.recommended.arguments[1]
    is_there = drive(arguments.planner, arguments.x, arguments.y, arguments.yaw, motion_set)
    return 0 if is_there else 1


if __name__ == '__main__':
    raise SystemExit(main())
