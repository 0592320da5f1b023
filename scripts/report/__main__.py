"""Makes a page from what `hires VERB --json FILE` wrote. It needs no network and no script to be read.

  hires report FILE.json --html PAGE.html   every verb that has --html
  hires report FILE.json --png FILE.png     of `achieve`: what was done when, as a picture

FILE.json may be - for standard input. --check alone: whether all that is needed is installed.
Exit codes: 0 written, 1 the JSON is broken, foreign or too new, 2 bad arguments, 3 a package is
missing, 4 a file cannot be written.
"""

import argparse
import importlib.util
import os
import sys

NEEDED = {'jinja2': 'python3-jinja2', 'matplotlib': 'python3-matplotlib', 'scipy': 'python3-scipy'}


def end(code, text):
    print(text, file=sys.stderr)
    sys.exit(code)


def require_packages():
    missing = [package for module, package in NEEDED.items() if importlib.util.find_spec(module) is None]
    if missing:
        end(3, 'a page needs %s, which %s not installed; install with `apt-get install %s`, or leave '
               'out --html and --png' % (' and '.join(missing), 'are' if len(missing) > 1 else 'is',
                                         ' '.join(missing)))


def write(path, data):
    """All or nothing; a device is written straight."""
    part = path if os.path.exists(path) and not os.path.isfile(path) else path + '.part'
    try:
        with open(part, 'wb') as file:
            file.write(data)
        if part != path:
            os.replace(part, path)
    except OSError as error:
        if part != path and os.path.isfile(part):
            os.remove(part)
        end(4, '%s: cannot be written: %s; check folder, rights and space' % (path, error.strerror))


def make(options):
    # Here, as they take most of a second, and may be missing.
    import report_drawings
    import report_input
    import report_pages
    try:
        answer = report_input.read(options.file, report_pages.PAGES)
        if options.png and answer.at('/report/verb', str) != 'achieve':
            raise report_input.ReportError('--png: %s is no answer of `hires achieve`, which alone has a '
                                           'timeline; use --html' % answer.name)
        page = report_pages.page(answer, options.file) if options.html else None
        picture = report_drawings.timeline_png(
            report_pages.bars_of(answer), answer.at('/duration', float)) if options.png else None
    except report_input.ReportError as error:
        end(1, str(error))
    if page is not None:
        write(options.html, page.encode('utf-8'))
    if picture is not None:
        write(options.png, picture)


def main():
    parser = argparse.ArgumentParser(prog='hires report', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('file', nargs='?')
    parser.add_argument('--html', default='')
    parser.add_argument('--png', default='')
    parser.add_argument('--check', action='store_true')
    options = parser.parse_args()
    if not options.check and not (options.file and (options.html or options.png)):
        parser.error('wanted FILE.json with --html or --png')
    require_packages()
    if not options.check:
        make(options)


if __name__ == '__main__':
    main()
