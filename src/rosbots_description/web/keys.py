"""A list of the keys that the page takes, on the key ?."""

import threading

import viser
from viser._gui_handles import GuiModalHandle

from .controls import table
from .site import Site

TITLE, CLOSE = 'Keys (? closes this list)', 'Close'
NAMES = {
    'arrowup': '\u2191',
    'arrowdown': '\u2193',
    'arrowleft': '\u2190',
    'arrowright': '\u2192',
    'escape': 'Escape',
    'space': 'Space',
    'delete': 'Delete',
    ',': 'comma',
    '.': 'full stop',
}
MODIFIERS = {'cmd/ctrl': 'Ctrl-', 'shift': 'Shift-', None: ''}


class KeyHelp:
    """Shows and hides the list, in each browser by itself."""

    def __init__(self, site: Site) -> None:
        self._gui = site.gui
        self._lock = threading.Lock()
        self._shown: dict[int, GuiModalHandle] = {}  # by the numbers of clients
        site.on_client_disconnect(self._forget)
        command = site.gui.add_command('Show the keys', hotkey='?', modifier='shift')  # type: ignore[arg-type]  # any key
        command.on_trigger(lambda event: self._toggle(event.client))
        site.allow_viewers(command)

    def _forget(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._shown.pop(client.client_id, None)

    def _toggle(self, client: viser.ClientHandle | None) -> None:
        if client is None:
            return
        with self._lock:
            shown = self._shown.pop(client.client_id, None)
            if shown is not None:
                shown.close()
                return
            with client.atomic():
                self._shown[client.client_id] = modal = client.gui.add_modal(TITLE)
                with modal:
                    client.gui.add_html(table(self.rows(client)))
                    close = client.gui.add_button(CLOSE)
                    close.on_click(lambda _: self._toggle(client))

    def rows(self, client: viser.ClientHandle) -> list[tuple[str, str]]:
        """Return what each key does now, and the keys for it, in alphabetical order."""
        found: dict[str, list[str]] = {}
        commands = self._gui._command_handle_from_uuid | client.gui._command_handle_from_uuid
        for command in tuple(commands.values()):  # of viser's own lists
            if command.hotkey is not None and not command.disabled:
                key = NAMES.get(command.hotkey, command.hotkey)
                prefix = '' if key == '?' else MODIFIERS[command.modifier]
                found.setdefault(command.label.split(' (')[0], []).append(prefix + key)
        return [(label, ', '.join(keys)) for label, keys in sorted(found.items())]
