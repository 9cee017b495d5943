"""Elements of an SDF file that are not simulated, named once per file by path and line."""

import logging
from collections.abc import Collection
from dataclasses import replace
from itertools import islice

from lxml import etree

from ...core import (
    MAX_NOTES,
    Fault,
    line_of,
    parse_numbers,
    report,
    shortened,
    warning,
)
from ..xml import LeftOut, scalar, tag_of

# A leaf with a value that holds here anyway is not mentioned.
_NEUTRAL: dict[str, tuple[float, ...]] = {
    'enable_wind': (0.0,),
    'linear_velocity': (0.0, 0.0, 0.0),
    'slip': (0.0,),
    'soft_cfm': (0.0,),
    'soft_erp': (0.2,),
    'collide_without_contact': (0.0,),
    'collide_without_contact_bitmask': (1.0,),
    'coefficient': (1.0,),
    'use_patch_radius': (1.0,),
    'patch_radius': (0.0,),
    'surface_radius': (0.0,),
    'visible': (1.0,),
    'initial_position': (0.0,),
    'center': (0.0,),
}

# Stored and reported, but without effect here: parent -> children.
_KEPT = {
    'ode': ('max_vel', 'min_depth'),
    'collision': ('max_contacts',),
    'limit': ('velocity',),
}
# The same, but the author of the model expects an effect.
_NOT_RUN = {'link': ('light', 'projector')}

# Elements whose mere presence has an effect, whatever they contain.
_PARTS = {part for parts in _NOT_RUN.values() for part in parts}
# Containers that saved worlds write even when they are empty.
_EMPTY = {
    'surface',
    'friction',
    'ode',
    'bullet',
    'torsional',
    'bounce',
    'contact',
    'limit',
    'dynamics',
    'physics',
    'geometry',
    'script',
    'wind',
    'gui',
    'audio',
    'meta',
}


class Notes:
    """Collects the notes about one file; `report` reports them, each once.

    Attributes:
        left_out: parts of its models that were left out.
    """

    def __init__(self, source: str) -> None:
        self.left_out = LeftOut()
        self._source = source
        self._unread: dict[str, dict[str, None]] = {}  # path -> lines, in order
        self._idle: dict[str, dict[str, None]] = {}
        self._faults: dict[str, Fault] = {}  # by their sentences

    def check(
        self, element: etree._Element, read: Collection[str], idle: Collection[str] = ()
    ) -> None:
        """Note the children of `element` that are not read, or have no effect.

        Args:
            read: tags that are read.
            idle: tags without effect here, such as a solver's settings.
        """
        kept, not_run = _KEPT.get(element.tag, ()), _NOT_RUN.get(element.tag, ())
        for child in element:
            if child.tag not in read or child.tag in (*kept, *not_run):
                self.unread(child, idle=child.tag in idle or child.tag in kept)

    def unread(self, element: etree._Element, idle: bool = False) -> None:
        """Note an element that is not simulated, unless its value has no effect anyway."""
        if not _is_neutral(element):
            lines = (self._idle if idle else self._unread).setdefault(_path(element), {})
            lines[line_of(element)] = None

    def warn(self, element: etree._Element, sentence: str) -> None:
        """Note that something is done differently than `element` specifies."""
        self.add(warning(element, shortened(sentence)))

    def add(self, fault: Fault) -> None:
        """Note a fault whose sentence names its location."""
        if len(self._faults) == MAX_NOTES:
            fault = Fault(f'{self._source}: more warnings of this kind are not listed')
        if len(self._faults) <= MAX_NOTES:
            self._faults.setdefault(fault.what, fault)

    def report(self, model: str = '') -> None:
        """Report all notes; those without effect on the simulation at level debug.

        Args:
            model: the name of the model that the file describes; '' for several.
        """
        faults = [*self.left_out.errors(), *self._faults.values(), *self.left_out.warnings]
        if self._unread:
            faults.append(Fault(f'not simulated: {_list(self._unread)}'))
        if self._idle:
            faults.append(Fault(f'without effect here: {_list(self._idle)}', logging.DEBUG))
        for fault in faults:
            what = self.with_source(fault.what)
            report(replace(fault, what=what, model=model or fault.model))

    def with_source(self, sentence: str) -> str:
        """Return a sentence that begins with the file."""
        named = sentence.startswith(self._source)
        return sentence if named else f'{self._source}: {sentence}'


def _is_neutral(element: etree._Element) -> bool:
    if element.tag in _PARTS:
        return False
    if len(element):
        return all(_is_neutral(child) for child in element)
    text = scalar(element).lower()
    if element.tag in _NEUTRAL and text:
        text = {'true': '1', 'false': '0'}.get(text, text)
        neutral = _NEUTRAL[element.tag]
        return parse_numbers(text, len(neutral)) == neutral
    return not text and not element.attrib and element.tag in _EMPTY


def _path(element: etree._Element) -> str:
    tags = [tag_of(element), *(tag_of(ancestor) for ancestor in element.iterancestors())]
    return '/'.join(reversed(tags[:-1] or tags))


def _list(lines_of: dict[str, dict[str, None]]) -> str:
    listed = ', '.join(
        f'{shortened(path, 200)} ({next(iter(lines))}'
        + (f' and {len(lines) - 1} more)' if len(lines) > 1 else ')')
        for path, lines in islice(lines_of.items(), MAX_NOTES)
    )
    more = len(lines_of) - MAX_NOTES
    return f'{listed} and {more} more' if more > 0 else listed
