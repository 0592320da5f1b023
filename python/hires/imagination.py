"""The imagination client's action `imagine` as one call."""

import io
import numbers
import operator
import re
import threading
import time
import xmlrpc.client
from dataclasses import dataclass, field
from typing import Dict, Optional, Tuple
from xml.parsers.expat import ExpatError

import actionlib
import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatus
from hires.failures import text_of
from hires.msg import (ActionTemplate, Atom, ImagineAction, ImagineGoal, ImagineResult, StringList)
from hires.srv import ImaginedRollout

_BRIEF_STATES = (actionlib.CommState.WAITING_FOR_GOAL_ACK, actionlib.CommState.WAITING_FOR_RESULT)
_ATOM = re.compile(r'\s*(\w+)\s*\(([^()]*)\)\s*')
_OUTCOMES = {getattr(ImagineResult, name): name.lower()
             for name in ('RANKED', 'RANKED_AT_DEADLINE', 'ALL_FAILED', 'NO_WORKER',
                          'NOTHING_FINISHED', 'INVALID', 'CANCELLED', 'UNDECIDED', 'CLOSE')}


class ImaginationError(RuntimeError):
    """Nothing was imagined: no master or nobody who serves the action, a client that went away during the
    request, or a request that cannot be played. The message says which, and what to do."""


@dataclass(frozen=True)
class Alternative:
    """What imagination found about one way to act."""
    action: str
    arguments: Tuple[str, ...]
    success: float                  # share of rollouts, 0 .. 1
    interval: Tuple[float, float]   # 95 %, of the probability of success
    rollouts: int
    duration: float                 # [s] mean of the rollouts that came to their end; nan: none did
    expected_cost: float            # [s] duration and price of failures; nan: no prices are known
    failures: Dict[str, int] = field(default_factory=dict)  # words as `hires imagine` prints them

    def __str__(self):
        return '%s(%s): %.1f %% of %d (%.0f .. %.0f %%), %.1f s' % (
            self.action, ', '.join(self.arguments), 100 * self.success, self.rollouts,
            100 * self.interval[0], 100 * self.interval[1], self.duration)


@dataclass(frozen=True)
class Answer:
    outcome: str                         # 'ranked', 'close', 'all_failed', ... as in Imagine.action
    why: str                             # one sentence
    ranking: Tuple[Alternative, ...]     # best first
    recommended: Optional[Alternative]   # None: imagination recommends nothing
    caveats: Tuple[str, ...]             # what speaks against trusting it
    seed: int
    probability_best: Optional[float] = None  # that the recommended one costs least; None: not by cost
    expected_regret: Optional[float] = None   # [s] of the recommended one; None: not by cost


@dataclass(frozen=True)
class SavedRollout:
    path: str                              # of the bag, on the computer of imagination_client
    index: int                             # which rollout of its alternative
    seed: int
    events: Tuple[Tuple[float, str], ...]  # [s] since the action began, and what happened


_LONGEST = 1e7  # [s] of a deadline, as the client has it
_PATIENCE = 10.0  # [s] of the wall's clock for a goal to be accepted, and for the result of one that is over


def _text(what, value):
    if isinstance(value, str):
        return value
    raise TypeError('%s is %r, wanted text' % (what, value))


def _names(what, one_or_several):
    if isinstance(one_or_several, (str, bytes)):
        one_or_several = [one_or_several]
    try:
        values = list(one_or_several)
    except TypeError:
        raise TypeError('%s is %r, wanted a name or a list of names' % (what, one_or_several)) from None
    return [_text(what, value) for value in values]


def _whole(what, value, most):
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError('%s is %r, wanted a whole number' % (what, value)) from None
    if not 0 <= number <= most:
        raise ValueError('%s is %d, wanted 0 to %d' % (what, number, most))
    return number


def _number(what, value):
    if isinstance(value, numbers.Real):
        return float(value)
    raise TypeError('%s is %r, wanted a number' % (what, value))


def _seconds(what, value):
    seconds = _number(what, value)
    if not 0.0 <= seconds <= _LONGEST:  # false for what is no number, too
        raise ValueError('%s is %r, wanted 0 to %.0f s; 0: none' % (what, value, _LONGEST))
    return rospy.Duration.from_sec(seconds)


def _atom(text):
    match = _ATOM.fullmatch(text)
    if match is None:
        raise ValueError("%r is no fact; write it as 'On(mug1, placingAreaNorthTable1)'" % text)
    arguments = [word.strip() for word in match.group(2).split(',') if word.strip()]
    return Atom(predicate=match.group(1), arguments=arguments)


def _alternative(prediction):
    return Alternative(
        action=prediction.action.name, arguments=tuple(prediction.action.arguments),
        success=prediction.success_share,
        interval=(prediction.success_lower, prediction.success_upper),
        rollouts=prediction.rollouts, duration=prediction.duration_mean,
        expected_cost=prediction.expected_cost,
        failures={text_of(entry.failure): entry.count for entry in prediction.failures})


def init_node(name, **options):
    """As rospy.init_node, which waits without end for a master that is not there.

    Raises ImaginationError where no master answers.
    """
    try:
        rospy.get_master().getPid()
    except (OSError, xmlrpc.client.Error, ExpatError) as error:
        raise ImaginationError(
            'no master answers at %s (%s); start one (roslaunch hires imagination.launch), or set '
            'ROS_MASTER_URI to the one that runs' % (rosgraph.get_master_uri(), error)) from None
    rospy.init_node(name, **options)


