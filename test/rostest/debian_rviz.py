"""What tests need to know of Debian's RViz 1.14.

With software rendering it now and then overwrites its own heap while it opens its window, also
where only Debian's programs run. So it is started again if it crashed before its window stood.
"""

import re

STARTS = 4  # at most
CRASH = re.compile(r'rviz-\d+\] (process )?has died.*?exit code -(6|11),', re.S)
STANDS = '/rviz/reload_shaders'  # the first service that it opens after its window
