"""A small car of boxes and cylinders: four driven wheels, each on a steered carrier."""

RADIUS, BASE, TRACK = 0.05, 0.3, 0.2  # [m]
SIDES = ('front_left', 1, 1), ('front_right', 1, -1), ('rear_left', -1, 1), ('rear_right', -1, -1)


def _link(name, mass, moment, shape='', origin=''):
    collision = f'<collision>{origin}<geometry>{shape}</geometry></collision>' if shape else ''
    return (
        f'<link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{moment}" ixy="0" '
        f'ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial>{collision}</link>'
    )


def transmission(joint, interface):
    """Return a simple transmission of a joint with an interface: Effort, Position or Velocity."""
    return (
        f'<transmission name="{joint}_t"><type>transmission_interface/SimpleTransmission</type>'
        f'<joint name="{joint}"><hardwareInterface>hardware_interface/{interface}JointInterface'
        f'</hardwareInterface></joint><actuator name="{joint}_m"/></transmission>'
    )


def car(steered=('front_left', 'front_right'), driven=('rear_left', 'rear_right'), mu=1.0):
    """Return the URDF of a car; wheels that are neither driven nor steered roll freely."""
    parts = [_link('base_link', 3.0, 0.02, '<box size="0.3 0.14 0.06"/>')]
    for name, ahead, left in SIDES:
        x, y = ahead * BASE / 2.0, left * TRACK / 2.0
        parent, place = 'base_link', f'{x} {y} 0'
        if name in steered:
            parts.append(_link(f'{name}_carrier', 0.2, 0.001))
            parts.append(
                f'<joint name="{name}_steer" type="revolute"><parent link="base_link"/>'
                f'<child link="{name}_carrier"/><origin xyz="{place}"/><axis xyz="0 0 1"/>'
                '<limit lower="-1" upper="1" effort="20" velocity="5"/></joint>'
            )
            parts.append(transmission(f'{name}_steer', 'Position'))
            parent, place = f'{name}_carrier', '0 0 0'
        parts.append(
            _link(
                f'{name}_wheel',
                0.2,
                0.0003,
                f'<cylinder radius="{RADIUS}" length="0.02"/>',
                '<origin rpy="1.5707963 0 0"/>',
            )
        )
        parts.append(
            f'<joint name="{name}_joint" type="continuous"><parent link="{parent}"/>'
            f'<child link="{name}_wheel"/><origin xyz="{place}"/><axis xyz="0 1 0"/>'
            '<limit effort="5" velocity="100"/></joint>'
            f'<gazebo reference="{name}_wheel"><mu1>{mu}</mu1><mu2>{mu}</mu2></gazebo>'
        )
        if name in driven:
            parts.append(transmission(f'{name}_joint', 'Velocity'))
    return (
        '<robot name="car">' + ''.join(parts) + '<gazebo><plugin name="control" '
        'filename="libgazebo_ros_control.so"/></gazebo></robot>'
    )
