"""The demo's plot of the path."""

from matplotlib import image

from rosbots_description.cli.demo_plot import plot_path
from rosbots_description.cli.demo_report import DRIVE
from rosbots_description.ros_api.clients.planar_sample import PlanarSample


def test_each_segment_is_drawn_in_its_own_colour(tmp_path):
    drive = [
        (segment, [PlanarSample(0.0, 0.0, i, i, 0.0), PlanarSample(3.0, 3.0, i + 1.0, i, 0.0)])
        for i, segment in enumerate(DRIVE)
    ]
    path = tmp_path / 'path.png'

    plot_path(path, drive, [sample for _, samples in drive for sample in samples])

    picture = image.imread(path)
    assert picture.shape[1] == 960
    pixels = (picture[..., :3] * 255).round().astype(int).reshape(-1, 3)
    colours = {tuple(pixel) for pixel in pixels}
    for rgb in ('1f77b4', 'ff7f0e', '2ca02c', 'd62728'):
        assert tuple(bytes.fromhex(rgb)) in colours
