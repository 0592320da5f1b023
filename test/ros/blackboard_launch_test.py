#!/usr/bin/env python3
"""launch/blackboard.launch as a user starts it knows the restaurant: run by `rostest hires
blackboard_launch.test`."""

import os
import sys
import threading
import unittest

import rospy

from hires.msg import BlackboardError, FluentChanges, FluentQuery
from hires.srv import BlackboardStatistics, QueryFluents

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import LIMIT  # noqa: E402
from test_run import run_test  # noqa: E402


class BlackboardLaunchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('blackboard_launch_test')
        rospy.wait_for_service('blackboard/statistics', LIMIT)

    def query(self, **fields):
        answer = rospy.ServiceProxy('blackboard/query', QueryFluents)(query=FluentQuery(**fields))
        self.assertEqual(answer.error.code, BlackboardError.NONE, answer.error.message)
        return {fluent.instance for fluent in answer.fluents}

    def test_the_restaurant_is_known(self):
        self.assertIn('counter1', self.query(below=['Furniture']))
        self.assertIn('preManipulationAreaEastCounter1', self.query(below=['Area']))

    def test_its_topics_are_there_with_what_holds_now(self):
        statistics = rospy.ServiceProxy('blackboard/statistics', BlackboardStatistics)()
        self.assertIn('areas', statistics.topics)
        snapshot, has_come = [], threading.Event()

        def on_message(message):
            snapshot.append(message)
            has_come.set()
        subscriber = rospy.Subscriber('blackboard/areas', FluentChanges, on_message)
        self.addCleanup(subscriber.unregister)
        self.assertTrue(has_come.wait(LIMIT))
        self.assertTrue(snapshot[0].snapshot)
        self.assertEqual({change.fluent.instance for change in snapshot[0].changes},
                         self.query(below=['Area']))


if __name__ == '__main__':
    run_test('blackboard_launch', BlackboardLaunchTest)
