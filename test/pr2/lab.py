"""A laboratory: the fake PR2, and launch/pr2.launch by roslaunch, under a master of their own.

    lab = Lab(navigation='own')
    lab.start()
    lab.connect('pr2_safety')
    goal = lab.execute('move_base', 'preManipulationAreaEastCounter1')
    lab.stop()
"""

import math
import os
import signal
import sys
import threading
import xmlrpc.client

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.path.join(HERE, '..', '..'))
sys.path.insert(0, os.path.join(HERE, '..', 'ros', 'support'))

from action_goal import ActionGoal  # noqa: E402
from ros_processes import (LIMIT, Processes, free_port_block, processes_with,  # noqa: E402
                           wait_until)

START = 180.0  # [s] far beyond what starting everything takes on a busy computer
GOAL_LIMIT = 300.0  # [s] by the wall's clock, for an action or a task
MILL = ['peppermill1', 'peppermill_thesis', 5.47, 10.16, 0.75]  # name, model, where it stands
NODES = ('middle_layer', 'world_tracker', 'translator', 'blackboard', 'planner',
         'imagination_client', 'execution_monitor', 'base_guard', 'map_check')


def executable_of(package):
    """The program of the same name, which may be Debian's or a workspace's."""
    prefixes = os.environ.get('CMAKE_PREFIX_PATH', '').split(os.pathsep)
    prefixes += ['/usr', '/opt/ros/noetic']
    paths = [os.path.join(prefix, 'lib', package, package) for prefix in prefixes]
    return next(path for path in paths if os.access(path, os.X_OK))


def wait_for(condition, what):
    """For what takes long, and is asked of a master that has other things to do."""
    pause = threading.Event()

    def slowly():
        value = condition()
        return value or (pause.wait(0.3) and None)
    return wait_until(slowly, what, START)


class Truth:
    """Where the base really was and how fast, at 100 Hz: (time [s], x, y, yaw, speed along its
    heading [m/s], turning [rad/s])."""

    def __init__(self):
        self._changed = threading.Condition()
        self.samples = []

    def note(self, message):
        pose, twist = message.pose.pose, message.twist.twist
        yaw = 2 * math.atan2(pose.orientation.z, pose.orientation.w)
        with self._changed:
            self.samples.append((message.header.stamp.to_sec(), pose.position.x, pose.position.y,
                                 yaw, twist.linear.x, twist.angular.z))
            self._changed.notify_all()

    def wait_for(self, condition, what, limit=LIMIT):
        """Waits until the newest sample is as wanted; its index."""
        with self._changed:
            if not self._changed.wait_for(
                    lambda: self.samples and condition(self.samples[-1]), limit):
                raise AssertionError('waited in vain for %s; the base: %s' % (
                    what, self.samples[-1:]))
            return len(self.samples) - 1

    def wait_for_time(self, time):
        self.wait_for(lambda s: s[0] >= time, 'the time %.2f' % time)

    def since(self, index):
        with self._changed:
            return list(self.samples[index:])


