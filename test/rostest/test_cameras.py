"""Topics of cameras: names, types, frames, stamps, latching, and settings by clients."""

import io
import re

import numpy as np
import rospy
from dynamic_reconfigure.client import Client
from PIL import Image as PilImage
from rosbots_msgs.srv import Step
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, PointCloud2
from sensor_msgs.srv import SetCameraInfo
from simulator import DEADLINE, SimulatorTest, pose, proxy, recorded, topics_of, wait_until
from std_msgs.msg import Empty
from test_sensors import spacing

IMAGES = ('image_raw', 'image_raw/compressed')  # the latter as with image_transport's plugin
SETTINGS = ('parameter_descriptions', 'parameter_updates')


class CameraTest(SimulatorTest):
    def spawn_camera(self, robot, folder, topics, namespace='/', plugin='libgazebo_ros_camera.so'):
        """Spawn a recorded robot and assert that its topics below `folder` are `topics`."""
        self.spawn_recorded(
            robot,
            {f'{folder}/{topic}' for topic in topics},
            namespace=namespace,
            change=lambda text: text.replace('libgazebo_ros_camera.so', plugin),
        )

    def test_images_and_camera_infos_have_equal_stamps(self):
        self.spawn_camera('camera_320', '/nsx/camera1', {*IMAGES, 'camera_info', *SETTINGS}, '/nsx')
        infos = self.collect('/nsx/camera1/camera_info', CameraInfo)
        images = self.read('/nsx/camera1/image_raw', Image, 12)
        image = images[-1]
        self.assertEqual((image.width, image.height, image.step), (320, 240, 960))
        self.assertEqual((image.encoding, len(image.data)), ('rgb8', 230400))
        self.assertEqual(image.header.frame_id, 'camera_link_optical')
        self.assertEqual(tuple(image.data[:3]), (178, 178, 178))  # the background
        wait_until(
            lambda: images[5].header.stamp in {one.header.stamp for one in list(infos)},
            'the camera info of an image',
        )
        self.pause()  # each step waits for its picture then, however long that takes
        step, begin = proxy('step', Step), self.world().sim_time + 0.0005

        def stepped():
            return [one for one in list(images) if one.header.stamp.to_sec() > begin]

        for count in range(1, 6):
            self.assertTrue(step(34).success)
            wait_until(lambda count=count: len(stepped()) >= count, 'a picture')
        self.assertLessEqual(spacing(stepped()), {33, 34})
        self.assertAlmostEqual(infos[-1].P[3], -13.347686, 5)

    def test_readers_that_keep_up_get_each_picture(self):
        """Rospy numbers the messages that are published; the engine's tests count the pictures."""
        text = re.sub(
            '<width>.*?</height>',
            '<width>800</width><height>800</height>',
            recorded('camera_320'),
            flags=re.DOTALL,
        )
        self.assertTrue(self.spawn('bot', text, pose(z=0.0)).success)
        client = Client('/camera1', timeout=DEADLINE)
        client.update_configuration({'imager_rate': 5.0})  # any machine keeps up with it
        client.close()
        images = self.collect('/camera1/image_raw', Image)
        compressed = self.read('/camera1/image_raw/compressed', CompressedImage, 15)
        wait_until(lambda: len(images) >= 15, 'pictures')
        self.assertEqual((images[0].width, images[0].height), (800, 800))
        for messages in (images[:], compressed[:]):
            numbers = [message.header.seq for message in messages]
            self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))))
        stamps = [[message.header.stamp for message in found] for found in (images, compressed)]
        both = max(found[0] for found in stamps), min(found[-1] for found in stamps)
        self.assertEqual(
            *([stamp for stamp in found if both[0] <= stamp <= both[1]] for found in stamps)
        )

    def test_compressed_image_is_the_image(self):
        self.spawn_camera('camera_320', '/camera1', {*IMAGES, 'camera_info', *SETTINGS})
        compressed = self.read('/camera1/image_raw/compressed', CompressedImage, 2)
        images = self.collect('/camera1/image_raw', Image)
        wait_until(
            lambda: images and compressed[-1].header.stamp >= images[0].header.stamp,
            'both images of one time',
        )
        image = images[0]
        (same,) = (one for one in compressed if one.header.stamp == image.header.stamp)
        self.assertEqual(
            (same.format, same.header.frame_id),
            ('rgb8; jpeg compressed bgr8', 'camera_link_optical'),
        )
        pixels = np.asarray(PilImage.open(io.BytesIO(same.data)), int)
        away = np.abs(pixels - np.frombuffer(image.data, 'u1').reshape(240, 320, 3))
        self.assertLess(away.mean(), 1.0)

    def test_subscriber_during_a_pause_gets_the_last_image(self):
        self.spawn_camera('camera_320', '/camera1', {*IMAGES, 'camera_info', *SETTINGS})
        self.read('/camera1/image_raw', Image, 2)
        self.pause()
        infos = self.collect('/camera1/camera_info', CameraInfo)
        self.assertEqual(len(self.read('/camera1/image_raw', Image, 1)), 1)
        self.assertEqual(infos, [])

    def test_clients_set_rate_and_camera_info(self):
        self.spawn_camera('camera_320', '/camera1', {*IMAGES, 'camera_info', *SETTINGS})
        self.assertEqual(rospy.get_param('/camera1/imager_rate'), 2.0)
        client = Client('/camera1', timeout=DEADLINE)
        client.update_configuration({'imager_rate': 5.0})
        self.assertEqual(spacing(self.read('/camera1/camera_info', CameraInfo, 4)[1:]), {200})
        client.close()
        rospy.wait_for_service('/camera1/set_camera_info', DEADLINE)
        wanted = CameraInfo(width=320, height=240, K=[1.0, 0, 2.0, 0, 3.0, 4.0, 0, 0, 1.0])
        answer = rospy.ServiceProxy('/camera1/set_camera_info', SetCameraInfo)(wanted)
        self.assertEqual((answer.success, answer.status_message), (True, ''))
        info = self.read('/camera1/camera_info', CameraInfo, 2)[-1]
        self.assertEqual((list(info.K), info.header.frame_id), (list(wanted.K), ''))

    def test_each_trigger_gives_one_image(self):
        self.spawn_camera(
            'camera_320',
            '/camera1',
            {*IMAGES, 'camera_info', 'image_trigger', *SETTINGS},
            plugin='libgazebo_ros_triggered_camera.so',
        )
        images = self.collect('/camera1/image_raw', Image)
        trigger = self.publisher('/camera1/image_trigger', Empty)
        # Again and again, for the camera does not take pictures before it knows its reader.
        wait_until(lambda: trigger.publish(Empty()) or images, 'a picture')
        self.pause()  # steps wait for pictures then
        step = proxy('step', Step)
        self.assertTrue(step(300).success)

        def another():
            """Trigger once, and return the picture."""
            begin = self.world().sim_time + 0.0005
            trigger.publish(Empty())
            newer = []

            def has_come():
                self.assertTrue(step(1).success)
                newer[:] = [one for one in list(images) if one.header.stamp.to_sec() > begin]
                return newer

            wait_until(has_come, 'another picture')
            self.assertTrue(step(300).success)  # in which a further one would come
            return newer[0]

        first, second = another(), another()
        self.assertEqual(second.header.seq, first.header.seq + 1)

    def test_both_cameras_of_a_multicamera_have_equal_stamps(self):
        topics = {
            f'{side}/{topic}'
            for side in ('left', 'right')
            for topic in (*IMAGES, 'camera_info', *SETTINGS)
        }
        self.spawn_camera('multicamera', '/multisense', topics)
        left = self.collect('/multisense/left/image_raw', Image)
        right = self.read('/multisense/right/image_raw', Image, 5)
        wait_until(
            lambda: {m.header.stamp for m in left} & {m.header.stamp for m in right}, 'equal stamps'
        )

    def test_depth_camera_publishes_all_its_topics(self):
        self.spawn_camera(
            'openni_kinect',
            '/camera',
            {
                'rgb/image_raw',
                'rgb/image_raw/compressed',
                'rgb/camera_info',
                'depth/image_raw',
                'depth/camera_info',
                'depth/points',
                *SETTINGS,
            },
        )
        cloud = self.read('/camera/depth/points', PointCloud2, 2)[-1]
        self.assertEqual((cloud.height, cloud.width, cloud.point_step), (240, 320, 32))
        self.assertEqual(
            [(f.name, f.offset) for f in cloud.fields], [('x', 0), ('y', 4), ('z', 8), ('rgb', 16)]
        )
        self.assertFalse(cloud.is_dense)
        image = self.read('/camera/depth/image_raw', Image, 2)[-1]
        self.assertEqual((image.encoding, image.step), ('32FC1', 1280))
        self.read('/camera/depth/camera_info', CameraInfo, 2)

    def test_robot_can_be_deleted_while_its_camera_is_subscribed(self):
        for _ in range(2):
            self.spawn_camera('camera_320', '/camera1', {*IMAGES, 'camera_info', *SETTINGS})
            self.read('/camera1/image_raw', Image, 2)
            self.assertTrue(self.delete('bot').success)
            self.assertNotIn('/camera1/image_raw', topics_of())
            self.disconnect()
