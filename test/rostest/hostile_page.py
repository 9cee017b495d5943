"""For hostile_names.test: the server that the texts name, their models, a watch on pages."""

import base64
import contextlib
import socket
import threading
from xml.sax.saxutils import quoteattr

import rospy
import zstandard
from support.hostile_texts import HOST, MARK

LINK = """<link name={}><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision name={}><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>"""
# Records whatever the page does not make itself, if only for a moment.
WATCH = """
window.foreign = [];
const tags = 'iframe, object, embed, base, video, audio, form, math, template, marquee, h1, ' +
  'strong, em, del, code, blockquote, .MARK, #MARK, [name=MARK], [src*="HOST"], [href*="HOST"], ' +
  '[data*="HOST"], [href^="javascript"], [onmouseover], [onfocus], [onload], [onerror*=MARK]';
const ours = /MARK|HOST/;
const look = node => {
  if (node.nodeType !== Node.ELEMENT_NODE) return;
  for (const one of [node, ...node.querySelectorAll('*')])
    if (one.matches(tags) || (one.matches('script, style') && ours.test(one.textContent)))
      foreign.push(one.outerHTML.slice(0, 200));
};
new MutationObserver(changes => changes.forEach(change => {
  change.addedNodes.forEach(look);
  if (change.type === 'attributes') look(change.target);
})).observe(document, {childList: true, subtree: true, attributes: true});
""".replace('MARK', MARK).replace('HOST', HOST)
MAGIC = b'\x28\xb5\x2f\xfd'  # of Zstandard


class Listener:
    """The server that the texts name; counts connections, and those that ask for something."""

    def __init__(self):
        self.connections = self.requests = 0
        self._socket = socket.create_server(('127.0.0.1', 0))
        self.port = self._socket.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:
                return
            self.connections += 1
            threading.Thread(target=self._read, args=(connection,), daemon=True).start()

    def _read(self, connection):
        with connection, contextlib.suppress(OSError):
            self.requests += bool(connection.recv(1))

    def close(self):
        self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()


def body(name, of_link):
    """Return a URDF of a model with one link."""
    return f'<robot name={quoteattr(name)}>{link(of_link)}</robot>'


def link(text):
    name = quoteattr(text)
    return LINK.format(name, name)


def arm(texts):
    """Return a URDF of a chain: a link, joint, sensor and plugin for each text."""
    parts = [link('base')]
    for text, parent in zip(texts, ['base', *texts], strict=False):
        name = quoteattr(text)
        parts.append(f"""{link(text)}<joint name={name} type="continuous">
<parent link={quoteattr(parent)}/><child link={name}/><origin xyz="0 0 0.2"/><axis xyz="0 0 1"/>
</joint><gazebo reference={name}><sensor name={quoteattr(f'{text} imu')} type="imu"/>
<sensor name={name} type="sonar"/></gazebo>
<gazebo><plugin name={name} filename={quoteattr(f'{text}.so')}/></gazebo>""")
    return f'<robot name="arm">{"".join(parts)}</robot>'


def topic(text, kind):
    """Return a name that the ROS master accepts, as close to a text as that allows."""
    return rospy.resolve_name(f'/{kind}{text}'.replace(' ', '\t').replace(':', '&colon;'))


def watch(driver, ignores_policy=True):
    """Let a tab record what is foreign to its pages."""
    driver.execute_cdp_cmd('Page.enable', {})
    driver.execute_cdp_cmd('Page.setBypassCSP', {'enabled': ignores_policy})
    driver.execute_cdp_cmd('Page.addScriptToEvaluateOnNewDocument', {'source': WATCH})


def recorded(data):
    """Return the messages of a recording, from the text in its page."""
    packed = base64.b64decode(data)
    return zstandard.ZstdDecompressor().decompressobj().decompress(packed[packed.index(MAGIC) :])
