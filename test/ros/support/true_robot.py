"""Where a simulated robot really is, told by the graph that a rostest's launch file started."""

import threading

import rospy
from hires.msg import RobotState


class TrueRobot:
    """rospy.init_node must have been called."""

    def __init__(self):
        self.state = None
        self._told = threading.Event()
        self._subscriber = rospy.Subscriber('ground_truth/robot_state', RobotState, self._on_state)

    def _on_state(self, state):
        self.state = state
        self._told.set()

    def wait(self, seconds):
        """Whether it has said anything by then."""
        return self._told.wait(seconds)
