"""How a world looks, and from where a window shows it."""

from lxml import etree

from ...core import Pose
from ...description import SceneSpec
from .document import SdfDocument
from .values import boolean_of, colour_of, pose_in

READ_OF_SCENE = ('ambient', 'background', 'shadows')


def read_scene(document: SdfDocument, world: etree._Element) -> SceneSpec:
    """Return the <scene> of a world; the default if there is none.

    Raises:
        ModelError: a number is wrong.
    """
    element = world.find('scene')
    if element is None:
        return SceneSpec()
    document.notes.check(element, READ_OF_SCENE, ('grid', 'sky', 'fog', 'origin_visual'))
    plain = SceneSpec()
    return SceneSpec(
        colour_of(element, 'ambient') or plain.ambient,
        colour_of(element, 'background') or plain.background,
        boolean_of(element, 'shadows', plain.shadows),
    )


def read_user_camera(document: SdfDocument, world: etree._Element) -> Pose | None:
    """Return the pose of <gui><camera>, x forward, in the world; None if there is none.

    Raises:
        ModelError: a number is wrong.
    """
    gui = world.find('gui')
    if gui is None:
        return None
    document.notes.check(gui, ('camera',), ('plugin',))
    camera = gui.find('camera')
    if camera is None:
        return None
    document.notes.check(camera, ('pose',), ('view_controller', 'projection_type', 'track_visual'))
    pose = camera.find('pose')
    return None if pose is None else pose_in(pose)
