"""The layout of the panel: a bar of icons, one line for each label, a sheet on phones.

Viser lays out each control in a row of its own. `MARK` finds rows by viser's elements, and where
they are by empty elements of the page: what is in one container with `BAR` is a bar of icons, what
is in one with `PAD` ends with a cross of five buttons. It marks them by attributes, for the style
sheet. Without these, all works in rows.
"""

import viser

from .text import running

BAR, PAD = '<div class="bar"></div>', '<div class="pad"></div>'
NARROW = '(max-width: 36em)'  # of pages: viser then has a sheet at the bottom
WIDTH = 384.0  # of the panel otherwise [pixels]

_BAR, _PAD = '[data-holds=bar]', '[data-holds=pad]'
_ICON = f'{_BAR} > div > .mantine-Button-root'
_ROW, _CHECK = '[data-row]', '[data-row=check]'
_TAB, _SMALL_TAB = '[data-dock-strip] > [data-dock-tab]', '.mantine-Tabs-tab'

# A label has a line of its own if it needs one; what is too long keeps its end.
_ROWS = f"""
{_ROW} {{ flex-wrap: wrap }}
{_ROW} > div:first-child {{ width: auto !important; min-width: 6.5em; max-width: 100% }}
{_ROW} > div:last-child {{ flex: 1 1 11em !important; min-width: 0 }}
{_CHECK} {{ flex-wrap: nowrap }}
{_CHECK} > div:first-child {{ flex: 1 1 0 !important; min-width: 0 }}
{_CHECK} > div:last-child {{ flex: 0 0 auto !important }}
{_ROW} > div:first-child > p {{ white-space: nowrap; overflow: hidden; text-overflow: ellipsis;
  direction: rtl; text-align: left; letter-spacing: -0.2px !important }}
{_ROW} label {{ direction: ltr; unicode-bidi: isolate }}
{_ROW} wbr {{ display: none }}
.mantine-Select-dropdown {{ min-width: 11em }}"""

# The labels of icons are tooltips, which screen readers read as well.
_ICONS = f"""
{_BAR} {{ display: flex; flex-wrap: wrap; align-items: center; gap: 0.3em; padding: 0.4em 0.6em 0 }}
{_BAR} > div {{ flex: 0 0 100%; min-width: 0; margin: 0 !important; padding: 0 !important }}
{_BAR} > [data-cell=bar], {_BAR} > div:empty, {_BAR} > [data-cell=hidden] {{ display: none }}
{_BAR} > [data-cell=clock] {{ flex: 1 1 auto }}
{_BAR} > [data-cell=icon] {{ flex: 0 0 auto }}
{_BAR} > [data-cell=tabs] {{ flex-basis: calc(100% + 1.2em); margin: 0 -0.6em !important }}
{_BAR} > [data-cell=number] {{ flex: 0 0 4em }}
{_BAR} > [data-cell=choice] {{ flex: 1 1 4em }}
{_BAR} > div > .mantine-Flex-root > div:first-child {{ position: absolute !important; opacity: 0;
  pointer-events: none }}
{_ICON} {{ position: relative; width: 2em; height: 2em !important; padding: 0 !important;
  overflow: visible; font-size: 1em }}
{_ICON} .mantine-Button-inner {{ overflow: visible }}
{_ICON} .mantine-Button-section {{ margin: 0; font-size: 1.15em; text-align: left }}
{_BAR} > [data-cell=bar] ~ div ~ div > .mantine-Button-root {{ color: inherit;
  background: transparent }}
{_BAR} > [data-cell=bar] ~ div ~ div > .mantine-Button-root:hover {{
  background: var(--mantine-color-default-hover) }}
{_ICON}[data-disabled] {{ opacity: 0.35 }}
{_ICON} .mantine-Button-label {{ position: absolute; top: calc(100% + 0.3em); left: 0; z-index: 50;
  height: auto; max-width: 20em; padding: 0.3em 0.6em; border-radius: 0.25em; background: #212529;
  color: #fff; font-size: 0.8rem; font-weight: 400; opacity: 0; pointer-events: none }}
{_BAR} > [data-cell=choice] ~ div .mantine-Button-label {{ left: auto; right: 0 }}
{_ICON}:hover .mantine-Button-label, {_ICON}:focus-visible .mantine-Button-label {{ opacity: 1 }}"""

