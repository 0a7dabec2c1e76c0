"""Broken laws out of a sound one, of which one member is another; and one check of a law."""

from functools import wraps
from types import FunctionType

from contactlab.testing import checks_for, outcome


def checked(law, name, **options):
    """Return the outcome of one check of a law."""
    check = next(check for check in checks_for(law) if check.name == name)
    return outcome(law, check, **options)


def broken(base, member, *rows):
    """Return laws, each with the check meant for it, and words of what the check says of it.

    A row has the law's name, its member (a method without the law), check and words; more checks
    and words may follow.
    """
    return _rows(base, member, rows, _method)


def altered(base, member, *rows):
    """Return laws as ``broken``, whose method is a function of what the sound one answers.

    The function takes the answer (if that is a tuple, its parts), and then the arguments.
    """
    return _rows(base, member, rows, lambda change: _after(getattr(base, member), change))


def _rows(base, member, rows, made):
    found = []
    for name, value, *told in rows:
        law = type(name, (base,), {member: made(value)})
        found += [(law, check, words) for check, words in zip(told[::2], told[1::2], strict=True)]
    return found


def _method(value):
    """Return a function as a method that does not take the law; anything else as it is."""
    if not isinstance(value, FunctionType):
        return value
    return lambda _, *given: value(*given)


def _after(sound, change):
    """Return a method that changes what a sound one answers."""

    @wraps(sound)
    def method(law, *given, **named):
        answer = sound(law, *given, **named)
        return change(*(answer if type(answer) is tuple else (answer,)), *given)

    return method
