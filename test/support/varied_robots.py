"""Robots that use what public ones use: every plugin and sensor, odd spellings, empty tags.

Feature k of a kind is in every robot whose number is k modulo the number of features of that kind,
so that each is in several robots, in different company.
"""

from rosbots_description.sim.plugin_registry import missing_libraries

ROBOTS = 60
MIMIC = '<joint>left_grip</joint><mimicJoint>right_grip</mimicJoint><multiplier>-1</multiplier>'

TRUE = ('true', 'True', 'TRUE', '1', ' true ', 'yes')
FALSE = ('false', 'False', 'FALSE', '0', ' false ', 'no')
RATES = ('20', '20.0', ' 20 ', '2e1', '20.')
NAMESPACES = (
    '',
    '<robotNamespace/>',
    '<robotNamespace></robotNamespace>',
    '<robotNamespace>/</robotNamespace>',
    '<robotNamespace> r{k} </robotNamespace>',
    '<robotNamespace>/r{k}/x</robotNamespace>',
)

MASS = (
    '<inertial><mass value="{m}"/><inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" '
    'izz="{i}"/></inertial>'
)
WHEEL = (
    MASS.format(m=0.5, i=0.001) + '<visual><origin rpy="1.5707963 0 0"/><geometry>'
    '<cylinder radius="0.1" length="0.04"/></geometry><material name="black"/></visual>'
    '<collision><origin rpy="1.5707963 0 0" xyz="0 0 0"/><geometry>'
    '<cylinder radius="0.1" length="0.04"/></geometry></collision>'
)
BASE = (
    MASS.format(m=5, i=0.1) + '<visual><geometry><box size="0.5 0.3 0.1"/></geometry>'
    '<material name="grey"><color rgba="0.5 0.5 0.5 1"/></material></visual>'
    '<collision name="base_collision"><geometry><box size="0.5 0.3 0.1"/></geometry></collision>'
)
FRAME = (
    '<link name="base_footprint"/><joint name="base_joint" type="fixed"><parent '
    'link="base_footprint"/><child link="base_link"/></joint><material name="black">'
    '<color rgba="0 0 0 1"/></material><link name="sensor_link"/><joint name="sensor_joint" '
    'type="fixed"><parent link="base_link"/><child link="sensor_link"/><origin xyz="0.2 0 0.12"/>'
    '</joint>'
)
CASTER = (
    '<link name="caster">' + MASS.format(m=0.2, i=0.001) + '<collision><geometry>'
    '<sphere radius="0.05"/></geometry></collision></link><joint name="caster_joint" '
    'type="fixed"><parent link="base_link"/><child link="caster"/><origin xyz="-0.2 0 -0.05"/>'
    '</joint>'
    '<gazebo reference="caster"><mu1>0</mu1><mu2>0.0</mu2></gazebo>'
)


def joint(child, x, y, parent='base_link', axis='0 1 0', kind='continuous'):
    return (
        f'<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/><child '
        f'link="{child}"/><origin xyz="{x} {y} 0"/><axis xyz="{axis}"/></joint>'
    )


def wheel(name, x, y, parent='base_link'):
    return f'<link name="{name}">{WHEEL}</link>' + joint(name, x, y, parent)


TWO = wheel('left', 0.1, 0.17) + wheel('right', 0.1, -0.17) + CASTER
FOUR = ''.join(
    wheel(f'{end}_{side}', x, y)
    for end, x in (('front', 0.15), ('rear', -0.15))
    for side, y in (('left', 0.17), ('right', -0.17))
)
STEER = (
    wheel('left', -0.15, 0.17)
    + wheel('right', -0.15, -0.17)
    + '<link name="fork">'
    + MASS.format(m=0.3, i=0.001)
    + '</link>'
    + joint('fork', 0.15, 0, axis='0 0 1')
    + wheel('front', 0, 0, 'fork')
)

PUSHED = (
    '<commandTopic>cmd_vel</commandTopic><odometryTopic>odom</odometryTopic><odometryFrame>'
    'odom</odometryFrame><odometryRate>{rate}</odometryRate><robotBaseFrame>base_footprint'
    '</robotBaseFrame><x_velocity_p_gain>1000.0</x_velocity_p_gain><y_velocity_p_gain>1000'
    '</y_velocity_p_gain><yaw_velocity_p_gain>50</yaw_velocity_p_gain>'
)

