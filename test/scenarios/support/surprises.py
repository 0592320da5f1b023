"""What nobody tells the robot of and what its task is not about: on the counter, where things are
taken from and put, stand a box of no known kind and another, cold mug; a second box stands on the
table that the task is about, if it is not the last part with room; and a guest has got up and left a
chair in the way. The same task gives the same surprises."""

import os
import random

from closed_loop import CONFIG
from random_tasks import APART
from restaurant import FRAMES, is_over

# The truth in which that chair stands there.
MOVED_CHAIR = os.path.join(CONFIG, '..', 'test', 'data', 'loop', 'moved_chair.yaml')
ON_COUNTER = (('box1', 'unknown_0.110x0.070x0.180'), ('mug9', 'coffee_cup'))
AT_GOAL = ('box2', 'unknown_0.110x0.070x0.180')
COUNTER = 'placingareaeastrightcounter1'
AHEAD, BEHIND, ALONG = 0.06, -0.1, 0.5  # [m] off the middle of the counter's area
ON_TABLE = 0.06  # [m] off the middle of a table's area
FULL = 2  # things that leave no room on a quarter of a table
TURN = 3.0  # [rad]
TRIES = 300


def surprises(task):
    """For the `hidden` of a scenario; a thing for which there is no room is left out."""
    chance = random.Random('surprise %d' % task.seed)
    taken = [*task.objects.values(), *task.hidden.values()]
    things = []

    def put(name, model, areas):
        for area in areas:
            pose = _free_pose(chance, taken, area)
            if pose is not None:
                taken.append(pose)
                return things.append({'name': name, 'model': model, 'pose': pose})
    for name, model in ON_COUNTER:
        put(name, model, [COUNTER])
    areas = _areas_with_room(task)
    if COUNTER not in task.goal_areas and len(areas) > 1:
        put(*AT_GOAL, chance.sample(areas, len(areas)))
    return things


def _areas_with_room(task):
    poses = task.hidden.values()
    return [area for area in task.goal_areas
            if sum(is_over(area, *pose[:3]) for pose in poses) < FULL]


def _free_pose(chance, taken, area):
    x, y, z, _ = FRAMES[area]
    along_x, along_y = (((BEHIND, AHEAD), ALONG) if area == COUNTER else
                        ((-ON_TABLE, ON_TABLE), ON_TABLE))
    for _ in range(TRIES):
        pose = [round(x + chance.uniform(*along_x), 3),
                round(y + chance.uniform(-along_y, along_y), 3), z,
                round(chance.uniform(-TURN, TURN), 2)]
        if all(max(abs(pose[0] - p[0]), abs(pose[1] - p[1])) > APART for p in taken):
            return pose
    return None
