"""The pages in a real browser (Debian's chromium): nothing to complain of, nothing asked of a network."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'scripts', 'report'))

import report_input  # noqa: E402
import report_pages  # noqa: E402


def page_of(name):
    path = os.path.join(ROOT, 'test', 'data', 'report', name)
    return report_pages.page(report_input.read(path, report_pages.PAGES), path)


class Opened:
    """What the browser said about a page, asked of others for it, and showed (PNG)."""

    def __init__(self, text, *options):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'page.html')
            with open(path, 'w', encoding='utf-8') as file:
                file.write(text)
            done = subprocess.run(
                ['chromium', '--headless', '--no-sandbox', '--disable-gpu', '--no-first-run',
                 '--host-resolver-rules=MAP * ~NOTFOUND', '--user-data-dir=%s/profile' % folder,
                 '--enable-logging=stderr', '--log-net-log=%s/net.json' % folder,
                 '--screenshot=%s/page.png' % folder, *options, 'file://' + path],
                stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
            self.console = re.findall(r'CONSOLE\S*\s(.*)', done.stderr)
            with open(os.path.join(folder, 'net.json'), encoding='utf-8') as file:
                events = json.load(file)['events']
            with open(os.path.join(folder, 'page.png'), 'rb') as file:
                self.picture = file.read()
        # What the browser asks for itself, for updates of its own, has no origin.
        self.requests = {event['params']['url'] for event in events
                         if event.get('params', {}).get('initiator', 'not an origin') != 'not an origin'}


class BrowserTest(unittest.TestCase):
    def test_pages_are_shown_without_a_complaint_or_a_request(self):
        for name in sorted(os.listdir(os.path.join(ROOT, 'test', 'data', 'report'))):
            with self.subTest(name):
                opened = Opened(page_of(name))
                self.assertEqual(opened.console, [])
                self.assertEqual(opened.requests, set())
                self.assertGreater(len(opened.picture), 20000, 'an empty page')

    def test_a_phone_shows_the_whole_width(self):
        """Wide tables move inside of their frames; the page itself is as wide as the screen."""
        measure = ('<script>const page = document.documentElement;'
                   'console.log("beyond the screen: " + (page.scrollWidth - page.clientWidth))</script></body>')
        for name in sorted(os.listdir(os.path.join(ROOT, 'test', 'data', 'report'))):
            text = page_of(name).replace('</body>', measure)
            text = text.replace("default-src 'none'", "default-src 'none'; script-src 'unsafe-inline'")
            with self.subTest(name):
                opened = Opened(text, '--window-size=500,900')
                self.assertEqual(re.findall(r'beyond the screen: (-?\d+)', str(opened.console)), ['0'])

    def test_a_complaint_and_a_request_would_be_seen(self):
        opened = Opened('<!DOCTYPE html><title>x</title><img src="http://127.0.0.1:9/x.png">'
                        '<script>console.error("no")</script>')
        self.assertIn('http://127.0.0.1:9/x.png', opened.requests)
        self.assertIn('"no"', str(opened.console))


if __name__ == '__main__':
    unittest.main()
