"""Who hears a publisher of rospy.

    wait_until(lambda: '/middle_layer' in listeners(publisher), 'the middle layer to listen')
"""

import socket


def listeners(publisher):
    """Names of the nodes that are connected to it and hear what it says from now on. rospy itself still
    counts, for a while, those that were killed: what is told to them alone is lost."""
    return {connection.endpoint_id for connection in list(publisher.impl.connections) if _is_open(connection)}


def _is_open(connection):
    try:
        return bool(connection.socket.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT))
    except BlockingIOError:
        return True  # nothing to read, as it should be
    except (OSError, AttributeError):
        return False  # closed meanwhile
