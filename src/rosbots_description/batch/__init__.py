"""Many runs of one scenario: parameters, records, conditions, and one row a run in Parquet.

A run needs no ROS. Ray, which only `run` imports, spreads runs over processes and machines.
"""

from .conditions import Condition
from .local_ray import ClusterError, remove_left_folders
from .parameters import Parameters, Run
from .policy import Commands, Policy, PolicyError, commands_of, load_policy
from .records import JointReading, Statistics, check_vectors, value_at
from .runner import Progress, Result, count_rows, run
from .scenario import ModelEntry, RecordEntry, Scenario, ScenarioError, ScenarioFile

__all__ = [
    'ClusterError',
    'Commands',
    'Condition',
    'JointReading',
    'ModelEntry',
    'Parameters',
    'Policy',
    'PolicyError',
    'Progress',
    'RecordEntry',
    'Result',
    'Run',
    'Scenario',
    'ScenarioError',
    'ScenarioFile',
    'Statistics',
    'check_vectors',
    'commands_of',
    'count_rows',
    'load_policy',
    'remove_left_folders',
    'run',
    'value_at',
]