_CROSS = f"""
{_PAD} {{ display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); column-gap: 0.4em }}
{_PAD} > div {{ grid-column: 1 / -1 }}
{_PAD} > div:nth-last-child(-n + 5) {{ margin-inline: 0.4em !important }}
{_PAD} > div:nth-last-child(4) {{ grid-column: 1 }}
{_PAD} > div:nth-last-child(2n + 1):nth-last-child(-n + 5) {{ grid-column: 2 }}
{_PAD} > div:nth-last-child(2) {{ grid-column: 3 }}"""

_TABS = f"""
[data-strip] {{ background: none !important;
  border-bottom: 1px solid var(--mantine-color-default-border) }}
{_TAB}, {_SMALL_TAB} {{ flex: 1 1 auto; flex-direction: column; justify-content: center;
  gap: 0.2em; height: 4em !important; padding: 0 0.2em !important; font-size: 0.7rem }}
{_TAB} > div, {_SMALL_TAB} .mantine-Tabs-tabSection {{ margin: 0 !important; font-size: 1.4em }}"""

_SHEET = f"""
@media {NARROW} {{
  [style*="position: fixed"][style*="width: 20em"] {{ width: 100% !important;
    max-height: 70% !important; border-radius: 1em 1em 0 0 !important }}
  [style*="width: 20em"] {{ width: 100% !important }}
}}
@media (pointer: coarse) {{
  {_ICON} {{ width: 2.5em; height: 2.5em !important }}
}}"""

# Viser fades the scene in, in five frames after its reflections have been loaded; where they are
# loaded again meanwhile, as at the start of a page on a slow computer, it would stay faint.
OPAQUE = 'canvas[data-engine] { opacity: 1 !important }'

STYLE = f'<style>{_ROWS}{_ICONS}{_CROSS}{_TABS}{_SHEET}{OPAQUE}</style>'

# What is in one cell of a bar, and by what that is found.
_CELLS = {
    'bar': '> .bar',
    'hidden': '> [hidden]',
    'clock': '> .clock',
    'icon': '> .mantine-Button-root',
    'number': '> .mantine-Flex-root .mantine-NumberInput-root',
    'choice': '> .mantine-Flex-root .mantine-Select-root',
    'tabs': '[role=tablist]',
}

# Runs whenever something appears in the page. The style sheet could find all of it by `:has`; but
# then a browser styles the whole panel anew each time the clock shows another second.
MARK = f"""if (!document.body.dataset.marked) {{
  document.body.dataset.marked = 'yes';
  const all = selector => document.querySelectorAll(selector);
  // Not what is there already: that would be a change, for all who watch the page.
  const put = (one, name, value) => one.dataset[name] === value || (one.dataset[name] = value);
  const mark = () => {{
    for (const one of all('.bar, .pad'))
      put(one.parentElement.parentElement, 'holds', one.className);
    for (const cell of all('{_BAR} > div'))
      put(cell, 'cell', Object.entries({_CELLS}).find(
        ([_, content]) => cell.querySelector(`:scope ${{content}}`))?.[0] ?? '');
    for (const row of all('.mantine-Flex-root'))
      if (row.querySelector(':scope > div > .mantine-Text-root > label[for]'))
        put(row, 'row', row.querySelector('.mantine-Checkbox-root') ? 'check' : 'field');
      else delete row.dataset.row;
    for (const strip of all('[data-dock-strip]'))
      strip.toggleAttribute('data-strip', strip.querySelector(':scope > [data-dock-tab]') !== null);
  }};
  new MutationObserver(mark).observe(document.body, {{childList: true, subtree: true}});
  mark();
}}"""

# The sheet begins closed; viser opens it. The element is in it, below its handle.
CLOSE_SHEET = (
    f"if (matchMedia('{NARROW}').matches && !document.body.dataset.sheet) "
    "{ document.body.dataset.sheet = 'closed'; this.closest(`[style*='position: fixed']`)"
    "?.querySelector(`[style*='cursor: pointer']`)?.click() }"
)

LAY_OUT = (MARK, CLOSE_SHEET)  # which the page's policy allows


def lay_out(gui: viser.GuiApi) -> None:
    """Lay out the panel; to be called before anything is added to it."""
    gui.configure_theme(show_logo=False, show_share_button=False, control_width='large')
    gui.main_panel.dock_right()
    gui.main_panel.set_width(WIDTH)
    gui.add_html(STYLE + ''.join(map(running, LAY_OUT)))
