"""Text of strangers on the page: names, files and messages of models are never markup.

Viser's Markdown and HTML run whatever is in them. So the page has no Markdown with foreign text,
and its HTML is made here. Labels, options, hints and notifications are texts for viser, too.
"""

import html
import unicodedata
from collections.abc import Sequence

import viser

MOST = 300  # characters of a text in one place
STYLE = 'font-size: 0.85em; padding: 0 0.7em; overflow-wrap: anywhere'  # as viser's own rows
Rows = Sequence[tuple[str, str]]
# Control characters, and formatting ones such as those that reverse the direction of a line.
_HIDDEN = {'Cc', 'Cf', 'Cs', 'Co', 'Cn', 'Zl', 'Zp'}


def plain(text: str, most: int = MOST) -> str:
    """Return a text on one line of at most so many characters, without invisible ones."""
    short = text if len(text) <= most else text[: most - 1] + '\u2026'
    return ''.join(map(_shown, short))


def _shown(character: str) -> str:
    """Return what is shown of a character: spaces of all widths are one space."""
    if character in '\t\n\r' or (kind := unicodedata.category(character)) == 'Zs':
        return ' '
    return '\ufffd' if kind in _HIDDEN else character


def markup(text: str, most: int = MOST) -> str:
    """Return HTML that shows a text, in an element or in a quoted attribute, and nothing else."""
    return html.escape(plain(text, most))


def running(script: str, title: str = '') -> str:
    """Return HTML that runs a script, which finds a title in `this.title`.

    HTML that comes into a running page can run one only on an event. The script is one of ours,
    without double quotes, which the page's policy allows by its hash.
    """
    titled = f' title="{markup(title)}"' if title else ''
    return f'<img hidden src="data:,"{titled} onerror="{script}">'


class Words:
    """Lines of text, and a table of texts, on the page."""

    def __init__(self, gui: viser.GuiApi, text: str = '', visible: bool = True) -> None:
        # At once: viser's page complains of a control that is changed and removed in one frame.
        self._html = gui.add_html(_content(text), visible=visible)

    def show(self, text: str, rows: Rows = (), bold: str = '') -> None:
        """Show a bold text before lines of text, and rows of a name and a value below them."""
        content = _content(text, rows, bold)
        if content != self._html.content:
            self._html.content = content

    @property
    def visible(self) -> bool:
        """Whether they are shown."""
        return self._html.visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        if visible != self._html.visible:
            self._html.visible = visible


def _content(text: str, rows: Rows = (), bold: str = '') -> str:
    lines = '<br>'.join(markup(line) for line in text.split('\n'))
    title = f'<b>{markup(bold)}</b>' if bold else ''
    return f'<div class="words" style="{STYLE}">{title}{lines}{table(rows)}</div>'


def table(rows: Rows) -> str:
    """Return a table in HTML, names at the left and values at the right; '' without rows."""
    cells = ''.join(
        f'<tr><td>{markup(name)}</td><td style="text-align: right">{markup(value)}</td></tr>'
        for name, value in rows
    )
    return f'<table style="width: 100%; white-space: nowrap">{cells}</table>' if rows else ''
