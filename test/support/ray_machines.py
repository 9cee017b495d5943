"""A batch on several machines of one host.

For a process of its own: forks of one that had them crash when they free Ray's client.
"""

import os
import tempfile
from pathlib import Path
from typing import Any

from rosbots_description.batch import Result, cluster, local_ray, run


def run_on_several_machines(scenario: dict[str, Any]) -> Result:
    """Make a batch on a cluster of a head and two machines; return the result."""
    with tempfile.TemporaryDirectory(prefix='rb') as place, local_ray.private_environment():
        Path(place, 'ray').mkdir()  # for what Cluster writes
        # By default Ray notices a lost machine after 15 s.
        os.environ.update(RAY_TMPDIR=place, RAY_health_check_period_ms='500')
        from ray.cluster_utils import Cluster

        several = Cluster(
            initialize_head=True,
            head_node_args={
                'num_cpus': 0,
                'include_dashboard': False,
                'include_log_monitor': False,
                'no_monitor': True,
                'temp_dir': place,
                'object_store_memory': cluster.STORE_BYTES,
            },
        )
        try:
            for _ in range(2):
                several.add_node(num_cpus=1, object_store_memory=cluster.STORE_BYTES)
            return run(scenario, address=several.address)
        finally:
            several.shutdown()
