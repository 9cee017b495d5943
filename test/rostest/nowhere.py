#!/usr/bin/env python3
"""Run a command on a machine without a network, with a hostname that cannot be resolved.

Run it in its own namespaces: unshare --net --uts nowhere.py COMMAND…
"""

import fcntl
import os
import socket
import struct
import sys

SIOCGIFFLAGS, SIOCSIFFLAGS, IFF_UP = 0x8913, 0x8914, 0x1  # of Linux
REQUEST = '16sH14x'  # name of the interface, its flags

socket.sethostname('nowhere')
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
    loopback = struct.pack(REQUEST, b'lo', 0)
    _, flags = struct.unpack(REQUEST, fcntl.ioctl(control, SIOCGIFFLAGS, loopback))
    fcntl.ioctl(control, SIOCSIFFLAGS, struct.pack(REQUEST, b'lo', flags | IFF_UP))
os.execvp(sys.argv[1], sys.argv[1:])
