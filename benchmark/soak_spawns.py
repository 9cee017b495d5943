"""Second part of the soak test: a robot with sensors is spawned and deleted, while pages visit.

What server, renderer and page hold afterwards is compared with what they held after the first of
these spawns, when their allocators were full.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import rospy
from gazebo_msgs.srv import DeleteModel
from sensor_msgs.msg import Image, LaserScan
from server import PATIENCE, Server, wait_until
from soak_pages import visit
from web import Window

from rosbots_description.cli.launched import descendants

SLACK = 3  # descriptors, threads, processes and files that may be there beside those before
SETTLED_MEMORY = 300  # spawns from which on memory is judged
FIRST = 0.5  # share of the spawns that come before, until allocators are full
LEAST = 8  # spawns, before and after
VISITS = 3  # of the page while a robot is there
GROWN = 0.05  # of what was used before
COUNTS = 'descriptors', 'threads', 'processes', 'files'
POOL = 32  # threads that viser starts for callbacks as they are needed, and keeps
QUIET = 5.0  # [s, wall] after which what ends by itself has ended
EYES = """<robot name="eyes"><link name="body"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
<gazebo reference="body">
<sensor name="eye" type="camera"><update_rate>20</update_rate>
  <camera><horizontal_fov>1</horizontal_fov><image><width>160</width><height>120</height></image>
    <clip><near>0.05</near><far>50</far></clip></camera>
  <plugin name="eye" filename="libgazebo_ros_camera.so"><cameraName>eye</cameraName>
    <imageTopicName>image_raw</imageTopicName><cameraInfoTopicName>camera_info</cameraInfoTopicName>
    <frameName>body</frameName></plugin></sensor>
<sensor name="laser" type="ray"><update_rate>20</update_rate><ray><scan><horizontal>
    <samples>181</samples><min_angle>-1.5</min_angle><max_angle>1.5</max_angle></horizontal></scan>
    <range><min>0.2</min><max>10</max></range></ray>
  <plugin name="laser" filename="libgazebo_ros_laser.so"><topicName>scan</topicName>
    <frameName>body</frameName></plugin></sensor></gazebo></robot>"""


@dataclass(frozen=True)
class Held:
    """What processes and their children hold."""

    memory: float  # [MB] resident
    descriptors: int
    threads: int
    processes: int
    files: int  # in the folder for temporary files

    def __str__(self) -> str:
        return (
            f'{self.memory:.1f} MB, {self.descriptors} descriptors, {self.threads} threads, '
            f'{self.processes} processes, {self.files} temporary files'
        )


def held(process: int, folder: Path) -> Held:
    """Return what a process and its descendants hold."""
    family = [process, *descendants(process)]
    memory, descriptors, threads = 0.0, 0, 0
    for one in family:
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # ended meanwhile
            pages = Path(f'/proc/{one}/statm').read_text(encoding='ascii').split()[1]
            memory += int(pages) * os.sysconf('SC_PAGE_SIZE') / 1e6
            descriptors += len(os.listdir(f'/proc/{one}/fd'))
            threads += len(os.listdir(f'/proc/{one}/task'))
    return Held(memory, descriptors, threads, len(family), len(list(folder.rglob('*'))))


def settled(process: int, folder: Path) -> Held:
    """Return what is held when nothing more is let go of for a while."""
    end, least, since = time.monotonic() + PATIENCE, held(process, folder), time.monotonic()
    while time.monotonic() < min(end, since + QUIET):
        time.sleep(0.5)
        now = held(process, folder)
        if (now.descriptors, now.threads) < (least.descriptors, least.threads):
            since = time.monotonic()
        least = now
    return least


def grown(before: Held, after: Held, kinds: Sequence[str], pool: int = 0) -> Iterator[str]:
    """Yield a sentence for each kind of which there is more, a pool of threads and a few aside."""
    for kind in kinds:
        old, new = getattr(before, kind), getattr(after, kind)
        spare = 0 if kind == 'memory' else SLACK + (pool if kind == 'threads' else 0)
        if new > max(old * (1.0 + GROWN), old + spare):
            yield f'{kind} grew from {old:.4g} to {new:.4g}'


def soak_spawns(count: int, seed: int) -> list[str]:
    """Spawn and delete a robot with sensors so often, with visitors; return the faults."""
    with tempfile.TemporaryDirectory(prefix='rosbots_soak_') as folder:
        os.environ['TMPDIR'] = folder
        with Server() as server, Window() as window:
            return list(_spawned(server, window, Path(folder), count, seed))


def _spawned(server: Server, window: Window, folder: Path, count: int, seed: int) -> Iterator[str]:
    context = get_context('spawn')
    orders, theirs = context.Pipe()
    visitors = context.Process(target=visit, args=(window.address, seed, theirs), daemon=True)
    visitors.start()
    processes = {'server': server.process, 'gzweb': window.process}
    first = max(LEAST, round(FIRST * count))
    before: dict[str, Held] = {}
    for number in range(first + count):
        if number == first:
            before = {name: settled(process, folder) for name, process in processes.items()}
        orders.send(VISITS)
        spawn_and_delete(server)
        if not orders.poll(PATIENCE):
            yield 'the visitors of the page are stuck'
            return
        orders.recv()
    orders.send(0)
    for name, process in processes.items():
        after = settled(process, folder)
        print(f'{name:7} before       {before[name]}')
        print(f'{name:7} after {count:4}   {after}')
        kinds = (*COUNTS, *(('memory',) if count >= SETTLED_MEMORY else ()))
        yield from (
            f'{name}: {fault}'
            for fault in grown(before[name], after, kinds, POOL if name == 'gzweb' else 0)
        )


def spawn_and_delete(server: Server) -> None:
    """Spawn the robot, read its picture and its scan, and delete it."""
    server.spawn_urdf('eyes', EYES)
    got: set[str] = set()
    readers = [
        rospy.Subscriber('/eye/image_raw', Image, lambda _: got.add('picture')),
        rospy.Subscriber('/scan', LaserScan, lambda _: got.add('scan')),
    ]
    wait_until(lambda: len(got) == len(readers), 'a picture and a scan')
    for reader in readers:
        reader.unregister()
    answer = server.service('delete_model', DeleteModel)('eyes')
    if not answer.success:
        raise RuntimeError(answer.status_message)
