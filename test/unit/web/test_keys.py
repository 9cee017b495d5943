"""The list of the keys, on the key ?."""

import re

from support.browser import Browser


def rows(browser):
    """Return what the list shows: keys by what they do."""
    return dict(re.findall(r'<td>(.*?)</td><td.*?>(.*?)</td>', browser.tables()))


def test_the_list_has_what_keys_do_now_and_is_closed_by_its_button_or_key(browser, simulator):
    browser.press('?')
    browser.wait_until(lambda: rows(browser))
    shown = rows(browser)
    assert shown['Play or pause'] == 'Space'
    assert shown['Undo'] == 'Ctrl-Z'
    assert shown['View: Home'] == 'H'
    assert shown['Show the keys'] == '?'
    assert shown['Forward'] == 'I'  # W moves the camera, as nothing can be driven
    for close in (lambda: browser.click('Close'), lambda: browser.press('?')):
        close()
        browser.wait_until(lambda: not rows(browser))
        browser.press('?')
        browser.wait_until(lambda: rows(browser))


def test_each_browser_has_its_own_list(browser, site):
    with Browser(site.address) as other:
        other.wait_until(lambda: '?' in other.keys)
        other.press('?')
        other.wait_until(lambda: rows(other))
        browser.read()
        assert not rows(browser)
