"""Whether what the monitor claims is so: its words against the truth of the same moment."""

import re

from restaurant import FRAMES, FURNITURE, is_at, is_over

WORD = re.compile(r'(\w+)\(([^()]*)\): (?:unavailable: )?(\w+)(?:: ([^;]*))?')
ATOM = re.compile(r'(not )?(\w+)\(([^()]*)\)')
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


def words_of(text):
    return [word.strip() for word in text.split(',') if word.strip()]


def judge_atom(text, truth):
    """Of 'condition_lost' and 'effect_missing': the atom must not hold."""
    match = ATOM.match(text.strip())
    is_so = truth.holds(match.group(2), words_of(match.group(3))) if match else None
    if is_so is None:
        return OPEN
    return FALSE if is_so != bool(match.group(1)) else TRUE


def judge_occupied(arguments, things, truth):
    area = FRAMES[arguments[-1]]

    def is_there(name):
        thing = truth.objects.get(name)
        return thing is not None and not thing.attached_to and max(
            abs(thing.pose.position.x - area[0]), abs(thing.pose.position.y - area[1])) < 0.45
    return TRUE if things and all(is_there(thing) for thing in things) else FALSE


def judge(action, arguments, reason, detail, truth):
    """One claim about one step."""
    thing = next((a for a in arguments if a in truth.stands), None)
    if reason in ('condition_lost', 'effect_missing'):
        return judge_atom(detail, truth)
    if reason == 'area_occupied':
        return judge_occupied(arguments, words_of(detail), truth)
    if reason in ('object_slipped', 'grasp_failed') and thing:
        return FALSE if truth.holder(thing) else TRUE
    if reason == 'object_toppled' and thing:
        lies = not truth.stands[thing] and not truth.holder(thing)
        return TRUE if lies or truth.falls.get(thing) else FALSE
    if reason == 'object_not_seen':
        furniture = sum(FURNITURE.values(), [])
        is_there = thing and (truth.stands_on(thing, furniture) or truth.is_on_tray(thing))
        return FALSE if is_there else TRUE
    if reason == 'robot_collision':
        return TRUE if truth.has_collided else FALSE
    return OPEN


def judge_warning(text, truth):
    """[(claim, TRUE, FALSE or OPEN)] of a warning."""
    match = WORD.match(text)
    if not match:
        return []
    action, arguments, reason, detail = match.groups()
    verdict = judge(action, words_of(arguments), reason, detail or '', truth)
    return [('%s(%s): %s%s' % (action, arguments, reason, ': ' + detail if detail else ''),
             verdict)]
