"""ackermann_msgs has the MD5 sums of the original, as rosserial's headers of it carry them."""

from pathlib import Path

import genmsg
import pytest
from genmsg.gentools import compute_md5
from genmsg.msg_loader import load_depends, load_msg_from_file

FOLDER = Path(__file__).resolve().parents[2] / 'companions' / 'ackermann_msgs' / 'msg'
SUMS = {
    'AckermannDrive': '3512e91b48d69674a0e86fadf1ea8231',
    'AckermannDriveStamped': '1fd5d7f58889cefd44d29f6653240d0c',
}


@pytest.mark.parametrize('name', SUMS)
def test_message_has_the_md5_sum_of_the_original(name):
    context = genmsg.MsgContext.create_default()
    spec = load_msg_from_file(context, str(FOLDER / f'{name}.msg'), f'ackermann_msgs/{name}')
    load_depends(context, spec, {'std_msgs': ['/usr/share/std_msgs/msg'],
                                 'ackermann_msgs': [str(FOLDER)]})
    assert compute_md5(context, spec) == SUMS[name]
