"""Whether what the monitor claims is so: failures of steps against the truth of the same moment."""

import re

from hires.msg import Failure, StepStatus

from failures import text_of
from restaurant import FRAMES, FURNITURE, is_at, is_over

STANDING = re.compile('manipulationarea|startarea|^home$')
EDGE = 0.06    # [m] that an object may be off what is seen of it, and that counts as on an area
PALMS = {'leftarm1': 'l_gripper_palm_link', 'rightarm1': 'r_gripper_palm_link'}
TORSO = {'torsodownposture': (0.0, 0.03), 'torsoupposture': (0.27, 0.33)}  # [m] surely so

TRUE, FALSE, OPEN = 'true', 'false', 'not to be checked'


class Snapshot:
    """What is true now, of a Truth that goes on."""

    def __init__(self, truth):
        self.robot = truth.robot[-1]
        self.objects = {o.name: o for o in truth.world.objects}
        self.stands = {o.name: o.stands for o in truth.summary.objects}
        self.falls = truth.falls()
        self.has_collided = truth.summary.robot_collided

    def holder(self, name):
        held = self.objects.get(name)
        return held.attached_to if held else ''

    def held_by(self, arm):
        return next((o.name for o in self.objects.values() if o.attached_to == PALMS[arm]),
                    'nothing')

    def stands_free(self, name):
        """It is there, upright, and nobody holds it."""
        found = self.objects.get(name)
        return found is not None and self.stands[name]

    def stands_on(self, name, areas, slack=0.0):
        """Whether it stands free on one of these."""
        if not self.stands_free(name):
            return False
        p = self.objects[name].pose.position
        return any(is_over(area, p.x, p.y, p.z, slack) for area in areas)

    def is_on_tray(self, name):
        if not self.stands_free(name):
            return False
        p, base = self.objects[name].pose.position, self.robot.pose.position
        return 0.25 < p.z < 0.45 and abs(p.x - base.x) + abs(p.y - base.y) < 0.7

    def is_at(self, area):
        """As observation classifies it; None near the edge, where it may be either."""
        if 'floorarea' in area:  # where it is at no other one
            others = [self.is_at(other) for other in FRAMES if STANDING.search(other)]
            return False if True in others else None if None in others else True
        if is_at(self.robot.pose, self.robot.yaw, area, 0.20, 0.28):
            return True
        return None if is_at(self.robot.pose, self.robot.yaw, area, 0.32, 0.45) else False

    def holds(self, predicate, arguments):
        """Whether an atom is so: True, False, or None where truth does not tell."""
        if predicate == 'on':
            if arguments[1] == 'trayarea1':
                return self.is_on_tray(arguments[0])
            return self.stands_on(arguments[0], [arguments[1]], EDGE)
        if predicate == 'holding':
            return self.held_by(arguments[0]) == arguments[1]
        if predicate == 'robotat':
            return self.is_at(arguments[0])
        if predicate == 'hastorsoposture' and arguments[0] in TORSO:
            height = dict(zip(self.robot.joints.name, self.robot.joints.position))[
                'torso_lift_joint']
            low, high = TORSO[arguments[0]]
            return low <= height <= high
        return None


def effect_of(step):
    """(predicate, whether it is to hold) of the effect whose arguments the failure names; None where
    these are of no kind that truth tells of."""
    subjects, action = step.failure.subjects, step.action
    picks, places = action.name.startswith('pick'), action.name.startswith('place')
    if len(subjects) == 2 and (picks or places):
        if subjects[0] not in PALMS:
            return 'on', places
        return 'holding', picks == (subjects[1] != 'nothing')
    if len(subjects) == 1 and subjects[0] in TORSO:
        return 'hastorsoposture', subjects[0] in action.arguments
    if len(subjects) == 1 and subjects[0] in FRAMES:
        return 'robotat', subjects[0] in action.arguments
    return None


def judge_effect(step, truth):
    """The effect must be missing in truth, too."""
    effect = effect_of(step)
    is_so = truth.holds(effect[0], step.failure.subjects) if effect else None
    if is_so is None:
        return OPEN
    return FALSE if is_so == effect[1] else TRUE


def condition_of(subjects):
    """The predicate of what a step rests on, told by its arguments; None for others."""
    if len(subjects) == 2:
        return 'holding' if subjects[0] in PALMS else 'on'
    return 'robotat' if len(subjects) == 1 and subjects[0] in FRAMES else None


def judge_loss(step, truth):
    """What the step rests on must not be so in truth, too. The domain's steps rest on no place that
    must be empty, and no hand."""
    predicate = condition_of(step.failure.subjects)
    is_so = truth.holds(predicate, step.failure.subjects) if predicate else None
    return OPEN if is_so is None else FALSE if is_so else TRUE


def judge_occupied(step, truth):
    area = FRAMES[step.action.arguments[-1]]

    def is_there(name):
        thing = truth.objects.get(name)
        return thing is not None and not thing.attached_to and max(
            abs(thing.pose.position.x - area[0]), abs(thing.pose.position.y - area[1])) < 0.45
    return TRUE if step.failure.subjects and all(map(is_there, step.failure.subjects)) else FALSE


def judge(step, truth):
    """What the failure of a step says."""
    code = step.failure.code
    thing = next((a for a in step.action.arguments if a in truth.stands), None)
    if code == Failure.EFFECT_MISSING:
        return judge_effect(step, truth)
    if code == Failure.CONDITION_LOST:
        return judge_loss(step, truth)
    if code == Failure.AREA_OCCUPIED:
        return judge_occupied(step, truth)
    if code in (Failure.OBJECT_SLIPPED, Failure.GRASP_FAILED) and thing:
        return FALSE if truth.holder(thing) else TRUE
    if code == Failure.OBJECT_TOPPLED and thing:
        lies = not truth.stands[thing] and not truth.holder(thing)
        return TRUE if lies or truth.falls.get(thing) else FALSE
    if code == Failure.OBJECT_NOT_SEEN:
        furniture = sum(FURNITURE.values(), [])
        is_there = thing and (truth.stands_on(thing, furniture) or truth.is_on_tray(thing))
        return FALSE if is_there else TRUE
    if code == Failure.ROBOT_COLLISION:
        return TRUE if truth.has_collided else FALSE
    return OPEN


class Claims:
    """All that was claimed, each judged when it was said first: [(words for people, verdict)]."""

    def __init__(self):
        self.verdicts = []
        self._told = set()

    def note(self, steps, truth):
        for step in steps:
            key = step.plan, step.index
            has_begun = step.phase in (StepStatus.RUNNING, StepStatus.CHECKING, StepStatus.DONE)
            if has_begun or step.failure.code == Failure.NONE or key in self._told:
                continue
            self._told.add(key)
            words = '%s(%s): %s' % (step.action.name, ', '.join(step.action.arguments),
                                    text_of(step.failure))
            self.verdicts.append((words, judge(step, truth)))
