"""A goal of an action on its way, for tests.

    goal = ActionGoal(actionlib.ActionClient('plan', msg.PlanAction), msg.PlanGoal(task='...'))
    result = goal.result()

rospy's SimpleActionClient takes no notice of what comes before its `send_goal` has returned: an answer
that is quick enough is never seen.
"""

import threading
import xmlrpc.client

from listeners import listeners
from ros_processes import LIMIT, bounded_proxy, wait_until


def require_server(client, output):
    """Waits until the server that runs now hears this client and is heard by it.
    @param output  called for what to say if there is none."""
    try:
        wait_until(lambda: _is_served(client), 'the server of %s' % client.ns)
    except AssertionError as error:
        raise AssertionError('%s, which says: %s' % (error, output())) from error


def _is_served(client):
    import rosgraph
    import rospy
    heard = {sub.resolved_name for sub in (client.status_sub, client.result_sub, client.feedback_sub)}
    master = rosgraph.Master(rospy.get_name())
    try:
        servers = dict(master.getSystemState()[0]).get(client.result_sub.resolved_name, [])
        connections = [connection for server in servers for connection in
                       _bus_info(master.lookupNode(server))]
    except (OSError, xmlrpc.client.Error, xmlrpc.client.http.client.HTTPException, rosgraph.MasterError):
        return False  # one that is gone, whose port may be somebody else's
    reached = {c[4] for c in connections if c[2] == 'o' and c[1] == rospy.get_name()}
    return heard <= reached and all(listeners(pub).intersection(servers)
                                    for pub in (client.pub_goal, client.pub_cancel))


def _bus_info(uri):
    with bounded_proxy(uri) as node:
        return node.getBusInfo('/test')[2]


class ActionGoal:
    """@param limit  [s] by the wall's clock: it ends a broken test, and measures nothing.
    @param told  what more to say if something is waited for in vain.
    @param on_feedback  called with each feedback, on rospy's thread."""

    def __init__(self, client, goal, limit=LIMIT, told=None, on_feedback=None):
        from actionlib import CommState
        self._states = CommState
        self._changed = threading.Condition()
        self._state = None
        self._limit = limit
        self._told = told or (lambda: 'last feedback: %s' % self.feedback[-1:])
        self._listener = on_feedback
        self.feedback = []
        self._handle = client.send_goal(goal, self._on_transition, self._on_feedback)

    def _on_transition(self, handle):
        with self._changed:
            self._state = handle.get_comm_state()
            self._changed.notify_all()

    def _on_feedback(self, _, feedback):
        if self._listener:
            self._listener(feedback)
        with self._changed:
            self.feedback.append(feedback)
            self._changed.notify_all()

    def _wait(self, condition, what):
        with self._changed:
            if not self._changed.wait_for(condition, self._limit):
                raise AssertionError('waited in vain for %s\n%s' % (what, self._told()))

    def is_done(self):
        return self._state == self._states.DONE

    def wait_for_active(self):
        self._wait(lambda: self._state in (self._states.ACTIVE, self._states.DONE),
                   'the goal to be accepted')
        return self

    def sees(self, condition, what):
        """Waits for feedback like this, of the past included; false when the goal ends first."""
        looked = [0]

        def is_there():
            while looked[0] < len(self.feedback):
                looked[0] += 1
                if condition(self.feedback[looked[0] - 1]):
                    return True
            return self.is_done()
        self._wait(is_there, what)
        return looked[0] > 0 and condition(self.feedback[looked[0] - 1])

    def wait_for_feedback(self, condition, what):
        """Likewise; a goal that ends first is an error."""
        if not self.sees(condition, what):
            raise AssertionError('no %s until the end\n%s' % (what, self._told()))
        return self

    def cancel(self):
        """A client that cancels before it knows that its goal is accepted may take it for lost."""
        self.wait_for_active()
        self._handle.cancel()
        return self

    def wait_until_cancelling(self):
        """Until the server has taken the cancel."""
        self._wait(lambda: self._state in (self._states.PREEMPTING, self._states.WAITING_FOR_RESULT,
                                           self._states.DONE), 'the cancel to be taken')
        return self

    def abandon(self):
        """Asks for its end, if the test failed before it had the result."""
        if not self.is_done():
            self._handle.cancel()

    def give_up(self):
        """Likewise, and leaves nothing under way."""
        if not self.is_done():
            self._handle.cancel()
            self.result()

    def result(self):
        """As long as there is feedback a goal is on its way, however slow the computer is."""
        while not self.is_done():
            seen = len(self.feedback)
            self._wait(lambda seen=seen: self.is_done() or len(self.feedback) > seen, 'the result')
        return self._handle.get_result()

    def state(self):
        """As of actionlib_msgs/GoalStatus."""
        self.result()
        return self._handle.get_terminal_state()

    def status_text(self):
        self.result()
        return self._handle.get_goal_status_text()


class Task(ActionGoal):
    """A goal of `achieve`."""

    def warnings(self):
        """All so far."""
        if self.is_done():
            return self._handle.get_result().warnings
        return self.feedback[-1].warnings if self.feedback else []
