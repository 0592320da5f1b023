"""`hires_lab reproduce` of what is played in a minute: each number of the shipped catalogue is found in what this
version answers, each picture is drawn, and what holds by closed forms holds. Usage: reproduce_short_test.py HIRES"""

import json
import os
import subprocess
import sys
import tempfile
import unittest

WANTED = ['4.3.1', 'Table 5.1', '5.5', '6.1', 'Table 6.3', 'A.4', 'A.8', 'A.9']


class ReproduceShortTest(unittest.TestCase):
    program = ''

    def test_each_number_is_found_and_each_picture_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, name) for name in ('results', 'answer.json', 'page.html')]
            run = subprocess.run([self.program, 'reproduce', *WANTED, '--quiet', '--results', paths[0],
                                  '--json', paths[1], '--html', paths[2]], capture_output=True, text=True,
                                 check=False, stdin=subprocess.DEVNULL)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            with open(paths[1], encoding='utf-8') as file:
                items = {item['item']: item for item in json.load(file)['items']}
            with open(paths[2], encoding='utf-8') as file:
                page = file.read()
        self.assertGreater(len(items), 20)
        for name, item in items.items():
            with self.subTest(name):
                self.assertNotEqual(item['verdict'], 'not played', item['reason'])
                for value in item['values']:
                    self.assertIsNotNone(value['found'], value['name'])
        for name in ('Section 4.3.1', 'Table 5.1', 'Fig. 5.11', 'List. A.2'):
            self.assertEqual(items[name]['verdict'], 'check holds', items[name]['reason'])
        self.assertNotIn('Not drawn, for the answer', page)


if __name__ == '__main__':
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    ReproduceShortTest.program = sys.argv.pop()
    unittest.main()
