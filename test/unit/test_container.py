"""The container and the check on GitHub run what ./rosbots has."""

import re

import yaml
from support import ROOT
from support.programs import bash


def instructions():
    """Return the instructions of the Containerfile, as the bare machine reads them."""
    done = bash(
        'source "$ROOT/tools/bare_machine/container.bash"; instructions "$ROOT/Containerfile"'
    )
    return [tuple(line.split(' ', 1)) for line in done.stdout.splitlines()]


def commands():
    """Return the commands that ./rosbots has."""
    text = (ROOT / 'rosbots').read_text(encoding='utf-8')
    return set(re.findall(r'^    ([a-z]+)\)$', text, re.M))


def test_image_is_a_slim_debian_with_the_sets_that_are_asked_for():
    steps = instructions()
    assert ('ARG', 'RELEASE=trixie') in steps
    assert ('FROM', 'docker.io/library/debian:${RELEASE}-slim') in steps
    assert ('ARG', 'SETS=base') in steps
    assert any(kind == 'RUN' and './rosbots setup ${SETS}' in command for kind, command in steps)


def test_programs_in_it_do_not_run_as_root():
    kinds = [kind for kind, _ in instructions()]
    assert dict(instructions())['USER'] == 'robot'
    assert kinds.index('USER') > max(i for i, kind in enumerate(kinds) if kind == 'RUN')


def test_bare_machine_knows_every_instruction():
    script = (ROOT / 'tools' / 'bare_machine' / 'container.bash').read_text(encoding='utf-8')
    known = {
        word
        for line in re.findall(r'^      ([A-Z |]+)\)', script, re.M)
        for word in line.split(' | ')
    }
    assert {kind for kind, _ in instructions()} <= known


def test_image_leaves_out_what_was_made_here():
    ignored = (ROOT / '.dockerignore').read_text(encoding='utf-8').splitlines()
    made = (ROOT / '.gitignore').read_text(encoding='utf-8')
    assert '.*' in ignored  # .ws and .git
    for folder in ('demo_output', 'batch_output'):
        assert f'/{folder}' in ignored
        assert f'/{folder}/' in made


def test_action_runs_commands_with_all_its_inputs():
    action = yaml.safe_load((ROOT / 'action.yml').read_text(encoding='utf-8'))
    assert action['runs']['using'] == 'composite'
    steps = action['runs']['steps']
    called = {name for step in steps for name in re.findall(r'/rosbots" (\w+)', step['run'])}
    assert called == {'setup', 'check'}
    assert called <= commands()
    used = {name for step in steps for name in re.findall(r'inputs\.(\w+)', str(step.get('env')))}
    assert used == set(action['inputs'])
    for step in steps:  # an input inside a script could be a command
        assert '${{' not in step['run']


def test_example_of_the_documents_uses_the_action_and_a_container_of_debian():
    text = (ROOT / 'doc' / 'setup.md').read_text(encoding='utf-8')
    (block,) = re.findall('```yaml\n(.*?)```', text, re.S)
    (job,) = yaml.safe_load(block)['jobs'].values()
    assert job['container'] in ('debian:12', 'debian:13')
    action = yaml.safe_load((ROOT / 'action.yml').read_text(encoding='utf-8'))
    (step,) = [step for step in job['steps'] if 'rosbots_description' in step.get('uses', '')]
    assert set(step['with']) <= set(action['inputs'])
