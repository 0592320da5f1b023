#!/usr/bin/env python3
"""The whole system sees by pictures alone: a node recognises objects in the camera's clouds, and nobody
tells it, or any other node that decides, what is true. Run alone, or by
`rostest hires loop_pictures.test`."""

import os
import sys
import threading

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import CONFIG, RECOGNISER  # noqa: E402
from loop_case import AT_COUNTER, TABLE_TOP, LoopCase  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

MILL = {'peppermill1': (5.47, 10.16, 0.75, 0.0)}
CARRY = 'carry_object_on_tray peppermill1 counter1 table1'


# What a display of RViz listens to, and by which key.
DISPLAYS = {'rviz/MarkerArray': ('Marker Topic', 'visualization_msgs/MarkerArray'),
            'rviz/PointCloud2': ('Topic', 'sensor_msgs/PointCloud2'),
            'rviz/LaserScan': ('Topic', 'sensor_msgs/LaserScan'),
            'rviz/Image': ('Image Topic', 'sensor_msgs/Image'),
            'rviz/Camera': ('Image Topic', 'sensor_msgs/Image'),
            'rviz/Map': ('Topic', 'nav_msgs/OccupancyGrid'),
            'rviz/Path': ('Topic', 'nav_msgs/Path')}


def displays_of(name):
    with open(os.path.join(CONFIG, name + '.rviz'), encoding='utf-8') as file:
        return yaml.safe_load(file)['Visualization Manager']['Displays']


def shown_by(displays):
    """{topic: type} of all displays but the grid, groups included."""
    shown = {}
    for display in displays:
        if display['Class'] == 'rviz/Group':
            shown.update(shown_by(display['Displays']))
        elif display['Class'] != 'rviz/Grid':
            key, kind = DISPLAYS[display['Class']]
            shown['/' + display[key].lstrip('/')] = kind
            if display['Class'] == 'rviz/Camera':  # it looks for the camera's model beside the picture
                beside = os.path.dirname(display[key]) + '/camera_info'
                shown['/' + beside] = 'sensor_msgs/CameraInfo'
    return shown


class LoopPicturesTest(LoopCase):
    # So many rollouts that the quicker drive, on which the mill may be lost, does not pass for a safe one by chance.
    SETTINGS = dict(sensing='pictures', rollouts=64)

    def require_displays(self, name):
        """Somebody publishes what the display shows, for as many workers as there are."""
        shown = {topic: kind for topic, kind in shown_by(displays_of(name)).items()
                 if not topic.startswith('/worker_') or topic.startswith('/worker_1/')}
        self.assertIn('/worker_1/markers', shown)
        # The worker's come once the relay has heard of it.
        wait_until(lambda: shown.items() <= self.loop.main.topic_types().items(),
                   lambda: '%s to have all that %s shows: %s' % (self.loop.main.topic_types(), name, shown))
        silent = [topic for topic in shown if not self.loop.main.publishers(topic)]
        self.assertEqual(silent, [], name)

    def require_truth_unheard(self):
        """By others than this test."""
        me = self.loop.rospy.get_name()
        truths = [topic for topic in self.loop.main.publishers() if 'ground_truth' in topic]
        self.assertEqual(len(truths), 3, truths)
        for topic in truths:
            self.assertEqual(self.loop.main.subscribers(topic), [me], topic)

    def listeners_to_truth(self):
        """Who else listens to it, looked for when another step has begun; a list that goes on."""
        found, looked = [], []

        def look(feedback):
            begun = sum(step.started == step.started for step in feedback.steps)
            if looked[-1:] == [begun]:
                return
            looked.append(begun)
            for topic in self.loop.main.publishers():
                if 'ground_truth' in topic:
                    found.extend(node for node in self.loop.main.subscribers(topic)
                                 if node != self.loop.rospy.get_name())
        return look, looked, found

    def listen_to_recognition(self):
        """Names that are shown over recognised things, once there are some."""
        from visualization_msgs.msg import MarkerArray
        names, has_some = set(), threading.Event()

        def note(message):
            names.update((marker.text, marker.lifetime.to_sec()) for marker in message.markers
                         if marker.ns == 'names')
            if names:
                has_some.set()
        subscriber = self.loop.rospy.Subscriber('recognition_markers', MarkerArray, note)
        self.addCleanup(subscriber.unregister)
        return names, has_some

    def test_a_picture_shows_or_hides_displays_that_there_are(self):
        displays = displays_of('hyperreality')
        groups = {group['Name']: {one['Name'] for one in group['Displays']} for group in displays
                  if group['Class'] == 'rviz/Group'}
        self.assertEqual(set(groups), {'Reality', 'Recognition', 'Imagination'})
        cameras = [display for display in displays if display['Class'] == 'rviz/Camera']
        self.assertEqual(len(cameras), 2)
        for camera in cameras:
            for name, members in groups.items():
                told = set(camera['Visibility'][name]) - {'Value'}
                self.assertEqual(told, members, camera['Name'])

    def test_the_mill_gets_to_the_table_and_nobody_looks_at_the_truth(self):
        self.begin(AT_COUNTER, MILL)
        names, has_names = self.listen_to_recognition()
        look, looked, found = self.listeners_to_truth()
        task = self.achieve(CARRY, on_feedback=look)
        self.wait_for_step(task, 'pick_up_object')
        for display in ('hyperreality', 'topple', 'serve_coffee'):
            self.require_displays(display)
        self.require_truth_unheard()
        self.assertEqual(self.loop.main.publishers('/detections'), ['/' + RECOGNISER])
        self.assertTrue(has_names.wait(60.0), 'nothing is shown of what is recognised')
        for text, lifetime in names:
            self.assertRegex(text, r'^\w+ \d+ %$')
            self.assertGreater(lifetime, 0.0)
        self.require(task, self.codes.SUCCEEDED)
        self.require_truth_unheard()
        self.assertEqual(found, [])
        self.assertGreater(len(looked), 3, 'after each step it is looked again')
        self.wait_until_it_stands()
        self.assert_on_table1('peppermill1')
        self.assert_stands_upright('peppermill1', TABLE_TOP)


if __name__ == '__main__':
    run_test('loop_pictures', LoopPicturesTest)
