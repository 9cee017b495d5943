"""Files on their way from browsers: few, small, and dropped when their browser goes."""

import time
from dataclasses import dataclass, field

from ..controls import plain
from .client_messages import MalformedError, Message, RefusedError

MAX_BYTES = 10_000_000  # of a file
MAX_PARTS = 20_000
OF_ONE, IN_ALL = 2, 6  # files at once, of a browser and of all
PATIENCE = 30.0  # [s, wall] without a part after which a file makes room for another


@dataclass
class Upload:
    """A file, of which parts may be missing."""

    owner: object
    button: str  # its number
    name: str
    size: int
    count: int  # of its parts
    parts: dict[int, bytes] = field(default_factory=dict)
    received: int = 0  # bytes
    newest: float = 0.0  # when a part came last [s, monotonic]

    @property
    def is_whole(self) -> bool:
        """Tell whether no part is missing."""
        return len(self.parts) == self.count

    @property
    def content(self) -> bytes:
        """Return the bytes of a file that is whole."""
        return b''.join(self.parts[number] for number in range(self.count))


class Uploads:
    """Collects the parts of files; not thread-safe."""

    def __init__(self) -> None:
        self._running: dict[str, Upload] = {}

    def __len__(self) -> int:
        return len(self._running)

    def start(self, owner: object, message: Message) -> Upload:
        """Begin a file; one without parts is whole.

        Raises:
            RefusedError: it is too large, or there are too many.
        """
        name = plain(message.filename)
        if not (0 <= message.part_count <= MAX_PARTS and message.size_bytes >= 0) or (
            message.transfer_uuid in self._running
        ):
            raise MalformedError('This is no file of the page.')
        if message.size_bytes > MAX_BYTES:
            raise RefusedError(_too_large(name))
        now = time.monotonic()
        self._running = {
            key: one for key, one in self._running.items() if now - one.newest < PATIENCE
        }
        mine = sum(one.owner is owner for one in self._running.values())
        if mine >= OF_ONE or len(self._running) >= IN_ALL:
            raise RefusedError(
                f"'{name}' is not uploaded: {OF_ONE} files of a browser and "
                f'{IN_ALL} of all are taken at once; wait for them'
            )
        upload = Upload(
            owner,
            message.source_component_uuid,
            name,
            message.size_bytes,
            message.part_count,
            newest=now,
        )
        if not upload.is_whole:
            self._running[message.transfer_uuid] = upload
        return upload

    def add(self, owner: object, message: Message) -> Upload | None:
        """Add a part; return its file, None for one that was refused.

        Raises:
            RefusedError: the file has more bytes than it is to have.
        """
        upload = self._running.get(message.transfer_uuid)
        if upload is None or upload.owner is not owner:
            return None
        if not 0 <= message.part_index < upload.count or message.part_index in upload.parts:
            raise MalformedError('This is no part of the file.')
        upload.parts[message.part_index] = message.content
        upload.received += len(message.content)
        upload.newest = time.monotonic()
        if upload.received > upload.size or (upload.is_whole and upload.received < upload.size):
            del self._running[message.transfer_uuid]
            raise RefusedError(
                _too_large(upload.name)
                if upload.received > MAX_BYTES
                else f"'{upload.name}' has {upload.received} bytes of the {upload.size} that were "
                'announced; upload it again'
            )
        if upload.is_whole:
            del self._running[message.transfer_uuid]
        return upload

    def leave(self, owner: object) -> None:
        """Drop the files of a browser that has disconnected."""
        self._running = {key: one for key, one in self._running.items() if one.owner is not owner}


def _too_large(name: str) -> str:
    return f"'{name}' has more than {MAX_BYTES} bytes, which no description needs"
