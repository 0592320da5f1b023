"""Failures in messages, as `hires` prints them."""

from hires.msg import Failure

#: {code: word}
WORDS = {getattr(Failure, name): name.lower() for name in dir(Failure)
         if name.isupper() and isinstance(getattr(Failure, name), int)}


def text_of(failure):
    """'area_occupied: book1, book2'; '' for no failure."""
    if failure.code == Failure.NONE:
        return ''
    more = failure.detail or ', '.join(failure.subjects)
    word = WORDS.get(failure.code, 'failure_%d' % failure.code)  # of a newer version
    return word + (': ' + more if more else '')
