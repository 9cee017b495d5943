"""The event of a new message to browsers, which any thread may add."""

import asyncio

from viser.infra._async_message_buffer import AsyncMessageBuffer


class LoopEvent(asyncio.Event):
    """An event that only the thread of its loop sets.

    Viser sets the event of a buffer in the thread that adds a message, and once more in the loop.
    Events of asyncio do not bear the first: "deque mutated during iteration" was raised in
    what added the message, which was left half done.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._own_loop = loop

    def set(self) -> None:
        """Set it if this is the loop's thread; for others, viser has the loop do it."""
        if asyncio._get_running_loop() is self._own_loop:
            super().set()


def leave_to_loop(buffer: AsyncMessageBuffer) -> None:
    """Let only its loop set the event of a buffer that nobody reads yet."""
    buffer.message_event = LoopEvent(buffer.event_loop)
