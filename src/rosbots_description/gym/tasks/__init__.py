"""The tasks that are registered with Gymnasium, for the robot of the article."""

from .follow_line import FollowLine
from .go_to_goal import GoToGoal
from .maze import Maze
from .wander import Wander

__all__ = ['FollowLine', 'GoToGoal', 'Maze', 'Wander']