# Tags of each drive: the body that it needs, and its parameters.
DRIVES = {
    'diff_drive': (
        TWO,
        '<leftJoint>left_joint</leftJoint><rightJoint>right_joint</rightJoint>'
        '<wheelSeparation>0.34</wheelSeparation><wheelDiameter>0.2</wheelDiameter>'
        '<wheelTorque>5</wheelTorque><wheelAcceleration>0</wheelAcceleration>'
        '<publishWheelTF>{no}</publishWheelTF><publishOdomTF>{yes}</publishOdomTF>'
        '<publishWheelJointState>{yes}</publishWheelJointState><legacyMode>{no}'
        '</legacyMode><odometrySource>{source}</odometrySource><rosDebugLevel>na'
        '</rosDebugLevel><commandTopic>cmd_vel</commandTopic><odometryTopic>odom'
        '</odometryTopic><odometryFrame>odom</odometryFrame><robotBaseFrame>'
        'base_footprint</robotBaseFrame><publishTf>1</publishTf>',
    ),
    'skid_steer_drive': (
        FOUR,
        '<leftFrontJoint>front_left_joint</leftFrontJoint><rightFrontJoint>'
        'front_right_joint</rightFrontJoint><leftRearJoint>rear_left_joint'
        '</leftRearJoint><rightRearJoint>rear_right_joint</rightRearJoint>'
        '<wheelSeparation>0.34</wheelSeparation><wheelDiameter>0.2'
        '</wheelDiameter><torque>10</torque><robotBaseFrame>base_link'
        '</robotBaseFrame><broadcastTF>{yes}</broadcastTF><commandTopic>cmd_vel'
        '</commandTopic><odometryTopic>odom</odometryTopic><odometryFrame>odom'
        '</odometryFrame><covariance_x>0.0001</covariance_x>',
    ),
    'planar_move': (
        CASTER,
        '<commandTopic>cmd_vel</commandTopic><odometryTopic>odom'
        '</odometryTopic><odometryFrame>odom</odometryFrame><odometryRate>{rate}'
        '</odometryRate><robotBaseFrame>base_footprint</robotBaseFrame>',
    ),
    'tricycle_drive': (
        STEER,
        '<steeringJoint>fork_joint</steeringJoint><actuatedWheelJoint>'
        'front_joint</actuatedWheelJoint><encoderWheelLeftJoint>left_joint'
        '</encoderWheelLeftJoint><encoderWheelRightJoint>right_joint'
        '</encoderWheelRightJoint><wheelSeparation>0.34</wheelSeparation>'
        '<encoderWheelSeparation>0.34</encoderWheelSeparation><wheelDiameter>0.2'
        '</wheelDiameter><encoderWheelDiameter>0.2</encoderWheelDiameter>'
        '<wheelAcceleration>1</wheelAcceleration><wheelTorque>5</wheelTorque>'
        '<steeringSpeed>0.4</steeringSpeed><steeringAngleTolerance>0.01'
        '</steeringAngleTolerance><odometrySource>{source}</odometrySource>'
        '<publishWheelTF>{no}</publishWheelTF><publishWheelJointState>{yes}'
        '</publishWheelJointState><commandTopic>cmd_vel</commandTopic>'
        '<odometryTopic>odom</odometryTopic><odometryFrame>odom</odometryFrame>'
        '<robotBaseFrame>base_link</robotBaseFrame>',
    ),
    'force_based_move': (CASTER, PUSHED + '<publishOdometryTf>{yes}</publishOdometryTf>'),
    'ridgeback_force_based_move': (CASTER, PUSHED + '<cmdVelTimeOut>5.0</cmdVelTimeOut>'),
}
WHEELS = {'diff_drive': 'left', 'skid_steer_drive': 'front_left', 'tricycle_drive': 'left'}

