"""Front end of the executable gzclient: RViz, configured to show the simulated world."""

import argparse
import contextlib
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

from .display import display_works, has_graphics_card, no_window, run_window
from .gzserver import split_remappings
from .program import fail, say

_say = partial(say, 'gzclient')
# The window shows poses from the simulator, independent of /tf.
OWN_FRAMES = ('/tf:=gazebo/view/tf', '/tf_static:=gazebo/view/frames')
OFTEN, SELDOM = 'Frame Rate: 30', 'Frame Rate: 10'


def parser() -> argparse.ArgumentParser:
    """Return the parser of gzclient's options."""
    made = argparse.ArgumentParser(
        prog='gzclient', description='Look at the simulated world, through RViz.'
    )
    made.add_argument('--verbose', action='store_true', help='accepted; no effect')
    made.add_argument(
        '-g',
        '--gui-plugin',
        action='append',
        metavar='FILE',
        default=[],
        help='accepted; there is nothing to plug into',
    )
    return made


def config_file() -> Path:
    """Return the path of RViz's config, which is installed with the code."""
    return Path(__file__).resolve().parents[1] / 'config' / 'gzclient.rviz'


def main(arguments: Sequence[str] | None = None) -> int:
    """Open the window and monitor the simulator; return RViz's exit code, 0 without a display."""
    own, remappings = split_remappings(sys.argv[1:] if arguments is None else arguments)
    _, unknown = parser().parse_known_args(own)
    if unknown:
        _say(f'unknown options are ignored: {" ".join(unknown)}')
    if not display_works():
        _say(
            f'{no_window()}; the simulator runs without one, and web:=true or '
            'rosrun gazebo_ros gzweb shows it in a browser'
        )
        return 0
    rviz, config = shutil.which('rviz'), config_file()
    if rviz is None:
        return fail('gzclient', 'no window: rviz is not installed; on Debian: apt install rviz')
    environment = rviz_environment(os.environ, config.with_name('gzclient_log.config'))
    folder = environment.get('XDG_RUNTIME_DIR')
    if folder and not has_graphics_card():
        config = drawn_seldom(config, folder)
    command = [rviz, '-d', str(config), *OWN_FRAMES, *remappings, *_unique_name(remappings)]
    from ..ros_api.clients.server_watch import ServerWatch  # not needed without a window

    return run_window(
        command, environment, lambda text: _say(f'RViz {text}'), ServerWatch(_reporter()).poll
    )


def rviz_environment(given: Mapping[str, str], log_levels: Path) -> dict[str, str]:
    """Return an environment in which RViz and Qt log only relevant messages."""
    made = {'ROSCONSOLE_CONFIG_FILE': str(log_levels), **given}
    if not made.get('XDG_RUNTIME_DIR'):
        with contextlib.suppress(OSError):  # then Qt prints a warning
            folder = Path(tempfile.gettempdir(), f'rosbots-runtime-{os.getuid()}')
            folder.mkdir(mode=0o700, exist_ok=True)
            state = folder.lstat()
            # Its name is known to all: another user may have made it, or a link of that name.
            if stat.S_ISDIR(state.st_mode) and state.st_uid == os.getuid():
                folder.chmod(0o700)
                made['XDG_RUNTIME_DIR'] = str(folder)
    return made


def drawn_seldom(config: Path, folder: str) -> Path:
    """Return a copy of RViz's config, in this folder, with fewer pictures per second.

    Drawn without a graphics card, 30 keep a processor busy, which the simulation lacks. Where the
    folder cannot be written to, it is the config itself.
    """
    copy = Path(folder, config.name)
    made = copy.with_suffix(f'.{os.getpid()}')  # renamed when whole: other windows may open now
    with contextlib.suppress(OSError):
        made.write_text(config.read_text(encoding='utf-8').replace(OFTEN, SELDOM), encoding='utf-8')
        return made.replace(copy)
    return config


def _unique_name(remappings: Sequence[str]) -> list[str]:
    """Return a remapping to a unique name if another window already has this one's name.

    The ROS master would shut the other window down: it allows one node per name.
    """
    from ..ros_api.transport import NO_MASTER, node_name, running_node

    if not any(word.startswith('__name:=') for word in remappings):
        return []  # RViz generates a unique name
    name = node_name('rviz', remappings)
    with contextlib.suppress(*NO_MASTER):
        if running_node(name):
            other = f'{name}_{os.getpid()}'
            _say(f'a window has the name {name} already; this one is {other}')
            return [f'__name:={other.rpartition("/")[2]}']
    return []


def _reporter() -> Callable[[bool], None]:
    """Return the callback that reports, here and in the scene, whether there is a simulator."""
    from ..ros_api.clients.server_watch import NOTICE, Notice

    notice = Notice()

    def report(is_up: bool) -> None:
        if is_up:
            _say('the simulator is running again')
            notice.withdraw()
        else:
            _say(f'{NOTICE}; this window shows its last state')
            notice.show()

    return report
