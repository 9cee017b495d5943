"""A scene in PyBullet alone, as one number by which builds of PyBullet are compared.

Prints that number and the seconds that it took. For another build, put its module first:
    PYTHONPATH=FOLDER:test python3 -m support.bullet_bits
Four robots with two driven wheels and a caster wheel each, of cylinders and spheres, drive and turn
among a mesh, boxes that fall over each other, and a pendulum on two hinges with a torque sensor.
"""

import hashlib
import itertools
import struct
import sys
import tempfile
import time
from pathlib import Path

STEPS = 4000  # of 1 ms
EVERY = 10  # steps between readings
ROCK = ((1.0, 0.0, 0.0), (-1.0, 0.1, 0.0), (0.0, 1.1, 0.0), (0.05, -1.0, 0.0), (0.0, 0.1, 0.4))
ROCK_FACES = ((0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 3), (2, 3, 1))


def robot(bullet, client, x, y):
    """Add a robot: a box on two wheels, joints 0 and 1, and a ball."""
    body = client.createCollisionShape(bullet.GEOM_BOX, halfExtents=(0.25, 0.2, 0.05))
    wheel = client.createCollisionShape(bullet.GEOM_CYLINDER, radius=0.12, height=0.04)
    ball = client.createCollisionShape(bullet.GEOM_SPHERE, radius=0.06)
    lying = (0.7071067811865476, 0.0, 0.0, 0.7071067811865476)
    number = client.createMultiBody(
        4.0,
        body,
        -1,
        (x, y, 0.2),
        (0.0, 0.0, 0.05, 0.9987),
        linkMasses=(0.4, 0.4, 0.1),
        linkCollisionShapeIndices=(wheel, wheel, ball),
        linkVisualShapeIndices=(-1, -1, -1),
        linkPositions=((0.1, 0.23, -0.05), (0.1, -0.23, -0.05), (-0.2, 0.0, -0.1)),
        linkOrientations=(lying, lying, (0.0, 0.0, 0.0, 1.0)),
        linkInertialFramePositions=((0.0, 0.0, 0.0),) * 3,
        linkInertialFrameOrientations=((0.0, 0.0, 0.0, 1.0),) * 3,
        linkParentIndices=(0, 0, 0),
        linkJointTypes=(bullet.JOINT_REVOLUTE, bullet.JOINT_REVOLUTE, bullet.JOINT_FIXED),
        linkJointAxis=((0.0, 0.0, 1.0),) * 3,
    )
    client.changeDynamics(number, 2, lateralFriction=0.0)
    return number


def pendulum(bullet, client):
    """Add two rods that swing from a fixed one."""
    rod = client.createCollisionShape(bullet.GEOM_CAPSULE, radius=0.03, height=0.4)
    number = client.createMultiBody(
        0.0,
        -1,
        -1,
        (0.0, 3.0, 1.5),
        linkMasses=(1.0, 0.5),
        linkCollisionShapeIndices=(rod, rod),
        linkVisualShapeIndices=(-1, -1),
        linkPositions=((0.1, 0.0, 0.0), (0.0, 0.0, -0.5)),
        linkOrientations=((0.0, 0.6, 0.0, 0.8), (0.0, 0.0, 0.0, 1.0)),
        linkInertialFramePositions=((0.0, 0.0, -0.25),) * 2,
        linkInertialFrameOrientations=((0.0, 0.0, 0.0, 1.0),) * 2,
        linkParentIndices=(0, 1),
        linkJointTypes=(bullet.JOINT_REVOLUTE,) * 2,
        linkJointAxis=((0.0, 1.0, 0.0),) * 2,
    )
    client.enableJointForceTorqueSensor(number, 1)
    return number


def obstacles(bullet, client, folder):
    """Add the ground, a rock as a mesh, and a heap of boxes; return the boxes."""
    client.createMultiBody(0.0, client.createCollisionShape(bullet.GEOM_PLANE))
    lines = ['v {} {} {}'.format(*corner) for corner in ROCK]
    lines += ['f {} {} {}'.format(*(number + 1 for number in face)) for face in ROCK_FACES]
    file = Path(folder) / 'rock.obj'
    file.write_text('\n'.join(lines) + '\n', encoding='utf-8')
    rock = client.createCollisionShape(
        bullet.GEOM_MESH, fileName=str(file), flags=bullet.GEOM_FORCE_CONCAVE_TRIMESH
    )
    client.createMultiBody(0.0, rock, -1, (2.0, 0.0, 0.0))
    box = client.createCollisionShape(bullet.GEOM_BOX, halfExtents=(0.1, 0.1, 0.1))
    return [
        client.createMultiBody(0.5, box, -1, (-2.0 + 0.04 * i, 0.03 * i, 0.15 + 0.25 * i))
        for i in range(6)
    ]


def readings(client, bodies):
    """Return all numbers of the scene: poses, velocities, joints, contacts, rays."""
    found = [float(len(client.getContactPoints()))]
    for body in bodies:
        found += itertools.chain(
            *client.getBasePositionAndOrientation(body), *client.getBaseVelocity(body)
        )
        for joint in range(client.getNumJoints(body)):
            angle, speed, reaction, torque = client.getJointState(body, joint)
            found += [angle, speed, *reaction, torque]
    ends = [(6.0, 0.25 * i - 6.0, 0.3) for i in range(50)]
    rays = client.rayTestBatch([(-6.0, 0.1, 0.2)] * len(ends), ends)
    return found + [number for ray in rays for number in (float(ray[0]), ray[2], *ray[3])]


def bits(bullet):
    """Return the hash of all readings while the scene moves."""
    client = Client(bullet)
    try:
        client.setTimeStep(0.001)
        client.setGravity(0.0, 0.0, -9.8)
        with tempfile.TemporaryDirectory() as folder:
            boxes = obstacles(bullet, client, folder)
        robots = [robot(bullet, client, -0.5 * i, 0.8 * i - 1.2) for i in range(4)]
        digest = hashlib.sha256()
        bodies = [*boxes, *robots, pendulum(bullet, client)]
        for step in range(STEPS):
            if step % 500 == 0:
                for i, number in enumerate(robots):
                    speed = 3.0 + i + step / 1000.0
                    for joint, factor in ((0, 1.0), (1, 0.6 if step % 1000 else 1.1)):
                        client.setJointMotorControl2(
                            number,
                            joint,
                            bullet.VELOCITY_CONTROL,
                            targetVelocity=factor * speed,
                            force=5.0,
                        )
            client.stepSimulation()
            if step % EVERY == 0:
                numbers = readings(client, bodies)
                digest.update(struct.pack(f'<{len(numbers)}d', *numbers))
        return digest.hexdigest()
    finally:
        client.disconnect()


class Client:
    """PyBullet's functions, for one world."""

    def __init__(self, bullet):
        """Open a world without a window."""
        self._bullet, self._number = bullet, bullet.connect(bullet.DIRECT)

    def __getattr__(self, name):
        """Return a function of PyBullet that acts in this world."""
        function = getattr(self._bullet, name)
        return lambda *values, **named: function(*values, **named, physicsClientId=self._number)


def main():
    """Print the hash of the PyBullet that is first on the path."""
    import pybullet

    start = time.process_time()
    print(bits(pybullet), f'{time.process_time() - start:.1f} s', pybullet.__file__)


if __name__ == '__main__':
    sys.exit(main())
