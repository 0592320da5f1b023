"""Where the links of a robot are, from its URDF, for tests that publish what its sensors see."""

import math
import xml.etree.ElementTree as ElementTree

import numpy


def translation(x, y, z):
    matrix = numpy.eye(4)
    matrix[:3, 3] = (x, y, z)
    return matrix


def rotation(axis, angle):
    x, y, z = numpy.asarray(axis, float) / numpy.linalg.norm(axis)
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = numpy.eye(4)
    matrix[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return matrix


def planar(x, y, yaw):
    return translation(x, y, 0.0) @ rotation((0, 0, 1), yaw)


def quaternion(matrix):
    """x, y, z, w of a rotation that is no half turn about an axis across z."""
    m = matrix[:3, :3]
    w = math.sqrt(max(0.0, 1.0 + numpy.trace(m))) / 2
    if w > 1e-6:
        return ((m[2, 1] - m[1, 2]) / (4 * w), (m[0, 2] - m[2, 0]) / (4 * w),
                (m[1, 0] - m[0, 1]) / (4 * w), w)
    axis = numpy.sqrt(numpy.maximum(0.0, (numpy.diag(m) + 1) / 2))
    return (*axis, 0.0)


class Robot:
    def __init__(self, urdf):
        self._joints = {}
        for joint in ElementTree.parse(urdf).getroot().findall('joint'):
            self._joints[joint.find('child').get('link')] = joint

    def link(self, name, joints):
        """The link's pose in the root."""
        joint = self._joints.get(name)
        if joint is None:
            return numpy.eye(4)
        return self.link(joint.find('parent').get('link'), joints) @ self._own(joint, joints)

    @staticmethod
    def _own(joint, joints):
        origin = joint.find('origin')
        numbers = [0.0] * 6
        if origin is not None:
            numbers = [float(x) for x in (origin.get('xyz', '0 0 0') + ' ' +
                                          origin.get('rpy', '0 0 0')).split()]
        x, y, z, roll, pitch, yaw = numbers
        pose = (translation(x, y, z) @ rotation((0, 0, 1), yaw) @ rotation((0, 1, 0), pitch) @
                rotation((1, 0, 0), roll))
        position = joints.get(joint.get('name'), 0.0)
        if joint.get('type') in ('fixed', None) or position == 0.0:
            return pose
        axis = [float(x) for x in joint.find('axis').get('xyz').split()]
        if joint.get('type') == 'prismatic':
            return pose @ translation(*(position * numpy.asarray(axis)))
        return pose @ rotation(axis, position)