class Imagination:
    """Asks the imagination client of this process's master. init_node must have been called."""

    def __init__(self, action='imagine', wait=10.0):
        """wait: seconds of the wall's clock for the client to be there."""
        if not rospy.core.is_initialized():
            raise ImaginationError("this process is no node yet; call hires.init_node('my_name') first")
        # The simple client of rospy loses answers that come before its send_goal has returned.
        self._client = actionlib.ActionClient(action, ImagineAction)
        self._action, self._wait = action, wait
        self._is_connected = threading.Event()
        # In a thread, because actionlib waits by ROS time, which may stand still.
        threading.Thread(target=self._connect, daemon=True).start()

    def _connect(self):
        if self._client.wait_for_server():
            self._is_connected.set()

    def ask(self, action, *arguments, robot_at=None, on_tray=(), facts=(), rollouts=400, seed=1,
            deadline=0.0, ranking='', min_success=0.0, uncertainty='', max_regret=0.0):
        """What would happen? Each argument is a name, or a list of names to choose from; all
        combinations are played. The state is said by robot_at (an area), on_tray (objects) and
        facts ('On(mug1, placingAreaNorthTable1)'), one or a list of them. Zeros and '' stand for the
        client's defaults.

        Raises TypeError or ValueError for an argument that is none, ImaginationError where nobody
        answers or the request cannot be played; it names what is wrong.
        """
        goal = ImagineGoal(
            rollouts=_whole('rollouts', rollouts, 2**32 - 1), seed=_whole('seed', seed, 2**64 - 1),
            ranking=_text('ranking', ranking), min_success=_number('min_success', min_success),
            uncertainty=_text('uncertainty', uncertainty), request_id=rospy.get_name(),
            deadline=_seconds('deadline', deadline), max_regret=_number('max_regret', max_regret))
        goal.steps = [ActionTemplate(name=_text('action', action), alternatives=[
            StringList(values=_names('argument %d' % place, argument))
            for place, argument in enumerate(arguments, 1)])]
        goal.updated_fluents = [_atom(fact) for fact in _names('facts', facts)]
        if robot_at is not None:
            goal.updated_fluents.append(
                Atom(predicate='RobotAt', arguments=[_text('robot_at', robot_at)]))
        for name in _names('on_tray', on_tray):
            goal.updated_fluents.append(Atom(predicate='On', arguments=[name, 'trayArea1']))
        return self._answer(self._result(goal))

    def save_rollout(self, which='worst'):
        """Has one rollout of this node's last answer played again and saved for `hires watch`: worst
        (of all alternatives), median, first_fall or a number, of the best alternative, or of the
        third: 'worst@3'.

        Raises ImaginationError where nobody answers or there is no such rollout.
        """
        name = self._action.rpartition('/')[0]
        name = name + '/imagined_rollout' if name else 'imagined_rollout'
        try:
            answer = rospy.ServiceProxy(name, ImaginedRollout)(rospy.get_name(), str(which))
        except rospy.ServiceException as error:
            raise ImaginationError("nobody serves '%s' (%s); start it: roslaunch hires imagination.launch"
                                   % (rospy.resolve_name(name), error)) from error
        if not answer.success:
            raise ImaginationError(answer.message)
        return SavedRollout(path=answer.path, index=answer.rollout.index, seed=answer.rollout.seed,
                            events=tuple(zip(answer.times, answer.events)))

    def _result(self, goal):
        # Where a message cannot be written, rospy would send its beginning before the next one.
        goal.serialize(io.BytesIO())
        if not self._is_connected.wait(self._wait):
            raise ImaginationError(self._why_nobody())
        done = threading.Event()

        def on_transition(handle):
            if handle.get_comm_state() == actionlib.CommState.DONE:
                done.set()

        handle = self._client.send_goal(goal, on_transition)
        give_up = time.monotonic() + _PATIENCE
        try:
            while not done.wait(0.1):
                if rospy.is_shutdown():
                    raise ImaginationError('this node was shut down during the request')
                # Without a server there will be no result.
                if not self._client.pub_goal.get_num_connections():
                    raise ImaginationError('the imagination client went away during the request; '
                                           'see its log, then ask again')
                if handle.get_comm_state() not in _BRIEF_STATES:
                    give_up = time.monotonic() + _PATIENCE
                elif time.monotonic() > give_up:
                    raise ImaginationError('the imagination client did not accept the request, or its answer '
                                           'was lost; see its log, then ask again')
        finally:
            if not done.is_set():
                handle.cancel()
        result = handle.get_result()
        if result is None or handle.get_terminal_state() == GoalStatus.LOST:
            raise ImaginationError('the imagination client was started anew during the request; '
                                   'ask again')
        return result

    def _why_nobody(self):
        if rospy.get_rostime().is_zero():  # servers tell that they are there by ROS time
            return ('/use_sim_time is true at %s, and nobody publishes /clock: start what simulates the '
                    'time, or, where that has ended, rosparam set use_sim_time false' %
                    rosgraph.get_master_uri())
        return ("nobody serves the action '%s'; start it: roslaunch hires imagination.launch" %
                rospy.resolve_name(self._action))

    @staticmethod
    def _answer(result):
        outcome = _OUTCOMES[result.outcome]
        if outcome == 'invalid':
            raise ImaginationError(result.why)
        ranking = tuple(_alternative(prediction) for prediction in result.predictions)
        recommended = ranking[result.recommended] if result.recommended >= 0 else None
        return Answer(outcome=outcome, why=result.why, ranking=ranking, recommended=recommended,
                      caveats=tuple(result.caveats), seed=result.seed,
                      probability_best=result.probability_best if result.by_cost else None,
                      expected_regret=result.expected_regret if result.by_cost else None)
