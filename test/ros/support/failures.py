"""Failures in messages, as people read them."""

from hires.failures import WORDS, text_of  # noqa: F401
from hires.msg import Failure


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
