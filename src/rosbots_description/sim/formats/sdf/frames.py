"""Resolve the poses of a model or world, each of which may be given in another frame."""

from dataclasses import dataclass

from lxml import etree

from ...core import IDENTITY, AbsentError, Pose, compose, fault, suggestion
from ..xml import tag_of
from .values import pose_in

MODEL_FRAME = '__model__'


@dataclass(frozen=True)
class _Frame:
    element: etree._Element  # the element of that name, for messages
    pose: Pose  # in `base`
    base: str  # name of another frame; '' for the root
    carrier: str | None  # the frame it is attached to; None for a link


class Frames:
    """The named frames of one model, or of a world, each posed in another or in the root.

    All results are in the root: the model's own frame, or the world.
    """

    def __init__(self, *root_names: str) -> None:
        self._roots = {'', *root_names}
        self._frames: dict[str, _Frame] = {}
        self._known: dict[str, Pose] = {}

    def add(
        self,
        name: str,
        element: etree._Element,
        base: str = '',
        carrier: str | None = None,
        pose_element: etree._Element | None = None,
    ) -> None:
        """Add a frame by its <pose>; if a name occurs twice, the first counts.

        Args:
            base: the frame in which its pose is given, unless the pose names another.
            carrier: the frame that it is attached to; None if it is a link itself.
            pose_element: the <pose>, if it is not that of `element`.
        """
        pose = element.find('pose') if pose_element is None else pose_element
        frame = _Frame(element, pose_in(pose), _base_of(pose, base), carrier)
        self._frames.setdefault(name, frame)

    def add_at(self, name: str, element: etree._Element, pose: Pose, base: str) -> None:
        """Add a link by its pose in `base`."""
        self._frames.setdefault(name, _Frame(element, pose, base, None))

    def pose_of(self, name: str, element: etree._Element) -> Pose:
        """Return the pose of a frame.

        Raises:
            ModelError: there is no such frame, or frames are posed in a loop; it names `element`.
        """
        chain: list[tuple[str, _Frame]] = []
        seen: set[str] = set()
        while name not in self._known and not self._is_root(name):
            frame = self._find(name, element)
            if name in seen:
                raise fault(
                    frame.element, f"'{name}' is posed relative to itself, in a loop of frames"
                )
            seen.add(name)
            chain.append((name, frame))
            name, element = frame.base, frame.element
        pose = self._known.get(name, IDENTITY)
        for frame_name, frame in reversed(chain):
            pose = self._known[frame_name] = compose(pose, frame.pose)
        return pose

    def place(self, element: etree._Element, base: str = '') -> Pose:
        """Return the pose of an element, given in `base` unless its <pose> names another frame.

        Raises:
            ModelError: as `pose_of`.
        """
        pose = element.find('pose')
        at = element if pose is None else pose
        return compose(self.pose_of(_base_of(pose, base), at), pose_in(pose))

    def link_of(self, name: str, element: etree._Element) -> str:
        """Return the link that a frame is attached to.

        Raises:
            AbsentError: there is no such frame.
            ModelError: it is attached to none, or frames form a loop.
        """
        seen: list[str] = []
        while True:
            frame = self._find(name, element)
            if frame.carrier is None:
                return name
            seen.append(name)
            if frame.carrier in seen:
                raise fault(element, f"'{seen[0]}' is attached to itself, in a loop of frames")
            if frame.carrier in self._roots:
                raise fault(element, f"'{seen[0]}' is attached to no link; name a link")
            name = frame.carrier

    def _find(self, name: str, element: etree._Element) -> _Frame:
        frame = self._frames.get(name)
        if frame is None:
            raise fault(
                element,
                f"<{tag_of(element)}> names '{name}', but there is no such link, joint or frame"
                f'{suggestion(name, self._frames)}',
                AbsentError,
            )
        return frame

    def _is_root(self, name: str) -> bool:
        return name in self._roots and name not in self._frames


def is_posed_elsewhere(pose: etree._Element | None) -> bool:
    """Tell whether a <pose> names the frame in which it is given."""
    return bool(_base_of(pose, ''))


def _base_of(pose: etree._Element | None, default: str) -> str:
    """Return the frame in which a <pose> is given: `relative_to`, or `frame` before SDF 1.7."""
    if pose is None:
        return default
    return pose.get('relative_to') or pose.get('frame') or default