class Lab:
    """@param fake   parameters of the fake PR2: pose, torso, objects, world_in_map, latched_map,
    seed; cmd_vel and old_names of its move_base.  @param arguments  of pr2.launch."""

    def __init__(self, fake=None, **arguments):
        self.processes = Processes()
        self.main = self.processes.master()
        self._fake = dict(fake or {})
        self._arguments = dict(arguments)
        self._arguments.setdefault('workers', 1)
        self._arguments.setdefault('store', os.path.join(self.processes.folder.name, 'store.db'))
        self._arguments.setdefault('base_port', free_port_block(8) - 1)
        os.environ.update(ROS_MASTER_URI=self.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=self.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        self.fake, self.hires = [], None
        self.truth = Truth()
        self.guard_states, self.requests = [], []

    def start(self):
        """Side by side: HIRES waits for a robot that is not up yet."""
        self.start_hires()
        self.start_fake()
        wait_for(lambda: '/fake_pr2/halt_motors' in self.main.services(), 'the fake PR2')

    def start_fake(self):
        """As fake_pr2.launch does it, without the time that a roslaunch of its own takes."""
        world, urdf = os.path.join(ROOT, 'worlds', 'restaurant.world'), \
            os.path.join(ROOT, 'urdf', 'pr2_tray.urdf')
        shared = dict(world=world, world_in_map=self._fake.pop('world_in_map', [0.0, 0.0, 0.0]))
        move_base = dict(shared, old_names=self._fake.pop('old_names', False))
        cmd_vel = self._fake.pop('cmd_vel', 'base_guard/cmd_vel')
        robot = dict(shared, urdf=urdf, pose=[12.5, 9.8, 2.0], objects=[MILL])
        robot.update(self._fake)
        with open(urdf) as file:
            self.main.set_param('/robot_description', file.read())
        self.main.set_param('/fake_pr2', robot)
        self.main.set_param('/move_base_node', move_base)
        self.fake = [
            self._start([os.path.join(HERE, 'fake_pr2.py')]),
            self._start([executable_of('robot_state_publisher')]),
            self._start([os.path.join(HERE, 'fake_move_base.py'), 'cmd_vel:=' + cmd_vel])]

    def start_hires(self):
        self.hires = self._start(
            ['roslaunch', os.path.join(ROOT, 'launch', 'pr2.launch')] +
            ['%s:=%s' % item for item in self._arguments.items()])

    def _start(self, command):
        return self.processes.start(
            command, self.main, HOME=self.processes.folder.name,
            ROS_HOME=self.processes.folder.name, HIRES_TEST_LAB=self.processes.folder.name)

    def output(self):
        return '\n'.join(p.output() for p in [*self.fake, self.hires] if p is not None)

    # Our own node.

    def connect(self, name):
        """Once per test program."""
        import actionlib
        import rospy
        from geometry_msgs.msg import Twist
        from hires import msg
        from nav_msgs.msg import Odometry
        self.rospy, self.msg, self.twist = rospy, msg, Twist
        self.codes = msg.ExecuteActionResult
        rospy.init_node(name, disable_signals=True)
        many = dict(queue_size=10000, tcp_nodelay=True)
        rospy.Subscriber('fake_pr2/truth', Odometry, self.truth.note, **many)
        rospy.Subscriber('base_guard/state', msg.BaseGuardState, self.guard_states.append, **many)
        rospy.Subscriber('base_guard/request', msg.BaseRequest, self.requests.append, **many)
        self.joystick = rospy.Publisher('fake_pr2/joystick', Twist, queue_size=10)
        self.actions = actionlib.ActionClient('execute_action', msg.ExecuteActionAction)
        self.tasks = actionlib.ActionClient('achieve', msg.AchieveAction)
        self.require_server(self.actions)

    def require_server(self, client):
        # Connections alone do not tell: the tracker listens to goals, too.
        assert client.wait_for_server(self.rospy.Duration(START)), client.ns + ' has no server'

    def wait_for_news(self, client):
        """Of a server that was started again: it says its status, and hears goals."""
        from actionlib_msgs.msg import GoalStatusArray
        heard = []
        subscriber = self.rospy.Subscriber(client.ns + '/status', GoalStatusArray, heard.append)
        wait_for(lambda: heard, client.ns + '/status')
        subscriber.unregister()
        self.require_server(client)

    def execute(self, name, *arguments, limit=0.0):
        goal = self.msg.ExecuteActionGoal()
        goal.action.name, goal.action.arguments = name, list(arguments)
        goal.time_limit = self.rospy.Duration(limit)
        return ActionGoal(self.actions, goal, GOAL_LIMIT)

    def achieve(self, task):
        self.require_server(self.tasks)
        return ActionGoal(self.tasks, self.msg.AchieveGoal(task=task), GOAL_LIMIT)

    def set(self, service, on):
        """halt_motors, freeze_localisation, freeze_scan, lose_localisation of the fake."""
        from std_srvs.srv import SetBool
        self.rospy.ServiceProxy('fake_pr2/' + service, SetBool)(on)

    def pid_of(self, node):
        uri = wait_for(lambda: self.main.node_uri('/' + node), 'the node ' + node)
        try:
            with xmlrpc.client.ServerProxy(uri) as proxy:
                return proxy.getPid('/test')[2]
        except OSError:
            return None  # dead, and the master does not know yet

    def stop(self):
        """As a user stops it; what then still lives, goes."""
        if self.hires is not None:
            self.hires.signal(signal.SIGINT)
        for process in self.fake:
            process.signal(signal.SIGTERM)
        try:
            wait_for(lambda: not self._alive(), lambda: 'the end of %s' % self._alive())
        finally:
            for pid in self._alive():
                try:
                    os.kill(pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            self.processes.stop_all()

    def _alive(self):
        return processes_with('HIRES_TEST_LAB', self.processes.folder.name)
