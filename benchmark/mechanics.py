#!/usr/bin/env python3
"""Solve the friction law of the recorded drives to convergence; write test/data/mechanics.json.

Takes some ten minutes. To be repeated when shapes, friction or contact stiffness of the engine
change. Arguments are names of robots, to solve only their drives again.
"""

import json
import logging
import sys

from support.converged import FILE, converged_world
from support.motion import MOTORED, drive_as_recorded, measure, samples_at
from support.recorded import load

DIGITS = 6


def main(names: list[str]) -> int:
    """Solve and write; return the exit code."""
    logging.disable(logging.WARNING)
    found = json.loads(FILE.read_text(encoding='utf-8')) if FILE.exists() else {}
    for name in names or MOTORED:
        for command, recorded in load(name)['drives'].items():
            samples = drive_as_recorded(name, command, make_world=converged_world)
            quantities = measure(samples, recorded['seconds'])
            trace = [sample[:4] for sample in samples_at(samples, recorded['trace'])]
            found[f'{name} {command}'] = {
                'quantities': {key: round(value, DIGITS) for key, value in quantities.items()},
                'trace': [[round(value, DIGITS) for value in row] for row in trace],
            }
            print(f'{name} {command}: {quantities["v"]:.4f} m/s, {quantities["w"]:.4f} rad/s')
    lines = (f'{json.dumps(key)}: {json.dumps(value)}' for key, value in sorted(found.items()))
    FILE.write_text('{\n' + ',\n'.join(lines) + '\n}\n', encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
