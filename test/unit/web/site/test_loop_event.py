"""Threads add messages while the loop sends them."""

import asyncio
import threading

from support.browser import Browser
from viser._messages import RemoveSceneNodeMessage
from viser.infra._async_message_buffer import AsyncMessageBuffer

from rosbots_description.web.site.loop_event import LoopEvent, leave_to_loop

MESSAGE = RemoveSceneNodeMessage('/robot')


def buffer_of_this_loop():
    buffer = AsyncMessageBuffer(asyncio.get_running_loop(), persistent_messages=True)
    leave_to_loop(buffer)
    return buffer


def test_a_thread_that_adds_a_message_leaves_the_event_to_the_loop():
    async def add():
        buffer = buffer_of_this_loop()
        windows = buffer.window_generator(0)
        window = asyncio.ensure_future(anext(windows))
        await asyncio.sleep(0)  # it waits for a message
        thread = threading.Thread(target=buffer.push, args=(MESSAGE,))
        thread.start()
        thread.join()  # the loop stands still meanwhile
        was_set = buffer.message_event.is_set()
        received = await window
        await windows.aclose()
        return was_set, received

    assert asyncio.run(add()) == (False, [MESSAGE])


def test_the_loop_itself_may_add_messages():
    async def add():
        buffer = buffer_of_this_loop()
        buffer.push(MESSAGE)
        return buffer.message_event.is_set()

    assert asyncio.run(add())


def test_every_buffer_of_a_site_leaves_its_event_to_the_loop(site):
    with Browser(site.address) as browser:
        browser.wait_until(site.get_clients)
        (client,) = site.get_clients().values()
        for sender in site._websock_server, client._websock_connection:
            assert isinstance(sender.get_message_buffer().message_event, LoopEvent)
