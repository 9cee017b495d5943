"""A page with a browser and a simulator that are only pretended."""

import pytest
from support.browser import Browser
from support.window import FakeSimulator

from rosbots_description.web import Page, Site


@pytest.fixture
def site():
    site = Site('127.0.0.1', 0)
    yield site
    site.stop()


@pytest.fixture
def simulator():
    return FakeSimulator()


@pytest.fixture
def page(site, simulator):
    return Page(site, simulator)


@pytest.fixture
def browser(site, simulator, page):
    with Browser(site.address) as browser:
        browser.wait_until(lambda: simulator.change and page.browsers)
        yield browser
