"""The title of the page is the name of the world."""

import html
import re

from rosbots_description.sim.description import SceneChange
from rosbots_description.web.site.policy import _hash, page_headers


def title(browser):
    """Return the title that the page is given."""
    found = [
        re.search('title="([^"]*)" onerror="([^"]*)"', props.get('content', ''))
        for kind, props in browser.controls.values()
        if kind == 'GuiHtmlMessage'
    ]
    (only,) = [match for match in found if match]
    return html.unescape(only[1])


def test_a_world_gives_page_and_panel_its_name(browser, simulator):
    browser.wait_until(lambda: title(browser) == 'gzweb')
    simulator.change(SceneChange(True, name='<b>"kitchen"'))
    browser.wait_until(lambda: title(browser) == '<b>"kitchen"')
    labels = [m['label'] for m in browser.messages if m['type'] == 'SetGuiPanelLabelMessage']
    assert labels[-1] == '<b>"kitchen"'


def test_scripts_of_the_page_are_allowed_by_their_hashes(browser):
    policy = page_headers()['Content-Security-Policy']
    browser.wait_until(lambda: title(browser))
    scripts = [
        html.unescape(script)
        for _, props in browser.controls.values()
        for script in re.findall('onerror="([^"]*)"', props.get('content', '') or '')
    ]
    assert len(scripts) >= 2
    for script in scripts:
        assert _hash(script) in policy, script
