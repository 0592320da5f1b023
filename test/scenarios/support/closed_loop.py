"""The whole system as real processes under a main master of its own, as closed_loop.launch puts it
together: simulated robot, middle layer, world tracker, translator, Blackboard, planner, imagination
with its workers, execution monitor. Each node can be killed, stopped and started again alone.

    loop = ClosedLoop()
    loop.connect('my_test')
    loop.start(scenario_of(robot, objects))
    result = loop.achieve(task).result()
    loop.destroy()

One test program has one master (a rospy node cannot change it); the nodes may be started anew.
"""

import math
import os
import signal
import sys
import threading

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.abspath(os.path.join(HERE, '..', '..', 'ros', 'support')))

from action_goal import Task, require_server  # noqa: E402
from blackboard_access import BlackboardAccess  # noqa: E402
from ros_processes import (  # noqa: E402
    Processes, executable, free_port_block, processes_with, wait_until)
from scene_file import read_scene  # noqa: E402

CONFIG = os.path.abspath(os.path.join(HERE, '..', '..', '..', 'config'))
RESTAURANT = os.path.join(CONFIG, 'knowledge', 'restaurant.yaml')
IMAGINE_PLACING = os.path.join(CONFIG, 'knowledge', 'imagine_placing.yaml')
SERVE = 'serve_coffee_to_guest guest1'
TASK_LIMIT = 300.0  # [s] by the wall's clock: it ends a broken test, and measures nothing
FEEDBACK_PERIOD = 0.05  # [s] by the wall's clock: its words say that the monitor keeps up
MARK = 'HIRES_TEST_LOOP'

# Of the execution monitor, in main ROS time: what programs may take to do their work. They do not
# work faster when the robot does.
WORKING_TIMES = ('effect_timeout', 'observation_delay', 'break_delay', 'stop_timeout',
                 'arrival_margin', 'answer_grace', 'late_wait', 'retry_period')

# In the order of their start.
NODES = ('sim_robot', 'middle_layer', 'world_tracker', 'translator', 'blackboard', 'planner',
         'imagination_client', 'execution_monitor')
RECOGNISER, HEAT_READER = 'tabletop_recogniser', 'heat_reader'


def scenario_of(robot, objects, hidden=(), temperatures=()):
    """What is true at first, as config/scenarios has it; poses are [x, y, z, yaw], temperatures of
    objects [K] by name."""
    warm = {name: {'temperature': kelvin} for name, kelvin in dict(temperatures).items()}
    return {'task': 'of a test', 'knowledge': [], 'robot': robot,
            'objects': [{'name': name, 'pose': list(pose), **warm.get(name, {})}
                        for name, pose in objects.items()],
            'hidden': [{'name': name, 'pose': list(pose)} for name, pose in dict(hidden).items()]}


def text_of(fluent, role):
    for entry in fluent.properties:
        if entry.role == role:
            return entry.text
    return None


def link_of(fluent, role):
    """The instance that fills a role, in lower case."""
    return next((entry.text.lower() for entry in fluent.properties if entry.role == role), None)


def speed_of(robot):
    """[m/s] and [rad/s] of the base, the larger one."""
    twist = robot.twist
    return max(math.hypot(twist.linear.x, twist.linear.y), abs(twist.angular.z))


def joint_speeds(before, after):
    """[m/s] or [rad/s] of each joint, from one moment to the next."""
    dt = (after.joints.header.stamp - before.joints.header.stamp).to_sec()
    was = dict(zip(before.joints.name, before.joints.position))
    return {name: abs(math.remainder(position - was[name], 2.0 * math.pi)) / dt
            for name, position in zip(after.joints.name, after.joints.position)}


