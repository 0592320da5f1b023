"""The execution monitor with the real planner and Blackboard, and fakes of what is beyond, as
processes under a main master of their own.

    system = ExecutionSystem()
    system.start()
    task = system.achieve(CARRY)
    result = task.result()
    system.destroy()
"""

import os

import yaml

from action_goal import ActionGoal, Task, require_server
from blackboard_access import BlackboardAccess
from ros_processes import Processes, executable, wait_until

SUPPORT = os.path.dirname(os.path.abspath(__file__))
CONFIG = os.path.abspath(os.path.join(SUPPORT, '..', '..', '..', 'config'))
ROLES = ('middle_layer', 'imagination', 'translator')
CARRY = 'carry_object_on_tray peppermill1 counter1 table1'
SERVE = 'serve_coffee_to_guest guest1'


class ExecutionSystem(BlackboardAccess):
    def __init__(self):
        self.processes = Processes()
        self.main = self.processes.master()
        self.nodes = {}
        self.monitor_config = self._write_config()

    def _write_config(self, **changes):
        """The shipped file with short times."""
        with open(os.path.join(CONFIG, 'execution_monitor.yaml')) as file:
            config = yaml.safe_load(file)
        config['domain'] = os.path.join(CONFIG, config['domain'])
        config['operators'] = os.path.join(CONFIG, config['operators'])
        config['ontology'] = [os.path.join(CONFIG, path) for path in config['ontology']]
        config['monitor'].update(effect_timeout=1.0, break_delay=0.2, stop_timeout=5.0,
                                 planning_timeout=3.0, late_wait=0.0)
        config['servers'].update(server_wait=1.0, cancel_wait=1.0)
        config['start_wait'] = 2.0
        config.update(changes)
        return self.processes.write('execution_monitor.yaml', yaml.safe_dump(config))

    # Processes.

    def start(self):
        self.start_blackboard()
        self.start_planner()
        for role in ROLES:
            self.start_fake(role)
        self.start_monitor()

    def start_blackboard(self):
        store = os.path.join(self.processes.folder.name, 'blackboard.db')
        self.nodes['blackboard'] = self.processes.start(
            [executable('blackboard'), '_store:=' + store], self.main)

    def start_planner(self):
        self.nodes['planner'] = self.processes.start([executable('planner')], self.main)

    def start_fake(self, role):
        fake = self.processes.start(
            ['/usr/bin/python3', os.path.join(SUPPORT, 'execution_fakes.py'), role], self.main)
        self.nodes[role] = fake
        fake.wait_for('fakes are ready')

    def start_monitor(self, *arguments):
        self.nodes['monitor'] = self.processes.start(
            [executable('execution_monitor'), '_config:=' + self.monitor_config, *arguments],
            self.main)

    def kill(self, name):
        self.nodes[name].kill()

    def destroy(self):
        self.processes.stop_all()

    # What the fakes do, and did.

    def behave(self, action, **wanted):
        self.main.set_param('/fake/' + action, wanted)

    def log(self):
        """What the fakes were asked, role by role."""
        return [text for told in (self.main.param('/fake/log') or {}).values() for text in told]

    def done(self, name):
        """Calls of an action, in order."""
        return [text for text in self.log() if text.startswith(name + '(')]

    def robot_steps(self):
        """All calls of actions, in order."""
        return [text for text in self.log() if '(' in text]

    def observe(self, step):
        """What follows from a step, "move_torso(torsoupposture)", is seen."""
        name, arguments = step.rstrip(')').split('(')
        getattr(self._observations, name)(*arguments.split(', '))

    def put(self, thing, area):
        """It is seen there."""
        self._observations.on(thing, area)

    def say_observed_until(self, time, sequence=0):
        """As a tracker does when the Blackboard has come to that number."""
        message = self.msg.ObservationProgress(sequence=sequence)
        message.header.stamp = time
        self._progress.publish(message)

    def free(self, action):
        """Lets what hangs in this action go on."""
        self.main.set_param('/fake/go_on', action)

    def reset(self):
        """The restaurant as it was at first, and fakes that do as they are told."""
        self.main.set_param('/fake', {'imagine': {'answer': 'ranked', 'recommend': 'slow'}})
        wait_until(lambda: self._reaches('blackboard/add'), 'the Blackboard')
        seen = self._observations
        seen.robot_at('floorAreaTamsRestaurant1')
        seen.torso('torsodownposture')
        for arm in ('leftarm1', 'rightarm1'):
            seen.arm(arm, 'armuntuckedposture')
            seen.holding(arm, 'nothing')
        for thing in ('mug1', 'mug2', 'peppermill1'):
            seen.on(thing, 'placingAreaEastRightCounter1')
        if self.fluents('ImagineWish', now=True):
            seen.end('imaginePlaceObject')

    def put_wish(self):
        """Placing is to be imagined."""
        wish = self.msg.Fluent(concept_name='ImagineWish', instance='imaginePlaceObject', properties=[
            self.msg.FluentProperty(role='hasAction', type='xsd:string', text='place_object')])
        self.ask('add', self.srv.WriteFluents, fluents=[wish])

    # The test itself as a node.

    def _reaches(self, service):
        try:
            self.rospy.wait_for_service(service, 1.0)
            return True
        except self.rospy.ROSException:
            return False

    def connect(self):
        os.environ.update(ROS_MASTER_URI=self.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=self.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import actionlib
        import rospy
        from hires import msg, srv
        self.rospy, self.msg, self.srv = rospy, msg, srv
        from execution_fakes import Observations
        self._observations = Observations()
        rospy.init_node('execution_test', disable_signals=True)
        self.client = actionlib.ActionClient('achieve', msg.AchieveAction)
        self.actions = actionlib.ActionClient('execute_action', msg.ExecuteActionAction)
        self._progress = rospy.Publisher('observation_progress', msg.ObservationProgress,
                                         queue_size=10, latch=True)
        self.require_server()

    def require_server(self):
        require_server(self.client, lambda: self.nodes['monitor'].output())

    def achieve(self, task, imagination=''):
        def told():
            return 'last feedback: %s\nthe monitor says:\n%s' % (
                achieved.feedback[-1:], self.nodes['monitor'].output()[-4000:])

        achieved = Task(self.client, self.msg.AchieveGoal(task=task, imagination=imagination),
                        told=told)
        return achieved

    def execute(self, name, *arguments):
        """An action of the robot, past the monitor."""
        require_server(self.actions, lambda: self.nodes['middle_layer'].output())
        action = self.msg.ActionCall(name=name, arguments=list(arguments))
        return ActionGoal(self.actions, self.msg.ExecuteActionGoal(action=action))


def text_of(fluent, role):
    for entry in fluent.properties:
        if entry.role == role:
            return entry.text
    return None
