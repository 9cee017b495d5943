"""Import xacro 1.13 so that its documents can be written under Python 3.13, too.

On import, xacro replaces minidom's `Element.writexml` by a function that calls minidom's private
`_write_data` with two arguments. Since Python 3.13 it takes three, so that nothing in the process
can write XML by minidom any more. The method is replaced here once more, under every Python, by one
that uses only public names and writes the same text.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING
from xml.dom.minidom import Element, Node
from xml.sax.saxutils import escape

if TYPE_CHECKING:
    from types import ModuleType

    from _typeshed import SupportsWrite


def import_xacro() -> ModuleType:
    """Return the module xacro, whose documents this Python can write.

    Raises:
        ImportError: xacro is not installed.
    """
    xacro = import_module('xacro')
    Element.writexml = _write_element  # type: ignore[assignment, method-assign]
    return xacro


def _write_element(
    element: Element,
    writer: SupportsWrite[str],
    indent: str = '',
    addindent: str = '',
    newl: str = '',
) -> None:
    """Write an element with sorted attributes and without text that is only white space."""
    attributes = ''.join(
        f' {name}="{escape(value, {chr(34): "&quot;"})}"'
        for name, value in sorted(element.attributes.items())
    )
    writer.write(f'{indent}<{element.tagName}{attributes}')
    children = element.childNodes
    if not children:
        writer.write(f'/>{newl}')
    elif len(children) == 1 and children[0].nodeType == Node.TEXT_NODE:
        writer.write('>')
        children[0].writexml(writer)
        writer.write(f'</{element.tagName}>{newl}')
    else:
        writer.write(f'>{newl}')
        for child in children:
            if child.nodeType != Node.TEXT_NODE or child.data.strip():
                child.writexml(writer, indent + addindent, addindent, newl)
        writer.write(f'{indent}</{element.tagName}>{newl}')
