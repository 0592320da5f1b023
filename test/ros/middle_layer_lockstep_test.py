#!/usr/bin/env python3
"""Load on the machine changes nothing: in lockstep the same action gives the same true path bit by
bit, whatever else runs. And the same code: a skill through topics and controllers takes the path
that it takes in a rollout. Run alone, or by `rostest hires middle_layer_lockstep.test`."""

import math
import multiprocessing
import os
import subprocess
import sys
import unittest

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from failures import text_of  # noqa: E402
from robot_system import COUNTER, MUG, RobotSystem  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from scene_file import read_scene  # noqa: E402
from test_run import run_test  # noqa: E402

CONFIG = os.path.abspath(
    os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config'))
TOPPLE = os.path.join(CONFIG, 'scenarios', 'topple.yaml')
TICK = 50000000  # [ns]
POSITION = ANGLE = 0.02  # [m], [rad]: how far the two ways may differ
WINDOW = 12  # [ticks] and how much earlier or later: 0.6 s, a little more than between two looks

DRIVES = (('move_base', 'preManipulationAreaEastTable2'),
          ('move_base_param', 'preManipulationAreaWestTable2', 'slow'),
          ('move_base_param', 'preManipulationAreaWestTable2', 'fast'),
          ('move_base_blind', 'home'))
POSTURES = (('move_torso', 'torsoMiddlePosture'),
            ('tuck_arms', 'armTuckedPosture', 'armTuckedPosture'),
            ('move_arm_to_side', 'leftArm1'),
            ('tuck_arms', 'armUnTuckedPosture', 'armUnTuckedPosture'))
HANDLING = (('look_at', 'mug1'),
            ('observe_objects_on_area', 'placingAreaEastRightCounter1'),
            ('measure_temperature', 'mug1', 'placingAreaEastRightCounter1'),
            ('observe_objects_at', 'placingAreaEastRightCounter1', 'manipulationAreaEastCounter1',
             'torsoMiddlePosture', 'left'),
            ('pick_up_object', 'mug1', 'rightArm1'),
            ('place_object', 'mug1', 'rightArm1', 'placingAreaEastRightCounter1'),
            ('pick_up_object', 'mug1', 'rightArm1'),
            ('place_object_at', 'mug1', 'rightArm1', 'placingAreaEastRightCounter1', 'middle'),
            ('pick_up_object', 'mug1', 'rightArm1'),
            ('move_base_blind', 'preManipulationAreaEastCounter1'),
            ('place_on_tray', 'rightArm1', 'mug1'),
            # As the domain has it: arms do not stick out while the robot drives. What stands on the
            # tray is driven and braked with, and may shake and slide.
            ('tuck_arms', 'armTuckedPosture', 'armTuckedPosture'),
            ('move_base_param', 'preManipulationAreaSouthTable1', 'fast'),
            ('tuck_arms', 'armTuckedPosture', 'armUnTuckedPosture'),
            ('move_arm_to_side', 'rightArm1'),
            ('pick_up_from_tray', 'rightArm1', 'mug1'),
            ('move_arms_to_carryposture',))


def scene_of_the_robots_laser(processes):
    """The configured scene, whose rollouts see as many beams as the robot, as often; else they drive by
    fewer, to be quick, and a little differently."""
    def read(name):
        with open(os.path.join(CONFIG, name)) as file:
            return yaml.safe_load(file)

    scene, layer, laser = read_scene(), read('obstacle_layer.yaml'), read('sim_robot.yaml')['laser']
    del laser['noise']
    layer['laser'] = {**laser, 'period': 1e-9 * TICK}
    scene['obstacle_layer'] = processes.write('obstacle_layer.yaml', yaml.safe_dump(layer))
    return processes.write('scene.yaml', yaml.safe_dump(scene))


def burn():
    while True:
        pass


class Hogs:
    """More busy processes than there are processors."""

    def __enter__(self):
        self._hogs = [multiprocessing.Process(target=burn, daemon=True)
                      for _ in range(2 * os.cpu_count())]
        for hog in self._hogs:
            hog.start()

    def __exit__(self, *_):
        for hog in self._hogs:
            hog.kill()
            hog.join()


def values_of(state):
    """Everything about the robot that can differ, as exact numbers."""
    return (state.pose.position.x, state.pose.position.y, state.yaw, state.twist.linear.x,
            state.twist.linear.y, state.twist.angular.z, tuple(state.joints.name),
            tuple(state.joints.position))


def configuration(x, y, yaw, joints):
    """{name: (value, how far it may differ)}"""
    values = {'x': (x, POSITION), 'y': (y, POSITION), 'yaw': (yaw, ANGLE)}
    values.update({name: (position, ANGLE) for name, position in joints.items()})
    return values


def configuration_of(state):
    return configuration(state.pose.position.x, state.pose.position.y, state.yaw,
                         dict(zip(state.joints.name, state.joints.position)))


def difference(a, b):
    """{name: b - a}; what turns without end differs by less than half a turn."""
    return {name: math.remainder(b[name][0] - value, 2.0 * math.pi)
            if name != 'x' and name != 'y' else b[name][0] - value
            for name, (value, _) in a.items()}


def off_segment(point, a, b):
    """By how much of what is allowed `point` differs from its nearest point between a and b."""
    way, to_point = difference(a, b), difference(a, point)
    length = sum(step * step for step in way.values())
    share = sum(way[name] * to_point[name] for name in way) / length if length > 0.0 else 0.0
    share = min(1.0, max(0.0, share))
    return max(abs(to_point[name] - share * way[name]) / allowed
               for name, (_, allowed) in a.items())


def off_path(path, other):
    """The largest of these for points of `path` and what `other` passes at about the time."""
    def off(index):
        first = max(0, min(index, len(other) - 1) - WINDOW)
        last = min(len(other) - 1, index + WINDOW)
        return min(off_segment(path[index], other[k], other[min(k + 1, last)])
                   for k in range(first, last + 1))
    return max(off(index) for index in range(len(path)))


def positions_of(world):
    return {o.name: (o.pose.position.x, o.pose.position.y, o.pose.position.z)
            for o in world.objects}


def farthest(objects, other):
    """[m] by which the object that differs most stands elsewhere."""
    return max((math.dist(position, other[name]) for name, position in objects.items()),
               default=0.0)


class TrueWorlds:
    """Where all objects really are, tick by tick, of the robot that is started next."""

    def __init__(self, system):
        self._worlds = worlds = {}  # by stamp [ns]
        self._subscriber = system.rospy.Subscriber(
            'ground_truth/world_state', system.msg.WorldState,
            lambda world: worlds.update({world.header.stamp.to_nsec(): world}),
            queue_size=10000, tcp_nodelay=True)

    def at(self, stamp):
        wait_until(lambda: stamp in self._worlds, 'the true world at the end of an action')
        return positions_of(self._worlds[stamp])

    def forget(self):
        self._subscriber.unregister()


class Rollout:
    """What skill_trace says of one skill."""

    def __init__(self, lines):
        self.path, self.objects, self.end = [], {}, None
        for line in lines:
            first, *words = line.split()
            if first == 'end':
                self.end = ' '.join(words)
                return
            if first == 'object':
                self.objects[words[0]] = tuple(map(float, words[1:]))
                continue
            joints = (word.split('=') for word in words[3:])
            self.path.append(configuration(*map(float, words[:3]),
                                           {name: float(value) for name, value in joints}))


class MiddleLayerLockstepTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(lockstep=True, pace=0.0, hold=True)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('middle_layer_lockstep_test')

    def start(self, **robot):
        self.system.start_robot(**robot)
        self.system.start_middle_layer()
        self.system.require_server()
        self.addCleanup(self.system.end_processes)

    def run_action(self, action):
        """Result, and {stamp: true state} from the action's begin to its end."""
        self.system.hold(True)
        held = self.system.wait_for_standstill()
        goal = self.system.execute(*action).wait_for_active()
        self.system.hold(False)
        result = goal.result()
        begin, end = held + TICK, held + TICK + round(result.duration * 1e9)
        self.system.wait_for_truth(
            lambda s: s.joints.header.stamp.to_nsec() >= end, 'the truth to come to the end')
        path = {stamp: state for stamp, state in self.system.truth if begin <= stamp <= end}
        return result, path

    def run_alone(self, action, **robot):
        self.start(**robot)
        result, path = self.run_action(action)
        self.system.end_processes()
        return result, path

    def test_load_changes_nothing(self):
        action = ('move_base_param', 'preManipulationAreaEastTable2', 'fast')
        runs = []
        for with_hogs in (False, True, False, True):
            if with_hogs:
                with Hogs():
                    runs.append(self.run_alone(action, seed=3, scenario=TOPPLE))
            else:
                runs.append(self.run_alone(action, seed=3, scenario=TOPPLE))
        result, path = runs[0]
        self.assertEqual(result.code, self.system.codes.SUCCEEDED, text_of(result.failure))
        self.assertGreater(len(path), 50)
        exact = {stamp: values_of(state) for stamp, state in path.items()}
        for other_result, other_path in runs[1:]:
            self.assertEqual((other_result.code, text_of(other_result.failure), other_result.duration),
                             (result.code, text_of(result.failure), result.duration))
            self.assertEqual({stamp: values_of(state) for stamp, state in other_path.items()},
                             exact)

    def test_another_seed_is_another_truth(self):
        action = ('move_base_blind', 'home')
        paths = [self.run_alone(action, seed=seed)[1] for seed in (1, 2)]
        last = [values_of(path[max(path)]) for path in paths]
        self.assertNotEqual(last[0], last[1])

    # The same code

    def test_every_action_of_the_domain_is_compared(self):
        with open(os.path.join(CONFIG, 'domains', 'restaurant.yaml')) as file:
            actions = set(yaml.safe_load(file)['operators']) - {'imagine'}  # not done by the robot
        compared = {action[0] for action in (*DRIVES, *POSTURES, *HANDLING)}
        self.assertEqual(compared, actions | {'look_at'})

    def rollouts(self, where, actions):
        words = ' , '.join(' '.join(action) for action in actions).split()
        scene = scene_of_the_robots_laser(self.system.processes)
        output = subprocess.run([executable('skill_trace'), scene, where, *words], check=True,
                                stdout=subprocess.PIPE, text=True).stdout
        lines = iter(output.splitlines())
        return [Rollout(lines) for _ in actions]

    def require_same(self, where, *actions):
        rollouts = self.rollouts(where, actions)
        worlds = TrueWorlds(self.system)
        self.addCleanup(worlds.forget)
        self.start(uncertainty='none',
                   **{'scenario' if where.endswith('.yaml') else 'area': where})
        for action, imagined in zip(actions, rollouts):
            with self.subTest(action=action):
                result, states = self.run_action(action)
                succeeded = result.code == self.system.codes.SUCCEEDED
                self.assertEqual('succeeded' if succeeded else text_of(result.failure), imagined.end,
                                 self.system.output())
                self.require_same_path(action, [configuration_of(states[stamp])
                                                for stamp in sorted(states)], imagined.path)
                self.require_same_objects(action, worlds.at(max(states)), imagined.objects)
        self.system.end_processes()

    def require_same_path(self, action, real, imagined):
        # A camera that looks twice a second is not always at the same beat.
        self.assertLessEqual(abs(len(real) - len(imagined)), WINDOW)
        off = max(off_path(real, imagined), off_path(imagined, real))
        self.report(action, 'the paths differ by at most %.5f m or rad' % (off * POSITION))
        self.assertLessEqual(off, 1.0)

    def require_same_objects(self, action, real, imagined):
        self.assertEqual(set(real), set(imagined))
        off = farthest(real, imagined)
        self.report(action, '%d objects end at most %.5f m apart' % (len(real), off))
        self.assertLessEqual(off, POSITION)

    def report(self, action, text):
        # Past rosunit, which keeps standard output to itself.
        print('%s(%s): %s' % (action[0], ', '.join(action[1:]), text), file=sys.__stderr__,
              flush=True)

    def test_driving_is_the_same_as_in_a_rollout(self):
        for action in DRIVES:
            self.require_same('nearStartArea1', action)

    def test_postures_are_the_same_as_in_a_rollout(self):
        self.require_same(TOPPLE, *POSTURES)

    def test_handling_objects_is_the_same_as_in_a_rollout(self):
        self.system.tell({'mug1': ('coffee_cup', *MUG)})
        self.require_same(self.system.processes.write('counter.yaml', COUNTER), *HANDLING)


if __name__ == '__main__':
    run_test('middle_layer_lockstep', MiddleLayerLockstepTest)
