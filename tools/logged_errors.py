"""Errors in the output and the logs of a rostest: none but those that it expects.

Looked at are the rostest's own output, and the logs of all nodes of its ROS_LOG_DIR: of those that
it launches, and of those that its tests start. test/rostest/expected_errors.yaml has, for each
.test file, patterns (re.search) of the errors that it provokes, each with the reason.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import dropwhile
from pathlib import Path

import yaml
from results import ROOT

EXPECTED = ROOT / 'test' / 'rostest' / 'expected_errors.yaml'
COLOURS = re.compile(r'\x1b\[[0-9;]*m')
# A record of a log file, with its logger, or of a terminal.
RECORD = re.compile(
    r'(?:\[(?P<logger>[\w.]+)\])?'
    r'\[ ?(?P<level>DEBUG|INFO|WARN|WARNING|ERROR|FATAL)\]'
    r'(?: \[[\d., ]+\]:| [-\d]+ [\d:,]+:)? ?(?P<message>.*)'
)
# Client library's and master's own accounts of connections: nodes that end are still called.
CONNECTIONS = re.compile(r'(rospy|rosmaster|xmlrpc)\b')
TRACEBACK = 'Traceback (most recent call last):'


def records(lines: Iterable[str]) -> Iterator[list[str]]:
    """Yield the lines of each record of a log, what a program prints itself among them."""
    record: list[str] = []
    for line in lines:
        text = COLOURS.sub('', line).rstrip()
        if record and RECORD.match(text):
            yield record
            record = []
        record.append(text)
    yield record


def errors(lines: Iterable[str]) -> Iterator[str]:
    """Yield the message of each record of an error, and the last line of each traceback."""
    for record in records(lines):
        head = RECORD.match(record[0]) if record else None
        if head and CONNECTIONS.match(head['logger'] or ''):
            continue
        if head and head['level'] in ('ERROR', 'FATAL') and TRACEBACK not in head['message']:
            yield head['message']
        for start, line in enumerate(record):
            if TRACEBACK in line:
                rest = dropwhile(lambda text: not text or text[0] in ' |', record[start + 1 :])
                yield f'traceback: {next(rest, "without an end")}'


def read_expected(test: str) -> dict[str, str]:
    """Return the patterns that a .test file expects, or any may have, with their reasons."""
    lists: dict[str, dict[str, str]] = yaml.safe_load(EXPECTED.read_text())
    return lists['any'] | lists.get(test, {})


def unexpected(logs: Iterable[Path], expected: Mapping[str, str]) -> list[str]:
    """Return what these logs have and no pattern expects, and the patterns without an error.

    Args:
        expected: reasons by pattern; where one begins with "perhaps", timing decides.
    """
    missing = {pattern for pattern, why in expected.items() if not why.startswith('perhaps')}
    found: dict[str, str] = {}
    for log in logs:
        with log.open(errors='replace') as lines:
            for error in errors(lines):
                matching = {pattern for pattern in expected if re.search(pattern, error)}
                missing -= matching
                if not matching:
                    found.setdefault(error, log.name)
    return [
        *(f'not expected, in {name}: {error}' for error, name in found.items()),
        *(f'expected, but not logged: {pattern}' for pattern in sorted(missing)),
    ]
