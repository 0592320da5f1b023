"""A planar laser scanner: the base laser of a PR2 (640 beams over 260 degrees, 20 Hz)."""

import math

import numpy

NUM_BEAMS = 640
ANGLE = 2.2689        # [rad] to both sides
RANGE_MIN = 0.08      # [m]
RANGE_MAX = 10.0      # [m]
NOISE = 0.005         # [m] sd
HEIGHT = 0.303        # [m] of the beams above the floor
FORWARD = 0.275       # [m] of the scanner before the base's centre


class Laser:
    """@param shapes  what it may hit."""

    def __init__(self, shapes, seed):
        self._rng = numpy.random.default_rng(seed)
        self._angles = numpy.linspace(-ANGLE, ANGLE, NUM_BEAMS)
        boxes = [s for s in shapes if s.radius is None]
        rounds = [s for s in shapes if s.radius is not None]
        self._boxes = numpy.array([(s.pose.x, s.pose.y, s.pose.yaw, s.size[0] / 2, s.size[1] / 2)
                                   for s in boxes]).reshape(-1, 5)
        self._rounds = numpy.array([(s.pose.x, s.pose.y, s.radius)
                                    for s in rounds]).reshape(-1, 3)

    def scan(self, X_MB):
        """Ranges [m] seen from a base in the map; beyond RANGE_MAX: infinite."""
        x, y = X_MB.apply(FORWARD, 0.0)
        angles = self._angles + X_MB.yaw
        cosine, sine = numpy.cos(angles), numpy.sin(angles)
        ranges = numpy.full(NUM_BEAMS, math.inf)
        ranges = numpy.minimum(ranges, self._hit_boxes(x, y, cosine, sine))
        ranges = numpy.minimum(ranges, self._hit_rounds(x, y, cosine, sine))
        ranges += self._rng.normal(0.0, NOISE, NUM_BEAMS)
        ranges[ranges > RANGE_MAX] = math.inf
        return numpy.maximum(ranges, 0.0)

    def _hit_boxes(self, x, y, cosine, sine):
        """The slab method, in each box's own frame."""
        bx, by, yaw, half_x, half_y = (column[:, None] for column in self._boxes.T)
        c, s = numpy.cos(yaw), numpy.sin(yaw)
        u, v = c * (x - bx) + s * (y - by), -s * (x - bx) + c * (y - by)
        du, dv = c * cosine + s * sine, -s * cosine + c * sine
        with numpy.errstate(divide='ignore', invalid='ignore'):
            u1, u2 = (-half_x - u) / du, (half_x - u) / du
            v1, v2 = (-half_y - v) / dv, (half_y - v) / dv
        near = numpy.fmax(numpy.fmin(u1, u2), numpy.fmin(v1, v2))
        far = numpy.fmin(numpy.fmax(u1, u2), numpy.fmax(v1, v2))
        hits = numpy.where((near <= far) & (far > 0.0), numpy.maximum(near, 0.0), math.inf)
        return hits.min(axis=0, initial=math.inf)

    def _hit_rounds(self, x, y, cosine, sine):
        cx, cy, radius = (column[:, None] for column in self._rounds.T)
        along = (cx - x) * cosine + (cy - y) * sine
        beside = -(cx - x) * sine + (cy - y) * cosine
        with numpy.errstate(invalid='ignore'):
            hits = along - numpy.sqrt(radius ** 2 - beside ** 2)
        return numpy.where(hits > 0.0, hits, math.inf).min(axis=0, initial=math.inf)
