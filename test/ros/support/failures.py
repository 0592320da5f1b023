"""Failures in messages, as people read them."""

from hires.msg import Failure

WORDS = {getattr(Failure, name): name.lower() for name in dir(Failure)
         if name.isupper() and isinstance(getattr(Failure, name), int)}


def text_of(failure):
    """'area_occupied: book1, book2'; '' for no failure."""
    if failure.code == Failure.NONE:
        return ''
    more = failure.detail or ', '.join(failure.subjects)
    return WORDS[failure.code] + (': ' + more if more else '')


def failure(text):
    """The message of such words."""
    if not text:
        return Failure()
    word, _, more = text.partition(': ')
    code = {word: code for code, word in WORDS.items()}[word]
    names = more.split(' touches ') if ' touches ' in more else more.split(', ') if more else []
    if any(' ' in name for name in names):
        return Failure(code=code, detail=more)
    return Failure(code=code, subjects=names, detail=more if ' touches ' in more else '')
