"""The queue of commands: nothing is lost, and nobody waits longer than asked."""

import signal
import threading

from rosbots_description.ros_api.server.command_queue import CommandQueue

LONG = 30.0  # [s] far more than any of these tests takes


def test_commands_come_in_order_with_those_that_arrive_meanwhile():
    queue = CommandQueue()
    queue.put(lambda: queue.put('third'))
    queue.put('second')
    taken = []
    for command in queue.take_all():
        taken.append(command() if callable(command) else command)
    assert taken == [None, 'second', 'third']
    assert list(queue.take_all()) == []


def test_shortest_timeout_ends_also_after_a_command_without_a_wait():
    queue = CommandQueue()

    def wait_often():
        for _ in range(1000):
            queue.put(None)
            assert list(queue.take_all()) == [None]
            queue.wait(1e-9)

    waiting = threading.Thread(target=wait_often, daemon=True)
    waiting.start()
    waiting.join(LONG)
    assert not waiting.is_alive()


def test_waiting_ends_with_a_command_of_another_thread():
    queue, taken = CommandQueue(), []

    def take():
        while len(taken) < 1000:
            queue.wait(None)
            taken.extend(queue.take_all())

    taking = threading.Thread(target=take, daemon=True)
    taking.start()
    putting = [
        threading.Thread(target=lambda: [queue.put(n) for n in range(250)]) for _ in range(4)
    ]
    for thread in putting:
        thread.start()
    taking.join(LONG)
    assert not taking.is_alive()
    assert sorted(taken) == sorted([*range(250)] * 4)


def test_waiting_ends_with_a_command_of_a_signal_handler_on_its_own_thread():
    queue = CommandQueue()
    before = signal.signal(signal.SIGUSR1, lambda *_: queue.put('from the handler'))
    try:
        here = threading.get_ident()
        threading.Timer(0.05, signal.pthread_kill, [here, signal.SIGUSR1]).start()
        queue.wait(LONG)
        assert list(queue.take_all()) == ['from the handler']
    finally:
        signal.signal(signal.SIGUSR1, before)
