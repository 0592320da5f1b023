#!/usr/bin/env python3
"""Middle layer, imagination client or worker is killed while the robot drives as it was imagined, with the mill on
its tray. Prints for each kill which motion sets were driven, what was known of them, and whether the mill dropped.
Run alone, or by `rostest hires loop_repaired_drive.test`. HIRES_KILL_MOMENTS: kills of each process; default: 1."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import RESTAURANT  # noqa: E402
from loop_case import LoopCase  # noqa: E402
from test_run import run_test  # noqa: E402

MOMENTS = int(os.environ.get('HIRES_KILL_MOMENTS', '1'))
TASK = 'unload_tray peppermill1 table1'
# Before the counter, the mill on the middle of the tray: the task begins with the drive.
LOADED = {'pose': [6.8, 10.1, 3.14], 'torso': 'torsoupposture',
          'arms': {'leftarm1': 'armtuckedposture', 'rightarm1': 'armtuckedposture'}}
ON_TRAY = {'peppermill1': (6.52, 10.1, 0.3464, 0.0)}
MILL_ON_TRAY = os.path.abspath(os.path.join(
    os.path.dirname(__file__), '..', 'data', 'loop', 'mill_on_tray.yaml'))
DRIVE = 20.0  # [s] simulated, less than the drive takes


class RepairedDriveTest(LoopCase):
    SETTINGS = dict(pace=4.0)

    def restart(self, victim):
        if victim == 'worker':
            self.loop.kill_workers()
            self.loop.start_worker(1)
        else:
            self.loop.kill(victim)
            self.loop.start_node(victim)

    def drives_with_kill(self, victim, moment):
        """Drives with the load, motion sets that imagination recommended, and falls, where that process is killed
        so long [s] after the drive began."""
        self.begin(LOADED, ON_TRAY, knowledge=(RESTAURANT, MILL_ON_TRAY))
        self.loop.wait_for_worker(1)
        task = self.achieve(TASK)
        self.wait_for_step(task, 'move_base_param')
        begun = self.truth.now()
        self.truth.wait(lambda t: t.now() > begun + moment, 'the moment')
        self.restart(victim)
        result = task.result()  # a middle layer that is slow to come back ends the task
        drives = self.steps_of(result, 'move_base_param')
        for drive in drives:
            print('%s killed after %.1f s: %s, %s; falls: %s' % (
                victim, moment, drive.action.arguments[-1], drive.note, self.truth.falls()), flush=True)
        recommended = {i.predictions[i.recommended].action.arguments[-1]
                       for i in result.imaginations if i.recommended >= 0}
        return drives, recommended, self.truth.falls()

    def test_a_drive_is_as_imagined_whichever_process_is_killed_meanwhile(self):
        for victim, num_drives in (('middle_layer', 2), ('imagination_client', 1), ('worker', 1)):
            for i in range(MOMENTS):
                moment = DRIVE * (i + 1) / (MOMENTS + 1)
                with self.subTest(victim=victim, moment=moment):
                    drives, recommended, falls = self.drives_with_kill(victim, moment)
                    self.assertGreaterEqual(len(drives), num_drives)
                    for drive in drives:
                        self.assertIn(drive.action.arguments[-1], recommended)
                        if drive.phase == self.phases.DONE:  # else the note is the failure
                            self.assertTrue(drive.note.startswith('imagined'), drive.note)
                    self.assertEqual(falls, {})


if __name__ == '__main__':
    run_test('loop_repaired_drive', RepairedDriveTest)
