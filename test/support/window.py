"""What the window's page is tested with: a simulator that remembers, and what it would show."""

from contextlib import contextmanager
from functools import partialmethod

from rosbots_description.sim.core import Pose, SimError, Twist
from rosbots_description.sim.description import (
    Box,
    ModelText,
    SceneChange,
    ShownLink,
    ShownModel,
    ShownMotion,
    ShownReading,
    Visual,
)
from rosbots_description.web import Editor, Goals, Inspection, Joints, Library, Robots, Site, Worlds
from rosbots_description.web.panels import TimeControl
from rosbots_description.web.scene import Models
from rosbots_description.web.simulator import View


@contextmanager
def serving(host='127.0.0.1', *token, **options):
    """Yield a site at a free port, until it is no longer needed."""
    site = Site(host, 0, *token, **options)
    try:
        yield site
    finally:
        site.stop()


class FakeContacts:
    """Contacts that a test shows."""

    def __init__(self):
        self.show = None

    def open(self, show):
        self.show = show

    def close(self):
        self.show = None


class Remembering:
    """Remembers what it is told, and refuses with its fault if it has one.

    It has the methods of `parts`, protocols of the page, that a subclass does not define.
    """

    def __init_subclass__(cls, parts=()):
        for part in parts:
            for name in dir(part):
                if not name.startswith('_') and not hasattr(cls, name):
                    setattr(cls, name, partialmethod(cls._note, name))

    def __init__(self):
        self.told, self.fault = [], ''

    def done(self, *names):
        """Return what was told by the methods of these names."""
        return [told for told in self.told if told[0] in names]

    def _note(self, name, *arguments):
        self.told.append((name, *arguments))
        if self.fault:
            raise SimError(self.fault)


class FakeSimulator(
    Remembering, parts=(View, TimeControl, Robots, Inspection, Editor, Library, Worlds)
):
    """A simulator; most parts of it are this object."""

    def __init__(self):
        super().__init__()
        self.change = self.motion = None
        self.where = Pose(), Twist()
        self.topics = ()
        self.view = self.time = self.robots = self.inspection = self.editor = self.library = (
            self.worlds
        ) = self
        self.contacts, self.joints = FakeContacts(), FakeJoints()
        self.sensors, self.signals = FakeTopics(), FakeSignals()
        self.maps, self.goals = FakeMaps(), FakeGoals()
        self.names = []  # of models on the model path
        self.missing = []  # what models are spawned without
        self.known_faults = []  # of its world

    def open(self, change, motion):
        self.change, self.motion = change, motion

    def close(self):
        self.change = self.motion = None

    def faults(self):
        return tuple(self.known_faults)

    def state(self, model, link, _patience=None):
        self.told.append(('state', model, link))
        return self.where

    def drive_topics(self):
        return self.topics

    def models(self):
        return self.names

    def parameters(self):
        return ()

    def model(self, name):
        return ModelText(name, f'model {name}')

    def parameter(self, name):
        return ModelText('', name)

    def file(self, name, content):
        return ModelText('', f'{name}: {content.decode()}')

    def omissions(self, name):
        return self.missing

    def shape(self, spec):
        return ModelText(spec.name, spec)

    def light(self, spec):
        return ModelText(spec.name, spec)

    def insert(self, text, on_ground=False, beside=False):
        self._note('insert', text, on_ground, beside)
        return f'new {text.name}'

    def describe(self, name):
        self._note('describe', name)
        return ModelText(name, 'text', pose=Pose((1.0, 0.0, 0.0)))


class FakeJoints(Remembering, parts=(Joints,)):
    """Joints that all stand at `now`."""

    def __init__(self):
        super().__init__()
        self.topics, self.now = (), 0.25

    def position(self, model, joint):
        return self.now

    def command_topics(self):
        return self.topics


class FakeTopics:
    """Keeps what is open, and answers with the readings that it is given."""

    def __init__(self, topics=()):
        self.published, self.open_topics, self.readings = dict(topics), set(), {}
        self.place = ('base', Pose((0.0, 0.0, 0.5)))  # of every frame

    def offered(self):
        return dict(self.published)

    def open(self, topic, kind):
        assert self.published[topic] == kind
        self.open_topics.add(topic)

    def close(self, topic):
        self.open_topics.remove(topic)

    def read(self, topic):
        assert topic in self.open_topics
        reading = self.readings.pop(topic, None)
        if isinstance(reading, str):
            raise SimError(reading)
        return reading

    def locate(self, frame, links):
        self.links = links
        return self.place


class FakeMaps(FakeTopics):
    """The same, and a true map."""

    def __init__(self, topics=()):
        super().__init__(topics)
        self.truth, self.heights = ShownReading(words='no cell'), []

    def true_map(self, height):
        self.heights.append(height)
        if isinstance(self.truth, str):
            raise SimError(self.truth)
        return self.truth


class FakeGoals(Remembering, parts=(Goals,)):
    """Topics of poses; `frames` says at which link each frame is, and where."""

    def __init__(self):
        super().__init__()
        self.goals, self.estimates = (), ()
        self.frames = {}
        self.is_listening = False

    def goal_topics(self):
        return self.goals

    def estimate_topics(self):
        return self.estimates

    def locate(self, frame, links):
        self.is_listening = True
        return self.frames.get(frame)

    def rest(self):
        self.is_listening = False


class FakeSignals:
    """Keeps what is open, and answers with the samples that it is given."""

    def __init__(self, topics=()):
        self.topics, self.open_curves, self.samples = dict(topics), set(), {}
        self.opened = []  # every curve that was opened, in order
        self.fault = ''

    def signal_topics(self):
        return dict(self.topics)

    def open(self, curve):
        if self.fault:
            raise SimError(self.fault)
        self.opened.append(curve)
        self.open_curves.add(curve)

    def close(self, curve):
        self.open_curves.remove(curve)

    def read(self):
        samples, self.samples = self.samples, {}
        return {curve: samples.get(curve, []) for curve in self.open_curves}


class Shown:
    """Remembers what a view shows."""

    def __init__(self, view):
        self.changes, self.motions = [], []
        view.open(self.changes.append, self.motions.append)


def selection(page):
    """Return what is selected in the browser that connected first."""
    return next(iter(page.browsers.values())).selection


def model(name, number, shape=None, position=(0.0, 0.0, 0.0), links=('link',)):
    """Return a model of links, numbered from that on, each with a visual 1 m above its frame."""
    visual = Visual('v', shape or Box((1.0, 1.0, 1.0)), Pose((0.0, 0.0, 1.0)))
    found = (ShownLink(n, link, Pose(position), (visual,)) for n, link in enumerate(links, number))
    return ShownModel(name, tuple(found))


def models_with(*shown):
    """Return the models of a page that is shown these."""
    models = Models()
    models.apply(SceneChange(True, shown))
    return models


def clock(time=0.0, real_time=0.0, paused=False, **poses):
    """Return a motion; _3=POSE is of the link of number 3."""
    return ShownMotion(
        time,
        real_time,
        round(1000 * time),
        paused,
        {int(name[1:]): pose for name, pose in poses.items()},
    )
