"""Property tests: valid models are read completely; anything else is rejected with one message."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import package_directory, robot_urdf
from support.descriptions import sdfs, urdfs
from support.invariants import check_sentence, check_spec, total
from support.mutations import RAW, damaged, spoiled

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.formats.sdf.sdf import load_sdf, load_sdf_light
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.uris import UnknownPackage
from rosbots_description.sim.resources.xml_parser import parse_xml, root_tag

ROUNDING = 1e-6  # relative; masses differ by up to six orders of magnitude


def read_urdf(text):
    return load_urdf(text, 'model', find_package=package_directory)[0]


def read_sdf(text):
    return load_sdf(text, 'model', find_model=lambda _: None, find_package=package_directory)[0]


def read_any(text):
    """Return the model, or None if the text is rejected with a proper message."""
    read = read_urdf if root_tag(text) == 'robot' else read_sdf
    try:
        spec = read(text)
    except (ModelError, UnknownPackage) as error:
        check_sentence(error)
        return None
    check_spec(spec)
    return spec


@given(urdfs())
def test_mass_and_centre_of_mass_of_a_urdf_are_kept(description):
    spec = read_urdf(description.text)
    check_spec(spec)
    if not spec.static:
        mass, centre = total(spec)
        assert mass == pytest.approx(description.mass, rel=ROUNDING)
        assert centre == pytest.approx(description.centre, rel=ROUNDING, abs=1e-6)
    assert len(spec.links) + len(spec.reduced) == description.links


@given(sdfs())
def test_mass_and_links_of_an_sdf_are_kept(description):
    spec = read_sdf(description.text)
    check_spec(spec)
    mass, centre = total(spec)
    assert len(spec.links) == description.links
    assert mass == pytest.approx(description.mass, rel=ROUNDING)
    assert centre == pytest.approx(description.centre, rel=ROUNDING, abs=1e-6)


@given(st.data())
def test_damaged_description_is_read_or_rejected(data):
    description = data.draw(st.one_of(urdfs(), sdfs()))
    read_any(data.draw(damaged(description.text)))


@given(st.data())
def test_description_with_one_wrong_value_is_read_or_rejected(data):
    description = data.draw(st.one_of(urdfs(), sdfs()))
    read_any(data.draw(spoiled(description.text)))


@given(st.data())
def test_damaged_robot_is_read_or_rejected(data):
    read_any(data.draw(damaged(robot_urdf())))


@given(RAW)
def test_any_text_is_read_or_rejected(text):
    root_tag(text)
    for read in (parse_xml, load_sdf_light, load_urdf):
        try:
            read(text, 'it')
        except ModelError as error:
            check_sentence(error)
    read_any(text)