# Plugins of the model, with their tags.
STATES = {
    'joint_state_publisher': '<jointName>{wheel}</jointName>',
    'p3d': '<bodyName>base_footprint</bodyName><topicName>truth</topicName><gaussianNoise>0.01'
    '</gaussianNoise><frameName>world</frameName><xyzOffset>0 0 0</xyzOffset><rpyOffset>0 0 '
    '0</rpyOffset>',
    'imu': '<bodyName>base_footprint</bodyName><topicName>imu_old</topicName><serviceName>imu_s'
    '</serviceName><gaussianNoise>0.0</gaussianNoise><rpyOffset>0 0 0</rpyOffset>',
    'force': '<bodyName>base_footprint</bodyName><topicName>push</topicName>',
    'ft_sensor': '<jointName>{wheel}</jointName><topicName>wrench</topicName>',
    'hand_of_god': '<linkName>base_footprint</linkName><frameId>world</frameId><ka>1</ka><kl>1'
    '</kl>',
    'joint_pose_trajectory': '<topicName>path</topicName><updateRate>10</updateRate>',
    'wheel_slip': '<wheel link_name="{wheel_link}"><slip_compliance_lateral>0.1'
    '</slip_compliance_lateral><slip_compliance_longitudinal>0.1'
    '</slip_compliance_longitudinal><wheel_normal_force>10</wheel_normal_force>'
    '</wheel>',
    'hector_imu': '<bodyName>base_footprint</bodyName><topicName>raw</topicName><accelDrift>0.1 '
    '0.1 0.1</accelDrift><rateGaussianNoise>0.01 0.01 0.01</rateGaussianNoise>',
    'hector_gps': '<bodyName>base_footprint</bodyName><topicName>fix</topicName><velocityTopicName>'
    'fix_velocity</velocityTopicName><drift>1 1 1</drift><referenceLatitude>49.9'
    '</referenceLatitude>',
    'nothing': '',
}

IMAGE = (
    '<horizontal_fov>1.2</horizontal_fov><image><width>{w}</width><height>24</height>'
    '<format>{format}</format></image><clip><near>0.05</near><far>30</far></clip>'
)
NOISE = '<noise><type>gaussian</type><mean>0.0</mean><stddev>0.01</stddev></noise>'
CAMERA = '<camera name="c">' + IMAGE + NOISE + '</camera>'
PAIR = (
    '<camera name="left">' + IMAGE + '</camera><camera name="right"><pose>0 -0.07 0 0 0 0'
    '</pose>' + IMAGE + '</camera>'
)
SCAN = (
    '<ray><scan><horizontal><samples>9</samples><resolution>1</resolution><min_angle>-1'
    '</min_angle><max_angle>1</max_angle></horizontal>{rows}</scan><range><min>0.1</min><max>10'
    '</max><resolution>0.01</resolution></range>' + NOISE + '</ray>'
)
ROWS = (
    '<vertical><samples>3</samples><resolution>1</resolution><min_angle>-0.1</min_angle>'
    '<max_angle>0.1</max_angle></vertical>'
)
TOPICS = (
    '<cameraName>cam</cameraName><imageTopicName>image_raw</imageTopicName>'
    '<cameraInfoTopicName>camera_info</cameraInfoTopicName><frameName>sensor_link</frameName>'
    '<hackBaseline>0.07</hackBaseline><distortionK1>0.0</distortionK1><CxPrime>0</CxPrime>'
)
DEPTHS = (
    TOPICS + '<depthImageTopicName>depth/image_raw</depthImageTopicName>'
    '<depthImageCameraInfoTopicName>depth/camera_info</depthImageCameraInfoTopicName>'
    '<pointCloudTopicName>points</pointCloudTopicName><pointCloudCutoff>0.1</pointCloudCutoff>'
)
BEAM = '<topicName>scan</topicName><frameName>sensor_link</frameName>'

