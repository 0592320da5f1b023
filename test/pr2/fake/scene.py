"""What stands in the fake PR2's world, read from an SDF world: boxes and upright cylinders. All
poses are in the map of the robot, which may lie elsewhere than the world's own frame."""

import math
import os
import xml.etree.ElementTree as ElementTree

import numpy


class Pose2:
    """x, y [m] and yaw [rad] of a frame in another one."""

    def __init__(self, x=0.0, y=0.0, yaw=0.0):
        self.x, self.y, self.yaw = float(x), float(y), float(yaw)

    def __mul__(self, other):
        x, y = self.apply(other.x, other.y)
        return Pose2(x, y, wrap(self.yaw + other.yaw))

    def inverse(self):
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(-c * self.x - s * self.y, s * self.x - c * self.y, -self.yaw)

    def apply(self, x, y):
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return self.x + c * x - s * y, self.y + s * x + c * y


def wrap(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


class Box:
    """@param size  x, y [m]; it reaches from `bottom` to `top` [m] above the floor."""

    def __init__(self, pose, size, bottom, top):
        self.pose, self.size, self.bottom, self.top = pose, size, bottom, top
        self.radius = None

    def distance(self, x, y):
        """[m] from points on the floor plan to its outline; 0 within."""
        local = self.pose.inverse()
        u, v = local.apply(x, y)
        return numpy.hypot(numpy.maximum(numpy.abs(u) - self.size[0] / 2, 0.0),
                           numpy.maximum(numpy.abs(v) - self.size[1] / 2, 0.0))


class Cylinder:
    def __init__(self, pose, radius, bottom, top):
        self.pose, self.radius, self.bottom, self.top = pose, radius, bottom, top
        self.size = (2 * radius, 2 * radius)

    def distance(self, x, y):
        return numpy.maximum(numpy.hypot(x - self.pose.x, y - self.pose.y) - self.radius, 0.0)


class Scene:
    """@param world     path of an SDF world; its models lie in models/ beside it.
    @param X_MW         the world's frame in the robot's map."""

    def __init__(self, world, X_MW=Pose2()):
        self.models = os.path.join(os.path.dirname(os.path.abspath(world)), 'models')
        self.X_MW = X_MW
        self.shapes = []
        for include in ElementTree.parse(world).getroot().iter('include'):
            model = include.find('uri').text.strip().replace('model://', '')
            shapes, is_static = self.model(model)
            if is_static:
                X_WM, z = _read_pose(include.find('pose'))
                self.shapes += [_moved(shape, X_MW * X_WM, z) for shape in shapes]

    def model(self, name):
        """Its shapes in its own frame, and whether it stands for good."""
        root = ElementTree.parse(os.path.join(self.models, name, 'model.sdf')).getroot()
        model = root.find('model')
        shapes = []
        for link in model.findall('link'):
            X_ML, z = _read_pose(link.find('pose'))
            shapes += [_moved(_read_shape(c, name), X_ML, z) for c in link.findall('collision')]
        static = model.find('static')
        return shapes, static is not None and static.text.strip() in ('true', '1')

    def slice(self, height):
        """What a horizontal laser at this height [m] hits."""
        return [shape for shape in self.shapes if shape.bottom <= height <= shape.top]

    def within(self, bottom, top):
        """What reaches into a band of heights [m]."""
        return [shape for shape in self.shapes if shape.bottom <= top and shape.top >= bottom]

    def support(self, x, y, z):
        """Height [m] of the highest top at a place that is not above z; the floor is 0."""
        return max([shape.top for shape in self.shapes
                    if shape.top <= z and shape.distance(x, y) == 0.0], default=0.0)


def _read_pose(element):
    if element is None or not element.text:
        return Pose2(), 0.0
    x, y, z, roll, pitch, yaw = (float(number) for number in element.text.split())
    if abs(roll) > 1e-9 or abs(pitch) > 1e-9:
        raise ValueError('pose "%s": the fake PR2 knows upright bodies only' % element.text)
    return Pose2(x, y, yaw), z


def _read_shape(collision, model):
    pose, z = _read_pose(collision.find('pose'))
    box = collision.find('geometry/box/size')
    cylinder = collision.find('geometry/cylinder')
    if box is not None:
        x, y, height = (float(number) for number in box.text.split())
        return Box(pose, (x, y), z - height / 2, z + height / 2)
    if cylinder is not None:
        height = float(cylinder.find('length').text)
        return Cylinder(pose, float(cylinder.find('radius').text), z - height / 2, z + height / 2)
    raise ValueError('model %s: the fake PR2 knows boxes and cylinders only' % model)


def _moved(shape, X_AB, z):
    """The shape in A that was given in B."""
    pose = X_AB * shape.pose
    if shape.radius is None:
        return Box(pose, shape.size, shape.bottom + z, shape.top + z)
    return Cylinder(pose, shape.radius, shape.bottom + z, shape.top + z)


class Grid:
    """An occupancy grid of shapes, as a map that was driven and saved: cells within them or cut by
    their rim are occupied. Row by row, x fastest."""

    def __init__(self, shapes, resolution=0.05, margin=0.5):
        reach = [(s.pose.x, s.pose.y, math.hypot(*s.size) / 2) for s in shapes]
        self.resolution = resolution
        self.x = math.floor((min(x - r for x, _, r in reach) - margin) / resolution) * resolution
        self.y = math.floor((min(y - r for _, y, r in reach) - margin) / resolution) * resolution
        right = max(x + r for x, _, r in reach) + margin
        upper = max(y + r for _, y, r in reach) + margin
        self.width = int(math.ceil((right - self.x) / resolution))
        self.height = int(math.ceil((upper - self.y) / resolution))
        x = self.x + (numpy.arange(self.width) + 0.5) * resolution
        y = self.y + (numpy.arange(self.height) + 0.5) * resolution
        x, y = numpy.meshgrid(x, y)
        self.is_occupied = numpy.zeros(x.shape, bool)
        for shape in shapes:
            self.is_occupied |= shape.distance(x, y) <= resolution / 2
