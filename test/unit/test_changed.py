"""Tests that a change can have touched: found by imports, and all of them when that is unsure."""

import changed
import pytest

SOURCE = 'src/rosbots_description/'


@pytest.mark.parametrize(
    ('name', 'case'),
    [
        ('web/editing/gizmo.py', 'test/unit/web/test_page.py'),
        # a plugin, imported when used
        (
            'sim/sensors/imu.py',
            'test/engine/sim/sensors/test_imu.py',
        ),
        ('sim/physics/bullet/contact_stiffness.py', 'test/engine/gym/test_parallel.py'),
        ('ros_api/messages/fields.py', 'test/unit/ros_api/server/test_static_frames.py'),
    ],
)
def test_tests_that_import_the_changed_file_run_and_all_rostests(name, case):
    choice = changed.choose([SOURCE + name])
    assert case in choice.cases
    assert choice.rostests is None


def test_what_nothing_leads_to_is_left_out_and_counted():
    choice = changed.choose([SOURCE + 'web/editing/gizmo.py', 'README.md'])
    assert 'test/unit/sim/physics/bullet/test_friction_slip_compliance.py' not in choice.cases
    left = len(changed.test_files()) - len(choice.cases)
    assert choice.left_out.startswith(f'{left} of {len(changed.test_files())} files')


def test_tests_that_read_the_source_always_run():
    choice = changed.choose(['README.md'])
    assert {'test/unit/test_documents.py', 'test/unit/test_architecture.py'} <= set(choice.cases)
    assert choice.rostests == []


def test_a_changed_test_runs():
    name = 'test/unit/sim/physics/bullet/test_friction_slip_compliance.py'
    assert name in changed.choose([name]).cases


@pytest.mark.parametrize(
    ('program', 'runs'),
    [('test_frames.py', 'frames.test'), ('test_services.py', 'simulator.test')],
)
def test_a_program_of_rostests_runs_the_files_that_name_it(program, runs):
    choice = changed.choose([f'test/rostest/{program}'])
    assert [path.name for path in choice.rostests] == [runs]
    assert changed.choose(['test/rostest/simulator.py']).rostests is None


def test_a_lesson_runs_the_rostest_that_follows_it():
    choice = changed.choose(['doc/lessons/two_robots.md'])
    assert [path.name for path in choice.rostests] == ['lessons.test']


@pytest.mark.parametrize(
    'name',
    ['package.xml', 'urdf/rosbots.xacro', 'test/data/hostile/cases.yaml', SOURCE + 'deleted.py'],
)
def test_everything_runs_when_unsure(name):
    choice = changed.choose([name])
    assert (choice.cases, choice.rostests) == (None, None)
    assert name in choice.left_out
