#!/usr/bin/env python3
"""Stands for the robot, its translator and its imagination, as one process a test can kill.

    execution_fakes.py ROLE...     ROLE: middle_layer, translator, imagination

A step is done at once and its effects are observed, unless the parameter /fake/<action> says
otherwise: a map with any of
    reason: TEXT     it fails with this reason, after its effects on the robot's own place
    times: N         only the first N times (default: always)
    hang: true       it goes on until it is preempted, or /fake/go_on names the action
    hang_for: TEXT   only where this is one of its arguments
    deaf: true       it does not even listen to that
    silent: true     its effects are not observed
The imagination answers as /fake/imagine says: {answer: ranked|all_failed|no_worker|hang,
recommend: NAME of the last argument}. What came is told in the list /fake/log/<node>, one text each.
"""

import math
import sys
import threading

import actionlib
import rospy
from failures import failure
from hires import msg, srv

POSTURES = {name.lower(): name for name in (
    'ArmTuckedPosture', 'ArmUnTuckedPosture', 'ArmToSidePosture', 'ArmCarryPosture',
    'TorsoUpPosture', 'TorsoMiddlePosture', 'TorsoDownPosture')}
ARMS = {'leftarm1': 'LeftArm1', 'rightarm1': 'RightArm1'}


def log(text):
    """Each role in a list of its own: nobody else writes there."""
    key = '/fake/log' + rospy.get_name()
    with LOG_LOCK:
        rospy.set_param(key, rospy.get_param(key, []) + [text])


LOG_LOCK = threading.Lock()


def behaviour_of(action, arguments):
    """What the test wants of an action now."""
    wanted = rospy.get_param('/fake/' + action, {})
    if wanted.get('hang_for') and wanted['hang_for'] not in arguments:
        return {}
    if 'times' not in wanted:
        return wanted
    if wanted['times'] <= 0:
        return {}
    rospy.set_param('/fake/%s/times' % action, wanted['times'] - 1)
    return wanted


class Observations:
    """Writes what a tracker would see."""

    def link(self, role, kind, filler):
        return msg.FluentProperty(role=role, type=kind, text=filler)

    def put(self, concept, instance, *properties):
        fluent = msg.Fluent(concept_name=concept, instance=instance, properties=list(properties))
        self.call('add', srv.WriteFluents, fluents=[fluent])

    def end(self, instance):
        self.call('remove', srv.RemoveFluents, instances=[instance])

    def call(self, name, kind, **fields):
        """The Blackboard may be away for a while."""
        while not rospy.is_shutdown():
            try:
                answer = rospy.ServiceProxy('blackboard/' + name, kind)(
                    by=msg.Assertion(source=msg.Assertion.OBSERVATION), **fields)
                if answer.error.code:
                    rospy.logerr('%s: %s', name, answer.error.message)
                return
            except rospy.ServiceException:
                threading.Event().wait(0.05)

    def robot_at(self, area):
        self.put('RobotAt', 'robotAtPR21', self.link('hasRobot', 'Robot', 'PR21'),
                 self.link('hasArea', 'Area', area))

    def torso(self, posture):
        self.put(POSTURES[posture], 'postureTorso1', self.link('hasTorso', 'Torso', 'torso1'))

    def arm(self, arm, posture):
        self.put(POSTURES[posture], 'posture' + ARMS[arm], self.link('hasArm', 'Arm', arm))

    def holding(self, arm, thing):
        self.put('Holding', 'holding' + ARMS[arm], self.link('hasArm', 'Arm', arm),
                 self.link('hasPassiveObject', 'PassiveObject', thing))

    def on(self, thing, area):
        self.put('On', 'on' + thing.capitalize(),
                 self.link('hasPhysicalEntity', 'PassiveObject', thing),
                 self.link('hasArea', 'PlacingArea', area))

    def off(self, thing):
        self.end('on' + thing.capitalize())

    # Effects of the steps, as restaurant.lisp has them.
    def move_base(self, area):
        self.robot_at(area)

    def move_base_param(self, area, _):
        self.robot_at(area)

    def move_base_blind(self, area):
        self.robot_at(area)

    def move_torso(self, posture):
        self.torso(posture)

    def tuck_arms(self, left, right):
        self.arm('leftarm1', left)
        self.arm('rightarm1', right)

    def move_arm_to_side(self, arm):
        self.arm(arm, 'armtosideposture')

    def move_arms_to_carryposture(self):
        for arm in ARMS:
            self.arm(arm, 'armcarryposture')

    def observe_objects_on_area(self, area):
        pass

    def pick_up_object(self, thing, arm):
        self.off(thing)
        self.holding(arm, thing)

    def place_object(self, thing, arm, area):
        self.holding(arm, 'nothing')
        self.on(thing, area)

    def place_on_tray(self, arm, thing):
        self.holding(arm, 'nothing')
        self.on(thing, 'trayArea1')

    def pick_up_from_tray(self, arm, thing):
        self.off(thing)
        self.holding(arm, thing)


