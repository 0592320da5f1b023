"""A room, what a laser sees in it, and a robot that drives there with wheels that err."""

import math

import numpy
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, Quaternion, TransformStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from sensor_msgs.msg import LaserEcho, LaserScan, MultiEchoLaserScan

MAP, BASE, LASER = 'map', 'base_footprint', 'base_laser_link'
RESOLUTION, WIDTH, HEIGHT = 0.05, 200, 140  # [m], cells: 10 m x 7 m
BOXES = ((0.0, 5.0, 1.0, 7.0), (7.5, 0.0, 10.0, 0.8), (4.0, 6.0, 5.2, 7.0), (8.8, 4.5, 10.0, 5.5),
         (5.0, 3.3, 5.4, 3.6))              # x, y of two corners [m]
LASER_X = 0.275                             # [m] before the base
ANGLES = numpy.linspace(-2.25, 2.25, 181)   # [rad]
RANGE_MAX = 12.0                            # [m]


def room():
    """Occupied cells, [row, column]."""
    grid = numpy.zeros((HEIGHT, WIDTH), bool)
    grid[[0, -1], :] = grid[:, [0, -1]] = True
    for box in BOXES:
        x0, y0, x1, y1 = (int(round(side / RESOLUTION)) for side in box)
        grid[y0:y1, x0:x1] = True
    return grid


class Laser:
    def __init__(self):
        self._grid = room()
        self._chance = numpy.random.RandomState(5)
        self._steps = numpy.arange(0.0, RANGE_MAX, 0.02)

    def ranges(self, pose):
        """Of a base at that x, y, yaw; errors of 1 cm."""
        x, y, yaw = pose
        x, y = x + LASER_X * math.cos(yaw), y + LASER_X * math.sin(yaw)
        bearing = (yaw + ANGLES)[:, None]
        column = ((x + self._steps * numpy.cos(bearing)) / RESOLUTION).astype(int)
        row = ((y + self._steps * numpy.sin(bearing)) / RESOLUTION).astype(int)
        hits = self._grid[row.clip(0, HEIGHT - 1), column.clip(0, WIDTH - 1)]
        return self._steps[hits.argmax(axis=1)] + self._chance.normal(0.0, 0.01, len(ANGLES))


def moved(pose, forward, turn):
    x, y, yaw = pose
    middle = yaw + 0.5 * turn
    return x + forward * math.cos(middle), y + forward * math.sin(middle), wrapped(yaw + turn)


def wrapped(angle):
    return math.remainder(angle, 2.0 * math.pi)


def after(first, second):
    """The pose `second`, which is seen from the pose `first`."""
    c, s = math.cos(first[2]), math.sin(first[2])
    return (first[0] + c * second[0] - s * second[1], first[1] + s * second[0] + c * second[1],
            wrapped(first[2] + second[2]))


class Robot:
    """Drives round the pillar in the middle; its odometry says too much, and turns too far."""
    START = (5.0, 1.8, 0.0)

    def __init__(self):
        self.pose, self.odometry = self.START, (0.0, 0.0, 0.0)

    def drive(self):
        self.move(0.1, 0.1 / 1.7)

    def move(self, forward, turn):
        self.pose = moved(self.pose, forward, turn)
        self.odometry = moved(self.odometry, 1.03 * forward, 1.05 * turn)


# Messages of all that; poses are x, y, yaw, times are in seconds.

def quaternion_of(yaw):
    return Quaternion(z=math.sin(yaw / 2.0), w=math.cos(yaw / 2.0))


def yaw_of(quaternion):
    return 2.0 * math.atan2(quaternion.z, quaternion.w)


def _fill(message, frame, time):
    message.header.frame_id, message.header.stamp = frame, rospy.Time.from_sec(time)
    return message


def map_message(occupied=None):
    message = _fill(OccupancyGrid(), MAP, 0.0)
    message.info.width, message.info.height, message.info.resolution = WIDTH, HEIGHT, RESOLUTION
    message.info.origin.orientation = quaternion_of(0.0)
    message.data = [100 if cell else 0 for cell in (room() if occupied is None else occupied).flat]
    return message


def pose_message(pose, time, variance=0.04):
    """For initialpose."""
    message = _fill(PoseWithCovarianceStamped(), MAP, time)
    message.pose.pose.position.x, message.pose.pose.position.y = pose[:2]
    message.pose.pose.orientation = quaternion_of(pose[2])
    for index in (0, 7, 35):
        message.pose.covariance[index] = variance
    return message


def scan_message(laser, pose, time):
    return _fill(LaserScan(angle_min=ANGLES[0], angle_increment=ANGLES[1] - ANGLES[0], angle_max=ANGLES[-1],
                           range_min=0.02, range_max=RANGE_MAX, ranges=laser.ranges(pose)), LASER, time)


def echoes_of(scan):
    """As a laser tells it that hears several echoes of a beam, the nearest one not first."""
    echoes = MultiEchoLaserScan(header=scan.header)
    for name in ('angle_min', 'angle_max', 'angle_increment', 'range_min', 'range_max'):
        setattr(echoes, name, getattr(scan, name))
    echoes.ranges = [LaserEcho([distance + 1.5, distance]) for distance in scan.ranges]
    return echoes


def odometry_message(pose, time):
    message = _fill(Odometry(child_frame_id=BASE), 'odom', time)
    message.pose.pose.position.x, message.pose.pose.position.y = pose[:2]
    message.pose.pose.orientation = quaternion_of(pose[2])
    return message


def transform_message(parent, child, pose, time):
    message = _fill(TransformStamped(child_frame_id=child), parent, time)
    message.transform.translation.x, message.transform.translation.y = pose[:2]
    message.transform.rotation = quaternion_of(pose[2])
    return message


def laser_transform():
    return transform_message(BASE, LASER, (LASER_X, 0.0, 0.0), 0.0)


class HearsEchoes:
    """For the test of a node that hears scans on `base_scan`."""
    node_type = None  # what starts it

    def test_a_laser_that_hears_several_echoes_is_used_by_the_nearest(self):
        from sensor_msgs.msg import MultiEchoLaserScan, Range
        plain = self.scan
        self.scans = self.rospy.Publisher('/echoes', MultiEchoLaserScan, queue_size=1000)
        self.publishers = self.publishers[:-1] + [self.scans]
        self.scan = lambda: echoes_of(plain())
        node = self.begun('base_scan:=/echoes')
        self.assertLess(max(self.drive(30, node))[0], 0.15)
        sonar = self.rospy.Publisher('/sonar', Range, queue_size=10)
        self.publishers = self.publishers[:-1] + [sonar]
        node = self.node_type(self, 'base_scan:=/sonar')
        sonar.publish(Range())
        self.dropped(node, 'its type is sensor_msgs/Range, wanted sensor_msgs/LaserScan or MultiEchoLaserScan')
