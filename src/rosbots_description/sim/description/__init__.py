"""Models and worlds as frozen values, complete and checked, in SI units."""

from .built_in import GROUND_PLANE, SUN
from .element import Element, PluginSpec
from .materials import gazebo_material, material_of_colours
from .model_spec import (
    FIXED,
    PRISMATIC,
    REVOLUTE,
    WORLD,
    Box,
    Collision,
    Colour,
    Cylinder,
    Geometry,
    Inertial,
    JointSpec,
    LinkSpec,
    Material,
    Mesh,
    ModelSpec,
    Plane,
    Reflection,
    Sphere,
    Surface,
    Visual,
)
from .model_text import ModelText
from .physics_settings import PhysicsSettings, check_physics
from .robot_control import (
    CONTINUOUS,
    CommandTopic,
    ControlledJoint,
    Mimic,
    RobotControl,
    SoftLimits,
    Transmission,
)
from .sensor_spec import SensorSpec
from .shown_reading import ShownGrid, ShownReading
from .shown_scene import (
    SceneChange,
    ShownContact,
    ShownLink,
    ShownModel,
    ShownMotion,
    ShownSensor,
)
from .world_spec import (
    DIRECTIONAL,
    POINT,
    SPOT,
    LightSpec,
    ModelState,
    SceneSpec,
    WorldSpec,
)

__all__ = [
    'CONTINUOUS', 'DIRECTIONAL', 'FIXED', 'GROUND_PLANE', 'POINT', 'PRISMATIC', 'REVOLUTE', 'SPOT',
    'SUN', 'WORLD', 'Box', 'Collision', 'Colour', 'CommandTopic', 'ControlledJoint', 'Cylinder',
    'Element', 'Geometry', 'Inertial', 'JointSpec', 'LightSpec', 'LinkSpec', 'Material', 'Mesh',
    'Mimic', 'ModelSpec', 'ModelState', 'ModelText', 'PhysicsSettings', 'Plane', 'PluginSpec',
    'Reflection', 'RobotControl', 'SceneChange', 'SceneSpec', 'SensorSpec', 'ShownContact',
    'ShownGrid', 'ShownLink', 'ShownModel', 'ShownMotion', 'ShownReading', 'ShownSensor',
    'SoftLimits', 'Sphere', 'Surface', 'Transmission', 'Visual', 'WorldSpec', 'check_physics',
    'gazebo_material', 'inertia', 'material_of_colours',
]