# Type of a sensor, what is in it, its library, that plugin's tags.
SENSORS = [
    ('ray', SCAN, 'laser', BEAM),
    ('gpu_ray', SCAN, 'gpu_laser', BEAM),
    ('ray', SCAN, 'block_laser', BEAM + '<gaussianNoise>0.01</gaussianNoise>'),
    ('ray', SCAN, 'range', BEAM + '<radiation>ultrasound</radiation><fov>0.2</fov>'),
    (
        'ray',
        SCAN,
        'velodyne_laser',
        BEAM + '<min_range>0.2</min_range><organize_cloud>{no}</organize_cloud>',
    ),
    ('gpu_ray', SCAN, 'velodyne_gpu_laser', BEAM + '<max_range>9</max_range>'),
    (
        'imu',
        '<imu><angular_velocity><x>' + NOISE + '</x></angular_velocity></imu>',
        'imu_sensor',
        '<topicName>imu</topicName><frameName>sensor_link</frameName><updateRateHZ>{rate}'
        '</updateRateHZ><gaussianNoise>0.01</gaussianNoise><initialOrientationAsReference>{no}'
        '</initialOrientationAsReference>',
    ),
    (
        'contact',
        '<contact><collision>base_footprint_fixed_joint_lump__base_collision_collision'
        '</collision></contact>',
        'bumper',
        '<bumperTopicName>bump</bumperTopicName><frameName>world</frameName>',
    ),
    ('camera', CAMERA, 'camera', TOPICS),
    ('multicamera', PAIR, 'multicamera', TOPICS),
    ('multicamera', PAIR, 'triggered_multicamera', TOPICS),
    ('camera', CAMERA, 'triggered_camera', TOPICS + '<triggerTopicName>now</triggerTopicName>'),
    ('depth', CAMERA, 'depth_camera', DEPTHS),
    ('depth', CAMERA, 'openni_kinect', DEPTHS),
    ('imu', '', '', ''),
    ('ray', SCAN, '', ''),
    ('camera', CAMERA, '', ''),
    # without a counterpart here
    ('sonar', '<sonar><min>0</min><max>1</max><radius>0.1</radius></sonar>', '', ''),
    ('altimeter', '', '', ''),
    ('gps', '', '', ''),
    ('magnetometer', '', '', ''),
    ('force_torque', '', '', ''),
    ('logical_camera', '', '', ''),
]

TRANSMISSIONS = [
    '<transmission name="t{k}"><type>transmission_interface/SimpleTransmission</type><joint '
    'name="{wheel}"><hardwareInterface>hardware_interface/VelocityJointInterface'
    '</hardwareInterface></joint><actuator name="m"><mechanicalReduction>1</mechanicalReduction>'
    '</actuator></transmission>',
    '<transmission name="t{k}" type="pr2_mechanism_model/SimpleTransmission"><actuator name="m"/>'
    '<joint name="{wheel}"/><mechanicalReduction>1</mechanicalReduction>'
    '<motorTorqueConstant>1</motorTorqueConstant></transmission>',
    '<transmission name="t{k}"/>',
    '',
]

# Two fingers, the second of which follows the first, by one of the plugins for that.
FINGERS = ''.join(
    f'<link name="{side}_finger">' + MASS.format(m=0.1, i=0.001) + f'</link><joint name="{side}"'
    f' type="revolute"><parent link="base_link"/><child link="{side}_finger"/><origin '
    'xyz="0.2 0 0.1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="2"/>'
    f'{mimic}</joint>'
    for side, mimic in (('left_grip', ''), ('right_grip', '{mimic}'))
)
GRIPPERS = {
    'ros_control': (
        '<mimic joint="left_grip" multiplier="-1"/>',
        '<transmission name="g"><type>'
        'transmission_interface/SimpleTransmission</type><joint name="left_grip">'
        '<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>'
        '<actuator name="m"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>',
        'libgazebo_ros_control.so',
        '<robotSimType>gazebo_ros_control/DefaultRobotHWSim'
        '</robotSimType><controlPeriod>0.001</controlPeriod>',
    ),
    'roboticsgroup': ('', '', 'libroboticsgroup_gazebo_mimic_joint_plugin.so', MIMIC),
    'upatras': ('', '', 'libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so', MIMIC),
}

# What else is in public descriptions.
ODD = [
    '<gazebo reference="base_link"><material>Gazebo/Blue</material><mu1>0.2</mu1><mu2 value="0.2"/>'
    '<kp>1000000.0</kp><kd>100.0</kd><minDepth>0.001</minDepth><maxVel>1.0</maxVel><fdir1>1 0 0'
    '</fdir1><turnGravityOff>{no}</turnGravityOff><selfCollide>{no}</selfCollide></gazebo>',
    '<gazebo reference="base_link"><gravity>{yes}</gravity><dampingFactor>0.01</dampingFactor>'
    '<laserRetro>0</laserRetro><maxContacts>10</maxContacts></gazebo><gazebo/>',
    '<gazebo reference="{wheel}"><implicitSpringDamper>{yes}</implicitSpringDamper>'
    '<provideFeedback>{yes}</provideFeedback><stopCfm>0</stopCfm><stopErp>0.2</stopErp></gazebo>',
    '<gazebo reference="sensor_joint"><preserveFixedJoint>{no}</preserveFixedJoint>'
    '<disableFixedJointLumping>{no}</disableFixedJointLumping></gazebo>',
    '<gazebo reference="base_link"><visual><material><script><name>Gazebo/Red</name><uri>file://'
    'media/materials/scripts/gazebo.material</uri></script></material></visual></gazebo>',
    '<gazebo reference="no_such_link"><material>Gazebo/Grey</material></gazebo>',
    '<gazebo><static>{no}</static></gazebo><!-- <gazebo reference="x"/> -->',
    '<gazebo reference="base_link"><mu1></mu1><kp/></gazebo>',
]


