#!/usr/bin/env python3
"""The Blackboard as a real node under a main master of its own: services, topics, demands, slow
readers, bags, and being killed. Run alone, or by `rostest hires blackboard.test`."""

import itertools
import os
import subprocess
import sys
import threading
import unittest

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
ONTOLOGY = [os.path.join(ROOT, 'config', 'ontology', name) for name in ('upper.ttl', 'race.ttl')]
KNOWLEDGE = """!Fluent
Class_Instance: [Counter, counter1]
StartTime: [0, 0]
FinishTime: [0, 0]
Properties:
  - [hasPose, Pose, poseCounter1]
---
!Fluent
Class_Instance: [Pose, poseCounter1]
StartTime: [0, 0]
FinishTime: [0, 0]
Properties:
  - [hasX, "xsd:float", 1.5]
"""
TOPICS = """!DemandTopic
Name: mugs
SubclassFilter: [Mug]
---
!DemandTopic
Name: framed
SubclassFilter: [Pose]
PropertyFilter: [hasFrame]
---
!DemandTopic
Name: things_on_areas
QueryFilter: ['select ?instance where { ?on a upper:On ; upper:hasPhysicalEntity ?instance }']
"""
HISTORY = 50  # changes kept of a demand topic
QUEUE = 20    # messages kept for a subscriber


class Reader:
    """Follows a topic as its messages say: drops old news, counts gaps, keeps changes in order."""

    def __init__(self, rospy, kind, topic, snapshot_first):
        self._changed = threading.Condition()
        self.snapshots, self.changes, self.gaps, self.last = [], [], [], None
        self._has_begun = not snapshot_first
        self.hold = threading.Event()
        self.hold.set()
        self.entered = threading.Event()
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message)

    def _on_message(self, message):
        self.entered.set()
        self.hold.wait(LIMIT)
        with self._changed:
            self._take(message)
            self._changed.notify_all()

    def _take(self, message):
        if message.snapshot:
            self.snapshots.append(message)
            self._has_begun = True
            self.last = message.last_sequence
            return
        if not self._has_begun or (self.last is not None and message.last_sequence <= self.last):
            return
        if self.last is not None and message.previous != self.last:
            self.gaps.append((self.last, message.previous))
        self.changes += message.changes
        self.last = message.last_sequence

    def wait_for(self, condition, what):
        with self._changed:
            if not self._changed.wait_for(condition, LIMIT):
                raise AssertionError('waited in vain for ' + what)

    def close(self):
        self.hold.set()
        self._subscriber.unregister()


class BlackboardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        cls.processes.write('knowledge.yaml', KNOWLEDGE)
        cls.processes.write('topics.yaml', TOPICS)
        cls.store = os.path.join(cls.processes.folder.name, 'stores', 'blackboard.db')
        cls.config = cls.processes.write('blackboard.yaml', cls.config_text())
        cls.node = cls.start_node()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from hires import msg, srv
        cls.rospy, cls.msg, cls.srv = rospy, msg, srv
        cls.errors = msg.BlackboardError
        rospy.init_node('blackboard_test', disable_signals=True)
        cls.connect()

    @classmethod
    def config_text(cls, **changes):
        keys = dict(ontology=ONTOLOGY, store=cls.store, durability='process', cache=16, max_size=0,
                    knowledge=['knowledge.yaml'], topics=['topics.yaml'], threads=8,
                    max_waiting=1000, max_group=1000, queue_size=QUEUE, history=HISTORY,
                    max_topics=5, imagined=True)
        keys.update(changes)
        return yaml.safe_dump(keys)

    @classmethod
    def start_node(cls, *arguments):
        return cls.processes.start(
            [executable('blackboard'), '_config:=' + cls.config, *arguments], cls.main)

    @classmethod
    def connect(cls):
        """Calls of services, each over a connection of its own."""
        s = cls.srv
        cls.services = dict(
            add=s.WriteFluents, update=s.WriteFluents, remove=s.RemoveFluents,
            query=s.QueryFluents, load=s.LoadKnowledge, export=s.ExportFluents,
            start_episode=s.StartEpisode, finish_episode=s.FinishEpisode,
            list_episodes=s.ListEpisodes, changes_since=s.ChangesSince, demand=s.Demand,
            statistics=s.BlackboardStatistics)
        for name in cls.services:
            cls.rospy.wait_for_service('blackboard/' + name, LIMIT)

    def setUp(self):
        self.names = 'test%d' % id(self)

    def tearDown(self):
        self.assertTrue(self.node.is_running(), self.node.output())

    # Calls.

    def call(self, service, **fields):
        proxy = self.rospy.ServiceProxy('blackboard/' + service, self.services[service])
        return proxy(**fields)

    def grant(self, service, **fields):
        answer = self.call(service, **fields)
        self.assertEqual(answer.error.code, self.errors.NONE, answer.error.message)
        return answer

    def refuse(self, service, *texts, **fields):
        answer = self.call(service, **fields)
        self.assertEqual(answer.error.code, self.errors.REFUSED, answer.error.message)
        for text in texts:
            self.assertIn(text, answer.error.message)
        return answer

    def fluent(self, concept, instance, **links):
        """A fluent with links {role: (type, instance)}."""
        properties = [self.msg.FluentProperty(role=role, type=kind, text=text)
                      for role, (kind, text) in links.items()]
        return self.msg.Fluent(concept_name=concept, instance=instance, properties=properties)

    def pose(self, instance, x):
        return self.msg.Fluent(concept_name='Pose', instance=instance, properties=[
            self.msg.FluentProperty(role='hasX', type='xsd:float', real=x)])

    def mugs(self, prefix, count):
        return [self.fluent('Mug', '%s_%d' % (prefix, i)) for i in range(count)]

    def query(self, **fields):
        return self.grant('query', query=self.msg.FluentQuery(**fields)).fluents

    def find(self, instance, **fields):
        return self.query(instance=instance, **fields)

    def last(self):
        return self.grant('statistics').changes

    def read(self, topic, snapshot_first=True):
        reader = Reader(self.rospy, self.msg.FluentChanges, topic, snapshot_first)
        self.addCleanup(reader.close)
        if snapshot_first:
            reader.wait_for(lambda: reader.snapshots, 'the snapshot of ' + topic)
        return reader

    def read_all_changes(self):
        reader = self.read('blackboard/changes', snapshot_first=False)
        wait_until(lambda: reader._subscriber.get_num_connections() > 0, 'the connection')
        # Connected here may still mean unknown there: the first message tells.
        i = 0
        while not reader.changes:
            i += 1
            self.grant('add', fluents=[self.pose('%s_greeting' % self.names, float(i))])
            reader.entered.wait(0.1)
        wanted = self.last()
        reader.wait_for(lambda: reader.last >= wanted, 'the greeting')
        reader.changes.clear()
        return reader

    # Services.

    def test_an_empty_store_begins_with_the_knowledge_of_the_file(self):
        counter, = self.find('counter1')
        self.assertEqual(counter.concept_name, 'Counter')
        self.assertEqual([(p.role, p.type, p.text) for p in counter.properties],
                         [('hasPose', 'Pose', 'poseCounter1')])
        self.assertEqual((counter.start_earliest, counter.finish_latest),
                         (float('-inf'), float('inf')))

    def test_what_is_added_updated_and_removed_is_found_so(self):
        name = self.names
        begun = self.last()
        added = self.grant('add', fluents=[self.pose(name, 1.0)])
        self.assertEqual((added.changed, added.sequence), (1, begun + 1))
        again = self.grant('add', fluents=[self.pose(name, 1.0)])
        self.assertEqual((again.changed, again.sequence), (0, begun + 1))
        self.grant('update', fluents=[self.pose(name, 2.0)])
        pose, = self.find(name.upper())
        self.assertEqual(pose.properties[0].real, 2.0)
        self.assertEqual(len(self.find(name, time_kind=self.msg.FluentQuery.EVER)), 2)
        self.assertEqual(self.grant('remove', instances=[name]).changed, 1)
        self.assertEqual(self.find(name), [])
        self.refuse('update', name, fluents=[self.pose(name, 3.0)])
        self.refuse('remove', name, instances=[name])

    def test_a_batch_goes_in_whole_or_not_at_all(self):
        begun = self.last()
        fluents = self.mugs(self.names, 20)
        answer = self.refuse('add', "'Mugg'", "'Mug'", fluents=fluents[:-1] + [
            self.fluent('Mugg', 'last')])
        self.assertEqual(answer.sequence, 0)
        self.assertEqual(self.last(), begun)
        self.assertEqual(self.grant('add', fluents=fluents).changed, 20)

    def test_bad_requests_say_what_is_wrong(self):
        query = self.msg.FluentQuery
        self.refuse('add', 'source', fluents=[], by=self.msg.Assertion(source=9))
        self.refuse('add', 'hasXx', fluents=[self.msg.Fluent('Pose', 'p', [
            self.msg.FluentProperty(role='hasXx', type='xsd:float')], 0, 0, 0, 0)])
        self.refuse('add', 'episode', fluents=[self.pose('p', 1.0)],
                    by=self.msg.Assertion(episode=12345))
        self.refuse('query', 'Mugg', query=query(below=['Mugg']))
        self.refuse('query', 'time_kind', query=query(time_kind=9))
        self.refuse('query', 'world', query=query(world=9))
        self.refuse('query', 'cursor', query=query(cursor='nonsense'))
        self.refuse('query', query=query(sparql='select'))
        self.refuse('finish_episode', '54321', id=54321)
        self.refuse('changes_since', "'mug'", "'mugs'", topic='mug')
        self.refuse('changes_since', 'limit', limit=1000000)
        self.refuse('changes_since', 'another store', sequence=1 << 40)
        self.refuse('load', 'path and text')
        self.refuse('load', '/nowhere.yaml', path='/nowhere.yaml')

    def test_queries_take_time_property_and_sparql(self):
        name = self.names
        self.grant('add', fluents=[self.fluent('Mug', name, hasPose=('Pose', name + 'pose')),
                                   self.pose(name + 'pose', 7.25)])
        wanted = self.msg.FluentProperty(role='hasX', type='xsd:float', real=7.25)
        self.assertIn(name + 'pose', [f.instance for f in self.query(properties=[wanted])])
        link = self.msg.FluentProperty(role='hasPose', type='Pose', text=name + 'pose')
        self.assertEqual([f.instance for f in self.query(properties=[link])], [name])
        found = self.query(sparql='select ?instance where { ?instance a race:Mug ; '
                                  'upper:hasPose ?pose . ?pose upper:hasX 7.25 }')
        self.assertEqual([f.instance for f in found], [name])
        self.assertEqual(self.find(name, time_kind=self.msg.FluentQuery.AT, at=1.0), [])

    def test_pages_follow_on_each_other(self):
        self.grant('add', fluents=self.mugs(self.names, 25))
        found, cursor, pages = [], '', 0
        while pages == 0 or cursor:
            page = self.grant('query', query=self.msg.FluentQuery(
                below=['Mug'], limit=10, cursor=cursor))
            found += [f.instance for f in page.fluents if f.instance.startswith(self.names)]
            cursor, pages = page.next, pages + 1
        self.assertEqual(sorted(found), sorted(f.instance for f in self.mugs(self.names, 25)))

    def test_loading_tells_what_went_in_and_export_gives_it_back(self):
        text = KNOWLEDGE.replace('ounter1', 'ounter_' + self.names)
        loaded = self.grant('load', text=text)
        self.assertEqual((loaded.concepts, list(loaded.counts)), (['Counter', 'Pose'], [1, 1]))
        self.assertEqual(self.grant('load', text=text).known, 2)
        exported = self.grant('export', query=self.msg.FluentQuery(
            instance='counter_' + self.names))
        self.assertIn('Class_Instance: [Counter, counter_%s]' % self.names, exported.text)
        self.assertEqual(exported.fluents, 1)

    def test_a_bad_file_names_the_line_and_nothing_goes_in(self):
        begun = self.last()
        bad = self.processes.write('bad.yaml', KNOWLEDGE + '---\n!Fluent\nClass_Instanc: [Mug, m]\n')
        self.refuse('load', 'bad.yaml', 'Class_Instanc', path=bad)
        self.assertEqual(self.last(), begun)

    def test_episodes_begin_and_end(self):
        started = self.grant('start_episode', task='serve').episode
        self.assertEqual((started.task, started.imagined, started.finish),
                         ('serve', False, float('inf')))
        by = self.msg.Assertion(episode=started.id)
        self.grant('add', fluents=[self.pose(self.names, 1.0)], by=by)
        finished = self.grant('finish_episode', id=started.id, outcome='succeeded').episode
        self.assertEqual(finished.outcome, 'succeeded')
        self.assertGreaterEqual(finished.finish, finished.start)
        listed, = self.grant('list_episodes', ids=[started.id]).episodes
        self.assertEqual(listed, finished)
        found = self.query(in_episode=True, episode=started.id)
        self.assertEqual([f.instance for f in found], [self.names])
        self.refuse('add', 'finished', fluents=[self.pose(self.names, 2.0)], by=by)

    def test_imagined_fluents_stay_apart(self):
        changes = self.read_all_changes()
        imagined = self.read('blackboard/imagined_changes', snapshot_first=False)
        wait_until(lambda: imagined._subscriber.get_num_connections() > 0, 'the connection')
        mugs = self.read('blackboard/mugs')
        episode = self.grant('start_episode', task='imagine', imagined=True).episode
        by = self.msg.Assertion(episode=episode.id)
        i = 0
        while not imagined.changes:  # connected here may still mean unknown there
            i += 1
            self.grant('add', fluents=[self.fluent('Mug', '%s_%d' % (self.names, i))], by=by)
            imagined.entered.wait(0.1)
        self.assertTrue(all(change.imagined for change in imagined.changes))
        self.assertEqual(self.find(self.names + '_1'), [])
        self.assertEqual(len(self.find(self.names + '_1', world=self.msg.FluentQuery.IMAGINED)), 1)
        self.grant('add', fluents=[self.fluent('Mug', self.names)])
        for reader in (changes, mugs):
            reader.wait_for(lambda: reader.changes, 'the real one')
            self.assertEqual([c.fluent.instance for c in reader.changes], [self.names])
            self.assertEqual(reader.gaps, [])

    # Topics.

    def test_a_demand_topic_begins_with_a_snapshot_for_its_new_subscriber_alone(self):
        self.grant('add', fluents=[self.fluent('Mug', self.names), self.pose('other', 1.0)])
        first = self.read('blackboard/mugs')
        held = {change.fluent.instance for change in first.snapshots[0].changes}
        self.assertIn(self.names, held)
        self.assertEqual(held, {f.instance for f in self.query(below=['Mug'], limit=100000)})
        process = self.processes.start(
            ['rostopic', 'echo', '-n1', '/blackboard/mugs/snapshot'], self.main)
        process.wait_for('True')
        self.grant('add', fluents=[self.fluent('Mug', self.names + 'later')])
        first.wait_for(lambda: first.changes, 'the change')
        self.assertEqual(len(first.snapshots), 1)

    def test_joins_bring_fluents_in_and_out(self):
        mug, on = self.names, 'on' + self.names
        self.grant('add', fluents=[self.fluent('Mug', mug)])
        reader = self.read('blackboard/things_on_areas')
        self.grant('add', fluents=[self.fluent('On', on, hasPhysicalEntity=('Mug', mug))])
        self.grant('remove', instances=[on])
        reader.wait_for(lambda: len(reader.changes) >= 2, 'the changes')
        self.assertEqual([(c.kind, c.fluent.instance) for c in reader.changes],
                         [(self.msg.FluentChange.ADDED, mug), (self.msg.FluentChange.REMOVED, mug)])

    def test_each_change_comes_once_and_in_order_while_many_write(self):
        known = self.last()
        changes, mugs = self.read_all_changes(), self.read('blackboard/mugs')
        writers, rounds = 8, 40
        failures = []

        def write(writer):
            # As who writes much does, each keeps its connection: a roscpp server may drop one that
            # ends with its call before the answer is read (ros_comm, issue 1976).
            proxy = self.rospy.ServiceProxy('blackboard/add', self.services['add'], persistent=True)
            try:
                for i in range(rounds):
                    answer = proxy(fluents=[
                        self.fluent('Mug', '%s_%d_%d' % (self.names, writer, i))])
                    if answer.error.code != self.errors.NONE:
                        failures.append(answer.error.message)
            except Exception as error:  # told below
                failures.append(error)

        begun = changes.last
        threads = [threading.Thread(target=write, args=(i,)) for i in range(writers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(LIMIT)
        self.assertEqual(failures, [])
        total = writers * rounds
        for reader in (changes, mugs):
            self.catch_up(reader, 'mugs' if reader is mugs else '')
            mine = [c for c in reader.changes if c.fluent.instance.startswith(self.names)]
            self.assertEqual(len(mine), total)
            self.assertEqual(len({c.fluent.instance for c in mine}), total)
            self.assertEqual([c.sequence for c in mine], sorted(c.sequence for c in mine))
        self.assertGreaterEqual(begun, known)
        numbers = [c.sequence for c in changes.changes]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))))

    def catch_up(self, reader, topic):
        """Waits until the reader is where the store is; it must have kept up without a gap."""
        if not topic:
            wanted = self.last()
        else:
            missed = self.grant('changes_since', topic=topic, sequence=reader.last).messages
            wanted = missed[-1].last_sequence if missed else reader.last
        reader.wait_for(lambda: reader.last >= wanted, 'the last change')
        self.assertEqual(reader.gaps, [])

    def framed(self, instance, frame):
        return self.msg.Fluent(concept_name='Pose', instance=instance, properties=[
            self.msg.FluentProperty(role='hasFrame', type='xsd:string', text=frame)])

    @long_case
    def test_a_slow_reader_sees_its_gap_and_catches_up(self):
        reader = self.read('blackboard/framed')
        begun = reader.last
        reader.entered.clear()
        reader.hold.clear()
        self.grant('add', fluents=[self.framed(self.names + '_first', 'map')])
        self.assertTrue(reader.entered.wait(LIMIT))
        # Far more than sockets buffer: the publisher's queue must give way.
        names = ['%s_%d' % (self.names, i) for i in range(5 * QUEUE)]
        for name in names:
            self.grant('add', fluents=[self.framed(name, 'x' * 400000)])
        reader.hold.set()
        i = 0
        while not reader.gaps:  # the gap shows with the next message that comes through
            i += 1
            before = reader.last
            self.grant('add', fluents=[self.framed('%s_more%d' % (self.names, i), 'map')])
            reader.wait_for(lambda: reader.last > before, 'a message')
            self.assertLess(i, 100)
        known, after = reader.gaps[0]
        self.assertLess(begun, known)
        missed, more = [], True
        while more and known < after:
            answer = self.grant('changes_since', sequence=known, limit=7)
            missed += [c for message in answer.messages for c in message.changes]
            known, more = missed[-1].sequence, answer.more
        seen = [c.sequence for c in reader.changes]
        gap = [c.sequence for c in missed if c.sequence <= after]
        self.assertEqual(set(seen) & set(gap), set())
        if len(reader.gaps) == 1:
            told = {c.fluent.instance for c in reader.changes + missed}
            self.assertEqual([name for name in names if name not in told], [])

    def test_what_a_topic_told_is_kept_for_a_while(self):
        begun = self.read('blackboard/mugs').last
        for i in range(5):
            self.grant('add', fluents=[self.fluent('Mug', '%s_%d' % (self.names, i))])
        answer = self.grant('changes_since', topic='mugs', sequence=begun)
        self.assertEqual([m.changes[0].fluent.instance for m in answer.messages],
                         ['%s_%d' % (self.names, i) for i in range(5)])
        self.assertEqual(answer.messages[0].previous, begun)
        part = self.grant('changes_since', topic='mugs', sequence=begun, limit=2)
        self.assertEqual((len(part.messages), part.more), (2, True))
        self.grant('add', fluents=self.mugs(self.names + 'x', HISTORY + 1))
        snapshot, = self.grant('changes_since', topic='mugs', sequence=begun).messages
        self.assertTrue(snapshot.snapshot)
        self.assertIn(self.names + '_0', [c.fluent.instance for c in snapshot.changes])

    def test_a_demand_is_a_topic_that_all_may_share(self):
        topic = self.grant('demand', name='poses', exact=['Pose']).topic
        self.assertEqual(topic, '/blackboard/poses')
        self.assertEqual(self.grant('demand', name='poses', exact=['Pose']).topic, topic)
        self.refuse('demand', 'another filter', name='poses', exact=['Mug'])
        reader = self.read(topic)
        self.grant('add', fluents=[self.pose(self.names, 3.5)])
        reader.wait_for(lambda: reader.changes, 'the change')
        self.assertEqual(reader.changes[0].fluent.properties[0].real, 3.5)

    def test_bad_demands_are_refused(self):
        for name in ('', '/poses', 'a b', '~x', '3', 'x/', 'a' * 1000):
            self.refuse('demand', 'topic', name=name, exact=['Pose'])
        self.refuse('demand', 'all changes', name='changes', exact=['Pose'])
        self.refuse('demand', "'Mug'", name='mug', exact=['Mugg'])
        self.refuse('demand', 'filter', name='nothing')
        self.refuse('demand', name='query', queries=['select ?x where {'])
        for i in range(10):
            if self.call('demand', name='many%d' % i, exact=['Mug']).error.code:
                break
        self.refuse('demand', 'max_topics', name='one_more', exact=['Mug'])

    @long_case
    def test_a_bag_of_changes_fills_another_blackboard(self):
        bag = os.path.join(self.processes.folder.name, 'changes.bag')
        recorder = self.processes.start(
            ['rosbag', 'record', '-O', bag, '/blackboard/changes', '__name:=recorder'], self.main)
        wait_until(lambda: '/recorder' in self.subscribers('/blackboard/changes'), 'the recorder')
        self.write_until_recorded(bag, self.names + 'begin')
        begun = self.last()
        self.grant('add', fluents=self.mugs(self.names, 30))
        self.grant('update', fluents=[self.pose(self.names + 'begin', -1.0)])
        self.grant('remove', instances=[self.names + '_3'])
        end = self.names + 'end'
        self.write_until_recorded(bag, end)
        recorder.signal(2)
        recorder.wait()
        import rosbag
        recorded = {}
        with rosbag.Bag(bag) as opened:
            for _, message, _ in opened.read_messages():
                for change in message.changes:
                    recorded[change.sequence] = change
        since = self.grant('changes_since', sequence=begun).messages
        made = [change for message in since for change in message.changes
                if change.fluent.instance != end]
        self.assertEqual(len(made), 32)
        for change in made:
            # As text: a bag brings types of its own.
            self.assertEqual(str(recorded[change.sequence]), str(change))
        self.replay([recorded[i] for i in sorted(recorded)])

    def write_until_recorded(self, bag, instance):
        """Changes of one fluent, until the file has one: so it has all that were made before."""
        values = itertools.count()

        def is_recorded():
            self.grant('add', fluents=[self.pose(instance, float(next(values)))])
            if not os.path.exists(bag + '.active'):
                return False
            with open(bag + '.active', 'rb') as file:
                return instance.encode() in file.read()
        wait_until(is_recorded, instance + ' in the bag')

    def subscribers(self, topic):
        state = self.main._call('getSystemState') or [[], [], []]
        return dict(state[1]).get(topic, [])

    def replay(self, changes):
        """What a bag says, said to an empty Blackboard, makes the same state."""
        other = self.start_node('__name:=other', '__ns:=replayed', '_store:=:memory:')
        name = '/replayed/blackboard/'
        self.rospy.wait_for_service(name + 'statistics', LIMIT)
        for change in changes:
            by = self.msg.Assertion(source=change.source, time=change.time)
            if change.kind == self.msg.FluentChange.REMOVED:
                answer = self.rospy.ServiceProxy(name + 'remove', self.srv.RemoveFluents)(
                    instances=[change.fluent.instance], by=by)
            else:
                answer = self.rospy.ServiceProxy(name + 'add', self.srv.WriteFluents)(
                    fluents=[change.fluent], by=by)
            self.assertEqual(answer.error.code, self.errors.NONE, answer.error.message)
        query = self.msg.FluentQuery(below=['Mug'], limit=100000)
        there = self.rospy.ServiceProxy(name + 'query', self.srv.QueryFluents)(query=query).fluents
        here = [f for f in self.query(below=['Mug'], limit=100000)
                if f.instance.startswith(self.names)]
        self.assertEqual([f for f in there if f.instance.startswith(self.names)], here)
        self.assertEqual(len(here), 29)
        other.kill()

    # The node itself.

    @long_case
    def test_what_was_acknowledged_survives_being_killed(self):
        for round_number in range(3):
            acknowledged, failures = [], []

            def write(writer, round_number=round_number, acknowledged=acknowledged):
                i = 0
                while True:
                    name = '%s_%d_%d_%d' % (self.names, round_number, writer, i)
                    try:
                        answer = self.call('add', fluents=[self.fluent('Mug', name)])
                    except (self.rospy.ServiceException, OSError):
                        return
                    if answer.error.code != self.errors.NONE:
                        failures.append(answer.error.message)
                        return
                    acknowledged.append(name)
                    i += 1

            threads = [threading.Thread(target=write, args=(i,)) for i in range(4)]
            for thread in threads:
                thread.start()
            wait_until(lambda: len(acknowledged) >= 100, 'the writers')
            self.node.kill()
            for thread in threads:
                thread.join(LIMIT)
            self.assertEqual(failures, [])
            self.restart()
            present = {f.instance for f in self.query(below=['Mug'], limit=1000000)}
            self.assertEqual([name for name in acknowledged if name not in present], [])
            numbers = [c.sequence for m in self.grant('changes_since', limit=100000).messages
                       for c in m.changes]
            self.assertEqual(numbers, list(range(1, len(numbers) + 1)))

    def restart(self):
        type(self).node = self.start_node()
        self.node.wait_for('store=')
        wait_until(lambda: self.call_or_none('statistics'), 'the node')

    def call_or_none(self, service):
        try:
            return self.call(service)
        except (self.rospy.ServiceException, OSError):
            return None

    def test_a_store_that_holds_something_is_not_loaded_into_again(self):
        self.grant('remove', instances=['poseCounter1'])
        self.node.signal(15)
        self.assertEqual(self.node.wait(), 0, self.node.output())
        self.restart()
        self.assertEqual(self.find('poseCounter1'), [])
        self.grant('add', fluents=[self.pose('poseCounter1', 1.5)])

    def test_two_nodes_cannot_write_one_store(self):
        other = self.start_node('__name:=second', '__ns:=second')
        self.assertEqual(other.wait(), 1, other.output())
        self.assertIn('blackboard.db', other.output())

    def test_files_that_are_wrong_end_the_start_with_their_name(self):
        unclear = self.processes.write('unclear.yaml', self.config_text(thraeds=3))
        not_a_store = self.processes.write('not_a_store.db', 'something else\n' * 1000)
        for arguments, text in ((['_config:=' + unclear], 'thraeds'),
                                (['_store:=' + not_a_store], 'not_a_store.db'),
                                (['_store:=:memory:', '_knowledge:=/nowhere.yaml'], '/nowhere.yaml'),
                                (['_store:=:memory:', '_topics:=/nowhere.yaml'], '/nowhere.yaml'),
                                (['_durability:=paper'], '~durability'),
                                (['_durability:=true'],
                                 "~durability is true, wanted one of 'process', 'power'"),
                                (['_threads:=0'], '~threads is 0')):
            with self.subTest(text=text):
                node = self.start_node('__name:=wrong', *arguments)
                self.assertEqual(node.wait(), 1, node.output())
                self.assertIn(text, node.output())
                for key in ('config', 'store', 'knowledge', 'topics', 'durability', 'threads'):
                    self.main._call('deleteParam', '/wrong/' + key)

    def test_diagnostics_tell_how_much_is_known_and_the_last_error(self):
        from diagnostic_msgs.msg import DiagnosticArray
        self.refuse('query', query=self.msg.FluentQuery(below=['Muggg']))
        told = {}

        def is_told():
            array = self.rospy.wait_for_message('/diagnostics', DiagnosticArray, LIMIT)
            told.update({pair.key: pair.value for status in array.status for pair in status.values})
            return 'Muggg' in told.get('last_error', '')
        wait_until(is_told, 'the error')
        for key in ('fluents', 'changes_per_second', 'queue', 'bytes'):
            self.assertGreaterEqual(float(told[key]), 0.0)
        self.assertEqual(told['file'], self.store)

    # The command line.

    def hires(self, *words):
        return subprocess.run([executable('hires'), 'blackboard', *words], capture_output=True,
                              text=True, env=self.processes.environment(self.main), timeout=LIMIT)

    def test_the_command_line_talks_to_the_node(self):
        text = KNOWLEDGE.replace('ounter1', 'ounter_' + self.names)
        file = self.processes.write('more.yaml', text)
        ended = self.hires('load', file)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn('2 fluents of 2 classes added', ended.stdout)
        ended = self.hires('query', '--property', 'hasPose=poseCounter_' + self.names)
        self.assertIn('counter_' + self.names, ended.stdout)
        self.assertIn('1 fluent\n', ended.stdout)
        ended = self.hires('export', '--instance', 'counter_' + self.names)
        self.assertTrue(ended.stdout.startswith('!Fluent\n'), ended.stdout)
        self.assertIn(self.store, self.hires('stats').stdout)
        bad = self.processes.write('bad_too.yaml', '!Fluent\nWrong: 1\n')
        ended = self.hires('load', bad)
        self.assertEqual(ended.returncode, 1)
        self.assertIn('bad_too.yaml', ended.stderr)

    @long_case
    def test_the_command_line_compares_episodes_with_and_without_the_node(self):
        ids = []
        for x in (1.0, 2.0):
            episode = self.grant('start_episode', task='drive').episode
            ids.append(str(episode.id))
            self.grant('add', fluents=[self.pose('%s_same' % self.names, 5.0 + x * 0.0),
                                       self.pose(self.names, x)],
                       by=self.msg.Assertion(episode=episode.id))
            self.grant('finish_episode', id=episode.id, outcome='done')
        self.assertIn('drive', self.hires('episodes').stdout)
        remote = self.hires('diff', *ids)
        self.assertEqual(remote.returncode, 0, remote.stderr)
        self.assertIn(self.names, remote.stdout)
        direct = self.hires('diff', *ids, '--store', self.store)
        self.assertEqual(direct.stdout, remote.stdout)


if __name__ == '__main__':
    # Not 'blackboard': rostest gives the test's name to its node.
    run_test('blackboard_node', BlackboardTest)
