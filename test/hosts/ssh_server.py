#!/usr/bin/env python3
"""The part of an SSH server that roslaunch needs to start nodes on another host: one key is let in,
commands run as this user with the environment that sshd would give. For tests only.

    ssh_server.py ADDRESS PORT HOST_KEY_FILE AUTHORISED_KEY_FILE
"""

import os
import pwd
import socket
import subprocess
import sys
import threading

import paramiko


class Session(paramiko.ServerInterface):
    def __init__(self, key, connection):
        self._key = key
        self._connection = connection

    def check_channel_request(self, kind, chanid):
        return (paramiko.OPEN_SUCCEEDED if kind == 'session' else
                paramiko.OPEN_FAILED_ADMINISTRATIVELY_PROHIBITED)

    def get_allowed_auths(self, username):
        return 'publickey'

    def check_auth_publickey(self, username, key):
        return paramiko.AUTH_SUCCESSFUL if key == self._key else paramiko.AUTH_FAILED

    def check_channel_exec_request(self, channel, command):
        threading.Thread(target=self._run, args=(channel, command), daemon=True).start()
        return True

    def _run(self, channel, command):
        client, server = self._connection.getpeername(), self._connection.getsockname()
        home = os.environ['HOME']
        environment = {'PATH': '/usr/bin:/bin', 'HOME': home,
                       'USER': pwd.getpwuid(os.getuid()).pw_name,
                       'SSH_CONNECTION': '%s %d %s %d' % (client[:2] + server[:2])}
        process = subprocess.Popen(['/bin/sh', '-c', command], env=environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, cwd=home)
        pumps = [threading.Thread(target=_pump, args=pair, daemon=True) for pair in (
            (process.stdout, channel.sendall), (process.stderr, channel.sendall_stderr))]
        for pump in pumps:
            pump.start()
        code = process.wait()
        print('ended with %d: %s' % (code, command.decode()), flush=True)
        for pump in pumps:
            pump.join()
        try:
            channel.send_exit_status(code)
            channel.close()
        except (OSError, EOFError):
            pass  # the other side has hung up


def _pump(stream, send):
    for line in stream:
        print('| ' + line.decode(errors='replace').rstrip(), flush=True)
        try:
            send(line)
        except (OSError, EOFError):
            pass  # the other side has hung up; what runs here must not block


def main():
    address, port, host_key, authorised = sys.argv[1:]
    key = paramiko.RSAKey(filename=authorised)
    with socket.socket() as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((address, int(port)))
        listener.listen(5)
        print('listening', flush=True)
        while True:
            connection, _ = listener.accept()
            transport = paramiko.Transport(connection)
            transport.add_server_key(paramiko.RSAKey(filename=host_key))
            transport.start_server(server=Session(key, connection), event=threading.Event())


if __name__ == '__main__':
    main()
