"""The scene in the browser: models, lights, cameras, and what is selected."""

from .follow import FollowPanel
from .ground import Ground
from .ground_clicks import GroundClicks
from .models import Models
from .nodes import link_node, node, place, pose_of, wxyz
from .outline import Outline
from .overlays import OVERLAYS
from .recordings import PATIENCE, BrowserRecording, SceneRecording, VideoRecording
from .scene import SceneView
from .selection import Selection
from .start_view import StartView
from .views import ViewPanel

__all__ = [
    'OVERLAYS',
    'PATIENCE',
    'BrowserRecording',
    'FollowPanel',
    'Ground',
    'GroundClicks',
    'Models',
    'Outline',
    'SceneRecording',
    'SceneView',
    'Selection',
    'StartView',
    'VideoRecording',
    'ViewPanel',
    'link_node',
    'node',
    'place',
    'pose_of',
    'wxyz',
]
