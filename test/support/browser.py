"""A browser without a picture: it opens the window's connection and decodes what comes."""

import html
import re
import struct
import time

import msgspec
import viser
import zstandard
from websockets.sync.client import connect

from .patience import PATIENCE

CAMERA = {
    'type': 'ViewerCameraMessage',
    'wxyz': [1.0, 0.0, 0.0, 0.0],
    'position': [3.0, 3.0, 3.0],
    'fov': 1.0,
    'near': 0.01,
    'far': 1000.0,
    'image_height': 100,
    'image_width': 100,
    'look_at': [0.0, 0.0, 0.0],
    'up_direction': [0.0, 0.0, 1.0],
}


WORDS = '<div class="words'  # begins lines of text
OWN = ('<div class="bar', '<div class="pad', '<style', '<img')  # begins what only lays out


class Browser:
    """Keeps all messages by type, and what is known of each node and control."""

    def __init__(self, address, headers=None):
        self.address = address
        self._connection = connect(
            address.replace('http', 'ws', 1),
            subprotocols=[f'viser-v{viser.__version__}'],
            additional_headers=headers,
            max_size=None,
            open_timeout=PATIENCE,
            ping_interval=None,  # else a ping while it closes may be logged as an error
        )
        self.messages = []
        self.windows = 0  # of messages: what comes at once
        self.nodes = {}  # of the scene: name -> [type, position, wxyz]
        self.owners = {}  # of nodes: '' for those of all browsers
        self.renders = 0  # how many pictures were given
        self.keys = {}  # what is bound to each
        self.idle_keys = set()  # those of them that do nothing now
        self.controls = {}  # uuid -> [type, properties]
        self.parents = {}  # uuid of a control -> that of what it is in
        self.send(CAMERA)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Leave."""
        self._connection.close()

    def send(self, message):
        self._connection.send(msgspec.msgpack.encode(message))

    def tell(self, kind, **fields):
        """Send a message of a type."""
        self.send({'type': kind, **fields})

    def read(self, seconds=0.05):
        """Take in what comes within so many seconds."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            try:
                content = self._connection.recv(timeout=left)
            except TimeoutError:
                return
            unpacked, packed = struct.unpack_from('<QQ', content)
            inner = zstandard.ZstdDecompressor().decompress(
                content[16 : 16 + packed], max_output_size=unpacked
            )
            self.windows += 1
            for message in msgspec.msgpack.decode(inner)['messages']:
                self.messages.append(message)
                self._take(message)

    def wait_until(self, condition, timeout=PATIENCE):
        """Read until the condition holds; one on what the page lacks does not hold yet."""
        end = time.monotonic() + timeout
        while True:
            try:
                holds, lacks = condition(), None
            except LookupError as error:
                holds, lacks = False, error
            if holds:
                return
            if time.monotonic() >= end:
                raise AssertionError('it did not come true') from lacks
            self.read()

    def click(self, label):
        """Press the button of that label."""
        self.choose(label, True)

    def hold(self, label):
        """Be holding the button of that label, once."""
        self.wait_until(lambda: self.control(label))
        self.tell('GuiButtonHoldMessage', uuid=self.control(label), frequency=10.0)

    def press(self, key):
        """Press a key, when it does something."""
        self.wait_until(lambda: key in self.keys)
        self.tell('CommandTriggerMessage', uuid=self.keys[key])

    def choose(self, label, value):
        """Set the value of a control, when there is one of that label."""
        self.wait_until(lambda: self.control(label))
        self.update(self.control(label), value)

    def update(self, number, value):
        """Set the value of the control of that number."""
        self.tell('GuiUpdateMessage', uuid=number, updates={'value': value})

    def look_at(self, point, position=CAMERA['position']):
        """Turn the camera to a point, or move it, too."""
        self.send({**CAMERA, 'look_at': point, 'position': position})

    def click_node(self, name):
        """Click on a node of the scene, when it is there."""
        self.wait_until(lambda: name in self.nodes)
        self.tell(
            'SceneNodeClickMessage',
            name=name,
            instance_index=None,
            ray_origin=[0.0, 0.0, 0.0],
            ray_direction=[1.0, 0.0, 0.0],
            screen_pos=[0.5, 0.5],
            modifier=None,
            owner='',
        )

    def drag_node(self, name, phase, position, owner=''):
        """Begin, go on or end to drag a node of the scene, by the phase's name, to a position."""
        self.tell(
            'SceneNodeDragMessage',
            phase=phase,
            name=name,
            instance_index=None,
            start_position=position,
            start_screen_pos=[0.5, 0.5],
            end_position=position,
            end_screen_pos=[0.5, 0.5],
            button='left',
            modifier=None,
            owner=owner,
        )

    def grab(self, node):
        """Begin to drag a handle of the scene."""
        self._send_of_handle('TransformControlsDragStartMessage', node)

    def drag(self, node, position):
        """Drag it to a position."""
        self._send_of_handle(
            'TransformControlsUpdateMessage', node, wxyz=[1.0, 0.0, 0.0, 0.0], position=position
        )

    def let_go(self, node):
        """Let it go."""
        self._send_of_handle('TransformControlsDragEndMessage', node)

    def _send_of_handle(self, kind, node, **more):
        self.tell(kind, name=node, owner=self.owners.get(node, ''), **more)

    def click_ray(self, origin, direction):
        """Click where a ray goes."""
        self.tell(
            'ScenePointerMessage',
            event_type='click',
            ray_origin=origin,
            ray_direction=direction,
            screen_pos=[[0.5, 0.5]],
            modifier=None,
        )

    def upload(self, label, name, content, claimed=None):
        """Upload a file in parts of 1000 bytes, or of as many bytes as claimed."""
        parts = [content[n : n + 1000] for n in range(0, len(content), 1000)]
        self.begin_file(label, name, claimed or len(content), len(parts))
        for number, part in enumerate(parts):
            self.send_part(label, name, number, part)

    def begin_file(self, label, name, size, count):
        """Begin a file of so many bytes in so many parts."""
        self.tell(
            'FileTransferStartUpload',
            source_component_uuid=self.control(label),
            transfer_uuid=name,
            filename=name,
            mime_type='',
            part_count=count,
            size_bytes=size,
        )

    def send_part(self, label, name, index=0, content=b'x'):
        """Send a part of it."""
        self.tell(
            'FileTransferPart',
            source_component_uuid=self.control(label),
            transfer_uuid=name,
            part_index=index,
            content=content,
        )

    def received(self, kind):
        """Return the messages of a type that have come."""
        return [message for message in self.messages if message['type'] == kind]

    def notes(self):
        """Return what the page has notified of."""
        return [message['props']['title'] for message in self.received('NotificationShowMessage')]

    def noted(self, part):
        """Tell whether one of the notices has a text in it."""
        return any(part in note for note in self.notes())

    def answer_render(self, content):
        """Give the picture that is asked for, the bytes of a JPEG or PNG; tell if there is one."""
        asked = self.received('GetRenderRequestMessage')
        if len(asked) == self.renders:
            return False
        self.renders = len(asked)
        number = asked[-1]['render_uuid']
        self.tell('GetRenderResponseMessage', payload=content, render_uuid=number)
        return True

    def download(self):
        """Return name and content of the file that came last; None if there is none yet."""
        started = self.received('FileTransferStartDownload')
        if not started:
            return None
        parts = [
            message['content']
            for message in self.received('FileTransferPart')
            if message['transfer_uuid'] == started[-1]['transfer_uuid']
        ]
        is_whole = len(parts) == started[-1]['part_count']
        return (started[-1]['filename'], b''.join(parts)) if is_whole else None

    def control(self, label):
        """Return the number of the control of that label; None if there is none."""
        return next(
            (uuid for uuid, (_, props) in self.controls.items() if props.get('label') == label),
            None,
        )

    def texts(self):
        """Return the texts that are shown, with spaces between what a table has."""
        return [
            html.unescape(re.sub('<[^>]*>', ' ', content.replace('<br>', '\n'))).strip()
            for content in self.contents()
            if content.startswith(WORDS)
        ]

    def shows(self, part):
        """Tell whether one of these texts has another in it."""
        return any(part in text for text in self.texts())

    def view(self):
        """Return eye and target that the page has told the camera last."""
        eyes = self.received('SetCameraPositionMessage')
        return eyes[-1]['position'], self.received('SetCameraLookAtMessage')[-1]['look_at']

    def tables(self):
        """Return the HTML that is shown of what is selected, in one."""
        return ''.join(
            content for content in self.contents() if not content.startswith((WORDS, *OWN))
        )

    def contents(self):
        """Return the HTML of what is shown, as it was sent."""
        return [
            props['content']
            for kind, props in self.controls.values()
            if kind == 'GuiHtmlMessage' and props.get('visible', True)
        ]

    def value(self, label):
        """Return the value of the control of that label."""
        return self.props(label)['value']

    def props(self, label):
        """Return the properties of the control of that label."""
        return self.controls[self.control(label)][1]

    def _take(self, message):
        kind, name = message['type'], message.get('name')
        if kind == 'RegisterCommandMessage':
            self.keys[message['props']['hotkey']] = message['uuid']
            self._enable(message['uuid'], message['props'])
        elif kind == 'CommandUpdateMessage':
            self._enable(message['uuid'], message['updates'])
        elif kind == 'GuiUpdateMessage' and message['uuid'] in self.controls:
            self.controls[message['uuid']][1].update(message['updates'])
        elif kind == 'GuiRemoveMessage':
            self.controls.pop(message['uuid'], None)
        elif kind.startswith('Gui') and 'props' in message:
            self.parents[message['uuid']] = message.get('container_uuid')
            self.controls[message['uuid']] = [
                kind,
                message['props'] | {'value': message.get('value')},
            ]
        elif name is not None and not message.get('virtual'):  # else it is there for what is below
            self._take_node(kind, name, message)

    def _take_node(self, kind, name, message):
        owner = message.get('owner', '')
        is_shown = self.owners.get(name) == owner  # not hidden by that of another owner
        if kind == 'RemoveSceneNodeMessage':
            self.nodes = {
                node: state
                for node, state in self.nodes.items()
                if self.owners[node] != owner or (node != name and not node.startswith(f'{name}/'))
            }
        elif kind == 'SetPositionMessage' and name in self.nodes and is_shown:
            self.nodes[name][1] = message['position']
        elif kind == 'SetOrientationMessage' and name in self.nodes and is_shown:
            self.nodes[name][2] = message['wxyz']
        elif 'props' in message and kind != 'SceneNodeUpdateMessage':
            self.nodes[name] = [kind, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]
            self.owners[name] = owner

    def _enable(self, uuid, told):
        if 'disabled' in told:
            keys = {key for key, command in self.keys.items() if command == uuid}
            self.idle_keys = self.idle_keys | keys if told['disabled'] else self.idle_keys - keys