class Truth:
    """What really happens, in order; for tests only."""

    def __init__(self, rospy, msg):
        self._changed = threading.Condition()
        self.robot = []  # RobotState of each moment
        self.num_repeated = 0  # words about the last moment: time stands
        self.world = None
        self.summary = None
        keep = dict(queue_size=10000, tcp_nodelay=True)
        self._subscribers = [
            rospy.Subscriber('ground_truth/robot_state', msg.RobotState, self._on_robot, **keep),
            rospy.Subscriber('ground_truth/world_state', msg.WorldState, self._on_world, **keep),
            rospy.Subscriber('ground_truth/summary', msg.GroundTruth, self._on_summary, **keep)]

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _on_robot(self, state):
        with self._changed:
            is_new = not self.robot or (state.joints.header.stamp >
                                        self.robot[-1].joints.header.stamp)
            self.num_repeated = 0 if is_new else self.num_repeated + 1
            if is_new:
                self.robot.append(state)
            self._changed.notify_all()

    def _on_world(self, state):
        with self._changed:
            self.world = state
            self._changed.notify_all()

    def _on_summary(self, summary):
        with self._changed:
            self.summary = summary
            self._changed.notify_all()

    def wait(self, condition, what, limit=TASK_LIMIT):
        """Waits until condition(self) holds."""
        with self._changed:
            if not self._changed.wait_for(lambda: self.is_complete() and condition(self), limit):
                raise AssertionError('waited in vain for ' + what)

    def is_complete(self):
        return bool(self.robot) and self.world is not None and self.summary is not None

    def now(self):
        """[s] of the last moment told of."""
        return self.robot[-1].joints.header.stamp.to_sec()

    def object(self, name):
        """Its ObjectState, or None."""
        return next((o for o in self.world.objects if o.name == name), None)

    def position(self, name):
        position = self.object(name).pose.position
        return position.x, position.y, position.z

    def tilt(self, name):
        """[rad] against the world's up-axis."""
        return next(o.tilt for o in self.summary.objects if o.name == name)

    def stands(self, name):
        """Nothing holds it, and it is not down."""
        return next(o.stands for o in self.summary.objects if o.name == name)

    def joint(self, name):
        """[m] or [rad]"""
        joints = self.robot[-1].joints
        return joints.position[list(joints.name).index(name)]

    def falls(self):
        return {o.name: o.falls for o in self.summary.objects if o.falls}

    def speed(self):
        """[m/s] and [rad/s], the larger one."""
        return speed_of(self.robot[-1])

    def joint_speeds(self):
        """{joint: m/s or rad/s}"""
        return joint_speeds(*self.robot[-2:]) if len(self.robot) > 1 else {}


