#!/usr/bin/env python3
"""The node `relay` between two real masters: run alone, or by `rostest hires relay.test`."""

import os
import re
import signal
import sys
import unittest

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import Processes, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

CONFIG = {
    'foreign_master': 'http://127.0.0.1:1/',
    'namespace': '/worker_1',
    'alias_prefix': '/mirrored',
    'poll_period': 0.05,
    'ping_period': 0.3,
    'call_timeout': 0.5,
    'local_pubs': [],
    'foreign_pubs': ['{ns}/.*'],
    'local_services': [],
    'foreign_services': [],
    'actions': [{'name': '{ns}/rollout', 'server': 'foreign'}],
}


class RelayTest(unittest.TestCase):
    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        self.main, self.foreign = self.processes.masters(2)

    def start_relay(self, **changes):
        text = yaml.safe_dump({**CONFIG, **changes})
        path = self.processes.write('relay.yaml', text)
        return self.processes.start(
            [executable('relay'), '_config:=' + path, '_foreign_master:=' + self.foreign.uri],
            self.main)

    def peer(self, master, *arguments, name):
        return self.processes.start(
            [executable('relay_test_peer'), *arguments, '__name:=' + name], master)

    def aliases(self, master, topic):
        return [node for node in master.publishers(topic) if node.startswith('/mirrored/')]

    def wait_for_mirror(self, master, topic):
        return wait_until(lambda: self.aliases(master, topic), '%s to be mirrored' % topic)

    def wait_for_withdrawal(self, master, topic):
        wait_until(lambda: not self.aliases(master, topic), '%s to be withdrawn' % topic)

    def received(self, counter, at_least):
        """Waits until a counter has received that many; its (received, lost, last)."""
        def numbers():
            lines = [line for line in counter.lines if line.startswith('received=')]
            found = re.findall(r'\d+', lines[-1]) if lines else ['0', '0', '0']
            return tuple(map(int, found)) if int(found[0]) >= at_least else None
        return wait_until(numbers, '%d messages' % at_least)

    # What crosses.

    def test_a_topic_crosses(self):
        self.start_relay()
        self.peer(self.foreign, 'stream', '/worker_1/scan', '1000', name='talker')
        counter = self.peer(self.main, 'count', '/worker_1/scan', name='listener')
        self.assertEqual(self.received(counter, 100)[1], 0)

    def test_a_latched_text_reaches_who_comes_later(self):
        self.start_relay()
        self.peer(self.foreign, 'latch', '/worker_1/state', 'hello', name='talker')
        self.wait_for_mirror(self.main, '/worker_1/state')
        self.peer(self.main, 'hear', '/worker_1/state', name='late').wait_for('heard=hello')

    def test_a_subscriber_that_waits_gets_what_is_published_later(self):
        self.start_relay()
        early = self.peer(self.main, 'hear', '/worker_1/state', name='early')
        wait_until(lambda: self.main.node_uri('/early'), 'the subscriber')
        self.peer(self.foreign, 'latch', '/worker_1/state', 'hello', name='talker')
        early.wait_for('heard=hello')

    def test_a_service_crosses(self):
        self.start_relay(foreign_services=['/ask'], local_services=['/tell'])
        self.peer(self.foreign, 'serve', '/ask', name='there')
        self.peer(self.main, 'serve', '/tell', name='here')
        self.peer(self.main, 'call', '/ask', name='caller').wait_for('reply=/there')
        self.peer(self.foreign, 'call', '/tell', name='caller').wait_for('reply=/here')

    def test_an_action_crosses_with_feedback(self):
        self.start_relay()
        self.peer(self.foreign, 'worker', '/worker_1', name='worker')
        client = self.peer(self.main, 'goal', '/worker_1', '20', '-1', name='client')
        client.wait_for('state=SUCCEEDED code=0 feedbacks=20')
        self.assertEqual(client.wait(), 0)

    def test_an_action_is_cancelled_across(self):
        self.start_relay()
        self.peer(self.foreign, 'worker', '/worker_1', name='worker')
        client = self.peer(self.main, 'goal', '/worker_1', '1000000', '3', name='client')
        client.wait_for('state=PREEMPTED code=3')

    def test_an_action_server_on_the_main_side_serves_the_foreign_side(self):
        self.start_relay(foreign_pubs=[], actions=[{'name': '/home/rollout', 'server': 'local'}])
        self.peer(self.main, 'worker', '/home', name='worker')
        client = self.peer(self.foreign, 'goal', '/home', '5', '-1', name='client')
        client.wait_for('state=SUCCEEDED code=0 feedbacks=5')

    # What does not.

    def test_equal_node_names_on_both_sides_live_side_by_side(self):
        self.start_relay(local_pubs=['{ns}/here'], foreign_pubs=['{ns}/there'])
        here = self.peer(self.main, 'stream', '/worker_1/here', '100', name='twin')
        there = self.peer(self.foreign, 'stream', '/worker_1/there', '100', name='twin')
        self.received(self.peer(self.main, 'count', '/worker_1/there', name='a'), 20)
        self.received(self.peer(self.foreign, 'count', '/worker_1/here', name='b'), 20)
        self.assertTrue(here.is_running() and there.is_running())

    def test_each_master_keeps_its_own_clock(self):
        self.start_relay(local_pubs=['/.*'], foreign_pubs=['/.*'])
        self.peer(self.main, 'clock', name='clock')
        self.peer(self.foreign, 'clock', name='clock')
        self.peer(self.foreign, 'stream', '/witness', '10', name='witness')
        self.peer(self.main, 'stream', '/witness_2', '10', name='witness')
        for master in (self.main, self.foreign):
            wait_until(lambda: master.publishers('/clock'), '/clock')
        self.wait_for_mirror(self.main, '/witness')
        self.wait_for_mirror(self.foreign, '/witness_2')
        for master in (self.main, self.foreign):
            self.assertEqual(master.publishers('/clock'), ['/clock'])
            self.assertEqual(self.aliases(master, '/rosout'), [])

    def test_unlisted_names_stay_where_they_are(self):
        self.peer(self.foreign, 'stream', '/odom', '10', name='odom')
        self.peer(self.foreign, 'serve', '/worker_1/ask', name='server')
        self.peer(self.main, 'stream', '/worker_1/state', '10', name='stranger')
        wait_until(lambda: self.foreign.publishers('/odom'), '/odom')
        wait_until(lambda: '/worker_1/ask' in self.foreign.services(), '/worker_1/ask')
        wait_until(lambda: self.main.publishers('/worker_1/state'), 'the stranger')
        self.start_relay()
        self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='witness')
        self.wait_for_mirror(self.main, '/worker_1/scan')
        self.assertEqual(self.main.publishers('/odom'), [])
        self.assertNotIn('/worker_1/ask', self.main.services())
        self.assertEqual(self.foreign.publishers('/worker_1/state'), [])

    # Deaths and restarts.

    def test_a_killed_publisher_is_withdrawn_and_followed_when_it_comes_back(self):
        self.start_relay()
        talker = self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        first = self.wait_for_mirror(self.main, '/worker_1/scan')
        talker.kill()
        self.wait_for_withdrawal(self.main, '/worker_1/scan')
        self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        self.assertNotEqual(first, self.wait_for_mirror(self.main, '/worker_1/scan'))

    def test_a_publisher_that_leaves_in_good_order_is_withdrawn(self):
        self.start_relay()
        talker = self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        self.wait_for_mirror(self.main, '/worker_1/scan')
        talker.signal(signal.SIGINT)
        self.wait_for_withdrawal(self.main, '/worker_1/scan')

    def test_a_restarted_foreign_master_is_served_again(self):
        self.start_relay()
        old = self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        first = self.wait_for_mirror(self.main, '/worker_1/scan')
        self.foreign.kill()
        old.kill()
        self.wait_for_withdrawal(self.main, '/worker_1/scan')
        self.foreign.start()
        self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        self.assertNotEqual(first, self.wait_for_mirror(self.main, '/worker_1/scan'))

    def test_a_restarted_main_master_gets_mirrors_relay_and_parameters_back(self):
        relay = self.start_relay()
        self.peer(self.foreign, 'stream', '/worker_1/scan', '100', name='talker')
        self.wait_for_mirror(self.main, '/worker_1/scan')
        wait_until(lambda: self.main.publishers('/diagnostics'), 'the relay node')
        self.main.set_param('/use_sim_time', False)
        self.main.kill()
        self.main.start()
        self.wait_for_mirror(self.main, '/worker_1/scan')
        relay.wait_for('state=replaced')
        wait_until(lambda: '/relay' in self.main.publishers('/diagnostics'), 'the relay node')
        self.assertIsNotNone(self.main.param('/relay/config'))
        self.assertTrue(relay.is_running())
        counter = self.peer(self.main, 'count', '/worker_1/scan', name='listener')
        self.received(counter, 10)
        relay.signal(signal.SIGTERM)
        self.assertEqual(relay.wait(), 0)
        self.wait_for_withdrawal(self.main, '/worker_1/scan')

    @long_case
    def test_an_established_stream_outlives_the_relay_and_loses_nothing(self):
        relay = self.start_relay()
        self.peer(self.foreign, 'stream', '/worker_1/scan', '1000', name='talker')
        counter = self.peer(self.main, 'count', '/worker_1/scan', name='listener')
        before = self.received(counter, 500)
        relay.kill()
        after = self.received(counter, before[0] + 1500)
        self.assertEqual(after[1], 0)
        aliases = self.aliases(self.main, '/worker_1/scan')
        self.start_relay()
        self.peer(self.foreign, 'stream', '/worker_1/witness', '10', name='witness')
        self.wait_for_mirror(self.main, '/worker_1/witness')
        self.assertEqual(self.aliases(self.main, '/worker_1/scan'), aliases)
        self.assertEqual(self.received(counter, after[0] + 1500)[1], 0)

    def test_what_a_killed_relay_left_of_dead_nodes_is_purged(self):
        relay = self.start_relay()
        talker = self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        self.wait_for_mirror(self.main, '/worker_1/scan')
        relay.kill()
        talker.kill()
        self.assertNotEqual(self.aliases(self.main, '/worker_1/scan'), [])
        self.start_relay()
        self.wait_for_withdrawal(self.main, '/worker_1/scan')

    def test_a_hung_foreign_master_blocks_neither_data_nor_the_main_side(self):
        self.start_relay()
        self.peer(self.foreign, 'stream', '/worker_1/scan', '1000', name='talker')
        doomed = self.peer(self.foreign, 'stream', '/worker_1/doomed', '10', name='doomed')
        counter = self.peer(self.main, 'count', '/worker_1/scan', name='listener')
        self.received(counter, 10)
        self.wait_for_mirror(self.main, '/worker_1/doomed')
        self.foreign.process.signal(signal.SIGSTOP)
        doomed.kill()
        self.wait_for_withdrawal(self.main, '/worker_1/doomed')
        before = self.received(counter, 10)
        self.assertEqual(self.received(counter, before[0] + 1000)[1], 0)
        self.foreign.process.signal(signal.SIGCONT)
        self.peer(self.foreign, 'stream', '/worker_1/new', '10', name='new')
        self.wait_for_mirror(self.main, '/worker_1/new')

    def test_a_hung_main_master_does_not_block_the_foreign_side(self):
        self.start_relay(local_pubs=['{ns}/command'])
        doomed = self.peer(self.main, 'stream', '/worker_1/command', '10', name='doomed')
        self.wait_for_mirror(self.foreign, '/worker_1/command')
        self.main.process.signal(signal.SIGSTOP)
        doomed.kill()
        self.wait_for_withdrawal(self.foreign, '/worker_1/command')
        self.main.process.signal(signal.SIGCONT)
        self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        self.wait_for_mirror(self.main, '/worker_1/scan')

    # Start and end.

    def test_each_stop_signal_withdraws_everything(self):
        self.peer(self.foreign, 'stream', '/worker_1/scan', '10', name='talker')
        self.peer(self.main, 'stream', '/worker_1/rollout/goal', '10', name='client')
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(signal=number.name):
                relay = self.start_relay()
                self.wait_for_mirror(self.main, '/worker_1/scan')
                self.wait_for_mirror(self.foreign, '/worker_1/rollout/goal')
                relay.signal(number)
                self.assertEqual(relay.wait(), 0)
                self.assertEqual(self.aliases(self.main, '/worker_1/scan'), [])
                self.assertEqual(self.aliases(self.foreign, '/worker_1/rollout/goal'), [])

    def test_a_bad_file_stops_the_relay_with_the_reason(self):
        relay = self.start_relay(poll_period=-1)
        self.assertEqual(relay.wait(), 1)
        self.assertRegex(relay.output(), "relay.yaml: poll_period is '-1'.*between 0.01 and 10")

    def test_a_missing_file_an_unknown_parameter_and_the_own_master_are_named(self):
        for arguments, text in (
                ([], '~config is missing'),
                (['_config:=/nowhere/relay.yaml'], '/nowhere/relay.yaml'),
                (['_config:=/x', '_foreign_mster:=http://h:1/'], "'foreign_mster' is unknown"),
                (['_config:=' + self.processes.write('a.yaml', yaml.safe_dump(CONFIG)),
                  '_foreign_master:=http://localhost:%d/' % self.main.port],
                 "is the relay's own master")):
            with self.subTest(arguments=arguments):
                name = 'bad_%d' % len(text)
                relay = self.processes.start(
                    [executable('relay'), '__name:=' + name, *arguments], self.main)
                self.assertEqual(relay.wait(), 1)
                self.assertIn(text, relay.output())


if __name__ == '__main__':
    run_test('relay', RelayTest)
