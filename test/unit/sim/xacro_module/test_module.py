"""Documents of xacro can be written whatever private functions minidom has."""

import sys
from xml.dom import minidom

from support import LIBRARY
from support.programs import ran

from rosbots_description.sim.xacro_module import import_xacro

TEXT = '<r><!-- why --><a z="1" b="&lt;&quot;&amp;"/>\n\n<t> x &gt; y </t><g>\n<h/></g></r>'


def test_elements_are_written_with_public_names_only(monkeypatch):
    import_xacro()
    element = minidom.parseString('<a z="1" b="&lt;&quot;&amp;"><g>\n <h/></g></a>').documentElement
    monkeypatch.setattr(minidom, '_write_data', None)
    assert element.toxml() == '<a b="&lt;&quot;&amp;" z="1"><g><h/></g></a>'


def test_text_is_indented_without_blank_lines():
    import_xacro()
    assert minidom.parseString(TEXT).documentElement.toprettyxml(indent='  ') == (
        '<r>\n'
        '  <!-- why -->\n'
        '  <a b="&lt;&quot;&amp;" z="1"/>\n'
        '  <t> x &gt; y </t>\n'
        '  <g>\n'
        '    <h/>\n'
        '  </g>\n'
        '</r>\n'
    )


def test_it_makes_no_difference_who_imports_xacro_first():
    program = (
        'import xacro\n'
        'from xml.dom import minidom\n'
        'from rosbots_description.sim.xacro_module import import_xacro\n'
        'assert import_xacro() is xacro\n'
        'del minidom._write_data\n'
        'print(minidom.parseString("<a b=\'1\'/>").documentElement.toxml())\n'
    )
    done = ran(sys.executable, '-c', program, cwd=LIBRARY.parent)
    assert (done.stdout, done.stderr) == ('<a b="1"/>\n', '')
