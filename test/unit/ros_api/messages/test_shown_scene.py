"""What a window shows arrives as it was sent."""

from rosbots_description.ros_api.messages import (
    contacts_message,
    motion_message,
    read_contacts,
    read_motion,
    scene_change,
    scene_message,
)
from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import (
    SPOT,
    Box,
    Collision,
    Cylinder,
    Inertial,
    JointSpec,
    LightSpec,
    Mesh,
    Plane,
    SceneChange,
    SceneSpec,
    ShownContact,
    ShownLink,
    ShownModel,
    ShownMotion,
    ShownSensor,
    Sphere,
    Surface,
    Visual,
    gazebo_material,
)

POSE = Pose((1.0, -2.0, 1e-9), (0.5, 0.5, -0.5, 0.5))


def test_a_change_arrives_as_it_was_sent():
    shapes = (
        Box((1.0, 2.0, 3.0)),
        Sphere(0.1),
        Cylinder(0.1, 2.0),
        Plane(),
        Mesh('/ä b.dae', (1.0, 1.0, -1.0), 'package://p/ä b.dae'),
    )
    visuals = tuple(
        Visual(f'"{n}"', shape, POSE, gazebo_material('Gazebo/Red') if n else None)
        for n, shape in enumerate(shapes)
    )
    whole = ShownLink(
        7,
        'l',
        POSE,
        visuals,
        (Collision('c', shapes[0], POSE, Surface(0.5)),),
        Inertial(2.0, POSE, 1.0),
        False,
        (ShownSensor('s', 'ray', POSE),),
    )
    joint = JointSpec('j', 'revolute', 'l', 'm', POSE, lower=-1.0)
    change = SceneChange(
        True,
        (ShownModel('a/b::c', (whole, ShownLink(8, 'm', POSE)), (joint,), True, POSE),),
        ('gone',),
        {'class': LightSpec('lamp', SPOT, POSE, cast_shadows=True)},
        SceneSpec(background=(0.0, 0.1, 0.2, 1.0), user_camera=POSE),
        0.002,
        0.0,
        '"kitchen"',
    )
    assert scene_change(scene_message(change)) == change


def test_contacts_arrive_as_they_were_sent():
    contacts = [
        ShownContact((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), (0.0, 0.1, 9.8)),
        ShownContact((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (-5.0, 0.0, 0.0)),
    ]
    assert read_contacts(contacts_message(contacts)) == contacts


def test_a_motion_arrives_as_it_was_sent():
    motion = ShownMotion(1e6 + 0.001, 2.5, 2**40 + 1, True, {3: POSE, 2**24 + 1: Pose()})
    assert read_motion(motion_message(motion)) == motion
