"""Lessons consist of steps that a reader can take, and all of them are run."""

import re
from pathlib import Path

import pytest
from support import ROOT
from support.lessons import LESSONS, Commands, File, LessonError, Shown, missing, read_lesson
from support.programs import lint_faults

STEPS = [(lesson, step) for lesson in LESSONS for step in read_lesson(lesson)]
PROGRAMS = [
    (lesson, step) for lesson, step in STEPS if isinstance(step, File) and step.language == 'python'
]
IN_LESSONS = 'ANN,D10,D2,T201,INP,EXE'  # rules that would not help a beginner
MOST = 30_000  # bytes of a picture
OURS = re.compile(r'`((?:rosrun|roslaunch|gz|\./rosbots) [^`]*)`')
TESTED_ELSEWHERE = {
    './rosbots doctor',
    './rosbots doctor --report',
    './rosbots setup batch',
    './rosbots setup gym',
    './rosbots shell',
    'gz world -p 0',
    'roslaunch rosbots_description follow_policy.launch goal_x:=2 goal_y:=1',
    'rosrun rosbots_description learn_by_cma.py policy.json',
    'rosrun rosbots_description wander.py',
}


def lesson(tmp_path, text):
    path = tmp_path / 'lesson.md'
    path.write_text(text, encoding='utf-8')
    return path


def named(case):
    """Return the id of a page or of a step."""
    return case.stem if isinstance(case, Path) else f'line_{case.line}'


def test_steps_are_read_in_order_with_what_they_print(tmp_path):
    page = lesson(
        tmp_path,
        """# A lesson
Save this as `a/robot.urdf`:
```xml
<robot>
</robot>
```

Add this to `a/robot.urdf`, above its last line:
```xml
  <link/>
```

Start it, in a terminal
of its own:
```bash
roslaunch it
```

And type
```bash
one
two
```
```text
[INFO] […]: done

```

With a wrong name it fails:
```bash
three
```

This appears in the first terminal:
```text
what
```

Press `q`, `i` and `,`; this appears in
the last terminal:
```text
faster
```
""",
    )
    assert read_lesson(page) == [
        File('a/robot.urdf', '<robot>\n</robot>\n', 'xml', 3, is_addition=False),
        File('a/robot.urdf', '  <link/>\n', 'xml', 9, is_addition=True),
        Commands('roslaunch it\n', 15, goes_on=True, fails=False),
        Commands('one\ntwo\n', 20, goes_on=False, fails=False, expected=('[INFO] […]: done',)),
        Commands('three\n', 30, goes_on=False, fails=True),
        Shown(('what',), 35, in_first=True),
        Shown(('faster',), 41, in_first=False, keys='qi,'),
    ]


@pytest.mark.parametrize(
    'text',
    [
        '```bash\nls\n',
        '```json\n{}\n```\n',
        'Look at this:\n```xml\n<a/>\n```\n',
        '```text\nshown\n```\n',
        '```\nls\n```\n',
        'Type:\n\n    rostopic list\n',
        '- A point\n  ```bash\n  ls\n  ```\n',
        '```bash\nls\n```\nIt shows\n```text\na\n```\n',
        '```bash\nls\n```\n```text\n\n```\n',
        'In a terminal of its own:\n```bash\none\ntwo\n```\n',
        'Start it (or not):\n```bash\nroslaunch it\n```\n',
    ],
    ids=[
        'open',
        'json',
        'a file without a name',
        'output of nothing',
        'no language',
        'indented',
        'in a list',
        'output after a sentence',
        'no output',
        'two lines in a terminal',
        'without a terminal',
    ],
)
def test_a_block_that_no_test_runs_is_refused(tmp_path, text):
    with pytest.raises(LessonError, match=r'^lesson\.md, line \d+: '):
        read_lesson(lesson(tmp_path, text))


def test_lines_are_added_above_the_last_one(tmp_path):
    for text, is_addition in (('<a>\n</a>\n', False), ('<b/>\n', True)):
        File('x', text, 'xml', 1, is_addition).write(tmp_path)
    assert (tmp_path / 'x').read_text() == '<a>\n<b/>\n</a>\n'


@pytest.mark.parametrize(
    ('expected', 'output', 'is_there'),
    [
        ('done', 'so\ndone\n', True),
        ('done', 'not done\n', False),
        ('[INFO] […]: done', '\x1b[1m[INFO] [1.5, 0.1]: done\x1b[0m\r\n', True),
        ('…done', 'not done\n', True),
        ('x: 0.…', 'x: 0.31\n', True),
        ('x: 0.…', 'x: 10.3\n', False),
    ],
)
def test_a_line_is_looked_for_in_the_whole_output(expected, output, is_there):
    assert missing((expected,), output) == ([] if is_there else [expected])


def test_there_are_lessons():
    assert len(LESSONS) >= 4


@pytest.mark.parametrize('page', LESSONS, ids=named)
def test_a_lesson_has_commands_and_is_in_the_index(page):
    assert any(isinstance(step, Commands) and step.expected for step in read_lesson(page))
    assert f'lessons/{page.stem}\n' in (ROOT / 'doc' / 'index.md').read_text(encoding='utf-8')


@pytest.mark.parametrize('page', LESSONS, ids=named)
def test_commands_within_sentences_are_tested_elsewhere(page):
    assert set(OURS.findall(page.read_text(encoding='utf-8'))) <= TESTED_ELSEWHERE


@pytest.mark.parametrize(('_page', 'step'), PROGRAMS, ids=named)
def test_programs_are_lint_clean(_page, step):
    assert not lint_faults(step.text, step.name, '--ignore', IN_LESSONS)


def test_pictures_are_shown_and_small():
    folder = ROOT / 'doc' / 'images' / 'lessons'
    shown = {
        name
        for page in LESSONS
        for name in re.findall(r'images/lessons/([\w-]+\.webp)', page.read_text(encoding='utf-8'))
    }
    assert shown == {path.name for path in folder.iterdir()}
    assert max(path.stat().st_size for path in folder.iterdir()) < MOST
