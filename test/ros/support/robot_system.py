"""A simulated robot and its middle layer as real processes under a main master of their own.

    robot = RobotSystem(uncertainty='none', lockstep=True)
    robot.start()
    result = robot.execute('move_base', 'preManipulationAreaEastCounter1').result()
    robot.stop()

One test program has one master (a rospy node cannot change it); the processes may be started anew.
"""

import os
import threading

from action_goal import ActionGoal, require_server
from diagnostics import wait_for_middle_layer
from ros_processes import LIMIT, Processes, executable

SKILL_LIMIT = 300.0  # [s] by the wall's clock: it ends a broken test, and measures nothing

# A robot at the counter, ready to grasp the mug there.
MUG = (5.47, 10.16, 0.75)
COUNTER = """
task: none
knowledge: []
robot:
  pose: [6.0, 10.11, 3.14]  # manipulationAreaEastCounter1
  torso: torsoupposture
  arms: {leftarm1: armtosideposture, rightarm1: armtosideposture}
objects:
  - {name: mug1, pose: [%g, %g, %g, 0.0]}
hidden: []
""" % MUG


class RobotSystem:
    """@param arguments  private parameters of the simulated robot."""

    def __init__(self, **arguments):
        self.processes = Processes()
        self.main = self.processes.master()
        self.main.set_param('/use_sim_time', True)
        self.arguments = arguments
        self.robot = None
        self.middle_layer = None
        os.environ.update(ROS_MASTER_URI=self.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=self.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        self.client = None
        self.truth = []  # (stamp in ns, RobotState) in order
        self._truth_changed = threading.Condition()
        self._truth_subscriber = None
        self._known_objects = None

    def connect(self, name):
        """Once per test program: our own node."""
        import actionlib
        import rospy
        from hires import msg, srv
        self.rospy, self.msg, self.srv = rospy, msg, srv
        self.codes = msg.ExecuteActionResult
        rospy.init_node(name, disable_signals=True)
        self.client = actionlib.ActionClient('execute_action', msg.ExecuteActionAction)

    def _watch_truth(self):
        """From now on, and nothing of an earlier robot that is still on its way."""
        if self._truth_subscriber is not None:
            self._truth_subscriber.unregister()
        truth = self.truth = []

        def note(state):
            with self._truth_changed:
                truth.append((state.joints.header.stamp.to_nsec(), state))
                self._truth_changed.notify_all()
        self._truth_subscriber = self.rospy.Subscriber(
            'ground_truth/robot_state', self.msg.RobotState, note, queue_size=10000,
            tcp_nodelay=True)

    def wait_for_truth(self, condition, what, limit=SKILL_LIMIT):
        """Waits until the true state of the robot is as wanted; that state."""
        with self._truth_changed:
            if not self._truth_changed.wait_for(
                    lambda: self.truth and condition(self.truth[-1][1]), limit):
                raise AssertionError('waited in vain for ' + what)
            return self.truth[-1][1]

    def wait_during(self, goal, condition, what):
        """Likewise, of a goal that is still on its way then."""
        state = self.wait_for_truth(lambda state: condition(state) or goal.is_done(), what)
        if goal.is_done():
            raise AssertionError('waited for %s; the goal ended before, with %s\n%s' % (
                what, goal.result(), self.output()))
        return state

    def wait_for_standstill(self):
        """While the world is held: the stamp [ns] at which it stands."""
        def is_repeated():
            return len(self.truth) > 1 and self.truth[-1][0] == self.truth[-2][0]
        with self._truth_changed:
            if not self._truth_changed.wait_for(is_repeated, LIMIT):
                raise AssertionError('waited in vain for the world to stand')
            return self.truth[-1][0]

    def start_robot(self, **more):
        arguments = dict(self.arguments, **more)
        self._forget_parameters('/sim_robot')
        self._watch_truth()
        self.robot = self.processes.start(
            [executable('sim_worker'), '__name:=sim_robot', '_role:=robot'] +
            ['_%s:=%s' % (key, str(value).lower() if isinstance(value, bool) else value)
             for key, value in arguments.items()], self.main)
        return self.robot

    def start_middle_layer(self, *remaps, **arguments):
        self._forget_parameters('/middle_layer')
        arguments.setdefault('lockstep', self.arguments.get('lockstep', False))
        if not any(remap.startswith('navigation/cmd_vel:=') for remap in remaps):
            remaps += ('navigation/cmd_vel:=base_controller/command',)  # no multiplexer between
        self.middle_layer = self.processes.start(
            [executable('middle_layer'), *remaps] +
            ['_%s:=%s' % (key, str(value).lower() if isinstance(value, bool) else value)
             for key, value in arguments.items()], self.main)
        return self.middle_layer

    def _forget_parameters(self, node):
        """What an earlier process was started with stays at the master."""
        if self.rospy.has_param(node):
            self.rospy.delete_param(node)

    def require_server(self):
        """Time may stand still, so that rospy's own waiting would never end."""
        require_server(self.client, self.output)

    def require_ready(self):
        """In lockstep an action is refused until the robot waits for its controllers' answers."""
        self.require_server()
        try:
            wait_for_middle_layer(self.rospy)
        except AssertionError as error:
            raise AssertionError('%s\n%s' % (error, self.output()))

    def output(self):
        return '\n'.join(process.output() for process in (self.robot, self.middle_layer)
                         if process is not None)

    def goal(self, name, *arguments, limit=0.0):
        goal = self.msg.ExecuteActionGoal()
        goal.action.name = name
        goal.action.arguments = list(arguments)
        goal.time_limit = self.rospy.Duration(limit)
        return goal

    def execute(self, name, *arguments, limit=0.0):
        return ActionGoal(self.client, self.goal(name, *arguments, limit=limit), SKILL_LIMIT)

    def tell(self, objects):
        """Says where objects are, as the world tracker does: {name: (model, x, y, z)}."""
        state = self.msg.WorldState()
        state.header.frame_id = 'map'
        for name, (model, x, y, z) in objects.items():
            told = self.msg.ObjectState(name=name, model=model)
            told.pose.position.x, told.pose.position.y, told.pose.position.z = x, y, z
            told.pose.orientation.w = 1.0
            state.objects.append(told)
        if self._known_objects is None:
            self._known_objects = self.rospy.Publisher('known_objects', self.msg.WorldState,
                                                       latch=True, queue_size=1)
        self._known_objects.publish(state)

    def call(self, service, kind, **fields):
        """The answer of a service of the simulated robot."""
        self.rospy.wait_for_service('sim_robot/' + service, LIMIT)
        return self.rospy.ServiceProxy('sim_robot/' + service, kind)(**fields)

    def hold(self, is_held):
        from std_srvs.srv import SetBool
        return self.call('hold', SetBool, data=is_held)

    def step_until(self, condition, what, num_ticks=1000):
        """Lets a world that is held play on by ticks of 0.05 s until the robot's true state is as
        wanted: however slow the computer, what happens next cannot come too late."""
        from std_srvs.srv import Trigger
        stamp = self.wait_for_standstill()
        self.rospy.wait_for_service('sim_robot/step', LIMIT)
        step = self.rospy.ServiceProxy('sim_robot/step', Trigger, persistent=True)
        for _ in range(num_ticks):
            if condition(self.truth[-1][1]):
                step.close()
                return
            step()
            self.wait_for_truth(lambda _: self.truth[-1][0] > stamp, 'the world to play a tick')
            stamp = self.truth[-1][0]
        raise AssertionError('stepped in vain for ' + what)

    def end_processes(self):
        for process in (self.middle_layer, self.robot):
            if process is not None:
                process.destroy()

    def stop(self):
        self.processes.stop_all()
