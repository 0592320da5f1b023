"""What nodes say of themselves on /diagnostics."""

from ros_processes import wait_until


def diagnostics(rospy, name, condition):
    """Values of the node's status, and its `message`, once they are as wanted."""
    from diagnostic_msgs.msg import DiagnosticArray
    found = {}

    def take(message):
        for status in message.status:
            # The first of a node says that it is starting up, and no more.
            if status.name.startswith(name) and status.values:
                found.update({value.key: value.value for value in status.values})
                found['message'] = status.message

    subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, take)
    try:
        wait_until(lambda: found and condition(found), 'diagnostics of ' + name)
    finally:
        subscriber.unregister()
    return found
