"""The tree of models: a button for each, of the selected one also for its links."""

import pytest
from support.window import model, selection

from rosbots_description.sim.description import SceneChange
from rosbots_description.web.panels import tree


def rows(browser):
    """Return the labels of the buttons in the tree, from the top."""
    buttons = [
        props
        for kind, props in browser.controls.values()
        if kind == 'GuiButtonMessage' and props['color'] in ('gray', 'orange') and props['visible']
    ]
    return [props['label'] for props in sorted(buttons, key=lambda props: props['order'])]


def test_models_come_and_go_and_a_click_selects(browser, simulator, page):
    simulator.change(SceneChange(True, (model('b', 1), model('a', 2, links=('base', 'wheel')))))
    browser.wait_until(lambda: rows(browser) == ['b', 'a'])
    browser.click('a')
    browser.wait_until(lambda: rows(browser) == ['a', '└ base', '└ wheel', 'b'])
    browser.click('└ wheel')
    browser.wait_until(lambda: (selection(page).model, selection(page).link) == ('a', 'wheel'))
    browser.wait_until(lambda: browser.props('└ wheel')['color'] == 'orange')
    before = len(browser.controls)
    simulator.change(SceneChange(removed=('a',)))
    browser.wait_until(lambda: rows(browser) == ['b'])
    simulator.change(SceneChange(models=(model('c', 5),)))
    browser.wait_until(lambda: rows(browser) == ['b', 'c'])
    browser.click('c')
    browser.wait_until(lambda: selection(page).model == 'c')
    # No button is ever removed, so the page has none to miss.
    assert not browser.received('GuiRemoveMessage')
    browser.wait_until(lambda: rows(browser) == ['c', '└ link', 'b'])
    assert len(browser.controls) == before


def test_a_large_world_is_searched(browser, simulator, page, monkeypatch):
    monkeypatch.setattr(tree, 'MOST', 5)
    simulator.change(SceneChange(True, tuple(model(f'box_{n}', n) for n in range(100))))
    browser.wait_until(lambda: rows(browser) == [f'box_{n}' for n in range(5)])
    assert browser.shows('and 95 more')
    browser.choose('Find', 'BOX_77')
    browser.wait_until(lambda: rows(browser) == ['box_77'])
    selection(page).choose('box_3')
    browser.wait_until(lambda: rows(browser) == ['box_3', 'box_77'])
    assert not browser.shows('more')


@pytest.mark.parametrize('part', ['wheel', 'WHEEL'])
def test_links_of_the_selected_model_are_found(browser, simulator, page, part):
    simulator.change(
        SceneChange(True, (model('a', 1, links=('base', 'wheel_left')), model('b', 9)))
    )
    selection(page).choose('a')
    browser.wait_until(lambda: browser.control('└ base'))
    browser.choose('Find', part)
    browser.wait_until(lambda: rows(browser) == ['a', '└ wheel_left'])
