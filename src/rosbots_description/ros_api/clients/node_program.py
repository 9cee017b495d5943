"""Common start of the example nodes in scripts/."""

import sys
from collections.abc import Callable
from pathlib import Path

import rospy

from ...sim.core import SimError
from ..transport import is_running
from .service_program import CommandError, require_master


def run_node(main: Callable[[], None]) -> None:
    """Call `main`, which starts a node. Without a ROS master, or if a service fails, end with 1.

    The reason is printed as one sentence. Ctrl-C ends the program silently.
    """
    name = Path(sys.argv[0]).stem
    try:
        require_master(name)
        main()
    except (rospy.ROSInterruptException, KeyboardInterrupt):
        pass
    except (CommandError, SimError) as error:
        sys.exit(f'{name}: {error}')
    except rospy.ServiceException as error:
        if is_running():  # else the call was interrupted
            sys.exit(f'{name}: {error}')
    except ConnectionError:
        sys.exit(f'{name}: the ROS master has ended')
