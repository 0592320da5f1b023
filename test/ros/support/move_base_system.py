"""What tests of a robot's own move_base share: the limits of its local planner, and processes."""

import math
import os
import re
import sys

from ros_processes import executable, wait_until

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.path.join(HERE, '..', '..', '..'))
PLANNER = '/move_base_node/DWAPlannerROS'
NOETIC = ('max_vel_x', 'max_vel_trans', 'max_vel_theta', 'acc_lim_x', 'acc_lim_y', 'acc_lim_theta')
OLD = ('max_vel_x', 'max_trans_vel', 'max_rot_vel', 'acc_lim_x', 'acc_lim_y', 'acc_lim_th')
FAST = (0.55, 0.55, 1.0, 2.5, 2.5, 3.2)  # what a PR2's planner is configured to; Table 5.1
SLOW = (0.30, 0.30, 1.0, 1.4, 1.4, 2.0)  # Table 5.1
# What a guard forgives here: these tests are about move_base, and their machine may be slow.
PATIENT = {'pose_patience': 10.0, 'scan_patience': 10.0, 'request_patience': 5.0,
           'update_patience': 10.0, 'command_patience': 10.0}


def config_text(name, **values):
    """A file of config/ with other values for some keys of its top level."""
    with open(os.path.join(ROOT, 'config', name)) as file:
        text = file.read()
    for key, value in values.items():
        text, count = re.subn(r'^%s: [0-9.]+' % key, '%s: %g' % (key, value), text, flags=re.M)
        assert count == 1, key
    return text


class MoveBaseSystem:
    """@param processes  of the test.  @param main  its master.  @param rospy  after init_node."""

    def __init__(self, processes, main, rospy):
        self.processes, self.main, self.rospy = processes, main, rospy
        self.guard_config = processes.write('base_guard.yaml',
                                            config_text('base_guard.yaml', **PATIENT))
        self.guard = None

    def start_move_base(self, *remaps, is_new=True, **parameters):
        """@param is_new  False: with the parameters that its predecessor left, as after a crash."""
        if is_new and self.rospy.has_param('/move_base_node'):
            self.rospy.delete_param('/move_base_node')
        for name, value in parameters.items():
            self.rospy.set_param('/move_base_node/' + name, value)
        process = self.processes.start(
            [sys.executable, os.path.join(HERE, 'scripted_move_base.py'), *remaps], self.main)
        wait_until(lambda: PLANNER + '/set_parameters' in self.main.services() and
                   '/move_base_node' in self.main.publishers('/move_base/status'), 'move_base')
        return process

    def start_guard(self, journal, config=None):
        self.guard = self.processes.start(
            [executable('base_guard'), '_navigation:=move_base',
             '_config:=' + (config or self.guard_config), '_journal:=' + journal], self.main)
        return self.guard

    def values(self, names=NOETIC):
        """What the planner has; None where there is none."""
        from dynamic_reconfigure.srv import Reconfigure
        try:
            answer = self.rospy.ServiceProxy(PLANNER + '/set_parameters', Reconfigure)()
        except self.rospy.ServiceException:
            return None
        have = {p.name: p.value for p in answer.config.doubles}
        return tuple(have[name] for name in names)

    def await_values(self, values, names=NOETIC):
        def are_there():
            now = self.values(names)
            return now is not None and all(math.isclose(a, b) for a, b in zip(now, values))
        try:
            wait_until(are_there, '')
        except AssertionError:
            raise AssertionError('the planner has %s instead of %s; the guard: %s' % (
                self.values(names), values, self.guard and self.guard.output()))
