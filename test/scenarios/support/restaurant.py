"""Places of the restaurant, and knowledge files for other objects and guests than usual."""

import math
import os
import re
import xml.etree.ElementTree

from closed_loop import CONFIG, RESTAURANT

WORLD = os.path.join(CONFIG, '..', 'worlds', 'restaurant.world')
LOOSE = re.compile(r'(pose|boundingBox|on|at)?(mug\d|peppermill\d|coffee\d|guest\d)$', re.I)

# Furniture -> its placing areas, in the order in which the planner tries them; and seats likewise.
FURNITURE = {
    'counter1': ['placingareaeastrightcounter1'],
    'table1': ['placingareawestlefttable1', 'placingareaeastrighttable1',
               'placingareaeastlefttable1', 'placingareawestrighttable1'],
    'table2': ['placingareanorthlefttable2', 'placingareasouthrighttable2',
               'placingareanorthrighttable2', 'placingareasouthlefttable2'],
}
SEATS = {
    'sittingareawesttable1': ['placingareawestrighttable1', 'placingareawestlefttable1'],
    'sittingareaeasttable1': ['placingareaeastrighttable1', 'placingareaeastlefttable1'],
    'sittingareanorthtable2': ['placingareanorthrighttable2', 'placingareanorthlefttable2'],
    'sittingareasouthtable2': ['placingareasouthrighttable2', 'placingareasouthlefttable2'],
}
HALF = {'placingareaeastrightcounter1': (0.175, 0.325)}  # [m] along x and y; others:
HALF_TABLE = (0.175, 0.175)

CONCEPTS = {'mug': ('Mug', 0.08, 0.1), 'peppermill': ('Peppermill', 0.074, 0.274)}


def read_frames():
    """{name in lower case: (x, y, z, yaw)}"""
    frames = {}
    for frame in xml.etree.ElementTree.parse(WORLD).iter('frame'):
        pose = [float(number) for number in frame.findtext('pose').split()]
        frames[frame.get('name').lower()] = (pose[0], pose[1], pose[2], pose[5])
    return frames


FRAMES = read_frames()
# The box that the knowledge has of this area lies about another middle than its frame.
FRAMES['placingareaeastrightcounter1'] = (5.47, 10.01, 0.75, 0.0)


def is_over(area, x, y, z, slack=0.0):
    """Whether a point lies on a placing area; those of table2 overlap.
    @param slack  [m] beyond its edges."""
    middle = FRAMES[area]
    half = HALF.get(area, HALF_TABLE)
    return (abs(x - middle[0]) <= half[0] + slack and abs(y - middle[1]) <= half[1] + slack and
            abs(z - middle[2]) <= 0.1)


def area_under(x, y, z):
    """The nearest placing area that a point lies on, or None."""
    under = [area for areas in FURNITURE.values() for area in areas if is_over(area, x, y, z)]
    return min(under, default=None,
               key=lambda area: math.hypot(x - FRAMES[area][0], y - FRAMES[area][1]))


def is_at(pose, yaw, area, distance, angle):
    """Whether the robot stands there, by these tolerances [m] and [rad]."""
    x, y, _, wanted = FRAMES[area]
    return (math.hypot(pose.position.x - x, pose.position.y - y) <= distance and
            abs(math.remainder(yaw - wanted, 2.0 * math.pi)) <= angle)


def fluent(concept, instance, *properties):
    lines = ['!Fluent', 'Class_Instance: ["%s", %s]' % (concept, instance), 'StartTime: [0, 0]',
             'FinishTime: [0, 0]', 'Properties:' + ('' if properties else ' []')]
    return '\n'.join(lines + ['  - [%s]' % ', '.join(p) for p in properties]) + '\n'


def real(role, value):
    return role, '"xsd:float"', '%r' % float(value)


def about_object(name, pose, has_coffee):
    concept, width, height = CONCEPTS[name.rstrip('0123456789')]
    x, y, z, yaw = pose
    marks = [('hasPose', 'Pose', 'pose_' + name), ('hasBoundingBox', 'BoundingBox', 'box_' + name)]
    if has_coffee:
        marks.append(('hasContent', 'Coffee', 'coffee_in_' + name))
    yield fluent(concept, name, *marks)
    yield fluent('Pose', 'pose_' + name, real('hasX', x), real('hasY', y), real('hasZ', z),
                 real('hasYaw', yaw))
    yield fluent('BoundingBox', 'box_' + name, real('hasXSize', width), real('hasYSize', width),
                 real('hasZSize', height), ('hasPose', 'Pose', 'pose_' + name))
    yield fluent('On', 'on_' + name, ('hasPhysicalEntity', concept, name),
                 ('hasArea', 'PlacingArea', area_under(x, y, z)))
    if has_coffee:
        yield fluent('Coffee', 'coffee_in_' + name)


def about_guest(name, seat):
    yield fluent('Guest', name)
    yield fluent('At', 'at_' + name, ('hasPhysicalEntity', 'Guest', name),
                 ('hasArea', 'SittingArea', seat))


def knowledge_of(objects, coffees, guests):
    """Text of a knowledge file: the restaurant with these objects and guests, and no others.
    @param objects  {name: [x, y, z, yaw]}
    @param coffees  names of mugs that are full
    @param guests   {name: seat}"""
    with open(RESTAURANT) as file:
        documents = file.read().split('\n---\n')

    def is_kept(document):
        instance = re.search(r'Class_Instance: \["?\w+"?, (\w+)\]', document).group(1)
        return not LOOSE.match(instance)
    told = [document for document in documents if is_kept(document)]
    for name, pose in objects.items():
        told += about_object(name, pose, name in coffees)
    for name, seat in guests.items():
        told += about_guest(name, seat)
    return '\n---\n'.join(document.rstrip('\n') for document in told) + '\n'
