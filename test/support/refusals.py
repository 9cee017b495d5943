"""How calls are refused."""

import pytest


def sentence_of(kind, call, *arguments, **options):
    """Return the message, of one line, of the error of a kind that a call raises."""
    with pytest.raises(kind) as caught:
        call(*arguments, **options)
    sentence = str(caught.value)
    assert '\n' not in sentence
    return sentence


def exit_code(call, *arguments, **options):
    """Return what a call ends the program with."""
    with pytest.raises(SystemExit) as end:
        call(*arguments, **options)
    return end.value.code
