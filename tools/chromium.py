"""A Chromium without a screen, which draws in software; driven by Selenium."""

import base64
import io
import os
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress

from PIL import Image
from selenium import webdriver
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By

OPTIONS = [
    '--headless=new',
    '--no-sandbox',
    '--no-first-run',
    '--disable-dev-shm-usage',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-gpu-compositing',  # only the scene is drawn by the software's WebGL, not the page
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
]
CLOCK = "return document.querySelector('.clock b')?.textContent ?? ''"
UNTIDY = 'Tried to update non-existent component'  # of what was removed in the same frame
# [ms] before each frame: pages that draw all the time, in software, would keep the processors busy.
PAUSE = 250
# Frames come seldom, and the scene is drawn only in that at which somebody looks: see `picture`.
# So are the maps of shadows, which three.js draws anew for each frame.
DRAW_SELDOM = """
for (const name of ['clear', 'drawArrays', 'drawElements', 'drawArraysInstanced',
                    'drawElementsInstanced']) {
  const draw = WebGL2RenderingContext.prototype[name];
  WebGL2RenderingContext.prototype[name] = function (...numbers) {
    if (!window.isLookedAt) return;
    window.isDrawn ||= !this.getParameter(this.FRAMEBUFFER_BINDING);
    draw.apply(this, numbers);
  };
}
const soon = requestAnimationFrame, cancelSoon = cancelAnimationFrame, frames = new Map();
window.requestAnimationFrame = callback => {
  const frame = setTimeout(() => frames.set(frame, soon(now => {
    frames.delete(frame);
    callback(now);
  })), PAUSE);
  return frame;
};
window.cancelAnimationFrame = frame => {
  clearTimeout(frame);
  cancelSoon(frames.get(frame));
  frames.delete(frame);
};
""".replace('PAUSE', str(PAUSE))

HOPELESS = 180.0  # [s, wall] for a frame that is drawn in software, beside other programs
# Ends when the scene, and then the page around it, has been drawn.
LOOK = """
const done = arguments[0];
const look = () => {
  if (!window.isDrawn) return setTimeout(look, 10);
  window.isLookedAt = false;
  requestAnimationFrame(done);
};
[window.isLookedAt, window.isDrawn] = [true, false];
look();
"""


@contextmanager
def chromium(size: tuple[int, int], *more: str) -> Iterator[webdriver.Chrome]:
    """Open a browser; yield its driver.

    Args:
        size: width and height of pages [pixels].
        more: options of Chromium.
    """
    options = webdriver.ChromeOptions()
    options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
    for option in (*OPTIONS, *more):
        options.add_argument(option)
    with ExitStack() as stack:
        # Whatever it leaves there goes with it; processes of it may end after its driver.
        scratch = stack.enter_context(tempfile.TemporaryDirectory(ignore_cleanup_errors=True))
        service = Service('/usr/bin/chromedriver', env=os.environ | {'TMPDIR': scratch})
        driver = webdriver.Chrome(service=service, options=options)
        stack.callback(driver.quit)
        driver.set_script_timeout(HOPELESS)
        resize(driver, size)
        driver.execute_cdp_cmd('Page.enable', {})
        driver.execute_cdp_cmd(
            'Page.addScriptToEvaluateOnNewDocument', {'source': f'{{{DRAW_SELDOM}}}'}
        )
        yield driver


def resize(driver: webdriver.Chrome, size: tuple[int, int]) -> None:
    """Give pages another width and height [pixels]."""
    width, height = size
    driver.execute_cdp_cmd(
        'Emulation.setDeviceMetricsOverride',
        {'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': False},
    )


def picture(driver: webdriver.Chrome) -> Image.Image:
    """Return what the page shows, however long it takes to be drawn.

    Selenium's own screenshots have a deadline of 10 s, which cannot be changed.
    """
    driver.execute_async_script(LOOK)
    answer = driver.execute_cdp_cmd('Page.captureScreenshot', {})
    return Image.open(io.BytesIO(base64.b64decode(answer['data'])))


def drawn(driver: webdriver.Chrome) -> None:
    """Return when the page has been drawn again, with all that it knows of now."""
    driver.execute_async_script(
        'const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done))'
    )


def clock(driver: webdriver.Chrome) -> str:
    """Return the simulated time that the window's page shows, as hours:minutes:seconds, or ''."""
    return str(driver.execute_script(CLOCK))


def opens_tab(driver: webdriver.Chrome, name: str) -> bool:
    """Press a tab; tell whether it is open: it may move away as the page fills."""
    with suppress(StaleElementReferenceException):
        tab = driver.find_element(By.CSS_SELECTOR, f'[role=tab][title="{name}"]')
        tab.click()
        return tab.get_attribute('aria-selected') == 'true'
    return False


def faults(driver: webdriver.Chrome) -> list[str]:
    """Return the errors that its console has shown since the last call, but for viser's own."""
    return [
        entry['message']
        for entry in driver.get_log('browser')
        if entry['level'] == 'SEVERE' and UNTIDY not in entry['message']
    ]
