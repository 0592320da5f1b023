"""Numbers and texts of a page. Each says from which field of the JSON it comes (`data-at`), so that it
can be held against that."""

import json

from markupsafe import Markup, escape

# How a number is shown: its factor, and the form.
FORMS = {
    'percent': (100.0, '%.1f %%'),
    'share': (1.0, '%.3f'),
    'signed': (1.0, '%+.3f'),
    'seconds': (1.0, '%.1f s'),
    'milliseconds': (1000.0, '%.2f ms'),
    'rad': (1.0, '%.4f rad'),
    'whole': (1.0, '%d'),
    'factor': (1.0, '%.0f'),
    'measure': (1.0, '%.5g'),
    'small': (1.0, '%.2g'),
}


class Numbers:
    """What templates put fields on the page with."""

    def __init__(self, answer):
        self.answer = answer

    def number(self, pointer, form, nothing=None):
        """A number of the JSON.  @param nothing  shown where the field is null; else that is an error."""
        if nothing is not None and not self.answer.has(pointer):
            return Markup('<span class="nothing">%s</span>') % nothing
        value = self.answer.at(pointer, int if form == 'whole' else float)
        factor, shape = FORMS[form]
        return Markup('<data value="%s" data-at="%s">%s</data>') % (
            json.dumps(value), pointer, shape % (factor * value))

    def text(self, pointer):
        """A text of the JSON."""
        return Markup('<span data-at="%s">%s</span>') % (pointer, self.answer.at(pointer, str))

    def word(self, pointer):
        """The same, bare."""
        return self.answer.at(pointer, str)

    def holds(self, pointer):
        """Whether a field is true."""
        return self.answer.at(pointer, bool)

    def texts(self, pointer, between=', '):
        """A list of texts."""
        return Markup(escape(between)).join(self.text(item) for item in self.answer.items(pointer))

    def action(self, pointer):
        """An action with its arguments, as `move_base_param(atbench, slow)`."""
        return (self.text(pointer + '/action') + Markup('(') +
                self.texts(pointer + '/arguments') + Markup(')'))

    def failure(self, pointer):
        """What went wrong, and with what: `area_occupied: bowl1, book1`."""
        shown = self.text(pointer + '/failure')
        if self.answer.at(pointer + '/subjects', list):
            shown += Markup(': ') + self.texts(pointer + '/subjects')
        return shown

    def bar(self, pointer, most):
        """A bar as long as the number is of `most`."""
        share = self.answer.at(pointer, float) / most if most > 0 else 0.0
        return Markup('<span class="bar" style="width:%.1f%%"></span>') % (100.0 * min(share, 1.0))


def action_name(answer, pointer):
    """As Numbers.action, for pictures."""
    arguments = [answer.at(item, str) for item in answer.items(pointer + '/arguments')]
    return '%s(%s)' % (answer.at(pointer + '/action', str), ', '.join(arguments))


def values(answer, pointer):
    """A list of numbers; none where there is no such field."""
    return [answer.at(item, float) for item in answer.items(pointer)] if answer.has(pointer) else []


def bars_of(answer):
    """What was done when, for drawings.timeline."""
    kinds = {'kind': str, 'plan': int, 'index': int, 'action': str, 'outcome': str, 'begin': float,
             'end': float}
    bars = []
    for place in answer.items('/timeline'):
        bar = {field: answer.at('%s/%s' % (place, field), kind) for field, kind in kinds.items()}
        dispatch = place + '/dispatch'
        bar['dispatch'] = answer.at(dispatch, float) if answer.has(dispatch) else None
        bars.append(bar)
    return bars
