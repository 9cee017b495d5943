"""Parser of the lessons in doc/lessons: what a reader saves, types and sees, in its order.

The end of the paragraph before a fenced block says what the block is:

- "Save this as `FILE`:" a file (xml, python or yaml);
- "Add this to `FILE`, above its last line:" lines for a file that was saved before;
- "... in a terminal of its own:" before bash: a program that goes on until the lesson ends;
- "... fails:" before bash: commands of which the last one ends with an error;
- anything else before bash: commands, each of which succeeds.

A block of text right after one of bash is what that prints. After "... in the first terminal:" or
"... in the last terminal:" it is what the first or the last one of the programs that go on has
printed, once the keys are pressed there that the paragraph names: "Press `q` and `i`; this ...".
Each of its lines is one of the output, and "…" stands for anything.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from . import ROOT

LESSONS = sorted((ROOT / 'doc' / 'lessons').glob('*.md'))
FENCE = re.compile(r'^(?P<fence>`{3,}|~{3,})(?P<language>.*)$')
SAVED = re.compile(r'Save this as `([\w./]+)`:$')
ADDED = re.compile(r'Add this to `([\w./]+)`, above its last line:$')
GOES_ON = re.compile(r'\bin a terminal of its own:$', re.I)
IN_TERMINAL = re.compile(r'\bin the (first|last) terminal:$', re.I)
PRESSED = re.compile(r'\bPress (`.`(?:(?:, | and )`.`)*)[ ;]')
FAILS = re.compile(r'\bfails:$')
ENDLESS = ('roslaunch ', 'roscore')
COLOURS = re.compile(r'\x1b\[[0-9;?]*[a-zA-Z]|\x1b\][^\x07]*\x07')


class LessonError(ValueError):
    """A block that no reader can act on, and so no test either."""


@dataclass(frozen=True)
class File:
    """A file that the reader writes, or to which lines are added above the last one."""

    name: str
    text: str
    language: str
    line: int
    is_addition: bool

    def write(self, folder: Path) -> None:
        """Write it into the folder of the lesson."""
        path = folder / self.name
        text = self.text
        if self.is_addition:
            *lines, last = path.read_text(encoding='utf-8').splitlines(keepends=True)
            text = ''.join([*lines, text, last])
        path.write_text(text, encoding='utf-8')


@dataclass(frozen=True)
class Commands:
    """What the reader types into a terminal, and the lines of the output that the page shows."""

    text: str
    line: int
    goes_on: bool
    fails: bool
    expected: tuple[str, ...] = ()


@dataclass(frozen=True)
class Shown:
    """Lines that appear in the terminal of the first or of the last program that goes on.

    `keys` are pressed there before.
    """

    expected: tuple[str, ...]
    line: int
    in_first: bool
    keys: str = ''


def missing(expected: Iterable[str], output: str) -> list[str]:
    """Return those of the expected lines that an output does not have."""
    lines = [line.strip() for line in COLOURS.sub('', output).splitlines()]
    return [
        line for line in expected if not any(re.fullmatch(pattern(line), shown) for shown in lines)
    ]


def pattern(line: str) -> str:
    """Return the regular expression of a line, in which … stands for anything."""
    return '.*'.join(map(re.escape, line.strip().split('…')))


def read_lesson(path: Path) -> list[File | Commands | Shown]:
    """Return what the reader of a lesson does, in order.

    Raises:
        LessonError: a block is of a kind that no test acts on.
    """
    steps: list[File | Commands | Shown] = []
    for line, sentence, language, text in _blocks(path):
        where = f'{path.name}, line {line}'
        saved, added = SAVED.search(sentence), ADDED.search(sentence)
        if language == 'bash':
            commands = Commands(
                text, line, bool(GOES_ON.search(sentence)), bool(FAILS.search(sentence))
            )
            if text.startswith(ENDLESS) and not commands.goes_on and not commands.fails:
                raise LessonError(
                    f'{where}: {text.split()[0]} goes on; say "in a terminal of its own:" before it'
                )
            if commands.goes_on and len(text.splitlines()) > 1:
                raise LessonError(f'{where}: a terminal of its own takes one line')
            steps.append(commands)
        elif language == 'text':
            expected = tuple(filter(str.strip, text.splitlines()))
            before = steps[-1] if steps else None
            if not expected:
                raise LessonError(f'{where}: an output without lines')
            if terminal := IN_TERMINAL.search(sentence):
                pressed = PRESSED.search(sentence)
                keys = ''.join(re.findall('`(.)`', pressed[1])) if pressed else ''
                steps.append(Shown(expected, line, terminal[1] == 'first', keys))
            elif isinstance(before, Commands) and not before.expected and not sentence:
                steps[-1] = replace(before, expected=expected)
            else:
                raise LessonError(f'{where}: this output follows no command')
        elif language in ('xml', 'python', 'yaml') and (saved or added):
            name = (saved or added)[1]
            steps.append(File(name, text, language, line, bool(added)))
        else:
            raise LessonError(
                f'{where}: no test would do anything with a block of {language!r} '
                f'after {sentence!r}'
            )
    return steps


def _blocks(path: Path) -> Iterator[tuple[int, str, str, str]]:
    """Yield line, paragraph before it ('' right after a block), language and text of each block."""
    sentence, is_complete = '', True
    fence, language, start, text = '', '', 0, []
    for number, line in enumerate(path.read_text(encoding='utf-8').splitlines(), 1):
        if fence:
            if line.strip() == fence:
                yield start, sentence, language, ''.join(text)
                sentence, is_complete, fence, text = '', True, '', []
            else:
                text.append(f'{line}\n')
        elif begins := FENCE.match(line.lstrip()):
            if line != line.lstrip():
                raise LessonError(f'{path.name}, line {number}: a block is indented')
            fence, language, start = begins['fence'], begins['language'].strip(), number
        elif line.startswith('    '):
            raise LessonError(f'{path.name}, line {number}: no test would run an indented block')
        elif line.strip():
            sentence = line if is_complete else f'{sentence} {line}'
            is_complete = False
        else:
            is_complete = True
    if fence:
        raise LessonError(f'{path.name}, line {start}: the block has no end')
