"""Hands and what they can hold: a kinematic world. A gripper that closes around an object carries
it; what is let go comes to stand on what is below it; what stands on the tray rides along."""

import math
import os
import sys

import numpy
import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'ros',
                                'support'))

from pr2_frames import planar, rotation, translation  # noqa: E402

MAX_GAP = 0.09          # [m]
SPEED = 0.05            # [m/s] of the gap
PAD = 0.03              # [m] of the finger tips before and behind their middle
TIP = 0.18              # [m] of the finger tips' middle from the wrist roll frame
TRAY = (0.0796, 0.3291, 0.329)  # [m] the plate in the base: x from .. to, y to both sides
TRAY_TOP = 0.3462       # [m]
SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', '..', 'config',
                     'scene.yaml')


def read_standing(path=SCENE):
    """Block `standing` of a scene file. Used here: tilt [rad], drop [m]; things here come to stand or lie
    at once, so hold_time and slide never matter."""
    with open(path) as file:
        return yaml.safe_load(file)['standing']


class Thing:
    """A loose object: the box or cylinder of its model, upright, its origin below its middle."""

    def __init__(self, name, model, shape, X_MO):
        self.name, self.model, self.shape = name, model, shape
        self.parent = None      # None: the map; 'base'; or a palm's link
        self.X_PO = X_MO        # 4 x 4, in the parent
        self.fell = False       # it was let go leaning, or over nothing

    def width(self):
        return min(self.shape.size)


class World:
    """@param links     gives a link's pose in the base, 4 x 4, now.
    @param standing  what counts as a fall, as read_standing gives it."""

    def __init__(self, scene, links, standing=None):
        self._scene, self._links = scene, links
        self._standing = standing or read_standing()
        self.things = {}
        self.hands = {side: Hand(self, side) for side in ('l', 'r')}
        self.X_MB = numpy.eye(4)

    def add(self, name, model, x, y, z, yaw=0.0):
        shapes, _ = self._scene.model(model)
        self.things[name] = Thing(name, model, shapes[0], planar(x, y, yaw) @ translation(0, 0, z))

    def move_base(self, pose):
        self.X_MB = planar(pose.x, pose.y, pose.yaw)

    def pose(self, thing):
        """X_MO, 4 x 4."""
        return self.parent_pose(thing.parent) @ thing.X_PO

    def parent_pose(self, parent):
        if parent is None:
            return numpy.eye(4)
        return self.X_MB if parent == 'base' else self.X_MB @ self._links(parent)

    def attach(self, thing, parent):
        thing.X_PO = numpy.linalg.inv(self.parent_pose(parent)) @ self.pose(thing)
        thing.parent = parent

    def let_go(self, thing):
        """It comes to stand below where it was."""
        X_MO = self.pose(thing)
        x, y, z = X_MO[:3, 3]
        yaw = math.atan2(X_MO[1, 0], X_MO[0, 0])
        is_on_tray = self._is_over_tray(x, y) and z > TRAY_TOP - 0.02
        support = TRAY_TOP if is_on_tray else self._scene.support(x, y, z + 0.02)
        tilt = math.acos(min(1.0, max(-1.0, X_MO[2, 2])))
        thing.fell = tilt >= self._standing['tilt'] or z - support > self._standing['drop']
        thing.parent, thing.X_PO = None, planar(x, y, yaw) @ translation(0, 0, support)
        if is_on_tray:
            self.attach(thing, 'base')

    def _is_over_tray(self, x, y):
        u, v, _, _ = numpy.linalg.inv(self.X_MB) @ (x, y, 0.0, 1.0)
        return TRAY[0] <= u <= TRAY[1] and abs(v) <= TRAY[2]

    def step(self, dt):
        for hand in self.hands.values():
            hand.step(dt)


class Hand:
    def __init__(self, world, side):
        self._world = world
        self.palm = side + '_gripper_palm_link'
        self._tool = side + '_gripper_tool_frame'
        self.gap = 0.0          # [m]
        self.velocity = 0.0     # [m/s]
        self.held = None
        self._wanted = 0.0
        self.is_halted = False

    def command(self, gap):
        self._wanted = min(max(gap, 0.0), MAX_GAP)

    def step(self, dt):
        before = self.gap
        if not self.is_halted:
            change = max(-SPEED * dt, min(SPEED * dt, self._wanted - self.gap))
            floor = self.held.width() if self.held else 0.0
            self.gap = max(self.gap + change, min(before, floor)) if change < 0 else before + change
            if change < 0 and self.held is None:
                self._close_on_something()
            elif self.held is not None and self.gap > self.held.width() + 0.001:
                self._open()
        self.velocity = (self.gap - before) / dt

    def _close_on_something(self):
        X_MT = self._world.parent_pose(self._tool)
        for thing in self._world.things.values():
            if thing.parent not in (None, 'base') or thing.width() < self.gap:
                continue
            if self._is_between_fingers(X_MT, thing):
                self.gap = max(self.gap, thing.width())
                self.held = thing
                self._world.attach(thing, self.palm)
                return

    def _is_between_fingers(self, X_MT, thing):
        """The fingers close along y of the tool, and reach over some cm along its x."""
        X_TO = numpy.linalg.inv(X_MT) @ self._world.pose(thing)
        foot, axis = X_TO[:3, 3], X_TO[:3, 2]
        height = thing.shape.top - thing.shape.bottom
        along = min(max(-foot @ axis, 0.0), height)  # of its axis, nearest to the finger tips
        nearest = foot + along * axis
        if abs(axis[0]) > 0.7:  # grasped from above: only its upper end is between the fingers
            return math.hypot(nearest[1], nearest[2]) < thing.width() / 2 and abs(nearest[0]) < PAD
        return abs(nearest[0]) < PAD and abs(nearest[1]) < thing.width() / 2 and \
            abs(nearest[2]) < 0.02

    def _open(self):
        thing, self.held = self.held, None
        self._world.let_go(thing)
