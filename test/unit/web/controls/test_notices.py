"""Notices that are too many to be read are counted, and the count is told."""

import re
from threading import Thread

from rosbots_description.web.controls.notices import AT_ONCE, Notices

MANY, THREADS = 50, 4


def test_what_is_left_out_is_told_at_the_end(site, browser):
    notices = Notices(lambda: site.get_clients().values())

    def tell():
        for _ in range(MANY):
            notices.tell('no')

    threads = [Thread(target=tell) for _ in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    def told():
        notices.refresh()
        return [
            int(count[1])
            for note in browser.notes()
            if (count := re.fullmatch(r'(\d+) more notices? (is|are) left out', note))
        ]

    browser.wait_until(lambda: browser.notes().count('no') + sum(told()) == MANY * THREADS)
    assert browser.notes().count('no') >= AT_ONCE
    assert told()