def urdf(k):
    """Return the URDF of robot `k`."""
    drive, (body, tags) = list(DRIVES.items())[k % len(DRIVES)]
    has_wheels, link = drive in WHEELS, WHEELS.get(drive, 'caster')
    words = {
        'k': k,
        'yes': TRUE[k % len(TRUE)],
        'no': FALSE[k % len(FALSE)],
        'rate': RATES[k % len(RATES)],
        'source': ('encoder', 'world', '0', '1')[k // 4 % 4],
        'wheel': f'{link}_joint',
        'wheel_link': link,
        'w': 32,
        'rows': '',
        'format': ('R8G8B8', 'L8', 'B8G8R8', 'BAYER_RGGB8')[k % 4],
    }
    parts = [
        FRAME,
        f'<link name="base_link">{BASE}</link>',
        body,
        _plugin(_library(drive), 'drive', tags, k),
    ]
    for offset in (0, 3):
        name, inside = list(STATES.items())[(k + offset) % len(STATES)]
        if name == 'nothing' or (not has_wheels and '{wheel' in inside):
            continue
        parts.append(_plugin(_library(name), f'state{offset}', inside, k))
    for offset in (0, 7):
        parts.append(_sensor(k, offset))
    parts.append(TRANSMISSIONS[k % len(TRANSMISSIONS)] if has_wheels else '')
    if k % 4 == 3:  # its wheels have no transmission
        mimic, transmission, library, inside = list(GRIPPERS.values())[k // 4 % len(GRIPPERS)]
        parts += [
            FINGERS.replace('{mimic}', mimic),
            transmission,
            _plugin(library, 'gripper', inside, k),
        ]
    odd = ODD[k % len(ODD)]
    parts.append(odd if has_wheels or '{wheel}' not in odd else '')
    if k % 6 == 5:
        missing = missing_libraries()
        parts.append(_plugin(missing[k // 6 % len(missing)], 'missing', '', k))
    text = ''.join(parts)
    for word, value in words.items():
        text = text.replace(f'{{{word}}}', str(value))
    return f'<?xml version="1.0"?>\n<robot name="varied" xmlns:xacro="x">{text}</robot>'


def _library(name):
    for prefix, begin in (
        ('hector_', 'libhector_gazebo_ros_'),
        ('ridgeback_', 'libridgeback_ros_'),
    ):
        if name.startswith(prefix):
            return f'{begin}{name.removeprefix(prefix)}.so'
    return f'libgazebo_ros_{name}.so'


def _plugin(filename, name, tags, k):
    head = (
        '<plugin name="{}" filename="{}">',
        '<plugin filename="{1}" name="{0}">',
        '<plugin name="{}"  filename="{}" >',
    )[k % 3].format(name, filename)
    rates = (
        '<updateRate>{rate}</updateRate>',
        '<alwaysOn>{yes}</alwaysOn>',
        '<updateRate>0</updateRate>' if k % 12 == 2 else '',
    )
    rate = '' if '<updateRate>' in tags else rates[k % 3]
    return f'<gazebo>{head}{NAMESPACES[k % len(NAMESPACES)]}{rate}{tags}</plugin></gazebo>'


def _sensor(k, offset):
    kind, inside, library, tags = SENSORS[(k + offset) % len(SENSORS)]
    rows = ROWS if 'block' in library or 'velodyne' in library else ''
    plugin = (
        ''
        if not library
        else _plugin(f'libgazebo_ros_{library}.so', f'plugin{offset}', tags, k)
        .removeprefix('<gazebo>')
        .removesuffix('</gazebo>')
    )
    rate = '2' if 'camera' in kind or kind == 'depth' else '{rate}'  # pictures cost most
    return (
        f'<gazebo reference="sensor_link"><sensor type="{kind}" name="sensor{offset}">'
        f'<always_on>{{yes}}</always_on><update_rate>{rate}</update_rate><visualize>{{no}}'
        f'</visualize>{inside.replace("{rows}", rows)}{plugin}</sensor></gazebo>'
    )
