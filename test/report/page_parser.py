"""What a browser would make of a page, as far as the tests look at it."""

from html.parser import HTMLParser

VOID = {'meta', 'link', 'img', 'br', 'hr', 'input'}


class Page(HTMLParser):
    """Reads a page.
    - fields: (place in the JSON, machine-readable value or None, text shown) of what it shows
    - cells: (class, text that comes from no field) of each table cell
    - addresses: all that a browser could be told to load
    """

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.fields, self.cells, self.addresses, self.ids, self.tags = [], [], [], [], []
        self._open, self._field, self._cell = [], None, None
        self.feed(text)
        self.close()
        if self._open:
            raise AssertionError('never closed: %s' % self._open)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        attrs = dict(attrs)
        if 'id' in attrs:
            self.ids.append(attrs['id'])
        self.addresses += [attrs[key] for key in ('src', 'href', 'xlink:href', 'action', 'data') if key in attrs]
        if tag not in VOID:
            self._open.append(tag)
        if 'data-at' in attrs:
            self._field = [attrs['data-at'], attrs.get('value'), '', len(self._open)]
        if tag == 'td':
            self._cell = [attrs.get('class', ''), '']

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self._open.pop()

    def handle_endtag(self, tag):
        if not self._open or self._open[-1] != tag:
            raise AssertionError('%s closed in %s' % (tag, self._open))
        if self._field and self._field[3] == len(self._open):
            self.fields.append(tuple(self._field[:3]))
            self._field = None
        if tag == 'td':
            self.cells.append(tuple(self._cell))
            self._cell = None
        self._open.pop()

    def handle_data(self, data):
        if self._field:
            self._field[2] += data
        elif self._cell:
            self._cell[1] += data
