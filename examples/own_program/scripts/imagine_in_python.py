#!/usr/bin/env python3
"""Slow or fast? The same in Python: imagine_in_python.py WORLD"""

import sys

from hires import core

scene = core.Scene(world=sys.argv[1])
answer = scene.imagine('move_base_param', 'atBench', ['slow', 'fast'], robot_at='dock',
                       on_tray=['peppermill1'], rollouts=16, seed=7, threads=2)
print(*answer.ranking, answer.why, sep='\n')
