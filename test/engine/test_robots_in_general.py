"""What the engine's settings were chosen for: robots and things that are not the article's."""

import pytest
from support.scenes import SCENES

# The largest error of each scene, in its unit; measured ones are in doc/physics.md.
BOUNDS = {
    'one dragging caster': 0.002,
    'two casters, mu 1': 0.02,
    'two casters, mu 0.1': 0.002,
    '50 kg': 0.002,
    '0.2 kg': 0.002,
    'veer, one caster': 0.01,
    'veer, two casters': 0.01,
    'veer, 0.2 kg': 0.01,
    'veer, broad wheels': 0.01,
    "veer, the article's": 0.01,
    'skid steer straight': 0.002,
    'step of 3 cm [m]': 0.0,
    'parked on casters [m]': 1e-4,
    'parked on wheels [m]': 3e-4,
    'slides on 10 deg': 1e-3,
    'five boxes [m]': 1e-3,
    'half sunk box [m]': 0.15,
    'ball rolls': 1e-3,
}
SKID_TURNS = (0.5, 1.0)  # share of the rate without slip


def test_every_scene_is_looked_at():
    assert set(SCENES) == {*BOUNDS, 'skid steer turns'}


@pytest.mark.parametrize('name', BOUNDS)
def test_mechanics_is_obeyed(name):
    assert SCENES[name]() <= BOUNDS[name]


def test_a_skid_steer_turns_though_its_wheels_slip():
    least, most = SKID_TURNS
    assert least < SCENES['skid steer turns']() < most
