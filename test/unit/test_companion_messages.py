"""The messages of the stand-ins have the MD5 sums of the originals, which binaries and bags carry.

A client and a server understand each other only if the sums are equal. The sum of an action covers
those of its goal, result and feedback. Those of gazebo_msgs are of version 2.9.2. The definitions
are read with genmsg: neither a build nor a master is needed.
"""

import runpy
from pathlib import Path

import genmsg
import pytest
from genmsg.gentools import compute_md5
from genmsg.msg_loader import load_depends, load_msg_from_file, load_srv_from_file

ROOT = Path(__file__).resolve().parents[2]
TOOL = runpy.run_path(str(ROOT / 'tools' / 'make_messages.py'))
SHARE = Path('/usr/share')
SUMS = {
    'ackermann_msgs': {
        'AckermannDrive.msg': '3512e91b48d69674a0e86fadf1ea8231',
        'AckermannDriveStamped.msg': '1fd5d7f58889cefd44d29f6653240d0c',
    },
    'control_msgs': {
        'FollowJointTrajectory.action': 'bc4f9b743838566551c0390c65f1a248',
        'GripperCommand.action': '950b2a6ebe831f5d4f4ceaba3d8be01e',
        'JointTrajectory.action': 'a04ba3ee8f6a2d0985a6aeaf23d9d7ad',
        'PointHead.action': '7252920f1243de1b741f14f214125371',
        'SingleJointPosition.action': 'c4a786b7d53e5d0983decf967a5a779e',
        'GripperCommand.msg': '680acaff79486f017132a7f198d40f08',
        'JointControllerState.msg': '987ad85e4756f3aef7f1e5e7fe0595d1',
        'JointJog.msg': '1685da700c8c2e1254afc92a5fb89c96',
        'JointTolerance.msg': 'f544fe9c16cf04547e135dd6063ff5be',
        'JointTrajectoryControllerState.msg': '10817c60c2486ef6b33e97dcd87f4474',
        'PidState.msg': 'b138ec00e886c10e73f27e8712252ea6',
        'QueryCalibrationState.srv': '28af3beedcb84986b8e470dc5470507d',
        'QueryTrajectoryState.srv': 'ec93cdecbd8062d761aa52b7c90cd44b',
    },
    'controller_manager_msgs': {
        'ControllerState.msg': 'aeb6b261d97793ab74099a3740245272',
        'ControllerStatistics.msg': '697780c372c8d8597a1436d0e2ad3ba8',
        'ControllersStatistics.msg': 'a154c347736773e3700d1719105df29d',
        'HardwareInterfaceResources.msg': 'f25b55cbf1d1f76e82e5ec9e83f76258',
        'ListControllerTypes.srv': 'c1d4cd11aefa9f97ba4aeb5b33987f4e',
        'ListControllers.srv': '1341feb2e63fa791f855565d0da950d8',
        'LoadController.srv': '647e5c54b8d6468952d8d31f1efe96c0',
        'ReloadControllerLibraries.srv': '40e8c411fd1797d2e2c486018f846040',
        'SwitchController.srv': 'b29a7abc673b2c54c14b54e50f8d06a5',
        'UnloadController.srv': '647e5c54b8d6468952d8d31f1efe96c0',
    },
    'gazebo_msgs': {
        'ContactState.msg': '48c0ffb054b8c444f870cecea1ee50d9',
        'ContactsState.msg': 'acbcb1601a8e525bf72509f18e6f668d',
        'LinkState.msg': '0818ebbf28ce3a08d48ab1eaa7309ebe',
        'LinkStates.msg': '48c080191eb15c41858319b4d8a609c2',
        'ModelState.msg': '9330fd35f2fcd82d457e54bd54e10593',
        'ModelStates.msg': '48c080191eb15c41858319b4d8a609c2',
        'ODEJointProperties.msg': '1b744c32a920af979f53afe2f9c3511f',
        'ODEPhysics.msg': '667d56ddbd547918c32d1934503dc335',
        'PerformanceMetrics.msg': '884f71fd5037b886ec5e126b83c4425a',
        'SensorPerformanceMetric.msg': '01762ded18cfe9ebc7c8222667c99547',
        'WorldState.msg': 'de1a9de3ab7ba97ac0e9ec01a4eb481e',
        'ApplyBodyWrench.srv': '585b9f9618aa0581b207e2f2d90866bc',
        'ApplyJointEffort.srv': 'c0039811b8cc919490b3cff748cdf46b',
        'BodyRequest.srv': '5eade9afe7f232d78005bd0cafeab755',
        'DeleteLight.srv': 'ae11ea8100d536d5b92c2b5917abf912',
        'DeleteModel.srv': '9ce56b4e9e54616de25d796dc972a262',
        'GetJointProperties.srv': '7b30be900f50aa21efec4a0ec92d91c9',
        'GetLightProperties.srv': 'df2cef87e13e2e6990e81e8aaa454c19',
        'GetLinkProperties.srv': '0e06a70386d0ee3fb880c02f23fcd821',
        'GetLinkState.srv': '09d6c98cce97b35f7ab9bd70300657ab',
        'GetModelProperties.srv': '5717f7bd34ed990fa80e28b3015027a3',
        'GetModelState.srv': '4c515e936d3319c9610c559c60bfc3d4',
        'GetPhysicsProperties.srv': '575a5e74786981b7df2e3afc567693a6',
        'GetWorldProperties.srv': '36bb0f2eccf4d8be971410c22818ba3f',
        'JointRequest.srv': '0be1351618e1dc030eb7959d9a4902de',
        'SetJointProperties.srv': '15a76e921b1410c698d82782ea5fa370',
        'SetJointTrajectory.srv': '88f5c10979e3f9649d5ae87a3b12aa65',
        'SetLightProperties.srv': 'e6f13430c57278bb364aca53a1bf5ebf',
        'SetLinkProperties.srv': 'd534ce1b36ee99de0ffa806c3a6348f0',
        'SetLinkState.srv': '8a5146eb66ae4d26b0860b08f3f271be',
        'SetModelConfiguration.srv': '10e3139d3b669c40afc057d38956fff7',
        'SetModelState.srv': '5b3ab0281d4f5445def017e3a2e4a07b',
        'SetPhysicsProperties.srv': '97e2057080558ce4730434b5fae75c91',
        'SpawnModel.srv': '9ed9c82c96abe1a00c3e8cdaeee24413',
    },
    'four_wheel_steering_msgs': {
        'FourWheelSteering.msg': '04dd0f55e1f168668af1e2587a7cdd2a',
        'FourWheelSteeringStamped.msg': '9226582df815bc6df9e3206bc05923af',
    },
}


@pytest.mark.parametrize('package', SUMS)
def test_definitions_have_the_md5_sums_of_the_originals(package, tmp_path):
    folder = ROOT / 'companions' / package
    TOOL['write_action_messages'](folder, tmp_path)
    search = {path.parent.name: [str(path)] for path in SHARE.glob('*_msgs/msg')}
    search[package] = [str(folder / 'msg'), str(tmp_path)]
    defined = {path.name for kind in ('action', 'msg', 'srv') for path in folder.glob(f'{kind}/*')}
    sums = {}
    for name in defined:
        stem, _, kind = name.partition('.')
        load = load_srv_from_file if kind == 'srv' else load_msg_from_file
        path = tmp_path / f'{stem}Action.msg' if kind == 'action' else folder / kind / name
        context = genmsg.MsgContext.create_default()
        spec = load(context, str(path), f'{package}/{path.stem}')
        load_depends(context, spec, search)
        sums[name] = compute_md5(context, spec)
    assert sums == SUMS[package]
