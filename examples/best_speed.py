#!/usr/bin/env python3
"""The best speed for a robot with something on its tray: best_speed.py ROBOT OBJECT WORLD FROM TO"""

import sys

from hires import core


def best_speed(robot, load, world, begin, end):
    scene = core.Scene(world=world, robot=robot)
    speeds = {'%.1f m/s' % v: v for v in (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)}
    for name, speed in speeds.items():
        scene.add_motion_set(name, speed=speed, acceleration=2.0)
    answer = scene.imagine('move_base_param', end, list(speeds), robot_at=begin, on_tray=[load],
                           rollouts=64, seed=7, ranking='cost')
    for way in answer.ranking:
        print('%s: %5.1f %% of %d, %4.1f s, costs %.1f s' % (
            way.arguments[1], 100 * way.success, way.rollouts, way.duration, way.expected_cost))
    print('best:', answer.recommended.arguments[1] if answer.recommended else answer.why)


if len(sys.argv) != 6:
    sys.exit('usage: best_speed.py ROBOT OBJECT WORLD FROM TO, as urdf/cart.urdf vase1 '
             'worlds/workshop.world dock atBench')
try:
    best_speed(*sys.argv[1:])
except core.ConfigError as error:
    sys.exit('best_speed.py: %s' % error)
