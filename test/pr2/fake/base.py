"""A PR2's base: its controller, its wheels, its odometry, and who may command it. Time is handed in
as steps."""

import math

import numpy

from .scene import Pose2, wrap

MAX_SPEED = 1.0            # [m/s] limits of pr2_base_controller2.yaml
MAX_TURN = 2.0             # [rad/s]
MAX_ACCELERATION = numpy.array([2.0, 2.0, 2.0])  # [m/s^2], [m/s^2], [rad/s^2]
TIMEOUT = 0.2              # [s]
# Without a command in time the controller's target is zero at once, without its ramp, and without
# motors nothing turns the wheels: what then brakes are gears and tyres. Assumed, not published; the
# published efforts of wheels stop a simulated PR2 at 2.6 to 3.8 m/s^2 (docs/notes_physics.md).
WHEEL_DECELERATION = 3.0   # [m/s^2], [rad/s^2]
WHEEL_SLIP = 0.01          # share that the wheels turn more than the base moves
WHEEL_TURN_SLIP = 0.03     # ... while turning: wheels say more than the gyroscope
LONGEST_GAP = 0.02         # [s] of a time that counts as silence when this process was late


class Base:
    """Where the base is in the map (truth), and how fast in its own frame."""

    def __init__(self, X_MB):
        self.X_MB = X_MB
        self.V_B = numpy.zeros(3)       # x, y [m/s], yaw [rad/s]
        self.is_halted = False
        self._target = numpy.zeros(3)   # last command
        self._command = numpy.zeros(3)  # what the wheels are told
        self._silence = math.inf        # [s] since the last command

    def command(self, x, y, turn):
        speed = math.hypot(x, y)
        share = min(1.0, MAX_SPEED / speed) if speed > 1e-5 else 0.0
        self._target = numpy.array([x * share, y * share, max(-MAX_TURN, min(MAX_TURN, turn))])
        self._silence = 0.0

    def begin_turn(self, late):
        """A round of the loop begins, `late` [s] after the last: what was sent meanwhile has been
        taken already, so that a late loop is not taken for a silent sender."""
        self._silence += min(late, LONGEST_GAP)

    def step(self, dt):
        if self.is_halted or self._silence > TIMEOUT + 1e-9:
            self._command = numpy.zeros(3)
        else:
            self._command = self._ramp(dt)
        if self.is_halted:
            self._target = numpy.zeros(3)
        before = self.V_B
        self.V_B = before + self._limited(self._command - before, WHEEL_DECELERATION * dt)
        middle = (before + self.V_B) / 2 * dt
        self.X_MB = self.X_MB * Pose2(*_arc(middle))

    def _ramp(self, dt):
        """Towards the target, all three in step, as the slowest of them gets there."""
        change = self._target - self._command
        share = min(1.0, *(MAX_ACCELERATION * dt / numpy.maximum(numpy.abs(change), 1e-12)))
        return self._command + share * change

    @staticmethod
    def _limited(change, limit):
        largest = max(math.hypot(change[0], change[1]), abs(change[2]))
        return change if largest <= limit else change * (limit / largest)


def _arc(motion):
    """x, y, yaw of a motion along an arc."""
    x, y, yaw = motion
    c, s = math.cos(yaw / 2), math.sin(yaw / 2)
    return c * x - s * y, s * x + c * y, yaw


class Odometer:
    """Sums up what wheels, or wheels and gyroscope, say."""

    def __init__(self, slip, turn_slip):
        self.X_OB = Pose2()
        self.V_B = numpy.zeros(3)
        self._factors = numpy.array([1.0 + slip, 1.0 + slip, 1.0 + turn_slip])

    def step(self, V_B, dt):
        before, self.V_B = self.V_B, V_B * self._factors
        self.X_OB = self.X_OB * Pose2(*_arc((before + self.V_B) / 2 * dt))


class Multiplexer:
    """Who drives: the joystick while it speaks, else the navigation."""

    HOLD = 0.5  # [s] that the joystick keeps the base after its last word

    def __init__(self):
        self._joystick = -math.inf  # [s]

    def admits_navigation(self, now):
        return now - self._joystick > self.HOLD

    def joystick(self, now):
        self._joystick = now


class Amcl:
    """Where the robot believes to be: corrected now and then, in between as odometry says."""

    UPDATE_DISTANCE = 0.2  # [m]
    UPDATE_ANGLE = 0.5     # [rad]
    TOLERANCE = 0.1        # [s] by which its transform is dated into the future
    NOISE = (0.01, 0.01, 0.005)  # [m], [m], [rad] sd of a correction
    SPREAD = (0.05, 0.05, 0.05)  # [m], [m], [rad] that it tells of
    LOST_SPREAD = (1.0, 1.0, 0.8)

    def __init__(self, seed):
        self._rng = numpy.random.default_rng(seed)
        self.X_MO = None
        self.is_lost = False
        self._at = None  # odometry of the last correction

    def update(self, X_MB, X_OB):
        """A scan came. @return believed pose in the map and its spread, if it was corrected."""
        if self._at is not None and not self._is_due(X_OB):
            return None
        self._at = X_OB
        error = Pose2(*self._rng.normal(0.0, self.NOISE))
        X_MB_believed = X_MB * error
        self.X_MO = X_MB_believed * X_OB.inverse()
        return X_MB_believed, self.LOST_SPREAD if self.is_lost else self.SPREAD

    def forget(self):
        """It begins anew with the next scan."""
        self._at = None

    def _is_due(self, X_OB):
        moved = self._at.inverse() * X_OB
        return (math.hypot(moved.x, moved.y) >= self.UPDATE_DISTANCE or
                abs(wrap(moved.yaw)) >= self.UPDATE_ANGLE)
