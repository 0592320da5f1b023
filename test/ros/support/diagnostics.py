"""What nodes say of themselves on /diagnostics."""

from ros_processes import wait_until


def wait_for_guard(rospy):
    """Until the base guard would let somebody drive: one that has only just begun may not have heard the
    robot yet."""
    diagnostics(rospy, 'base_guard', lambda v: v['forbids driving'] == 'nothing')


def wait_for_middle_layer(rospy):
    """Until it hears of the robot all that it needs."""
    diagnostics(rospy, 'middle_layer', lambda v: v['message'] == 'ready')


def diagnostics(rospy, name, condition):
    """Values of the node's status, its `message` and `level`, once they are as wanted. What an earlier node
    of this name left behind at the master has to be forgotten there."""
    from diagnostic_msgs.msg import DiagnosticArray
    found = {}

    def is_registered():
        publishers = dict(rospy.get_master().getSystemState()[2][0])
        return '/' + name in publishers.get('/diagnostics', [])

    # rospy takes the last list of publishers it gets for the newest. One that is told of the node while
    # its own registration is still on the way gets the older list later, and never connects.
    wait_until(is_registered, name + ' to be registered for /diagnostics')

    def take(message):
        for status in message.status:
            # The first of a node says that it is starting up, and no more.
            if status.name.startswith(name) and status.values:
                found.update({value.key: value.value for value in status.values})
                found.update(message=status.message, level=status.level)

    subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, take)
    try:
        wait_until(lambda: found and condition(found), lambda: 'diagnostics of %s; connected to %d, heard %s'
                   % (name, subscriber.get_num_connections(), found))
    finally:
        subscriber.unregister()
    return found
