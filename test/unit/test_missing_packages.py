"""./rosbots check names the ROS packages that a robot needs and that are not here."""

import pytest
from support import ROOT

CHECK = ROOT / 'tools' / 'robot_check'
MANIFEST = """<package format="2"><name>rover</name><version>1.0.0</version><description>x
</description><maintainer email="a@b.example">a</maintainer><license>BSD</license>
<depend>gazebo_ros</depend>{}</package>"""


@pytest.mark.parametrize(
    ('needed', 'said'),
    [
        ('rospy', None),
        ('rover', None),
        (
            'interactive_markers',
            "rover needs 'interactive_markers', which is not among the ROS packages here: install "
            'python3-interactive-markers (requirements/optional.apt)',
        ),
        ('twist_mux', "rover needs 'twist_mux', which is not among the ROS packages here: if it"),
    ],
)
def test_what_is_missing_is_named_with_the_cure(tmp_path, monkeypatch, needed, said):
    monkeypatch.syspath_prepend(str(CHECK))
    import check

    folder = tmp_path / 'rover'
    folder.mkdir()
    (folder / 'package.xml').write_text(
        MANIFEST.format(f'<exec_depend>{needed}</exec_depend>'), encoding='utf-8'
    )
    monkeypatch.setattr(check.rospkg.RosPack, 'list', lambda _: ['gazebo_ros', 'rospy'])
    sentences = check.missing_packages([folder])
    assert [sentence[: len(said)] for sentence in sentences] == [said] if said else not sentences


def test_topic_tools_of_debian_is_two_packages(monkeypatch):
    monkeypatch.syspath_prepend(str(CHECK))
    import check

    assert check.optional_packages('topic_tools') == ['libtopic-tools-dev', 'topic-tools']
