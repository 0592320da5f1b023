"""A recogniser of objects in the picture of the head's camera. A laboratory brings its own; this
one knows the objects of the fake world and errs a little."""

import math

import numpy

LINK = 'head_mount_kinect_ir_link'   # x forward
HALF_WIDTH = math.radians(58.0) / 2  # [rad]
HALF_HEIGHT = math.radians(45.0) / 2
RANGE = (0.8, 3.5)                   # [m]
PERIOD = 0.5                         # [s] between two looks
STILL = 0.02                         # [rad/s] a head that turns faster sees nothing sharp
NOISE = 0.003                        # [m] sd


class Camera:
    def __init__(self, world, seed):
        self._world = world
        self._rng = numpy.random.default_rng(seed)

    def look(self):
        """[(thing, X_CO, visible share)] of what is in the picture."""
        X_CM = numpy.linalg.inv(self._world.parent_pose(LINK))
        seen = []
        for thing in self._world.things.values():
            X_CO = X_CM @ self._world.pose(thing)
            height = thing.shape.top - thing.shape.bottom
            x, y, z = (X_CO @ (0.0, 0.0, height / 2, 1.0))[:3]
            distance = math.sqrt(x * x + y * y + z * z)
            if not RANGE[0] <= distance <= RANGE[1] or x <= 0.0:
                continue
            if abs(math.atan2(y, x)) > HALF_WIDTH or abs(math.atan2(z, x)) > HALF_HEIGHT:
                continue
            X_CO[:3, 3] += self._rng.normal(0.0, NOISE, 3)
            seen.append((thing, X_CO, 1.0))
        return seen