class Server:
    """An action server whose goals each have a thread of their own."""

    def __init__(self, name, kind):
        self._cancelled = {}
        self._server = actionlib.ActionServer(name, kind, self._on_goal, self._on_cancel, False)
        self._server.start()

    def _on_goal(self, goal):
        self._cancelled[goal.get_goal_id().id] = threading.Event()
        goal.set_accepted()
        threading.Thread(target=self._run, args=(goal,), daemon=True).start()

    def _on_cancel(self, goal):
        event = self._cancelled.get(goal.get_goal_id().id)
        if event:
            event.set()

    def _run(self, goal):
        self.answer(goal, self._cancelled[goal.get_goal_id().id])


class MiddleLayer(Server):
    def __init__(self):
        self._observations = Observations()
        super().__init__('execute_action', msg.ExecuteActionAction)

    def answer(self, goal, cancelled):
        call = goal.get_goal().action
        wanted = behaviour_of(call.name, call.arguments)
        log('%s(%s)' % (call.name, ', '.join(call.arguments)))
        result = msg.ExecuteActionResult(failure=failure(wanted.get('reason', '')))
        if wanted.get('hang') or wanted.get('hang_for'):
            if self._hangs_until_freed(call.name, cancelled):
                return self._succeed(goal, call, wanted, result)
            if wanted.get('deaf'):
                threading.Event().wait()
            log('preempted %s' % call.name)
            result.code = result.PREEMPTED
            return goal.set_canceled(result)
        if result.failure.code:
            result.code = result.FAILED
            return goal.set_aborted(result)
        self._succeed(goal, call, wanted, result)

    def _hangs_until_freed(self, name, cancelled):
        """False: it was preempted."""
        while not cancelled.wait(0.05):
            if rospy.get_param('/fake/go_on', '') == name:
                return True
        return False

    def _succeed(self, goal, call, wanted, result):
        if not wanted.get('silent'):
            getattr(self._observations, call.name)(*call.arguments)
        goal.set_succeeded(result)


class Imagination(Server):
    def __init__(self):
        super().__init__('imagine', msg.ImagineAction)

    def answer(self, goal, cancelled):
        asked = goal.get_goal()
        wanted = rospy.get_param('/fake/imagine', {'answer': 'ranked'})
        log('imagine %s' % asked.steps[0].name)
        result = msg.ImagineResult(recommended=-1, seed=asked.seed, wall_seconds=1.5,
                                   simulated_seconds=30.0, why='as the test wants')
        if wanted['answer'] == 'hang':
            cancelled.wait()
            result.outcome = result.CANCELLED
            result.predictions = self.predictions(asked, wanted)
            goal.set_canceled(result)
            return log('imagining ended')
        if wanted['answer'] == 'no_worker':
            result.outcome = result.NO_WORKER
            return goal.set_aborted(result)
        is_ranked = wanted['answer'] == 'ranked'
        result.predictions = self.predictions(asked, wanted)
        result.outcome = result.RANKED if is_ranked else result.ALL_FAILED
        result.recommended = 0 if is_ranked else -1
        goal.set_succeeded(result)

    @staticmethod
    def predictions(asked, wanted):
        """Of each alternative 16 rollouts, what is recommended first."""
        does_fail = wanted['answer'] == 'all_failed'
        last = asked.steps[0].alternatives[-1].values
        best = wanted.get('recommend', last[0])
        return [msg.Prediction(
            action=msg.ActionCall(
                name=asked.steps[0].name,
                arguments=[a.values[0] for a in asked.steps[0].alternatives[:-1]] + [value]),
            rollouts=16, success_share=0.0 if does_fail else 1.0, duration_mean=20.0,
            duration_sd=1.0, duration_p50=20.0, duration_p95=22.0,
            durations=[18.5] + 14 * [20.0] + [22.0],
            failures=[msg.FailureCount(failure('area_occupied'), 16)] if does_fail else [])
                for value in sorted(last, key=lambda v: v != best)]


def translate(request):
    """The robot somewhere, and an object for each that is on something."""
    wanted = rospy.get_param('/fake/translator', {})
    log('translate')
    answer = srv.GenerateImagineStateResponse(error=wanted.get('error', ''))
    if not request.is_whole_state:
        answer.error = 'wanted the whole state'
    answer.world_state.header.frame_id = 'map'
    answer.robot_state.pose.orientation.w = 1.0
    for atom in request.updated_fluents:
        if atom.predicate == 'On':
            thing = msg.ObjectState(name=atom.arguments[0], model='coffee_cup')
            thing.pose.position.z = math.pi
            thing.pose.orientation.w = 1.0
            answer.world_state.objects.append(thing)
    return answer


def main():
    roles = sys.argv[1:]
    rospy.init_node('fake_' + '_'.join(roles))
    kept = []
    if 'middle_layer' in roles:
        kept.append(MiddleLayer())
    if 'imagination' in roles:
        kept.append(Imagination())
    if 'translator' in roles:
        kept.append(rospy.Service('generate_imagine_state', srv.GenerateImagineState, translate))
    print('fakes are ready', flush=True)
    rospy.spin()


if __name__ == '__main__':
    main()
