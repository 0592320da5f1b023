"""Ask HIRES from Python; messages, services and actions are in hires.msg and hires.srv.

Running nodes, by the action `imagine`:

    from hires import Imagination, init_node

    init_node('my_robot')  # rospy's own would wait without end for a master that is not there
    answer = Imagination().ask('move_base_param', 'atBench', ['slow', 'fast'], robot_at='dock',
                               on_tray=['mug1'])
    print(answer.recommended or answer.why)

In this process, without ROS: hires.core.
"""

import importlib

__all__ = ['Alternative', 'Answer', 'Imagination', 'ImaginationError', 'SavedRollout',
           'init_node']


def __getattr__(name):
    """What needs ROS is imported when it is asked for: hires.core does without."""
    if name in __all__:
        return getattr(importlib.import_module('hires.imagination'), name)
    raise AttributeError("module 'hires' has no attribute %r" % name)
