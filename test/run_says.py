"""Runs a command; it must succeed and say something of this pattern. Of its exit code ctest's own
PASS_REGULAR_EXPRESSION would know nothing.
Usage: run_says.py PATTERN COMMAND..."""

import re
import subprocess
import sys

pattern, command = sys.argv[1], sys.argv[2:]
done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                      stdin=subprocess.DEVNULL)
sys.stdout.write(done.stdout)
if done.returncode != 0:
    sys.exit('it ended with %d' % done.returncode)
if not re.search(pattern, done.stdout, re.DOTALL):
    sys.exit("it said nothing like '%s'" % pattern)
