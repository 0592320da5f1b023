"""Ask HIRES from Python; messages, services and actions are in hires.msg and hires.srv.

    import rospy
    from hires import Imagination

    rospy.init_node('my_robot')
    answer = Imagination().ask('move_base_param', 'atBench', ['slow', 'fast'], robot_at='dock',
                               on_tray=['mug1'])
    print(answer.recommended or answer.why)
"""

from hires.imagination import Alternative, Answer, Imagination, ImaginationError

__all__ = ['Alternative', 'Answer', 'Imagination', 'ImaginationError']
