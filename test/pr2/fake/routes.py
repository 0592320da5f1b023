"""Routes on an occupancy grid for a round robot: shortest, but rather through the middle."""

import heapq
import math

import numpy

from .scene import wrap

RADIUS = 0.36      # [m] of the base with its padding
SHY = 0.55         # [m] inflation: nearer to an obstacle costs more
SHY_COST = 3.0     # times the length, next to an obstacle
NEIGHBOURS = [(dx, dy, math.hypot(dx, dy)) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]


class Router:
    """@param message  nav_msgs/OccupancyGrid.
    @param shapes   what a tilting laser has marked beyond the map: tables whose legs alone are in
                    it."""

    def __init__(self, message, shapes=()):
        info = message.info
        self._resolution = info.resolution
        self._x, self._y = info.origin.position.x, info.origin.position.y
        cells = numpy.array(message.data, numpy.int8).reshape(info.height, info.width)
        x = self._x + (numpy.arange(info.width) + 0.5) * info.resolution
        y = self._y + (numpy.arange(info.height) + 0.5) * info.resolution
        x, y = numpy.meshgrid(x, y)
        blocked = cells != 0
        for shape in shapes:
            blocked = blocked | (shape.distance(x, y) <= info.resolution / 2)
        self._cost = self._inflate(blocked)

    def _inflate(self, blocked):
        """Cost per length; infinite where the base would touch."""
        distance = numpy.where(blocked, 0.0, math.inf)
        reach = int(math.ceil(SHY / self._resolution))
        height, width = blocked.shape
        padded = numpy.pad(blocked, reach)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                away = math.hypot(dx, dy) * self._resolution
                if away <= SHY:
                    near = padded[reach + dy:reach + dy + height, reach + dx:reach + dx + width]
                    distance = numpy.where(near, numpy.minimum(distance, away), distance)
        shy = 1.0 + SHY_COST * numpy.clip((SHY - distance) / (SHY - RADIUS), 0.0, 1.0)
        return numpy.where(distance < RADIUS, math.inf, shy)

    def _cell(self, x, y):
        return (int((x - self._x) / self._resolution), int((y - self._y) / self._resolution))

    def _cost_at(self, cell):
        height, width = self._cost.shape
        inside = 0 <= cell[0] < width and 0 <= cell[1] < height
        return self._cost[cell[1], cell[0]] if inside else math.inf

    def plan(self, start, goal):
        """Points x, y [m] from start to goal (Pose2); None: there is no way. A start too near to an
        obstacle may still be left."""
        first, last = self._cell(start.x, start.y), self._cell(goal.x, goal.y)
        if math.isinf(self._cost_at(last)):
            return None
        best, came = {first: 0.0}, {}
        queue = [(0.0, first)]
        done = set()
        while queue:
            _, cell = heapq.heappop(queue)
            if cell == last:
                return self._points(came, first, last, goal)
            if cell in done:
                continue
            done.add(cell)
            for dx, dy, length in NEIGHBOURS:
                following = (cell[0] + dx, cell[1] + dy)
                price = self._cost_at(following)
                if math.isinf(price):
                    if not self._is_leaving(first, following):
                        continue
                    price = 10.0
                cost = best[cell] + length * price
                if cost < best.get(following, math.inf):
                    best[following], came[following] = cost, cell
                    ahead = math.hypot(last[0] - following[0], last[1] - following[1])
                    heapq.heappush(queue, (cost + ahead, following))
        return None

    def _is_leaving(self, first, cell):
        reach = 0.3 / self._resolution
        height, width = self._cost.shape
        return (math.hypot(cell[0] - first[0], cell[1] - first[1]) <= reach and
                0 <= cell[0] < width and 0 <= cell[1] < height)

    def _points(self, came, first, last, goal):
        cells = [last]
        while cells[-1] != first:
            cells.append(came[cells[-1]])
        points = [(self._x + (c + 0.5) * self._resolution, self._y + (r + 0.5) * self._resolution)
                  for c, r in reversed(cells)]
        return points[:-1] + [(goal.x, goal.y)]


class Follower:
    """Velocities along a route within the local planner's limits: turns towards it, follows a point
    ahead, turns to the goal's heading. @param limits  dict of the current parameters, Noetic's
    names."""

    AHEAD = 0.4  # [m]

    def __init__(self, points, goal):
        self._points, self._goal = points, goal
        self._speed, self._turn = 0.0, 0.0
        self._is_there = False

    def distance_to_route(self, pose):
        return min(math.hypot(x - pose.x, y - pose.y) for x, y in self._points)

    def update(self, pose, limits, dt):
        """(forward [m/s], turn [rad/s]); None: it has arrived and stands."""
        rest = math.hypot(self._goal.x - pose.x, self._goal.y - pose.y)
        self._is_there = self._is_there or rest <= limits['xy_goal_tolerance'] / 2
        if self._is_there:
            wanted = self._turn_to_goal(pose, limits)
        else:
            wanted = self._towards_point(pose, rest, limits)
        if wanted is None and self._speed == 0.0 and self._turn == 0.0:
            return None
        speed, turn = wanted or (0.0, 0.0)
        self._speed = _approach(self._speed, speed, limits['acc_lim_x'] * dt)
        self._turn = _approach(self._turn, turn, limits['acc_lim_theta'] * dt)
        return self._speed, self._turn

    def _turn_to_goal(self, pose, limits):
        error = wrap(self._goal.yaw - pose.yaw)
        if abs(error) <= limits['yaw_goal_tolerance'] / 2:
            return None
        return 0.0, _turn(error, limits)

    def _towards_point(self, pose, rest, limits):
        x, y = self._point_ahead(pose)
        error = wrap(math.atan2(y - pose.y, x - pose.x) - pose.yaw)
        if abs(error) > 0.6:
            return 0.0, _turn(error, limits)
        fastest = min(limits['max_vel_x'], limits['max_vel_trans'])
        braking = math.sqrt(2 * 0.5 * limits['acc_lim_x'] * max(rest, 0.0))
        speed = min(fastest, max(limits['min_vel_trans'], braking)) * math.cos(error) ** 2
        limit = limits['max_vel_theta']
        return speed, max(-limit, min(limit, 1.5 * error))

    def _point_ahead(self, pose):
        distances = [math.hypot(x - pose.x, y - pose.y) for x, y in self._points]
        nearest = distances.index(min(distances))
        for i in range(nearest, len(self._points)):
            if distances[i] >= self.AHEAD:
                return self._points[i]
        return self._points[-1]


def _turn(error, limits):
    size = min(limits['max_vel_theta'], max(limits['min_vel_theta'], 1.5 * abs(error)))
    return math.copysign(size, error)


def _approach(value, target, step):
    return max(value - step, min(value + step, target))