class ClosedLoop(BlackboardAccess):
    """@param seed   of the robot's hidden truth and of all chance.
    @param pace      [s] of the simulated robot per second.
    @param rollouts  of an imagination, per combination of alternatives.
    @param sensing   pictures: objects are recognised in the camera's clouds, and measured
                     in the thermal camera's pictures, by a node of its own each."""

    def __init__(self, seed=1, pace=10.0, rollouts=8, workers=1, uncertainty=None, sensing=None):
        self.processes = Processes()
        self.main = self.processes.master()
        self.main.set_param('/use_sim_time', True)
        os.environ.update(ROS_MASTER_URI=self.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=self.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        self.seed = seed
        self.pace = pace
        self.rollouts = rollouts
        self.workers = workers
        self.uncertainty = uncertainty
        self.sensing = sensing
        self.base_port = free_port_block(workers + 1) - 1
        self.nodes = {}
        self.truth = None
        self.scenario = None
        self._monitor_config = None
        self.remaps = {}  # node -> ['topic:=other']
        self.knowledge = [RESTAURANT]
        self._stores = 0

    def _write_operators(self, on_late):
        with open(os.path.join(CONFIG, 'domains', 'restaurant.yaml')) as file:
            operators = yaml.safe_load(file)
        operators['operators']['move_base_param']['imagine']['on_late'] = on_late
        return self.processes.write('operators.yaml', yaml.safe_dump(operators))

    def _write_monitor_config(self, on_late, monitor):
        with open(os.path.join(CONFIG, 'execution_monitor.yaml')) as file:
            config = yaml.safe_load(file)
        config['domain'] = os.path.join(CONFIG, config['domain'])
        config['operators'] = self._write_operators(on_late)
        config['ontology'] = [os.path.join(CONFIG, path) for path in config['ontology']]
        for name in WORKING_TIMES:
            config['monitor'][name] *= self.pace
        config['monitor'].update(monitor)
        config['imagining']['rollouts'] = self.rollouts
        config['feedback_period'] = FEEDBACK_PERIOD
        return self.processes.write('execution_monitor.yaml', yaml.safe_dump(config))

    def _write_tracker_config(self):
        """The tracker is not waited for, and a computer that is busy for a moment is so for longer
        in the robot's time: what the tracker keeps lasts as long as on a robot."""
        scene = read_scene()
        scene['sensing']['robot_state']['history'] *= self.pace
        with open(os.path.join(CONFIG, 'world_tracker.yaml')) as file:
            config = yaml.safe_load(file)
        config['scene'] = self.processes.write('tracker_scene.yaml', yaml.safe_dump(scene))
        config['ontology'] = [os.path.join(CONFIG, path) for path in config['ontology']]
        return self.processes.write('world_tracker.yaml', yaml.safe_dump(config))

    # Nodes.

    def _arguments(self, name):
        if name == 'sim_robot':
            return ['_role:=robot', '_scenario:=' + self.scenario, '_seed:=%d' % self.seed,
                    '_pace:=%g' % self.pace, '_lockstep:=true'] + (
                        ['_uncertainty:=' + self.uncertainty] if self.uncertainty else []) + (
                            ['_sensing:=' + self.sensing] if self.sensing else [])
        if name == 'middle_layer':
            return ['_lockstep:=true', 'navigation/cmd_vel:=base_controller/command']
        if name == 'world_tracker':
            return ['_config:=' + self._write_tracker_config(), '_lockstep:=true']
        if name == 'translator':
            return ['_config:=' + os.path.join(CONFIG, 'translator.yaml')]
        if name == 'blackboard':
            return ['_store:=' + self.store(), '_knowledge:=' + ' '.join(self.knowledge)]
        if name == 'imagination_client':
            return ['_workers:=%d' % self.workers]
        if name == 'execution_monitor':
            return ['_config:=' + self._monitor_config, '_seed:=%d' % self.seed]
        return []

    def store(self):
        return os.path.join(self.processes.folder.name, 'blackboard_%d.db' % self._stores)

    def start_node(self, name):
        """It, anew or again."""
        program = 'sim_worker' if name == 'sim_robot' else name
        self.nodes[name] = self.processes.start(
            [executable(program), '__name:=' + name, *self._arguments(name),
             *self.remaps.get(name, [])], self.main,
            **{MARK: self.main.uri})
        return self.nodes[name]

    def start_worker(self, index):
        name = 'worker_host_%d' % index
        self.nodes[name] = self.processes.start(
            [executable('worker_host'), '__name:=' + name,
             '_config:=' + os.path.join(CONFIG, 'worker_host.yaml'), '_index:=%d' % index,
             '_base_port:=%d' % self.base_port], self.main, **{MARK: self.main.uri})
        return self.nodes[name]

    def start(self, scenario, knowledge=(RESTAURANT,), on_late='default', **monitor):
        """Everything; what runs already is for another world, and ended first, but for workers.
        @param on_late  what the domain says of a drive whose imagination is late: default, wait.
        @param monitor  changes of the section `monitor` of execution_monitor.yaml."""
        self.end_nodes()
        self._stores += 1
        self.knowledge = list(knowledge)
        self.scenario = self.processes.write('scenario.yaml', yaml.safe_dump(scenario))
        self._monitor_config = self._write_monitor_config(on_late, monitor)
        self.truth = Truth(self.rospy, self.msg)
        for index in range(1, self.workers + 1):
            if 'worker_host_%d' % index not in self.nodes:
                self.start_worker(index)
        for name in NODES:
            self.start_node(name)
        if self.sensing == 'pictures':
            self.start_node(RECOGNISER)
            self.start_node(HEAT_READER)
        self.require_server()

    def end_nodes(self):
        """All but the workers."""
        for name in (HEAT_READER, RECOGNISER, *reversed(NODES)):
            if name in self.nodes:
                self.nodes.pop(name).destroy()
                if self.rospy.has_param('/' + name):
                    self.rospy.delete_param('/' + name)
        if self.truth is not None:
            self.truth.close()

    def kill(self, name):
        self.nodes[name].kill()

    def pause(self, name):
        """SIGSTOP: it is there, and does not answer."""
        self.nodes[name].signal(signal.SIGSTOP)

    def unpause(self, name):
        self.nodes[name].signal(signal.SIGCONT)

    def wait_for_worker(self, index):
        """Until its topics have crossed to the main master."""
        wait_until(lambda: self.main.publishers('/worker_%d/rollout/result' % index),
                   'worker %d\n%s' % (index, self.output()))

    def kill_workers(self):
        """Hosts first, so that nobody starts them again; then what they started."""
        for index in range(1, self.workers + 1):
            self.nodes.pop('worker_host_%d' % index).destroy()
        wait_until(lambda: not self.simulators(), 'the workers to be gone')

    def simulators(self):
        """Process ids of what imagines."""
        return [pid for pid, command in processes_with(MARK, self.main.uri).items()
                if '__name:=sim_worker_' in command]

    def output(self):
        return '\n'.join('--- %s\n%s' % (name, '\n'.join(node.lines[-25:]))
                         for name, node in self.nodes.items())

    def destroy(self):
        self.processes.stop_all()

    # The test itself as a node.

    def connect(self, name):
        """Once per test program."""
        import actionlib
        import rospy
        from hires import msg, srv
        self.rospy, self.msg, self.srv = rospy, msg, srv
        rospy.init_node(name, disable_signals=True)
        self.client = actionlib.ActionClient('achieve', msg.AchieveAction)

    def require_server(self):
        """Time may not have begun, so that rospy's own waiting would never end."""
        require_server(self.client, self.nodes['execution_monitor'].output)

    def achieve(self, task, imagination='', on_feedback=None):
        goal = self.msg.AchieveGoal(task=task, imagination=imagination)
        return Task(self.client, goal, TASK_LIMIT, self.output, on_feedback)

    def intervene(self, service, kind, **fields):
        """The answer of a service of the simulated robot."""
        self.rospy.wait_for_service('sim_robot/' + service, 60.0)
        return self.rospy.ServiceProxy('sim_robot/' + service, kind)(**fields)

    def hold(self, is_held):
        """Time stands, or goes on."""
        from std_srvs.srv import SetBool
        answer = self.intervene('hold', SetBool, data=is_held)
        assert answer.success, answer.message

    def step_until(self, condition, what, num_ticks=4000, lag=math.inf, words=None):
        """Holds the world and lets it play on by ticks of 0.05 s until condition(truth): however slow
        the computer, what happens next cannot come too late.
        @param lag    [s] that what is observed may be old on the Blackboard before time goes on.
        @param words  how many have come of who must keep up: after each tick one more is waited for."""
        from std_srvs.srv import Trigger
        observed = [0.0]  # [s] up to then
        progress = self.rospy.Subscriber(
            'observation_progress', self.msg.ObservationProgress,
            lambda news: observed.append(news.header.stamp.to_sec()))
        self.hold(True)
        self.truth.wait(lambda truth: truth.num_repeated > 0, 'time to stand')
        step = self.rospy.ServiceProxy('sim_robot/step', Trigger, persistent=True)
        try:
            for _ in range(num_ticks):
                if condition(self.truth):
                    return
                before = self.truth.now()
                heard = words() if words else 0
                step()
                self.truth.wait(lambda truth: truth.now() > before, 'the world to play a tick')
                wait_until(lambda: self.truth.now() - observed[-1] <= lag,
                           lambda: 'observation\n' + self.output())
                if words:
                    wait_until(lambda: words() > heard, lambda: 'a word\n' + self.output())
        finally:
            step.close()
            progress.unregister()
        raise AssertionError('stepped in vain for %s\n%s' % (what, self.output()))
