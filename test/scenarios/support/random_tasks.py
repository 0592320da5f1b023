"""Tasks at random: what is to be done, where everything stands at first, what nobody tells the
robot, and what it is told and is not so. The same seed gives the same task."""

import math
import random

from restaurant import FRAMES, FURNITURE, SEATS, area_under, knowledge_of
from closed_loop import scenario_of

KINDS = ('serve', 'carry', 'clear')
OBJECTS = ('mug1', 'mug2', 'peppermill1')
OBSTACLES = ('bowl1', 'book1')
STANDS = ('premanipulationareaeastcounter1', 'premanipulationareanorthtable1',
          'premanipulationareasouthtable1', 'premanipulationareaeasttable2',
          'premanipulationareawesttable2', 'nearstartarea1', 'home', (12.5, 9.8, 2.0))
TORSOS = ('torsodownposture', 'torsomiddleposture', 'torsoupposture')
ARMS = (('armtuckedposture', 'armtuckedposture'), ('armuntuckedposture', 'armuntuckedposture'),
        ('armtuckedposture', 'armtosideposture'), ('armtosideposture', 'armtosideposture'))
APART = 0.16  # [m] between objects
TOLD_OFF = (0.03, 0.08)  # [m] between where a thing stands and where it is told to stand
TOLD_APART = 0.1         # [m] between things as they are told to stand
ELSEWHERE = 0.2          # how often it is told on another spot of the area
TRIES = 100


class RandomTask:
    def __init__(self, seed):
        chance = random.Random('task %d' % seed)
        self.seed = seed
        self.objects, self.hidden = {}, {}
        self.guests = self._draw_guests(chance)
        self.kind = KINDS[seed % len(KINDS)]
        getattr(self, '_draw_' + self.kind)(chance)
        self.coffees = self._draw_coffees(chance)
        self.missing = self._draw_missing(chance)
        self.robot, self.start = self._draw_robot(chance)
        self.is_placing_imagined = chance.random() < 0.5

    def knowledge(self, is_exact=True):
        """Text of a file.
        @param is_exact  whether things are told to stand just where they do."""
        told = self.objects if is_exact else self._tell_about_where()
        return knowledge_of(told, self.coffees, self.guests)

    def can_be_done(self):
        """Whether what is missing leaves what the task needs."""
        if self.kind == 'serve':
            return not set(self.coffees) <= self.missing
        return self.kind != 'carry' or self.goal_object not in self.missing

    def _tell_about_where(self):
        """As somebody says it who was there: some centimetres off, now and then on another spot of the
        same area, turned anyhow."""
        chance = random.Random('told %d' % self.seed)
        told = {}
        for name, pose in self.objects.items():
            told[name] = self._told_pose(chance, pose, list(told.values()))
        return told

    def _told_pose(self, chance, pose, told):
        area, yaw = area_under(*pose[:3]), round(chance.uniform(-math.pi, math.pi), 2)
        is_elsewhere = chance.random() < ELSEWHERE
        for _ in range(TRIES):
            off, way = chance.uniform(*TOLD_OFF), chance.uniform(-math.pi, math.pi)
            if is_elsewhere:
                x, y = (middle + chance.uniform(-0.12, 0.12) for middle in FRAMES[area][:2])
            else:
                x, y = pose[0] + off * math.cos(way), pose[1] + off * math.sin(way)
            found = (round(x, 3), round(y, 3), pose[2], yaw)
            if area_under(*found[:3]) == area and all(
                    max(abs(x - p[0]), abs(y - p[1])) > TOLD_APART for p in told):
                return found
        return pose[:3] + (yaw,)

    def scenario(self):
        there = {name: pose for name, pose in self.objects.items() if name not in self.missing}
        return scenario_of(self.robot, there, self.hidden)

    def is_done(self, there):
        """@param there  names of what stands on the areas that the task is about."""
        if self.kind == 'serve':
            return bool(set(there) & set(self.coffees))
        if self.kind == 'carry':
            return self.goal_object in there
        return set(there) & set(self.objects) == set(self.objects) - self.missing

    def _draw_guests(self, chance):
        seats = chance.sample(sorted(SEATS), chance.randint(1, len(SEATS)))
        return {'guest%d' % (i + 1): seat for i, seat in enumerate(seats)}

    def _draw_serve(self, chance):
        guest = chance.choice(sorted(self.guests))
        self.task = 'serve_coffee_to_guest ' + guest
        self.goal_areas = SEATS[self.guests[guest]]
        for name in chance.sample(OBJECTS, chance.randint(1, 3)):
            self._put(chance, name, 'placingareaeastrightcounter1')
        if not any(name.startswith('mug') for name in self.objects):
            self._put(chance, 'mug1', 'placingareaeastrightcounter1')
        self._hide(chance)

    def _draw_carry(self, chance):
        source, target = chance.sample(sorted(FURNITURE), 2)
        name = chance.choice(OBJECTS)
        self.task = 'carry_object_on_tray %s %s %s' % (name, source, target)
        self.goal_areas = FURNITURE[target]
        self.goal_object = name
        self._put(chance, name, chance.choice(FURNITURE[source]))
        for other in OBJECTS:
            if other != name and chance.random() < 0.3:
                self._put(chance, other, 'placingareaeastrightcounter1')
        self._hide(chance)

    def _draw_clear(self, chance):
        table = chance.choice(('table1', 'table2'))
        self.task = 'clear_table %s counter1' % table
        self.goal_areas = FURNITURE['counter1']
        areas = chance.sample(FURNITURE[table], 2)
        for name, area in zip(chance.sample(OBJECTS, chance.randint(1, 2)), areas):
            self._put(chance, name, area)

    def _draw_coffees(self, chance):
        mugs = sorted(name for name in self.objects if name.startswith('mug'))
        full = [name for name in mugs if chance.random() < 0.7]
        return full or mugs[:1]

    def _draw_missing(self, chance):
        """Now and then somebody took a thing away."""
        return {chance.choice(sorted(self.objects))} if chance.random() < 0.2 else set()

    def _draw_robot(self, chance):
        stand = chance.choice(STANDS)
        is_area = isinstance(stand, str)
        pose = list(FRAMES[stand][:2] + FRAMES[stand][3:]) if is_area else list(stand)
        arms = chance.choice(ARMS)
        robot = {'pose': pose, 'torso': chance.choice(TORSOS),
                 'arms': {'leftarm1': arms[0], 'rightarm1': arms[1]}}
        return robot, stand if is_area else 'floor'

    def _hide(self, chance):
        """Now and then things stand where something is to be put."""
        for name in OBSTACLES:
            if chance.random() < 0.3:
                self._put(chance, name, chance.choice(self.goal_areas), self.hidden)

    def _put(self, chance, name, area, among=None):
        """Somewhere on an area, away from what stands there; nowhere if there is no room."""
        among = self.objects if among is None else among
        x, y, z, _ = FRAMES[area]
        along = 0.24 if 'counter' in area else 0.06
        for _ in range(TRIES):
            pose = (round(x + chance.uniform(-0.06, 0.06), 3),
                    round(y + chance.uniform(-along, along), 3), z, 0.0)
            others = [*self.objects.values(), *self.hidden.values()]
            if all(max(abs(pose[0] - p[0]), abs(pose[1] - p[1])) > APART for p in others):
                assert area_under(*pose[:3]) == area, (name, area)
                among[name] = pose
                return
