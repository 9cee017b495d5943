"""Elements of a URDF, as text."""


def inertial(mass=1.0, moment=1.0):
    """Return the <inertial> of a ball."""
    return (
        f'<inertial><mass value="{mass}"/><inertia ixx="{moment}" iyy="{moment}" izz="{moment}" '
        'ixy="0" ixz="0" iyz="0"/></inertial>'
    )


INERTIAL = inertial()


def link(name, inside=INERTIAL):
    """Return a <link>, of 1 kg unless something else is in it."""
    return f'<link name="{name}">{inside}</link>'


def joint(name, parent, child, kind='continuous', inside=''):
    """Return a <joint>."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/>{inside}</joint>'
    )
