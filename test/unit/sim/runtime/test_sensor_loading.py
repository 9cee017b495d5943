"""Sensors are loaded with their model; omissions are reported once."""

import pytest
from support.fake_engine import FakeEngine

from rosbots_description.sim import sensors  # noqa: F401  registers
from rosbots_description.sim.core.errors import NotFoundError
from rosbots_description.sim.core.transforms import IDENTITY
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.plugin_registry.gazebo_libraries import PAGE
from rosbots_description.sim.resources.search_path import ModelSearch
from rosbots_description.sim.runtime.world import World

RAY = (
    '<ray><scan><horizontal><samples>{samples}</samples></horizontal></scan>'
    '<range><min>{least}</min><max>{most}</max></range>{more}</ray>'
)


def ray(samples=3, least=0.1, most=5, more=''):
    return RAY.format(samples=samples, least=least, most=most, more=more)


def load(inside, beside=''):
    link = f'<link name="a">{inside}</link>'
    text = f'<sdf version="1.6"><model name="m">{link}{beside}</model></sdf>'
    spec, _ = load_sdf(text, 'bot', source='b.sdf', find_model=ModelSearch())
    return World(make_engine=FakeEngine).spawn(spec, 'bot', IDENTITY)


def sensor(inside, kind='ray', name='s'):
    return f'<sensor name="{name}" type="{kind}">{inside}</sensor>'


def said(caplog):
    return [(record.levelname, record.getMessage()) for record in caplog.records]


def test_sensor_without_a_plugin_is_kept_silently(caplog):
    model = load(sensor(ray()))
    assert model.sensor('s') is model.sensor('a::s') is next(iter(model.sensors.values()))
    assert (model.left_out, caplog.records) == ([], [])


def test_sensor_of_an_unsupported_type_is_kept_and_reported(caplog):
    model = load(sensor('', 'sonar'))
    assert said(caplog) == [
        (
            'WARNING',
            "model 'bot', sonar 's' of link 'a': sensors of this type "
            f'are not simulated yet; see {PAGE}',
        )
    ]
    assert model.left_out == ["sonar 's'"]
    assert not model.sensor('s').measures


@pytest.mark.parametrize(
    ('library', 'level', 'remark'),
    [
        ('prosilica', 'WARNING', '{} is known but not supported yet'),
        ('laserr', 'ERROR', "unknown library '{}'; did you mean 'libgazebo_ros_laser.so'?"),
        ('diff_drive', 'ERROR', '{} works only in a <gazebo> or <model>, not where it stands'),
    ],
)
def test_unavailable_plugin_of_a_sensor_is_reported(library, level, remark, caplog):
    library = f'libgazebo_ros_{library}.so'
    model = load(sensor(f'{ray()}<plugin name="p" filename="{library}"/>'))
    remark = f"model 'bot', ray 's' of link 'a': {remark.format(library)}; see {PAGE}"
    assert said(caplog) == [(level, remark)]
    assert model.left_out == [f"ray 's' ({library})"]


RIGHT_RANGE = (
    'it must begin at 0 or more and end beyond, at most at 3.40282e+38, which is all '
    'that a scan can hold'
)


@pytest.mark.parametrize(
    ('inside', 'sentence'),
    [
        (ray(samples=0), '<samples> is 0; it takes a number from 1 to 1000000'),
        (ray(samples=1e7), '<samples> is 1e+07; it takes a number from 1 to 1000000'),
        (ray(samples='many'), "<samples> is 'many'; it takes a finite number"),
        (ray(samples='nan'), "<samples> is 'nan'; it takes a finite number"),
        (ray(least=2, most=1), f'<range> is from 2 to 1 m; {RIGHT_RANGE}'),
        (ray(least=-1), f'<range> is from -1 to 5 m; {RIGHT_RANGE}'),
        (ray(most='inf'), "<max> is 'inf'; it takes a finite number"),
        (
            ray(more='<noise><type>gaussian</type><stddev>nan</stddev></noise>'),
            "<stddev> is 'nan'; it takes a finite number",
        ),
        (
            ray(more='<noise><type>gaussian</type><stddev>-1</stddev></noise>'),
            '<stddev> of <noise> is -1; it must not be negative',
        ),
        ('', "a <sensor> of type 'ray' without <ray>"),
        (
            ray() + '<update_rate>1e-300</update_rate>',
            '<update_rate> is 1e-300 Hz; it must be at least 0.001, or 0 for every step',
        ),
    ],
)
def test_invalid_sensor_is_left_out_of_the_model(inside, sentence, caplog):
    model = load(sensor(inside))
    ((level, text),) = said(caplog)
    assert level == 'ERROR'
    assert text.startswith("model 'bot', ray 's' of link 'a': ")
    assert text.endswith(f'{sentence}; the model is spawned without it')
    assert model.left_out == ["ray 's'"]
    with pytest.raises(NotFoundError, match="has no sensor 's'; its sensors: none"):
        model.sensor('s')


@pytest.mark.parametrize('rate', ['nan', 'often', ''])
def test_invalid_rate_means_every_step(rate, caplog):
    model = load(sensor(f'{ray()}<update_rate>{rate}</update_rate>'))
    assert model.sensor('s').spec.update_rate == 0.0
    assert f"<update_rate> is '{rate}'; it takes a finite number [Hz]" in caplog.text


def test_sensor_plugin_does_not_run_in_a_model(caplog):
    load('', '<plugin name="p" filename="libgazebo_ros_laser.so"/>')
    assert 'libgazebo_ros_laser.so works only in a <sensor>, not where it stands' in caplog.text
