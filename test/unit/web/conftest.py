"""A page with a browser and a simulator that are only pretended."""

import pytest
from support.browser import Browser
from support.window import FakeSimulator, serving

from rosbots_description.web import Page


@pytest.fixture
def site():
    with serving() as site:
        yield site


@pytest.fixture
def simulator():
    return FakeSimulator()


@pytest.fixture
def complaints():
    """What a panel that is made without a page complains of."""
    return []


@pytest.fixture
def page(site, simulator):
    return Page(site, simulator)


@pytest.fixture
def panel(page):
    """The whole page; a file of tests of one panel makes that one instead, and no page."""
    return page


@pytest.fixture
def client(site, browser):
    """Viser's handle of the browser."""
    (client,) = site.get_clients().values()
    return client


@pytest.fixture
def browser(site, panel):
    """A browser that has been let in, and has all controls that all browsers have."""
    with Browser(site.address) as browser:
        controls = site.gui._gui_input_handle_from_uuid
        browser.wait_until(
            lambda: getattr(panel, 'browsers', True) and controls.keys() <= browser.controls.keys()
        )
        yield browser
