"""A Chromium without a screen, by its remote debugging: addresses in, pictures out."""

import base64
import json
import subprocess
import time
import urllib.request
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

START = 30.0  # [s, wall]
OPTIONS = [
    '--headless=new', '--no-sandbox', '--no-first-run', '--disable-dev-shm-usage',
    '--disable-background-networking', '--disable-component-update', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--remote-debugging-port=0',
]


class Chromium:
    """A page that is open for the length of a `with` statement.

    `faults` are the errors that its console has reported.
    """

    def __init__(self, address: str, size: tuple[int, int], folder: Path) -> None:
        """Open an address in a window of so many pixels; the profile goes into the folder."""
        self._process = subprocess.Popen(
            ['chromium', *OPTIONS, f'--user-data-dir={folder}',
             '--window-size={},{}'.format(*size), 'about:blank'],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._number = 0
        self.faults: list[str] = []
        try:
            self._connection = self._connect(folder / 'DevToolsActivePort')
            self.call('Runtime.enable')
            self.call('Log.enable')
            self.call('Page.navigate', url=address)
        except BaseException:
            self._process.kill()
            raise

    def __enter__(self) -> 'Chromium':
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()
        self._process.terminate()
        self._process.wait()

    def call(self, method: str, **parameters: object) -> dict[str, Any]:
        """Return what a method of the DevTools protocol answers."""
        self._number += 1
        self._connection.send(json.dumps(
            {'id': self._number, 'method': method, 'params': parameters}))
        while True:
            answer = json.loads(self._connection.recv(timeout=120.0))
            if answer.get('id') == self._number:
                found: dict[str, Any] = answer.get('result', {})
                return found
            self._note(answer)

    def evaluate(self, script: str) -> Any:  # noqa: ANN401  whatever it returns
        """Return the value of a JavaScript expression."""
        return self.call('Runtime.evaluate', expression=script, returnByValue=True)['result'].get(
            'value')

    def wait_for(self, script: str, timeout: float = 60.0) -> None:
        """Wait until a JavaScript expression is true."""
        end = time.monotonic() + timeout
        while not self.evaluate(script):
            if time.monotonic() > end:
                raise TimeoutError(script)
            time.sleep(0.2)

    def picture(self) -> bytes:
        """Return the page as PNG."""
        return base64.b64decode(self.call('Page.captureScreenshot')['data'])

    def _note(self, event: dict[str, Any]) -> None:
        parameters = event.get('params', {})
        if event.get('method') == 'Runtime.exceptionThrown':
            self.faults.append(json.dumps(parameters['exceptionDetails']))
        elif parameters.get('entry', {}).get('level') == 'error':
            self.faults.append(json.dumps(parameters['entry']))

    def _connect(self, file: Path) -> ClientConnection:
        end = time.monotonic() + START
        while not file.exists() or not file.read_text():
            if time.monotonic() > end or self._process.poll() is not None:
                raise TimeoutError('Chromium does not start')
            time.sleep(0.05)
        port = file.read_text().split()[0]
        with urllib.request.urlopen(f'http://127.0.0.1:{port}/json', timeout=START) as answer:
            page = next(one for one in json.load(answer) if one['type'] == 'page')
        return connect(page['webSocketDebuggerUrl'], max_size=None)
