"""Convert the text of an SDF to a `ModelSpec` or a `LightSpec`."""

from lxml import etree

from ...core import Pose, fault
from ...description import LightSpec, ModelSpec
from ...resources import Addresses, FileSearch, FindModel, FindPackage
from ..xml import check_name, initial_pose, inject_namespace
from .document import SdfDocument, SdfLibrary
from .lights import read_light
from .models import ModelParts, model_spec, read_include, read_model
from .values import pose_in


def load_sdf(
    text: str | bytes,
    name: str,
    *,
    source: str = 'model_xml',
    robot_namespace: str = '',
    find_model: FindModel,
    find_package: FindPackage | None = None,
    find_file: FileSearch = FileSearch(),  # noqa: B008 (it is immutable)
) -> tuple[ModelSpec, Pose]:
    """Read and check the first model of an SDF: its <model>, or the <include> of its <world>.

    Args:
        name: of the model; the one in the text is ignored, as in Gazebo.
        source: origin of the text; it begins every message.
        robot_namespace: given to plugins of this text that have no <robotNamespace>.
        find_model: path below the model path -> file or directory, or None, for model://; see
            `ModelSearch`.
        find_package: package name -> its directory, or None if unknown, for package://.
        find_file: for file:// with a relative path.

    Returns:
        The model and its <pose>, that of the <include> for an included model. The caller spawns it
        at compose(initial pose, <pose>).

    Raises:
        ModelError: the description cannot be simulated; the message says where and why.

    What is simulated differently than written is reported as a warning, once per file.
    """
    check_name(name)
    library = SdfLibrary(Addresses(find_model, find_package, find_file))
    document = library.add(text, source)
    inject_namespace(document.root, robot_namespace)
    parts, pose_element = _first_model(document)
    spec = model_spec(parts, name)
    library.report(name)
    return spec, initial_pose(lambda: pose_in(pose_element), name)


def load_sdf_light(text: str | bytes, name: str, *, source: str = 'model_xml') -> LightSpec | None:
    """Return the light that an SDF begins with, under `name`; None if it begins otherwise.

    Raises:
        ModelError: the text is not SDF, or a number of the light is not valid.
    """
    library = SdfLibrary(Addresses(lambda inner: None))
    document = library.add(text, source)
    first = document.root[0] if len(document.root) else None
    if first is None or first.tag.lower() != 'light':
        return None
    check_name(name)
    first.set('name', name)
    light = read_light(document, first, pose_in(first.find('pose')))
    library.report()
    return light


def _first_model(document: SdfDocument) -> tuple[ModelParts, etree._Element | None]:
    root = document.root
    models = root.findall('model')
    if len(models) > 1:
        document.notes.warn(models[1], 'only the first model is spawned')
    if models:
        return read_model(document, models[0]), models[0].find('pose')
    include = root.find('world/include')
    if include is None:
        raise fault(root, 'it has neither a <model> nor a <world> with an <include>')
    return read_include(document, include), include.find('pose')
