"""The tasks that are registered with Gymnasium, for the robot of the article."""

from .go_to_goal import GoToGoal

__all__ = ['GoToGoal']
