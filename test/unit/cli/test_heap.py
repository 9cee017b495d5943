"""What threads have freed can be used by others, and large pieces go back to the system."""

import pytest
from support.programs import python

# Each program ends with how much memory it has gained, in pieces of the size that it uses.
BEGIN = """
import ctypes, threading
from rosbots_description.cli.heap import use_one_heap

libc = ctypes.CDLL(None)
libc.malloc.restype, libc.free.argtypes = ctypes.c_void_p, [ctypes.c_void_p]

def resident():
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * 4096

def use(size, count):
    pieces = [libc.malloc(size) for _ in range(count)]
    last = libc.malloc(100_000)  # it keeps the heap from shrinking by itself
    for piece in pieces:
        ctypes.memset(piece, 1, size)
    for piece in pieces:
        libc.free(piece)

{call}
"""
THREADS = """
def work():
    use(60_000, 500)
    done.release()
    end.wait()

done, end, before = threading.Semaphore(0), threading.Event(), resident()
for _ in range(8):  # one after the other, and all stay
    threading.Thread(target=work).start()
    done.acquire()
print((resident() - before) / (60_000 * 500))
end.set()
"""
LARGE = """
use(20_000_000, 1)  # glibc takes it as a sign that pieces up to this size are freed soon
before = resident()
use(1_000_000, 50)
print((resident() - before) / (1_000_000 * 50))
"""


def gained(program, call):
    return float(python(BEGIN.format(call=call) + program).stdout)


@pytest.mark.skipif('not __import__("platform").libc_ver()[0] == "glibc"', reason='of glibc')
@pytest.mark.parametrize(
    ('program', 'least', 'most'),
    [(THREADS, 6.0, 1.5), (LARGE, 0.9, 0.1)],
    ids=['threads', 'large pieces'],
)
def test_what_was_freed_is_used_again_or_returned(program, least, most):
    assert gained(program, '') > least  # as glibc does it
    assert gained(program, 'use_one_heap()') < most
