"""A PR2's joints: their names in the order of its joint_states, how fast they are, where they are,
and the controllers that move them along splines."""

import math
import xml.etree.ElementTree as ElementTree


def _arm(side):
    return [side + '_' + name + '_joint' for name in (
        'upper_arm_roll', 'shoulder_pan', 'shoulder_lift', 'forearm_roll', 'elbow_flex',
        'wrist_flex', 'wrist_roll')]


def _gripper(side):
    return [side + '_gripper_' + name + 'joint' for name in (
        '', 'l_finger_', 'r_finger_', 'r_finger_tip_', 'l_finger_tip_', 'motor_screw_',
        'motor_slider_')]


CASTERS = ('fl', 'fr', 'bl', 'br')
NAMES = ([caster + part for caster in CASTERS for part in (
    '_caster_rotation_joint', '_caster_l_wheel_joint', '_caster_r_wheel_joint')] +
    ['torso_lift_joint', 'torso_lift_motor_screw_joint', 'head_pan_joint', 'head_tilt_joint',
     'laser_tilt_mount_joint'] +
    _arm('r') + _gripper('r') + _arm('l') + _gripper('l'))

# Controller -> its joints, as in the PR2's controller configuration.
CONTROLLERS = {
    'l_arm_controller': ['l_shoulder_pan_joint', 'l_shoulder_lift_joint', 'l_upper_arm_roll_joint',
                         'l_elbow_flex_joint', 'l_forearm_roll_joint', 'l_wrist_flex_joint',
                         'l_wrist_roll_joint'],
    'r_arm_controller': ['r_shoulder_pan_joint', 'r_shoulder_lift_joint', 'r_upper_arm_roll_joint',
                         'r_elbow_flex_joint', 'r_forearm_roll_joint', 'r_wrist_flex_joint',
                         'r_wrist_roll_joint'],
    'torso_controller': ['torso_lift_joint'],
    'head_traj_controller': ['head_pan_joint', 'head_tilt_joint'],
}
UNTUCKED = {'shoulder_pan': 0.4, 'shoulder_lift': 1.0, 'upper_arm_roll': 0.0, 'elbow_flex': -2.05,
            'forearm_roll': 0.0, 'wrist_flex': -0.1, 'wrist_roll': 0.0}
TORSO_DOWN = 0.0115   # [m] soft limit

# The gripper's linkage (facts of its transmission): half the gap over the finger's angle.
TIP_RADIUS = 0.0915                # [m]
TIP_OFFSET = -0.0001914            # [m]
TIP_ANGLE = math.radians(3.6029)   # [rad] of the fingers when closed
SCREW_PER_TURN = 0.004             # [m]


def finger_angle(gap):
    """[rad] of the fingers at a gap [m] between their tips."""
    sine = (gap / 2 - TIP_OFFSET) / TIP_RADIUS + math.sin(TIP_ANGLE)
    return min(max(math.asin(sine) - TIP_ANGLE, 0.0), 0.548)


class Limits:
    """lower, upper [rad] or [m] (infinite where a joint turns for ever) and speed."""

    def __init__(self, urdf):
        self.of = {}
        for joint in ElementTree.fromstring(urdf).findall('joint'):
            limit = joint.find('limit')
            if limit is None:
                continue
            endless = joint.get('type') == 'continuous'
            self.of[joint.get('name')] = (
                -math.inf if endless else float(limit.get('lower')),
                math.inf if endless else float(limit.get('upper')), float(limit.get('velocity')))


def initial_positions():
    positions = dict.fromkeys(NAMES, 0.0)
    for side, sign in (('l', 1.0), ('r', -1.0)):
        for name, value in UNTUCKED.items():
            positions['%s_%s_joint' % (side, name)] = value * (sign if 'pan' in name else 1.0)
    positions['torso_lift_joint'] = TORSO_DOWN
    return positions


class TrajectoryController:
    """Moves its joints along the splines of the last trajectory it was told, from where it then
    wanted them to be; never faster than they can."""

    def __init__(self, joints, limits, positions):
        self.joints = joints
        self._limits = {name: limits.of[name] for name in joints}
        self._positions = positions           # of the robot: read and written
        self._wanted = {name: positions[name] for name in joints}
        self._points = []                     # (time, positions, velocities or None), ascending
        self.velocities = dict.fromkeys(joints, 0.0)

    def command(self, now, trajectory):
        """@return why it is refused; None: it is followed from its stamp on, 0 being now."""
        if trajectory.points and sorted(trajectory.joint_names) != sorted(self.joints):
            return 'joints %s, wanted %s' % (trajectory.joint_names, self.joints)
        if not trajectory.points:
            self.hold()
            return None
        stamp = trajectory.header.stamp.to_sec()
        start = now if stamp == 0.0 else stamp
        self._points = [(now, self._at(now)[0], [self._at(now)[1][n] for n in self.joints])]
        order = [trajectory.joint_names.index(name) for name in self.joints]
        for point in trajectory.points:
            positions = [point.positions[i] for i in order]
            velocities = [point.velocities[i] for i in order] if point.velocities else None
            self._add(start + point.time_from_start.to_sec(), positions, velocities)
        return None

    def _add(self, time, positions, velocities):
        before = self._points[-1][1]
        near = {}
        for name, position in zip(self.joints, positions):
            if math.isinf(self._limits[name][0]):  # the short way round
                turn = position - before[name]
                position = before[name] + math.atan2(math.sin(turn), math.cos(turn))
            near[name] = position
        if time <= self._points[-1][0]:
            self._points[-1] = (self._points[-1][0], before, self._points[-1][2])
            time = self._points[-1][0] + 1e-3
        self._points.append((time, near, velocities))

    def hold(self):
        self._points = []
        self._wanted = {name: self._positions[name] for name in self.joints}

    def _at(self, now):
        """Wanted positions and velocities by joint."""
        still = dict.fromkeys(self.joints, 0.0)
        if not self._points:
            return dict(self._wanted), still
        if now >= self._points[-1][0]:
            return dict(self._points[-1][1]), still
        for (t0, p0, v0), (t1, p1, v1) in zip(self._points, self._points[1:]):
            if now <= t1:
                return self._spline(now - t0, t1 - t0, p0, v0, p1, v1)
        raise AssertionError('unreachable')

    def _spline(self, t, duration, p0, v0, p1, v1):
        """Cubic where both ends have velocities, else straight."""
        positions, velocities = {}, {}
        s = max(t, 0.0) / duration
        for i, name in enumerate(self.joints):
            a, b = p0[name], p1[name]
            if v0 is None or v1 is None:
                positions[name], velocities[name] = a + s * (b - a), (b - a) / duration
                continue
            m0, m1 = v0[i] * duration, v1[i] * duration
            c2, c3 = 3 * (b - a) - 2 * m0 - m1, 2 * (a - b) + m0 + m1
            positions[name] = a + s * (m0 + s * (c2 + s * c3))
            velocities[name] = (m0 + s * (2 * c2 + s * 3 * c3)) / duration
        return positions, velocities

    def step(self, now, dt):
        wanted, _ = self._at(now)
        self._wanted = wanted
        for name in self.joints:
            lower, upper, speed = self._limits[name]
            target = min(max(wanted[name], lower), upper)
            change = max(-speed * dt, min(speed * dt, target - self._positions[name]))
            self._positions[name] += change
            self.velocities[name] = change / dt
