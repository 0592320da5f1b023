#!/usr/bin/env python3
"""The whole system tells a hot mug from another by thermal pictures alone. Run alone, or by
`rostest hires loop_hot_mug.test`."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import CONFIG, HEAT_READER, RESTAURANT  # noqa: E402
from loop_case import AT_COUNTER, MUG, LoopCase  # noqa: E402
from test_run import run_test  # noqa: E402


class LoopHotMugTest(LoopCase):
    SETTINGS = dict(sensing='pictures')

    def test_of_two_mugs_the_one_that_is_seen_to_be_hot_gets_to_the_guest(self):
        self.begin(AT_COUNTER, {**MUG, 'mug2': (5.37, 9.94, 0.75, 0.0)}, temperatures={'mug1': 335.65},
                   knowledge=(RESTAURANT, os.path.join(CONFIG, 'knowledge', 'two_coffees.yaml')))
        self.require(self.achieve('serve_hot_coffee_to_guest guest1'), self.codes.SUCCEEDED)
        self.assertEqual(self.loop.main.publishers('/object_temperatures'), ['/' + HEAT_READER])
        self.wait_until_it_stands()
        self.assert_on_table1('mug1')


if __name__ == '__main__':
    run_test('loop_hot_mug', LoopHotMugTest)
