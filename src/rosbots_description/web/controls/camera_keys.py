"""Who gets the keys W, A, S, D and the arrows, by which viser moves its camera."""

import viser

from .text import running

# Viser's camera listens at the document, its hotkeys one element further in, where a key can be
# kept from the camera.
_FREE = 'document.documentElement.onkeydown = null'
_KEPT = (
    'document.documentElement.onkeydown = event => '
    '{ if (/^(arrow.+|[wasd])$/i.test(event.key)) event.stopPropagation() }'
)
HANDLERS = (_FREE, _KEPT)  # which the page's policy allows
FREE, KEPT = map(running, HANDLERS)


class CameraKeys:
    """Keeps these keys from the camera while they mean something else."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Begin with the camera having them; to be made outside of tabs, which may be closed."""
        self._html = gui.add_html('')

    def give(self, to_camera: bool) -> None:
        """Give the keys to the camera, or to hotkeys alone."""
        self._html.content = FREE if to_camera else KEPT
