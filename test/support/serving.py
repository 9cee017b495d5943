"""Servers of this machine, in the place of a ROS master, of nodes, and of strangers."""

import threading
from contextlib import contextmanager


@contextmanager
def serving(server):
    """Serve on a new thread; yield the server's address."""
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield f'http://localhost:{server.server_address[1]}/'
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
