"""What `hires VERB --json FILE` wrote: read, checked, and asked by the places of its fields."""

import json
import math
import os
import sys

FORMAT = 1  # the newest that is understood; as kReportFormat of report_output.h


class ReportError(Exception):
    """Somebody has to do something; the text says what."""


def _no_constant(word):
    raise ValueError('%s is no number of JSON' % word)


class Answer:
    """An answer whose fields are named by JSON pointers (RFC 6901): '/ranking/0/success/lower'."""

    def __init__(self, content, name):
        self._content = content
        self.name = name

    def has(self, pointer):
        """Whether the field is there and not null."""
        return self._find(pointer) is not None

    def at(self, pointer, kind):
        """A field of that type, `kind` being one of str, bool, int, float, list, dict, or None for any.
        @raise ReportError if it is missing or another."""
        value = self._find(pointer)
        if kind is None and value is not None:
            return value
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        fits = is_number and math.isfinite(value) if kind is float else (
            isinstance(value, kind) and isinstance(value, bool) == (kind is bool))
        if fits:
            return value
        words = {str: 'text', bool: 'true or false', int: 'a whole number', float: 'a number',
                 list: 'a list', dict: 'an object'}
        shown = 'nothing' if value is None else json.dumps(value)[:60]
        raise ReportError('%s: field %s: came %s, wanted %s; give a file as `hires VERB --json FILE` '
                          'writes it' % (self.name, pointer, shown, words[kind]))

    def items(self, pointer):
        """The places of a list's entries."""
        return ['%s/%d' % (pointer, i) for i in range(len(self.at(pointer, list)))]

    def keys(self, pointer):
        """The places of an object's fields."""
        return ['%s/%s' % (pointer, key.replace('~', '~0').replace('/', '~1'))
                for key in self.at(pointer, dict)]

    def _find(self, pointer):
        value = self._content
        for word in pointer.split('/')[1:]:
            word = word.replace('~1', '/').replace('~0', '~')
            if isinstance(value, dict):
                value = value.get(word)
            elif isinstance(value, list) and word.isdigit() and int(word) < len(value):
                value = value[int(word)]
            else:
                return None
        return value


def read(path, verbs):
    """The answer in a file, in standard input for '-'.
    @raise ReportError if it is none, newer than this program, or of none of these verbs, which alone have pages."""
    name = 'standard input' if path == '-' else path
    try:
        if path == '-':
            text = sys.stdin.buffer.read().decode('utf-8')
        else:
            with open(path, encoding='utf-8') as file:
                text = file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise ReportError('%s: cannot be read: %s; name a file that `hires VERB --json FILE` wrote' %
                          (name, getattr(error, 'strerror', None) or error)) from error
    try:
        content = json.loads(text, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ReportError('%s: is no JSON: %s; was it written to its end?' % (name, error)) from error
    answer = Answer(content, name)
    if not answer.has('/report'):
        raise ReportError('%s: has no field /report%s; pages are made of what %s write with --json' %
                          (name, _what_else(answer), _joined(verbs)))
    number = answer.at('/report/format', int)
    if not 1 <= number <= FORMAT:
        raise ReportError('%s: field /report/format is %d, this program reads 1 to %d; take the '
                          'HIRES that wrote it (version %s)' %
                          (name, number, FORMAT, answer.at('/report/version', str)))
    verb = answer.at('/report/verb', str)
    if verb not in verbs:
        raise ReportError('%s: field /report/verb: there is no page of %r; there are those of %s' %
                          (name, verb, _joined(verbs)))
    return answer


def _joined(verbs):
    return ', '.join(sorted(verbs))


def _what_else(answer):
    """What a file may be that no page is made of."""
    schema = answer.at('/schema', None) if answer.has('/schema') else None
    if isinstance(schema, str):
        return ': it is %s, numbers for machines that have no page' % schema
    return ', so it is no answer of `hires` that has a page, or one of a version before 0.2'


def folder_of(path):
    """From where relative paths in the file count."""
    return os.getcwd() if path == '-' else os.path.dirname(os.path.abspath(path))
