"""What can be inserted: models of the model path, robot descriptions on parameters, and files."""

import rospy
from rosbots_msgs.srv import GetModelLibrary

from ...sim.core import SimError
from ...sim.description import LightSpec, ModelSpec, ModelText
from ...sim.formats import sdf_of_include, sdf_of_light, sdf_of_model
from ...sim.resources import MAX_XML_BYTES, root_tag, text_of_upload
from ..transport import NO_MASTER
from .calls import call
from .xacro_sandbox import expanded


class RosLibrary:
    """What can be inserted; a fault is a SimError with a sentence."""

    def __init__(self) -> None:
        self._urdf: dict[str, bool] = {}  # whether a parameter holds one, by its name

    def models(self) -> list[str]:
        """Return the names of the models along the simulator's model path; [] if unknown."""
        try:
            return list(call('get_model_library', GetModelLibrary).model_names)
        except SimError:
            return []

    def parameters(self) -> list[str]:
        """Return the names of parameters that hold a URDF; [] if unknown.

        Each is read once, when its name is new.
        """
        try:
            names = rospy.get_param_names()
            self._urdf = {
                name: self._urdf[name] if name in self._urdf else _holds_urdf(name)
                for name in names
            }
        except NO_MASTER:
            return []
        return sorted(name for name, holds in self._urdf.items() if holds)

    def model(self, name: str) -> ModelText:
        """Return a model of the model path."""
        return ModelText(name, sdf_of_include(f'model://{name}'))

    def parameter(self, name: str) -> ModelText:
        """Return what a parameter holds, in the namespace of the parameter."""
        try:
            text = rospy.get_param(name)
        except (KeyError, *NO_MASTER):
            raise SimError(f'the parameter {name} is not set any more') from None
        if not isinstance(text, str):
            raise SimError(f'the parameter {name} holds no URDF')
        return ModelText('', text, namespace=name.rpartition('/')[0].lstrip('/'))

    def file(self, name: str, content: bytes) -> ModelText:
        """Return a URDF or SDF, or what a xacro file expands to, by the name of the file."""
        if name.lower().endswith('.xacro') and len(content) <= MAX_XML_BYTES:
            content = expanded(name, content)
        return ModelText('', text_of_upload(name, content, 'URDF, xacro or SDF'))

    def shape(self, spec: ModelSpec) -> ModelText:
        """Return a model as SDF."""
        return ModelText(spec.name, sdf_of_model(spec))

    def light(self, spec: LightSpec) -> ModelText:
        """Return a light as SDF."""
        return ModelText(spec.name, sdf_of_light(spec))


def _holds_urdf(parameter: str) -> bool:
    value = rospy.get_param(parameter, None)
    return isinstance(value, str) and root_tag(value) == 'robot'
